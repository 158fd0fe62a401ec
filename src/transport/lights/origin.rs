//! Origin of light, and pairs of values: one for direct light, one for indirect light.

use serde::{Deserialize, Serialize};
use std::ops::{Index, IndexMut};

/// Origin of a VPL's light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Origin {
    /// Emitted at its position.
    Direct,
    /// Reflected at its position.
    Indirect,
}

impl Origin {
    /// All origins.
    pub const ALL: [Origin; 2] = [Origin::Direct, Origin::Indirect];
}

/// One value for each origin of light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DirectIndirect<T> {
    /// Value for direct light.
    pub direct: T,
    /// Value for indirect light.
    pub indirect: T,
}

impl<T> DirectIndirect<T> {
    /// Creates a pair from a function of the origin.
    #[inline]
    pub fn from_fn(mut value: impl FnMut(Origin) -> T) -> DirectIndirect<T> {
        DirectIndirect { direct: value(Origin::Direct), indirect: value(Origin::Indirect) }
    }

    /// Applies a function to each value.
    #[inline]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> DirectIndirect<U> {
        DirectIndirect { direct: f(self.direct), indirect: f(self.indirect) }
    }

    /// References to both values.
    #[inline]
    pub fn as_ref(&self) -> DirectIndirect<&T> {
        DirectIndirect { direct: &self.direct, indirect: &self.indirect }
    }

    /// Both values, the value of direct light first.
    #[inline]
    pub fn into_array(self) -> [T; 2] {
        [self.direct, self.indirect]
    }
}

impl DirectIndirect<bool> {
    /// True if either holds.
    #[inline]
    pub fn any(self) -> bool {
        self.direct || self.indirect
    }

    /// Returns the one origin for which it holds; `None` if it holds for both or neither.
    #[inline]
    pub fn single_origin(self) -> Option<Origin> {
        match (self.direct, self.indirect) {
            (true, false) => Some(Origin::Direct),
            (false, true) => Some(Origin::Indirect),
            _ => None,
        }
    }
}

impl<T> Index<Origin> for DirectIndirect<T> {
    type Output = T;

    #[inline]
    fn index(&self, origin: Origin) -> &T {
        match origin {
            Origin::Direct => &self.direct,
            Origin::Indirect => &self.indirect,
        }
    }
}

impl<T> IndexMut<Origin> for DirectIndirect<T> {
    #[inline]
    fn index_mut(&mut self, origin: Origin) -> &mut T {
        match origin {
            Origin::Direct => &mut self.direct,
            Origin::Indirect => &mut self.indirect,
        }
    }
}
