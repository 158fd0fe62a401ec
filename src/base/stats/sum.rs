//! Sums of counts of parts of the work.

/// Implements `+=` field by field.
#[macro_export]
macro_rules! add_fields {
    ($counts:ident { $($field:ident),+ $(,)? }) => {
        impl std::ops::AddAssign for $counts {
            #[inline]
            fn add_assign(&mut self, other: $counts) {
                // Without `..`, so that a field cannot be forgotten.
                let $counts { $($field),+ } = other;
                $(self.$field += $field;)+
            }
        }
    };
}
pub use add_fields;
