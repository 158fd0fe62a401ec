//! The scenes: the measures of each and where things stand.

pub mod apartment;
pub mod hall;
pub mod kitchen;
pub mod knot;
pub mod nave;
pub mod plaza;
