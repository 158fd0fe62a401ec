//! The shapes that generated scenes are made of. A shape function returns a [`Shell`], an indexed surface
//! that knows which of its edges are creases; [`Assembly::add_at`] computes its normals, places it and appends it to a
//! part. Whatever consists of several shells is an [`Assembly`].
//!
//! Conventions: y is up, faces are counter-clockwise seen from outside, texture coordinates are metres
//! along the surface, so that a scene file scales its textures by the material alone.
//!
//! Units: metres; angles in degrees where a name says so, else radians.

mod arch;
mod assembly;
mod extrude;
mod loft;
mod normals;
mod part;
mod patch;
mod path;
mod place;
mod revolve;
mod rng;
mod shell;
mod solids;
mod spline;
mod sweep;
mod vessel;

#[cfg(test)]
mod tests;

pub use arch::{PointedArch, arc, circle, foil, points, rectangle, scaled};
pub use assembly::Assembly;
pub use extrude::{Faces, extrude, extrude_faces};
pub use loft::{disc, loft, rounded_box, rounded_rectangle, stacked, superellipsoid};
pub use part::Part;
pub use patch::{grid, patch, sheet};
pub use path::{fillet, helix};
pub use place::{
    at, both_sides, feet, mirror_x, mirror_z, moved, posed, standing_on, turned, turns, upright,
};
pub use revolve::{cone, cylinder, ellipsoid, lathe, lathe_sector, profile_lathe, ring, spindle, torus};
pub use rng::Rng;
pub use shell::Shell;
pub use solids::{beveled_box, block, frustum, slab, tile};
pub use spline::{spline, spline3};
pub use sweep::{Section, pipe, rod, sweep, sweep_along};
pub use vessel::Vessel;
