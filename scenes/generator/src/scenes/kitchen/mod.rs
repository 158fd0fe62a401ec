//! A fitted kitchen with a laid table, lit by fifteen small lamps, one of them aimed at the ceiling: about
//! 72,000 triangles, 28 % of the surface area glossy.
//!
//! The room spans x 0..4.6, y 0..2.6, z 0..4.2. Against the back wall (z = 0) stand refrigerator, cooker and
//! cupboards, against the right wall (x = 4.6) the sink below a window; the table is near the front left.

mod layout;
mod room;
mod table;

use crate::shapes::*;

/// Parts of the scene.
pub fn parts() -> Vec<Part> {
    let mut scene = Assembly::new();
    room::add(&mut scene);
    layout::add(&mut scene);
    table::add(&mut scene);
    scene.into_parts()
}
