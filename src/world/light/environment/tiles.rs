//! Tiles of the sphere of directions, of about equal flux.
//!
//! Directions are sampled uniformly in tiles of about constant radiance. In other tiles a block of cells is sampled
//! first, then a direction in it, uniformly if its radiance is about constant. The tables of cells exceed the caches,
//! and reading them takes longer than the shadow ray.

use crate::light::DiscreteDistribution;
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use std::f32::consts::TAU;
use std::ops::Range;

/// Maximum number of tiles.
const MAX_TILES: usize = 256;

/// Maximum number of blocks of cells along an edge. Tiles consist of whole blocks.
const MAX_BLOCKS: usize = 256;

/// Maximum squared coefficient of variation of the radiance in an even tile or block, which is the relative variance
/// that it adds to an estimate.
const EVEN: f64 = 0.03;

/// Grid of cells over the sphere of directions. Columns have equal azimuths, and rows lie between two heights.
pub(super) trait Grid: Sync {
    /// Returns the numbers of columns and rows.
    fn size(&self) -> [usize; 2];
    /// Returns the height above the horizon, in [-1, 1], at which a row begins. Heights decrease with the row.
    fn height(&self, row: usize) -> f32;
    /// Returns the share of all flux in some columns of a row.
    fn flux(&self, row: usize, columns: &Range<usize>) -> f32;
    /// Returns the luminances at a cell's corners, between which luminance is bilinear.
    fn luminances(&self, column: usize, row: usize) -> [f32; 4];
}

/// Rectangle of cells.
#[derive(Clone, Debug)]
pub(super) struct Tile {
    /// Columns and rows.
    pub cells: [Range<usize>; 2],
    /// Columns and rows of blocks.
    blocks: [Range<usize>; 2],
    /// Distribution of the rows of blocks; `None` if radiance is even.
    pub rows: Option<DiscreteDistribution>,
    /// Heights between which the tile lies.
    pub heights: [f32; 2],
    /// Share of all flux.
    pub flux: f32,
    /// Density per solid angle of directions in the tile, if it is even; else the factor that turns densities among all
    /// cells into densities in the tile.
    pub density: f32,
}

/// Partition of a grid.
#[derive(Clone, Debug)]
pub(super) struct Tiles {
    tiles: Vec<Tile>,
    /// Columns and rows of cells.
    size: [usize; 2],
    /// Numbers of cells along the edges of a block.
    block: [usize; 2],
    /// Number of blocks in a row.
    blocks: usize,
    /// Tile of each block.
    of_block: Vec<u16>,
    /// Distribution of the blocks of each row.
    columns: Vec<DiscreteDistribution>,
    /// Densities per solid angle among all cells of directions in even blocks; 0 for other blocks.
    even: Vec<f32>,
    /// Heights at which rows of blocks begin, and at which the last row ends.
    heights: Vec<f32>,
}

/// A sampled block, and random numbers for a point in it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TilePlace {
    column: usize,
    row: usize,
    /// Random numbers in [0, 1)².
    pub u: Vec2,
    /// Density per solid angle among all cells, if the block is even; else 0.
    pub density: f32,
}

/// Rectangle of blocks, and its flux.
type BlockPart = ([Range<usize>; 2], f64);

