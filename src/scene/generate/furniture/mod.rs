//! Things that more than one of the furnished scenes holds. Each function yields an [`Assembly`](super::builder::Assembly) that
//! stands on y = 0 about the origin, looking along +z, or adds to one.

mod books;
mod joinery;
mod lamps;
mod plants;
mod seating;
mod textiles;
mod upholstery;
mod vessels;

pub(super) use books::{bookcase, pile};
pub(super) use joinery::{bar_handle, casing, door, door_leaf, framed_panel, knob, skirting};
pub(super) use lamps::{downlight, pendant, shaded, uplighter};
pub(super) use plants::{potted_fern, potted_rubber_tree};
pub(super) use seating::{chair, turned_leg};
pub(super) use textiles::{curtain, rug};
pub(super) use upholstery::{bed, sofa};
pub(super) use vessels::{Vessel, turned};

pub(super) use super::builder;
