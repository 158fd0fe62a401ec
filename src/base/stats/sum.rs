//! Sums of structs of counts.

/// Implements `+=` field by field.
#[macro_export]
macro_rules! add_fields {
    ($counts:ident { $($field:ident),+ $(,)? }) => {
        impl std::ops::AddAssign for $counts {
            #[inline]
            fn add_assign(&mut self, other: $counts) {
                // The pattern has no `..`, so that no field is forgotten.
                let $counts { $($field),+ } = other;
                $(self.$field += $field;)+
            }
        }
    };
}
pub use add_fields;
