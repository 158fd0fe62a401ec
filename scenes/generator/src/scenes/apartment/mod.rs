//! A flat by day: living room, corridor, bedroom and study, about 72,000 triangles, 62 % of the surface area
//! glossy (painted walls, parquet, lacquer). The scene file leads a walk through it.
//!
//! x runs from the living room's window wall (0) to the flat's door (9.7), z towards the viewer.
//! ```text
//!           5.6 5.7            9.7
//!            +---+--------------+ -2.4
//!            |   |   bedroom
//!  0 +-------+   |              |
//!    |           +---------[ ]--+ 1.6 .. 1.7
//!    |  living  [ ]  corridor
//!    |           +--[ ]---------+ 3.0 .. 3.1
//! 4.6+-------+   |   study      |
//!            +---+--------------+ 5.6
//! ```

mod parquet;
mod rooms;
mod walls;

use crate::shapes::*;

/// Parts of the scene.
pub fn parts() -> Vec<Part> {
    let mut scene = Assembly::new();
    walls::add(&mut scene);
    parquet::add(&mut scene);
    rooms::add(&mut scene);
    scene.into_parts()
}