impl Tiles {
    /// Cuts a grid into tiles.
    pub fn new(grid: &impl Grid) -> Tiles {
        let size = grid.size();
        let block = size.map(|n| n.div_ceil(MAX_BLOCKS).max(1));
        let blocks = [0, 1].map(|axis| size[axis].div_ceil(block[axis]));
        let cells = |range: &Range<usize>, axis: usize| {
            range.start * block[axis]..(range.end * block[axis]).min(size[axis])
        };
        let cells_of = |i: usize| {
            let (x, y) = (i % blocks[0], i / blocks[0]);
            [cells(&(x..x + 1), 0), cells(&(y..y + 1), 1)]
        };
        let flux_of = |i: usize| -> f64 {
            let [columns, rows] = cells_of(i);
            rows.map(|row| f64::from(grid.flux(row, &columns))).sum()
        };
        let heights: Vec<f32> = (0..=size[1]).map(|row| grid.height(row)).collect();
        let sums_of = |i: usize| Sums::new(grid, &heights, &cells_of(i));
        let numbers = (0..blocks[0] * blocks[1]).into_par_iter();
        let (flux, sums): (Vec<f64>, Vec<Sums>) = numbers.map(|i| (flux_of(i), sums_of(i))).unzip();
        let parts = cut(&flux, blocks);
        let total: f64 = parts.iter().map(|part| part.1).sum();
        let columns: Vec<DiscreteDistribution> = flux
            .chunks(blocks[0].max(1))
            .map(|row| DiscreteDistribution::new(row.iter().map(|flux| *flux as f32)))
            .collect();
        let solid_angle = |[columns, rows]: &[Range<usize>; 2]| {
            (heights[rows.start] - heights[rows.end]) * TAU / size[0] as f32 * columns.len() as f32
        };
        let density = |i: usize| match sums[i].is_even() {
            true => finite((flux[i] / total) as f32 / solid_angle(&cells_of(i))),
            false => 0.0,
        };
        let even = (0..flux.len()).map(density).collect();
        let mut of_block = vec![0; flux.len()];
        for (tile, (rect, _)) in parts.iter().enumerate() {
            for y in rect[1].clone() {
                of_block[y * blocks[0]..][rect[0].clone()].fill(tile as u16);
            }
        }
        let tile = |(part, part_flux): &BlockPart| {
            let lines =
                || part[1].clone().map(|row| row * blocks[0] + part[0].start..row * blocks[0] + part[0].end);
            let even = lines().flat_map(|line| &sums[line]).fold(Sums::default(), Sums::and).is_even();
            let row_flux = |line: Range<usize>| flux[line].iter().sum::<f64>() as f32;
            let rows = (!even).then(|| DiscreteDistribution::new(lines().map(row_flux)));
            let cells = [cells(&part[0], 0), cells(&part[1], 1)];
            let flux = (part_flux / total) as f32;
            let density = finite(if even { 1.0 / solid_angle(&cells) } else { 1.0 / flux });
            let heights = [heights[cells[1].start], heights[cells[1].end]];
            Tile { cells, blocks: part.clone(), rows, heights, flux, density }
        };
        let tiles = parts.iter().map(tile).collect();
        let heights = (0..=blocks[1]).map(|row| heights[(row * block[1]).min(size[1])]).collect();
        Tiles { tiles, size, block, blocks: blocks[0], of_block, columns, even, heights }
    }

    /// Samples a block of a tile that is not even; `rows` is the distribution of its rows.
    #[inline]
    pub fn sample(&self, tile: &Tile, rows: &DiscreteDistribution, u: Vec2) -> TilePlace {
        let (row, v) = rows.sample(u.y);
        let row = tile.blocks[1].start + row;
        let (column, u) = self.columns[row].sample_between(&tile.blocks[0], u.x);
        TilePlace { column, row, u: Vec2::new(u, v), density: self.even[row * self.blocks + column] }
    }

    /// Returns columns and rows of a block's cells.
    #[inline]
    pub fn cells(&self, block: &TilePlace) -> [Range<usize>; 2] {
        let cells = |at: usize, axis: usize| {
            at * self.block[axis]..((at + 1) * self.block[axis]).min(self.size[axis])
        };
        [cells(block.column, 0), cells(block.row, 1)]
    }

    /// Samples a point uniformly by solid angle in a block. Returns its height, and the number of cells from the first
    /// column's left edge.
    #[inline]
    pub fn place(&self, block: &TilePlace) -> (f32, f32) {
        let [columns, _] = self.cells(block);
        let (top, bottom) = (self.heights[block.row], self.heights[block.row + 1]);
        (top + (bottom - top) * block.u.y, columns.start as f32 + block.u.x * columns.len() as f32)
    }

    /// Returns the density among all cells of directions in the block around a cell, if the block is even; else 0.
    #[inline]
    pub fn density(&self, column: usize, row: usize) -> f32 {
        self.even[self.block_of(column, row)]
    }

    /// Returns the block around a cell.
    #[inline]
    fn block_of(&self, column: usize, row: usize) -> usize {
        row / self.block[1] * self.blocks + column / self.block[0]
    }

