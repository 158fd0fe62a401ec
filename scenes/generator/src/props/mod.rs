//! Things that scenes hold. Each stands on y = 0 about the origin and looks along +z, unless it says otherwise.

pub mod church;
pub mod furniture;
pub mod industry;
pub mod kitchen;
