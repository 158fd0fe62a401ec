//! Versions of Embree.

use std::fmt;

/// A version of Embree; compares in release order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Version {
    /// Major version.
    pub major: u32,
    /// Minor version.
    pub minor: u32,
    /// Patch level.
    pub patch: u32,
}

impl Version {
    /// True if the bindings support this version. Hits are smaller in 4.2, and 5 has another interface.
    pub(super) fn is_supported(self) -> bool {
        self.major == 4 && self.minor >= 3
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}.{}.{}", self.major, self.minor, self.patch)
    }
}
