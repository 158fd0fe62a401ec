//! Sets of a material's lobes.

/// Set of some of a material's lobes, one bit per slot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LobeSet(pub(super) u8);

impl LobeSet {
    /// Returns true if the set is empty.
    #[inline]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns true if the lobe in a slot is in the set.
    #[inline(always)]
    pub(super) fn has(self, slot: usize) -> bool {
        self.0 >> slot & 1 != 0
    }
}
