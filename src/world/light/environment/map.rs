//! Cells of an environment map: the squares between four texels. The first and last rows of texels lie at the poles.
//!
//! Radiance is bilinear in a cell. A cell is sampled by the mean luminance of its corners times its solid angle, and a
//! point in it by the bilinear luminance. So the density is proportional to radiance up to the variation of the sine of
//! the latitude over one row, and a sun of one texel adds no variance.

use super::tiles::Grid;
use crate::light::DiscreteDistribution;
use base::math::{Rgb, luminance};
use glam::{Vec2, Vec3};
use scene::EnvironmentMap;
use std::f32::consts::{FRAC_1_PI, PI, TAU};
use std::ops::Range;

/// An environment map and the distributions of its cells.
#[derive(Clone, Debug)]
pub(super) struct Map {
    map: EnvironmentMap,
    /// Distribution of the rows.
    rows: DiscreteDistribution,
    /// Distribution of the columns of each row.
    columns: Vec<DiscreteDistribution>,
}

/// A point in the map.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CellPoint {
    pub column: usize,
    pub row: usize,
    /// Position in the cell, in [0, 1]².
    pub f: Vec2,
}

/// Radiance at the corners of a cell: top left, top right, bottom left, bottom right.
pub(super) type Corners = [Rgb; 4];

impl Map {
    /// Builds the distributions of a map.
    pub fn new(map: &EnvironmentMap) -> Map {
        let mut found = Map { map: map.clone(), rows: DiscreteDistribution::new([]), columns: Vec::new() };
        let rows = found.row_count();
        let share = |row: usize| {
            // Exact share of the sphere between two latitudes.
            let cos = |row: usize| (PI * row as f32 / rows as f32).cos();
            (cos(row) - cos(row + 1)).max(0.0)
        };
        let columns = (0..rows).map(|row| {
            let weight = share(row);
            DiscreteDistribution::new((0..map.width).map(|x| found.mean_luminance(x, row) * weight))
        });
        let columns: Vec<DiscreteDistribution> = columns.collect();
        found.rows = DiscreteDistribution::new(columns.iter().map(|c| c.total() as f32));
        found.columns = columns;
        found
    }

    /// Returns the mean luminance over the sphere of directions.
    pub fn mean(&self) -> f32 {
        self.rows.total() as f32 / (2.0 * self.map.width as f32)
    }

    /// Returns the mean of the corners' luminances.
    fn mean_luminance(&self, column: usize, row: usize) -> f32 {
        0.25 * luminance(self.corners(column, row).iter().sum())
    }

    /// Returns the number of rows of cells, which is one less than the number of rows of texels.
    fn row_count(&self) -> usize {
        self.map.height.max(2) - 1
    }

    /// Returns the point of the unit world direction `d`.
    #[inline]
    pub fn locate(&self, d: Vec3) -> CellPoint {
        let local = self.map.to_local * d;
        let u = local.x.atan2(-local.z) / TAU;
        let x = (u - u.floor()) * self.map.width as f32 - 0.5;
        let column = x.floor();
        let (row, y) = self.row_at(local.y);
        CellPoint {
            column: (column as i64).rem_euclid(self.map.width as i64) as usize,
            row,
            f: Vec2::new(x - column, y),
        }
    }

    /// Returns the row at height `z` above the horizon, and the position in it.
    #[inline]
    fn row_at(&self, z: f32) -> (usize, f32) {
        let rows = self.row_count();
        let y = z.clamp(-1.0, 1.0).acos() * FRAC_1_PI * rows as f32;
        let row = (y as usize).min(rows - 1);
        (row, (y - row as f32).clamp(0.0, 1.0))
    }

    /// Returns the point at height `z` above the horizon and `x` cells from the first column's left edge.
    #[inline]
    pub fn place_at(&self, z: f32, x: f32) -> CellPoint {
        let column = (x as usize).min(self.map.width - 1);
        let (row, y) = self.row_at(z);
        CellPoint { column, row, f: Vec2::new(x - column as f32, y) }
    }

    /// Returns the unit world direction of a point.
    #[inline]
    pub fn direction(&self, CellPoint { column, row, f }: CellPoint) -> Vec3 {
        let (sin_theta, cos_theta) = self.polar_angle(row, f).sin_cos();
        self.towards(sin_theta, cos_theta, column as f32 + f.x)
    }

    /// Returns the unit world direction at height `z` above the horizon and `x` cells from the first column's left
    /// edge.
    #[inline]
    pub fn direction_at(&self, z: f32, x: f32) -> Vec3 {
        self.towards((1.0 - z * z).max(0.0).sqrt(), z, x)
    }

