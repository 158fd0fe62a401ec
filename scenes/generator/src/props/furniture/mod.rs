//! Furniture of homes.

mod books;
mod joinery;
mod lamps;
mod plants;
mod seating;
mod textiles;
mod upholstery;

pub use books::{bookcase, pile};
pub use joinery::{bar_handle, casing, door, door_leaf, framed_panel, knob, skirting};
pub use lamps::{downlight, pendant, shaded, uplighter};
pub use plants::{potted_fern, potted_rubber_tree};
pub use seating::{chair, turned_leg};
pub use textiles::{curtain, rug};
pub use upholstery::{bed, sofa};
