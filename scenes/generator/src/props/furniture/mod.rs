//! Furniture of homes.

mod books;
mod joinery;
mod lamps;
mod ornaments;
mod plants;
mod seating;
mod storage;
mod tables;
mod textiles;
mod upholstery;

pub use books::{bookcase, pile};
pub use joinery::{bar_handle, casing, door, door_leaf, framed_panel, knob, on_end, skirting};
pub use lamps::{downlight, pendant, shaded, uplighter};
pub use ornaments::{BOWL, VASE, picture};
pub use plants::{potted_fern, potted_rubber_tree};
pub use seating::{chair, turned_leg};
pub use storage::{chest, night_table, sideboard, wardrobe};
pub use tables::{coffee_table, console, desk, dining_table, round_table};
pub use textiles::{drapes, rug};
pub use upholstery::{bed, sofa};
