//! Things that more than one of the furnished scenes holds. Each function yields an [`Assembly`](super::builder::Assembly) that
//! stands on y = 0 about the origin, looking along +z, or adds to one.

mod joinery;
mod lamps;
mod seating;
mod vessels;

pub(super) use joinery::{bar_handle, casing, door, framed_panel, knob, skirting};
pub(super) use lamps::{downlight, pendant, uplighter};
pub(super) use seating::{chair, turned_leg};
pub(super) use vessels::{Vessel, turned};

pub(super) use super::builder;
