//! Light from infinitely far: evaluation and sampling in proportion to radiance, about, or as [`LearnedSky`] has it.
//!
//! Directions are drawn by tiles of about equal flux, then within the tile. A distant disc, such as the sun, is a tile
//! of its own, over those that it hides nothing of: their radiances and densities add.

mod discs;
mod equal_cells;
mod learned;
mod map;
#[cfg(test)]
mod sky_tests;
mod table;
#[cfg(test)]
mod tests;
mod tiles;

pub use learned::{LearnedSky, Looks};

use base::math::{LANES, Rgb, Vec2x16, Vec3x16, lanes_in, luminance};
use base::sampling::uniform_sphere;
use discs::Discs;
use equal_cells::EqualCells;
use glam::{Vec2, Vec3};
use map::{Map, bilinear};
use scene::{DistantDisc, Environment};
use std::f32::consts::FRAC_1_PI;
use table::Table;
use tiles::{Block, Tiles};

/// The environment with its sampling distributions.
#[derive(Clone, Debug)]
pub struct EnvironmentLight {
    source: Source,
    /// Tiles of the source, then those of the discs.
    tiles: Tiles,
    discs: Discs,
    /// Tiles by flux.
    by_flux: Table,
    /// Mean luminance over the sphere, W/(sr m²).
    mean_luminance: f32,
}

#[derive(Clone, Debug)]
enum Source {
    Constant(Rgb),
    Map(Map),
}

/// A direction drawn from the environment.
#[derive(Clone, Copy, Debug)]
pub struct EnvironmentSample {
    /// Unit world direction towards the environment.
    pub direction: Vec3,
    /// Radiance arriving from that direction.
    pub radiance: Rgb,
    /// Density by solid angle.
    pub pdf: f32,
}

/// A tile, numbers by which a direction there is drawn, and the factor on its density.
#[derive(Clone, Copy, Default)]
struct Drawn {
    tile: usize,
    u: Vec2,
    density: f32,
}

/// Sixteen points that directions are drawn for, and what has been learned about them.
pub type Learned<'a> = Option<(&'a LearnedSky, &'a Vec3x16)>;

impl EnvironmentLight {
    /// Builds the distributions; `None` if environment and discs are black.
    pub fn new(environment: Option<&Environment>, discs: &[DistantDisc]) -> Option<EnvironmentLight> {
        let (source, mean_luminance, mut tiles) = match environment {
            None => (Source::Constant(Rgb::ZERO), 0.0, Tiles::new(&EqualCells)),
            Some(Environment::Constant(radiance)) => {
                (Source::Constant(*radiance), luminance(*radiance), Tiles::new(&EqualCells))
            }
            Some(Environment::Map(map)) => {
                let map = Map::new(map);
                let (mean, tiles) = (map.mean(), Tiles::new(&map));
                (Source::Map(map), mean, tiles)
            }
        };
        let discs = Discs::new(discs, tiles.all().len());
        let with_discs = mean_luminance + discs.mean_luminance();
        if !discs.is_empty() {
            tiles.add(discs.tiles(with_discs), mean_luminance / with_discs);
        }
        let mean_luminance = with_discs;
        let by_flux = Table::new(tiles.all(), &vec![0.0; tiles.all().len()], 1.0);
        let light = EnvironmentLight { source, tiles, discs, by_flux, mean_luminance };
        (mean_luminance > 0.0 && mean_luminance.is_finite()).then_some(light)
    }

    /// Mean luminance over the sphere of directions.
    pub fn mean_luminance(&self) -> f32 {
        self.mean_luminance
    }

    /// Number of tiles.
    pub fn tile_count(&self) -> usize {
        self.tiles.all().len()
    }

    /// Radiance arriving from the unit world direction `d`.
    pub fn radiance(&self, d: Vec3) -> Rgb {
        let radiance = match &self.source {
            Source::Constant(radiance) => *radiance,
            Source::Map(map) => {
                let place = map.locate(d);
                bilinear(&map.corners(place.column, place.row), place.f)
            }
        };
        self.discs.around(d).fold(radiance, |sum, (_, disc)| sum + disc)
    }

    /// Radiance arriving from the unit world direction `d`, and the density with which
    /// [`EnvironmentLight::sample`] draws it.
    pub fn radiance_pdf(&self, d: Vec3) -> (Rgb, f32) {
        self.radiance_pdf16(&Vec3x16::splat(d), 1, None)[0]
    }

