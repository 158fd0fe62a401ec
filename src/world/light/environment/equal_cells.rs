//! Cells of equal solid angle, for a constant environment.

use super::tiles::Grid;
use glam::Vec3;
use std::f32::consts::TAU;
use std::ops::Range;

/// Number of cells along an edge.
const CELLS: usize = 16;

/// Grid of cells of equal solid angle. The first row lies around the z axis.
pub(super) struct EqualCells;

impl EqualCells {
    /// Returns the unit direction at height `z` and `x` cells from the first column's left edge.
    #[inline]
    pub fn direction(z: f32, x: f32) -> Vec3 {
        let (sin, cos) = (TAU * x / CELLS as f32).sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        Vec3::new(r * cos, r * sin, z)
    }

    /// Returns column and row of a unit direction.
    #[inline]
    pub fn cell(d: Vec3) -> (usize, usize) {
        let cell = |x: f32| ((x * CELLS as f32) as usize).min(CELLS - 1);
        let phi = d.y.atan2(d.x) / TAU;
        (cell(phi - phi.floor()), cell(0.5 - 0.5 * d.z))
    }
}

impl Grid for EqualCells {
    fn size(&self) -> [usize; 2] {
        [CELLS; 2]
    }

    fn height(&self, row: usize) -> f32 {
        1.0 - 2.0 * row as f32 / CELLS as f32
    }

    fn flux(&self, _: usize, columns: &Range<usize>) -> f32 {
        columns.len() as f32 / (CELLS * CELLS) as f32
    }

    fn luminances(&self, _: usize, _: usize) -> [f32; 4] {
        [1.0; 4]
    }
}
