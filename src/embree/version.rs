//! Versions of Embree.

use std::fmt;

/// A version of Embree; compares in release order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Version {
    /// First number: the ABI.
    pub major: u32,
    /// Second number.
    pub minor: u32,
    /// Third number.
    pub patch: u32,
}

impl Version {
    /// True if the bindings describe this version: 4.2 has a smaller hit, 5 is another interface.
    pub(super) fn is_supported(self) -> bool {
        self.major == 4 && self.minor >= 3
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}.{}.{}", self.major, self.minor, self.patch)
    }
}