    /// [`EnvironmentLight::radiance_pdf`] in the lanes of `wanted`, which wait for memory together: a large
    /// map lies outside the caches, and look-ups one after the other would take most of a render's time.
    pub fn radiance_pdf16(&self, d: &Vec3x16, wanted: u16, learned: Learned) -> [(Rgb, f32); LANES] {
        let mut found = self.source_radiance_pdf16(d, wanted, learned);
        if !self.discs.is_empty() {
            let tables = self.tables(learned);
            for i in lanes_in(wanted) {
                for (tile, disc) in self.discs.around(d.get(i)) {
                    found[i].0 += disc;
                    found[i].1 += tables[i].density(tile);
                }
            }
        }
        found
    }

    /// The same without the discs.
    fn source_radiance_pdf16(&self, d: &Vec3x16, wanted: u16, learned: Learned) -> [(Rgb, f32); LANES] {
        let map = match &self.source {
            Source::Constant(radiance) => {
                let even = learned.is_none() && self.discs.is_empty();
                let tables = self.tables(learned);
                return each(wanted, |i| {
                    let (column, row) = EqualCells::cell(d.get(i));
                    let density = || tables[i].density(self.tiles.of_cell(column, row));
                    (*radiance, if even { 0.25 * FRAC_1_PI } else { density() })
                });
            }
            Source::Map(map) => map,
        };
        let places = each(wanted, |i| map.locate(d.get(i)));
        let corners = map.corners16(&places, wanted);
        let tiles = each(wanted, |i| self.tiles.of_cell(places[i].column, places[i].row));
        let tables = self.tables(learned);
        let of_tiles = each(wanted, |i| tables[i].density(tiles[i]));
        each(wanted, |i| {
            let radiance = bilinear(&corners[i], places[i].f);
            let within = match self.tiles.all()[tiles[i]].rows {
                None => 1.0,
                Some(_) => match self.tiles.density(places[i].column, places[i].row) {
                    0.0 => map.density(places[i], &corners[i], radiance),
                    density => density,
                },
            };
            (radiance, of_tiles[i] * within)
        })
    }

    /// Samples a direction about in proportion to luminance; `None` where the density vanishes.
    pub fn sample(&self, u: Vec2) -> Option<EnvironmentSample> {
        self.sample16(&Vec2x16 { x: [u.x; LANES], y: [u.y; LANES] }, 1, None)[0]
    }

    /// [`EnvironmentLight::sample`] in the lanes of `wanted`; `None` in the others. The lanes wait for memory together.
    pub fn sample16(&self, u: &Vec2x16, wanted: u16, learned: Learned) -> [Option<EnvironmentSample>; LANES] {
        if let (Source::Constant(radiance), None, true) = (&self.source, learned, self.discs.is_empty()) {
            let (radiance, pdf) = (*radiance, 0.25 * FRAC_1_PI);
            return each(wanted, |i| {
                Some(EnvironmentSample { direction: uniform_sphere(u.get(i)), radiance, pdf })
            });
        }
        let tables = self.tables(learned);
        let drawn = each(wanted, |i| {
            let (tile, rest) = tables[i].sample(u.x[i]);
            Drawn { tile, u: Vec2::new(rest, u.y[i]), density: tables[i].density(tile) }
        });
        let mut samples = self.sample_tiles(&drawn, wanted);
        if !self.discs.is_empty() {
            self.add_up(&mut samples, learned);
        }
        samples
    }

    /// Gives samples that are on a disc the radiance and density of all that is drawn there.
    fn add_up(&self, samples: &mut [Option<EnvironmentSample>; LANES], learned: Learned) {
        let (mut directions, mut on_discs) = (Vec3x16::default(), 0);
        for (i, sample) in samples.iter().enumerate() {
            if let Some(sample) = sample
                && self.discs.around(sample.direction).next().is_some()
            {
                directions.set(i, sample.direction);
                on_discs |= 1 << i;
            }
        }
        if on_discs != 0 {
            let found = self.radiance_pdf16(&directions, on_discs, learned);
            for i in lanes_in(on_discs) {
                let (radiance, pdf) = found[i];
                let sample = EnvironmentSample { direction: directions.get(i), radiance, pdf };
                samples[i] = (pdf > 0.0 && pdf.is_finite()).then_some(sample);
            }
        }
    }

