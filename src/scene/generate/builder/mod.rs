//! The shapes that generated scenes are made of. A shape function returns a [`Shell`], an indexed surface
//! that knows which of its edges are creases; [`Part::add`] places it, computes its normals and appends
//! it. Repeated things are built once as a `Part` of their own and placed with [`Part::append`].
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
mod patch;
mod path;
mod revolve;
mod rng;
mod shell;
mod solids;
mod spline;
mod sweep;

#[cfg(test)]
mod tests;

pub use arch::{PointedArch, arc, circle, foil, rectangle};
pub use assembly::Assembly;
pub use extrude::{Faces, extrude, extrude_faces, upright};
pub use loft::{disc, loft, rounded_box, rounded_rectangle, stacked, superellipsoid};
pub use patch::{grid, parallelogram, patch};
pub use path::{fillet, helix};
pub use revolve::{cone, cylinder, ellipsoid, lathe, lathe_sector, profile_lathe, ring, torus, tube};
pub use rng::Rng;
pub use shell::Shell;
pub use solids::{beveled_box, block, frustum, slab};
pub use spline::{spline, spline3};
pub use sweep::{Section, pipe, rod, sweep, sweep_along};

use super::Part;
use glam::{Affine3A, Mat3, Quat, Vec3};

impl Part {
    /// An empty part called `name`.
    pub fn new(name: &str) -> Self {
        Part { name: name.to_owned(), ..Part::default() }
    }

    /// Appends `shell` as it stands.
    pub fn add(&mut self, shell: &Shell) {
        self.add_at(shell, &Affine3A::IDENTITY);
    }

    /// Appends `shell` placed by `transform`; a mirroring transform keeps the outside outside.
    pub fn add_at(&mut self, shell: &Shell, transform: &Affine3A) {
        let mut piece = Part::default();
        normals::write(shell, &mut piece);
        self.append(&piece, transform);
    }

    /// Appends a copy of `piece` placed by `transform`; a mirroring transform keeps the outside outside.
    pub fn append(&mut self, piece: &Part, transform: &Affine3A) {
        let base = self.positions.len() as u32;
        let linear = Mat3::from(transform.matrix3);
        let to_normal = linear.inverse().transpose();
        let mirrored = linear.determinant() < 0.0;
        self.positions.extend(piece.positions.iter().map(|&p| transform.transform_point3(p)));
        self.normals.extend(piece.normals.iter().map(|&n| (to_normal * n).normalize()));
        self.uvs.extend_from_slice(&piece.uvs);
        self.triangles.extend(piece.triangles.iter().map(|&[a, b, c]| {
            if mirrored { [base + a, base + c, base + b] } else { [base + a, base + b, base + c] }
        }));
    }

    /// The surface area of all triangles.
    pub fn area(&self) -> f64 {
        self.triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| self.positions[i as usize].as_dvec3());
                0.5 * (b - a).cross(c - a).length()
            })
            .sum()
    }
}

/// A translation.
pub fn at(x: f32, y: f32, z: f32) -> Affine3A {
    Affine3A::from_translation(Vec3::new(x, y, z))
}

/// A turn about the y axis by `degrees`, then a translation to `position`.
pub fn turned(degrees: f32, position: Vec3) -> Affine3A {
    Affine3A::from_rotation_translation(Quat::from_rotation_y(degrees.to_radians()), position)
}

/// The transform that takes the origin to `from` and the y axis to the direction of `to`, for shapes that
/// are turned on the lathe.
pub fn standing_on(from: Vec3, to: Vec3) -> Affine3A {
    let axis = (to - from).normalize_or(Vec3::Y);
    Affine3A::from_rotation_translation(Quat::from_rotation_arc(Vec3::Y, axis), from)
}

/// Reflection in the plane x = `x`.
pub fn mirror_x(x: f32) -> Affine3A {
    at(2.0 * x, 0.0, 0.0) * Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0))
}

/// Reflection in the plane z = `z`.
pub fn mirror_z(z: f32) -> Affine3A {
    at(0.0, 0.0, 2.0 * z) * Affine3A::from_scale(Vec3::new(1.0, 1.0, -1.0))
}