    /// Adds tiles outside the grid, which has the share `share` of the flux afterwards.
    pub fn add(&mut self, tiles: impl Iterator<Item = Tile>, share: f32) {
        self.tiles.iter_mut().for_each(|tile| tile.flux *= share);
        self.tiles.extend(tiles);
    }

    /// Returns all tiles.
    #[inline]
    pub fn all(&self) -> &[Tile] {
        &self.tiles
    }

    /// Returns the tile of a cell.
    #[inline]
    pub fn of_cell(&self, column: usize, row: usize) -> usize {
        self.of_block[self.block_of(column, row)].into()
    }
}

/// Returns a density; 0 if it is not finite, because there is nothing to sample.
fn finite(density: f32) -> f32 {
    if density.is_finite() { density } else { 0.0 }
}

/// Integrals over cells, up to a factor: solid angle, luminance and squared luminance.
#[derive(Clone, Copy, Debug, Default)]
struct Sums([f64; 3]);

impl Sums {
    /// Sums over cells; `heights` are the borders of the rows.
    fn new(grid: &impl Grid, heights: &[f32], [columns, rows]: &[Range<usize>; 2]) -> Sums {
        let mut sums = [0.0; 3];
        for row in rows.clone() {
            let weight = f64::from(heights[row] - heights[row + 1]).max(0.0);
            for luminance in columns.clone().flat_map(|column| grid.luminances(column, row)) {
                let luminance = f64::from(luminance);
                sums[0] += weight;
                sums[1] += weight * luminance;
                sums[2] += weight * luminance * luminance;
            }
        }
        Sums(sums)
    }

    /// Adds other sums.
    fn and(self, other: &Sums) -> Sums {
        Sums(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }

    /// Returns true if radiance is about constant.
    fn is_even(&self) -> bool {
        let [angle, sum, squares] = self.0;
        squares * angle <= (1.0 + EVEN) * sum * sum
    }
}

impl Tile {
    /// Makes a tile of constant radiance outside a grid.
    pub fn apart(flux: f32, solid_angle: f32) -> Tile {
        let none = [0..0, 0..0];
        Tile {
            blocks: none.clone(),
            cells: none,
            rows: None,
            heights: [0.0; 2],
            flux,
            density: 1.0 / solid_angle,
        }
    }

    /// Samples a point uniformly by solid angle. Returns its height, and the number of cells from the first column's
    /// left edge.
    #[inline]
    pub fn place(&self, u: Vec2) -> (f32, f32) {
        let z = self.heights[0] + (self.heights[1] - self.heights[0]) * u.y;
        (z, self.cells[0].start as f32 + u.x * self.cells[0].len() as f32)
    }
}

/// Cuts a grid of blocks into parts: the brightest part is halved along its longer edge into parts of about equal flux,
/// again and again.
fn cut(flux: &[f64], blocks: [usize; 2]) -> Vec<BlockPart> {
    let mut parts = vec![([0..blocks[0], 0..blocks[1]], flux.iter().sum())];
    while parts.len() < MAX_TILES {
        let divisible = |i: &usize| parts[*i].0.iter().any(|range| range.len() > 1) && parts[*i].1 > 0.0;
        let brightest = (0..parts.len()).filter(divisible);
        let Some(i) = brightest.reduce(|a, b| if parts[b].1 > parts[a].1 { b } else { a }) else { break };
        let (rect, total) = parts[i].clone();
        // A row of blocks spans 360 degrees, a column 180 degrees.
        let widths = [2 * rect[0].len() * blocks[1], rect[1].len() * blocks[0]];
        let axis = usize::from(rect[0].len() == 1 || (rect[1].len() > 1 && widths[1] > widths[0]));
        let line = |at: usize| -> f64 {
            let mut line = rect.clone();
            line[axis] = at..at + 1;
            let rows = line[1].clone();
            rows.map(|y| flux[y * blocks[0]..][line[0].clone()].iter().sum::<f64>()).sum()
        };
        let (mut at, mut before) = (rect[axis].start + 1, line(rect[axis].start));
        while at + 1 < rect[axis].end && before < 0.5 * total {
            before += line(at);
            at += 1;
        }
        let (mut low, mut high) = (rect.clone(), rect);
        low[axis].end = at;
        high[axis].start = at;
        parts[i] = (low, before);
        parts.insert(i + 1, (high, (total - before).max(0.0)));
    }
    parts
}

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
