//! Tiles of the sphere of directions, of about equal flux.
//!
//! Where radiance is about even over a tile, directions are drawn there uniformly, which reads no table: those of a map
//! lie outside the caches, and reading them takes more time than the shadow ray.

use crate::light::DiscreteDistribution;
use glam::Vec2;
use std::f32::consts::TAU;
use std::ops::Range;

/// Maximum number of tiles.
const MAX_TILES: usize = 256;

/// Maximum number of blocks of cells along an edge; tiles consist of whole blocks.
const MAX_BLOCKS: usize = 256;

/// Maximum squared coefficient of variation of the radiance of an even tile: the variance that it adds to an estimate.
const EVEN: f64 = 0.03;

/// Grid of cells over the sphere of directions, columns of equal azimuth and rows between two heights.
pub(super) trait Grid {
    /// Numbers of columns and rows.
    fn size(&self) -> [usize; 2];
    /// Height above the horizon, in [-1, 1], at which a row begins; rows go down.
    fn height(&self, row: usize) -> f32;
    /// Share of all flux in some columns of a row.
    fn flux(&self, row: usize, columns: &Range<usize>) -> f32;
    /// Luminances at a cell's corners, between which they vary evenly.
    fn luminances(&self, column: usize, row: usize) -> [f32; 4];
}

/// Rectangle of cells.
#[derive(Clone, Debug)]
pub(super) struct Tile {
    /// Columns and rows.
    pub cells: [Range<usize>; 2],
    /// Rows, of which one is drawn; `None` if radiance is even.
    pub rows: Option<DiscreteDistribution>,
    /// Heights between which the tile lies.
    pub heights: [f32; 2],
    /// Share of all flux.
    pub flux: f32,
    /// Density by solid angle of the directions in the tile if it is even; else the factor that makes those drawn
    /// among all cells into those drawn in the tile.
    pub density: f32,
}

/// Partition of a grid.
#[derive(Clone, Debug)]
pub(super) struct Tiles {
    tiles: Vec<Tile>,
    /// Cells along the edges of a block, and blocks in a row.
    block: [usize; 2],
    blocks: usize,
    of_block: Vec<u16>,
}

/// Rectangle of blocks, and its flux.
type Part = ([Range<usize>; 2], f64);

impl Tiles {
    /// Cuts a grid, the brightest part first.
    pub fn new(grid: &impl Grid) -> Tiles {
        let size = grid.size();
        let block = size.map(|n| n.div_ceil(MAX_BLOCKS).max(1));
        let blocks = [0, 1].map(|axis| size[axis].div_ceil(block[axis]));
        let cells = |range: &Range<usize>, axis: usize| {
            range.start * block[axis]..(range.end * block[axis]).min(size[axis])
        };
        let flux_of = |i: usize| -> f64 {
            let (x, y) = (i % blocks[0], i / blocks[0]);
            let columns = cells(&(x..x + 1), 0);
            cells(&(y..y + 1), 1).map(|row| f64::from(grid.flux(row, &columns))).sum()
        };
        let flux: Vec<f64> = (0..blocks[0] * blocks[1]).map(flux_of).collect();
        let parts = cut(&flux, blocks);
        let total: f64 = parts.iter().map(|part| part.1).sum();
        let mut of_block = vec![0; flux.len()];
        for (tile, (rect, _)) in parts.iter().enumerate() {
            for y in rect[1].clone() {
                of_block[y * blocks[0]..][rect[0].clone()].fill(tile as u16);
            }
        }
        let tiles = parts.iter().map(|([columns, rows], flux)| {
            Tile::new(grid, [cells(columns, 0), cells(rows, 1)], (flux / total) as f32)
        });
        Tiles { tiles: tiles.collect(), block, blocks: blocks[0], of_block }
    }

    /// Adds tiles that are no part of the grid, which keeps `share` of the flux.
    pub fn add(&mut self, tiles: impl Iterator<Item = Tile>, share: f32) {
        self.tiles.iter_mut().for_each(|tile| tile.flux *= share);
        self.tiles.extend(tiles);
    }

    /// The tiles.
    #[inline]
    pub fn all(&self) -> &[Tile] {
        &self.tiles
    }

    /// Tile of a cell.
    #[inline]
    pub fn of_cell(&self, column: usize, row: usize) -> usize {
        self.of_block[row / self.block[1] * self.blocks + column / self.block[0]].into()
    }
}

impl Tile {
    /// A tile that is no part of a grid, of even radiance.
    pub fn apart(flux: f32, solid_angle: f32) -> Tile {
        Tile { cells: [0..0, 0..0], rows: None, heights: [0.0; 2], flux, density: 1.0 / solid_angle }
    }

    fn new(grid: &impl Grid, cells: [Range<usize>; 2], flux: f32) -> Tile {
        let [columns, rows] = &cells;
        let heights = [grid.height(rows.start), grid.height(rows.end)];
        let (mut angle, mut sum, mut squares) = (0.0f64, 0.0f64, 0.0f64);
        for row in rows.clone() {
            let weight = f64::from(grid.height(row) - grid.height(row + 1)).max(0.0);
            for column in columns.clone() {
                for luminance in grid.luminances(column, row).map(f64::from) {
                    angle += weight;
                    sum += weight * luminance;
                    squares += weight * luminance * luminance;
                }
            }
        }
        let even = squares * angle <= (1.0 + EVEN) * sum * sum;
        let cell = TAU / grid.size()[0] as f32;
        let solid_angle = (heights[0] - heights[1]) * cell * columns.len() as f32;
        let distribution = || DiscreteDistribution::new(rows.clone().map(|row| grid.flux(row, columns)));
        let density = if even { 1.0 / solid_angle } else { 1.0 / flux };
        let density = if density.is_finite() { density } else { 0.0 };
        Tile { rows: (!even).then(distribution), heights, flux, density, cells }
    }

    /// Height, and cells from the first column's left edge, of a place drawn uniformly by solid angle.
    #[inline]
    pub fn place(&self, u: Vec2) -> (f32, f32) {
        let z = self.heights[0] + (self.heights[1] - self.heights[0]) * u.y;
        (z, self.cells[0].start as f32 + u.x * self.cells[0].len() as f32)
    }
}

/// Cuts a grid of blocks into parts, the brightest along its longer edge into halves of about equal flux, and so on.
fn cut(flux: &[f64], blocks: [usize; 2]) -> Vec<Part> {
    let mut parts = vec![([0..blocks[0], 0..blocks[1]], flux.iter().sum())];
    while parts.len() < MAX_TILES {
        let divisible = |i: &usize| parts[*i].0.iter().any(|range| range.len() > 1) && parts[*i].1 > 0.0;
        let brightest = (0..parts.len()).filter(divisible);
        let Some(i) = brightest.reduce(|a, b| if parts[b].1 > parts[a].1 { b } else { a }) else { break };
        let (rect, total) = parts[i].clone();
        // A row of blocks goes round the horizon, a column from pole to pole.
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