    /// Samples a direction in each of sixteen tiles; densities are relative.
    pub fn sample_of_tiles(&self, tiles: &[usize; LANES], u: &Vec2x16) -> [Option<EnvironmentSample>; LANES] {
        let drawn = each(u16::MAX, |i| Drawn { tile: tiles[i], u: u.get(i), density: 1.0 });
        self.sample_tiles(&drawn, u16::MAX)
    }

    /// Share of all flux that a tile has.
    pub fn flux_of_tile(&self, tile: usize) -> f32 {
        self.tiles.all()[tile].flux
    }

    /// Samples a direction of a tile, by itself: a disc adds nothing to tiles that it is before. The density is that
    /// within the tile.
    pub fn sample_of_tile(&self, tile: usize, u: Vec2) -> Option<EnvironmentSample> {
        let mut drawn = [Drawn::default(); LANES];
        drawn[0] = Drawn { tile, u, density: self.tiles.all()[tile].density };
        self.sample_tiles(&drawn, 1)[0]
    }

    /// Samples directions in tiles, in the lanes of `wanted`.
    fn sample_tiles(&self, drawn: &[Drawn; LANES], wanted: u16) -> [Option<EnvironmentSample>; LANES] {
        let on_discs =
            lanes_in(wanted).filter(|i| self.discs.has(drawn[*i].tile)).fold(0, |on, i| on | 1 << i);
        let mut samples = self.sample_source_tiles(drawn, wanted & !on_discs);
        for i in lanes_in(on_discs) {
            let Drawn { tile, u, density } = drawn[i];
            let drawn = self.discs.sample(tile, u);
            samples[i] =
                drawn.map(|(direction, radiance)| EnvironmentSample { direction, radiance, pdf: density });
        }
        samples
    }

    /// The same in tiles of the source.
    fn sample_source_tiles(&self, drawn: &[Drawn; LANES], wanted: u16) -> [Option<EnvironmentSample>; LANES] {
        let tile = |i: usize| &self.tiles.all()[drawn[i].tile];
        let map = match &self.source {
            Source::Constant(radiance) => {
                return each(wanted, |i| {
                    let (z, x) = tile(i).place(drawn[i].u);
                    let direction = EqualCells::direction(z, x);
                    Some(EnvironmentSample { direction, radiance: *radiance, pdf: drawn[i].density })
                });
            }
            Source::Map(map) => map,
        };
        let even = |i: usize| tile(i).rows.is_none();
        let blocks = each(wanted, |i| match &tile(i).rows {
            Some(rows) => self.tiles.sample(tile(i), rows, drawn[i].u),
            None => Block::default(),
        });
        let mut directions = [Vec3::ZERO; LANES];
        let places = each(wanted, |i| {
            if !even(i) && blocks[i].density == 0.0 {
                let place = map.sample(&self.tiles.cells(&blocks[i]), blocks[i].u);
                directions[i] = map.direction(place);
                return place;
            }
            let (z, x) = if even(i) { tile(i).place(drawn[i].u) } else { self.tiles.place(&blocks[i]) };
            directions[i] = map.direction_at(z, x);
            map.place_at(z, x)
        });
        let corners = map.corners16(&places, wanted);
        each(wanted, |i| {
            let (place, direction) = (places[i], directions[i]);
            let radiance = bilinear(&corners[i], place.f);
            let within = match blocks[i].density {
                _ if even(i) => 1.0,
                0.0 => map.density(place, &corners[i], radiance),
                density => density,
            };
            let pdf = drawn[i].density * within;
            (pdf > 0.0 && pdf.is_finite()).then_some(EnvironmentSample { direction, radiance, pdf })
        })
    }

    /// Distributions over tiles, by lane.
    #[inline]
    fn tables<'a>(&'a self, learned: Learned<'a>) -> [&'a Table; LANES] {
        learned.map_or([&self.by_flux; LANES], |(sky, x)| sky.at(x))
    }
}

/// Applies `f` to each lane in `wanted`.
#[inline(always)]
fn each<T: Copy + Default>(wanted: u16, mut f: impl FnMut(usize) -> T) -> [T; LANES] {
    let mut values = [T::default(); LANES];
    for lane in lanes_in(wanted) {
        values[lane] = f(lane);
    }
    values
}