    /// Returns the unit world direction of a polar angle and `x` cells from the first column's left edge.
    fn towards(&self, sin_theta: f32, cos_theta: f32, x: f32) -> Vec3 {
        let (sin_phi, cos_phi) = (TAU * (x + 0.5) / self.map.width as f32).sin_cos();
        // The matrix is a rotation, so that its transpose is its inverse.
        let local = Vec3::new(sin_phi * sin_theta, cos_theta, -cos_phi * sin_theta);
        (self.map.to_local.transpose() * local).normalize()
    }

    /// Returns the angle from the upper pole.
    #[inline]
    fn polar_angle(&self, row: usize, f: Vec2) -> f32 {
        PI * (row as f32 + f.y) / self.row_count() as f32
    }

    /// Returns the radiance at a cell's corners.
    #[inline]
    pub fn corners(&self, column: usize, row: usize) -> Corners {
        self.texels(column, row).map(|i| self.map.radiance[i])
    }

    /// Returns the indices of the texels at a cell's corners.
    #[inline]
    fn texels(&self, column: usize, row: usize) -> [usize; 4] {
        let EnvironmentMap { width, height, .. } = &self.map;
        let right = if column + 1 == *width { 0 } else { column + 1 };
        let (top, bottom) = (row * width, (row + 1).min(height - 1) * width);
        [top + column, top + right, bottom + column, bottom + right]
    }

    /// Samples a point among a few cells.
    pub fn sample(&self, [columns, rows]: &[Range<usize>; 2], u: Vec2) -> CellPoint {
        let flux = |row: usize| self.flux(row, columns);
        let total: f32 = rows.clone().map(flux).sum();
        let (mut row, mut before) = (rows.start, 0.0);
        let mut here = flux(row);
        while row + 1 < rows.end && before + here <= u.y * total {
            before += here;
            row += 1;
            here = flux(row);
        }
        let rest_y =
            if here > 0.0 { ((u.y * total - before) / here).clamp(0.0, 1.0 - f32::EPSILON) } else { 0.0 };
        let (column, rest_x) = self.columns[row].sample_between(columns, u.x);
        let f = sample_bilinear(self.luminances(column, row), Vec2::new(rest_x, rest_y));
        CellPoint { column, row, f }
    }

    /// Returns the density per solid angle with which points are sampled among all cells, at a point of radiance
    /// `radiance`.
    #[inline]
    pub fn density(&self, point: CellPoint, corners: &Corners, radiance: Rgb) -> f32 {
        let cell = self.rows.probability(point.row) * self.columns[point.row].probability(point.column);
        let mean = 0.25 * luminance(corners.iter().sum());
        let theta = self.polar_angle(point.row, point.f);
        let cell_angle =
            (TAU / self.map.width as f32) * (PI / self.row_count() as f32) * theta.sin().max(1e-7);
        if mean > 0.0 { cell * luminance(radiance) / (mean * cell_angle) } else { 0.0 }
    }
}

impl Grid for Map {
    fn size(&self) -> [usize; 2] {
        [self.map.width, self.row_count()]
    }

    fn height(&self, row: usize) -> f32 {
        (PI * row as f32 / self.row_count() as f32).cos()
    }

    fn flux(&self, row: usize, columns: &Range<usize>) -> f32 {
        self.rows.probability(row) * self.columns[row].span(columns)
    }

    fn luminances(&self, column: usize, row: usize) -> [f32; 4] {
        self.corners(column, row).map(luminance)
    }
}

/// Interpolates between the corners of a cell.
#[inline]
pub(super) fn bilinear([a, b, c, d]: &Corners, f: Vec2) -> Rgb {
    a.lerp(*b, f.x).lerp(c.lerp(*d, f.x), f.y)
}

/// Samples a point of the unit square by values at its corners, bilinear between them.
fn sample_bilinear([a, b, c, d]: [f32; 4], u: Vec2) -> Vec2 {
    let y = sample_linear(a + b, c + d, u.y);
    let x = sample_linear(a + (c - a) * y, b + (d - b) * y, u.x);
    Vec2::new(x, y)
}

/// Samples [0, 1] with a density that is linear between `a` and `b`.
fn sample_linear(a: f32, b: f32, u: f32) -> f32 {
    if a + b <= 0.0 {
        return u;
    }
    let root = (a * a + (b * b - a * a) * u).max(0.0).sqrt();
    (u * (a + b) / (a + root)).clamp(0.0, 1.0)
}
