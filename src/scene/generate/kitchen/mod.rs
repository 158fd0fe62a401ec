//! A fitted kitchen with a laid table, lit by fifteen small lamps, one of them aimed at the ceiling: about
//! 72,000 triangles, 28 % of the surface area glossy.
//!
//! The room spans x 0..4.6, y 0..2.6, z 0..4.2. Against the back wall (z = 0) stand refrigerator, cooker and
//! cupboards, against the right wall (x = 4.6) the sink below a window; the table is near the front left.

mod appliances;
mod cabinets;
mod layout;
mod room;
mod sink;
mod table;
mod tableware;

use super::{Part, builder, furniture};
use builder::Assembly;
use glam::Vec3;

/// The room's extent from the origin.
const ROOM: Vec3 = Vec3::new(4.6, 2.6, 4.2);
/// Height of the upper face of the worktops.
const WORKTOP: f32 = 0.9;
/// Depth of worktops from the wall.
const WORKTOP_DEPTH: f32 = 0.63;
/// Depth of the bodies of the base cupboards.
const BASE_DEPTH: f32 = 0.58;
/// Lower edge and height of the wall cupboards, and their depth.
const WALL_UNIT: (f32, f32, f32) = (1.45, 0.72, 0.33);

/// The parts of the scene.
pub(super) fn parts() -> Vec<Part> {
    let mut scene = Assembly::new();
    room::add(&mut scene);
    layout::add(&mut scene);
    table::add(&mut scene);
    scene.into_parts()
}
