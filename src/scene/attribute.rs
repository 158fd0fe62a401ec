//! Attributes of meshes: colours and numbers that vertices or triangles have, such as vertex colours.
//!
//! A number is stored as a grey.

use base::math::Rgb;
use glam::Vec2;
use std::ops::{Add, Mul};

/// Number of an attribute's name, the same in all meshes of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct AttributeId(pub u32);

/// Attribute of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// Number of its name.
    pub id: AttributeId,
    /// Values of the vertices or triangles.
    pub values: AttributeValues,
}

/// Values of an attribute.
#[derive(Clone, Debug, PartialEq)]
pub enum AttributeValues {
    /// Value of each vertex. It is interpolated linearly on triangles.
    Vertices(Vec<Rgb>),
    /// Value of each triangle.
    Triangles(Vec<Rgb>),
}

impl AttributeValues {
    /// Returns the values at the corners of triangle `triangle`, whose vertices are `vertices`.
    #[inline]
    pub fn corners(&self, triangle: usize, vertices: &[u32; 3]) -> [Rgb; 3] {
        match self {
            AttributeValues::Vertices(values) => vertices.map(|i| values[i as usize]),
            AttributeValues::Triangles(values) => [values[triangle]; 3],
        }
    }

    /// Returns the value at barycentric weights `b` of the last two of a triangle's `vertices`.
    #[inline]
    pub fn at(&self, triangle: usize, vertices: &[u32; 3], b: Vec2) -> Rgb {
        match self {
            AttributeValues::Vertices(_) => interpolated(self.corners(triangle, vertices), b),
            AttributeValues::Triangles(values) => values[triangle],
        }
    }

    /// Returns all values.
    pub fn all(&self) -> &[Rgb] {
        let (AttributeValues::Vertices(values) | AttributeValues::Triangles(values)) = self;
        values
    }

    /// Returns all values for changes.
    pub fn all_mut(&mut self) -> &mut Vec<Rgb> {
        let (AttributeValues::Vertices(values) | AttributeValues::Triangles(values)) = self;
        values
    }
}

/// Returns the value at barycentric weights `at` of the last two corners.
#[inline]
pub fn interpolated<T: Add<Output = T> + Mul<f32, Output = T>>([a, b, c]: [T; 3], at: Vec2) -> T {
    a * (1.0 - at.x - at.y) + b * at.x + c * at.y
}
