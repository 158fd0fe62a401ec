//! Light from infinitely far away: evaluation and sampling, about in proportion to radiance or as [`LearnedSky`] tells.
//!
//! A tile of about average flux is sampled first, then a direction within the tile. A distant disc, such as the sun, is
//! a tile of its own in front of the others. It hides nothing: radiances and densities add up.
//!
//! Next-event estimation ([`EnvironmentLight::sample16`]) chooses among directions that were sampled beforehand in each
//! tile. Emission of photons and virtual lights samples directions anew.

mod discs;
mod learned;
mod map;
mod presampled;
#[cfg(test)]
mod presampled_tests;
mod sample;
#[cfg(test)]
mod sky_tests;
mod table;
#[cfg(test)]
mod tests;
mod tiles;

pub use learned::{LearnedAt, LearnedSky};
pub use sample::{EnvironmentSample, EnvironmentSamples16};

use super::observed::Observed;
use base::math::{F32x16, LANES, Rgb, Vec2x16, Vec3x16, lanes_in, luminance};
use base::sampling::uniform_sphere;
use discs::Discs;
use glam::{Vec2, Vec3};
use map::{Map, bilinear};
use presampled::Presamples;
use scene::{DistantDisc, Environment};
use std::f32::consts::FRAC_1_PI;
use table::TileTable;
use tiles::{EqualCells, TilePlace, Tiles};

/// The environment with its sampling distributions.
#[derive(Clone, Debug)]
pub struct EnvironmentLight {
    source: SkySource,
    /// Tiles of the source, then tiles of the discs.
    tiles: Tiles,
    discs: Discs,
    /// Distribution of the tiles by flux.
    by_flux: TileTable,
    /// Directions for next-event estimation.
    presamples: Presamples,
    /// Mean luminance over the sphere, W/(sr m²).
    mean_luminance: f32,
}

/// Light of the environment without discs.
#[derive(Clone, Debug)]
enum SkySource {
    Constant(Rgb),
    Map(Map),
}

/// A sampled tile, random numbers for a direction in it, and the factor on the density of that direction.
#[derive(Clone, Copy, Default)]
struct TileSample {
    tile: usize,
    u: Vec2,
    density: f32,
}

impl EnvironmentLight {
    /// Builds the distributions; `None` if environment and discs are black.
    pub fn new(environment: Option<&Environment>, discs: &[DistantDisc]) -> Option<EnvironmentLight> {
        let (source, mean_luminance, mut tiles) = match environment {
            None => (SkySource::Constant(Rgb::ZERO), 0.0, Tiles::new(&EqualCells)),
            Some(Environment::Constant(radiance)) => {
                (SkySource::Constant(*radiance), luminance(*radiance), Tiles::new(&EqualCells))
            }
            Some(Environment::Map(map)) => {
                let map = Map::new(map);
                let (mean, tiles) = (map.mean(), Tiles::new(&map));
                (SkySource::Map(map), mean, tiles)
            }
        };
        let discs = Discs::new(discs, tiles.all().len());
        let with_discs = mean_luminance + discs.mean_luminance();
        if !discs.is_empty() {
            tiles.add(discs.tiles(with_discs), mean_luminance / with_discs);
        }
        let mean_luminance = with_discs;
        let by_flux = TileTable::new(tiles.all(), &vec![0.0; tiles.all().len()], 1.0);
        let presamples = Presamples::default();
        let mut light = EnvironmentLight { source, tiles, discs, by_flux, presamples, mean_luminance };
        if !(mean_luminance > 0.0 && mean_luminance.is_finite()) {
            return None;
        }
        let flux: Vec<f32> = light.tiles.all().iter().map(|tile| tile.flux).collect();
        light.presamples = light.presample(&flux);
        Some(light)
    }

    /// Samples directions of all tiles, which have these shares of all samples.
    fn presample(&self, shares: &[f32]) -> Presamples {
        let sample = |tile: usize, u: &[Vec2; LANES]| {
            self.sample_tiles(&u.map(|u| TileSample { tile, u, density: 1.0 }), u16::MAX)
        };
        Presamples::new(shares, sample, |direction| self.discs.around(direction).next().is_some())
    }

    /// Learns from observations how much light comes from each tile.
    pub(super) fn learn(&self, observed: &Observed) -> LearnedSky {
        LearnedSky::new(self.tiles.all(), observed, |shares| self.presample(shares))
    }

    /// Returns the mean luminance over the sphere of directions.
    pub fn mean_luminance(&self) -> f32 {
        self.mean_luminance
    }

    /// Returns the number of tiles.
    pub fn tile_count(&self) -> usize {
        self.tiles.all().len()
    }

    /// Returns the radiance arriving from the unit world direction `d`.
    pub fn radiance(&self, d: Vec3) -> Rgb {
        let radiance = match &self.source {
            SkySource::Constant(radiance) => *radiance,
            SkySource::Map(map) => {
                let place = map.locate(d);
                bilinear(&map.corners(place.column, place.row), place.f)
            }
        };
        self.discs.around(d).fold(radiance, |sum, (_, disc)| sum + disc)
    }

    /// Returns the radiance arriving from the unit world direction `d`, and the density with which
    /// [`EnvironmentLight::sample`] samples `d`.
    pub fn radiance_pdf(&self, d: Vec3) -> (Rgb, f32) {
        self.radiance_pdf16(&Vec3x16::splat(d), 1, None)[0]
    }

    /// Returns [`EnvironmentLight::radiance_pdf`] in the lanes of `wanted`. The lanes wait for memory together, because
    /// a large map exceeds the caches.
    pub fn radiance_pdf16(
        &self,
        d: &Vec3x16,
        wanted: u16,
        learned: Option<LearnedAt>,
    ) -> [(Rgb, f32); LANES] {
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

    /// Returns radiances and densities without the discs.
    fn source_radiance_pdf16(
        &self,
        d: &Vec3x16,
        wanted: u16,
        learned: Option<LearnedAt>,
    ) -> [(Rgb, f32); LANES] {
        let map = match &self.source {
            SkySource::Constant(radiance) => {
                let even = learned.is_none() && self.discs.is_empty();
                let tables = self.tables(learned);
                return each(wanted, |i| {
                    let (column, row) = EqualCells::cell(d.get(i));
                    let density = || tables[i].density(self.tiles.of_cell(column, row));
                    (*radiance, if even { 0.25 * FRAC_1_PI } else { density() })
                });
            }
            SkySource::Map(map) => map,
        };
        // Short loops, so that the lanes wait for memory together.
        let places = each(wanted, |i| map.locate(d.get(i)));
        let corners = each(wanted, |i| map.corners(places[i].column, places[i].row));
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

    /// Samples a direction about in proportion to luminance; `None` if the density is zero.
    pub fn sample(&self, u: Vec2) -> Option<EnvironmentSample> {
        if let Some(sample) = self.sample_even(u) {
            return Some(sample);
        }
        let (tiles, rest) = TileTable::sample(&self.tables(None), &[u.x; LANES], 1);
        let (tile, u) = (tiles[0], Vec2::new(rest[0], u.y));
        let mut chosen = [TileSample::default(); LANES];
        chosen[0] = TileSample { tile, u, density: self.by_flux.density(tile) };
        let sample = self.sample_tiles(&chosen, 1)[0]?;
        if self.discs.around(sample.direction).next().is_none() {
            return Some(sample);
        }
        let (radiance, pdf) = self.radiance_pdf(sample.direction);
        (pdf > 0.0 && pdf.is_finite()).then_some(EnvironmentSample { radiance, pdf, ..sample })
    }

    /// Samples a direction of a constant sky without discs; `None` if the environment is another.
    #[inline]
    fn sample_even(&self, u: Vec2) -> Option<EnvironmentSample> {
        match self.source {
            SkySource::Constant(radiance) if self.discs.is_empty() => {
                Some(EnvironmentSample { direction: uniform_sphere(u), radiance, pdf: 0.25 * FRAC_1_PI })
            }
            _ => None,
        }
    }

    /// Samples one of the directions that were sampled beforehand, in each lane of `wanted`. Densities are those of
    /// continuous directions. A constant sky without discs, of which nothing was learned, has new directions.
    pub(super) fn sample16(
        &self,
        u: &Vec2x16,
        wanted: u16,
        learned: Option<LearnedAt>,
    ) -> EnvironmentSamples16 {
        let mut samples = EnvironmentSamples16::default();
        if learned.is_none() && self.sample_even(Vec2::ZERO).is_some() {
            for i in lanes_in(wanted) {
                if let Some(sample) = self.sample_even(u.get(i)) {
                    samples.set(i, sample.direction, sample.radiance, sample.pdf);
                }
            }
            return samples;
        }
        let tables = self.tables(learned);
        let (tiles, rest) = TileTable::sample(&tables, &u.x, wanted);
        let stored = learned.map_or(&self.presamples, |at| at.presamples);
        let positions = each(wanted, |i| stored.find(tiles[i], Vec2::new(rest[i], u.y[i])));
        // Short loops, so that many lanes wait for memory at once.
        let densities = each(wanted, |i| tables[i].density(tiles[i]));
        let presamples = each(wanted, |i| *stored.get(positions[i]));
        let mut on_discs = 0;
        for i in lanes_in(wanted) {
            let presample = &presamples[i];
            samples.set(i, presample.direction, presample.radiance, presample.density);
            on_discs |= u16::from(presample.on_disc) << i;
        }
        for i in 0..LANES {
            samples.pdf[i] *= densities[i];
        }
        if on_discs != 0 {
            let discs = self.radiance_pdf16(&samples.direction, on_discs, learned);
            for i in lanes_in(on_discs) {
                samples.set(i, samples.direction.get(i), discs[i].0, discs[i].1);
            }
        }
        for i in 0..LANES {
            samples.pdf[i] = if samples.pdf[i] < f32::INFINITY { samples.pdf[i] } else { 0.0 };
        }
        samples
    }

    /// Chooses sixteen tiles as is learned of one place, by numbers in [0, 1).
    pub fn tiles_by(&self, learned: &LearnedAt, u: &F32x16) -> [usize; LANES] {
        TileTable::sample(&learned.tables, u, u16::MAX).0
    }

    /// Returns one of the directions that were sampled beforehand in each of sixteen tiles; `None` in tiles without
    /// light.
    pub fn directions_of_tiles(&self, tiles: &[usize; LANES], u: &Vec2x16) -> [Option<Vec3>; LANES] {
        let presample = |lane: usize| self.presamples.get(self.presamples.find(tiles[lane], u.get(lane)));
        std::array::from_fn(|lane| Some(presample(lane)).filter(|s| s.density > 0.0).map(|s| s.direction))
    }

    /// Returns the share of all flux that a tile has.
    pub fn flux_of_tile(&self, tile: usize) -> f32 {
        self.tiles.all()[tile].flux
    }

    /// Samples a direction of a tile alone: discs add nothing to the tiles behind them. The density is that within the
    /// tile.
    pub fn sample_of_tile(&self, tile: usize, u: Vec2) -> Option<EnvironmentSample> {
        let mut chosen = [TileSample::default(); LANES];
        chosen[0] = TileSample { tile, u, density: self.tiles.all()[tile].density };
        self.sample_tiles(&chosen, 1)[0]
    }

    /// Samples directions in tiles, in the lanes of `wanted`.
    fn sample_tiles(&self, chosen: &[TileSample; LANES], wanted: u16) -> [Option<EnvironmentSample>; LANES] {
        let on_discs =
            lanes_in(wanted).filter(|i| self.discs.has(chosen[*i].tile)).fold(0, |on, i| on | 1 << i);
        let mut samples = self.sample_source_tiles(chosen, wanted & !on_discs);
        for i in lanes_in(on_discs) {
            let TileSample { tile, u, density } = chosen[i];
            let sample = self.discs.sample(tile, u);
            samples[i] =
                sample.map(|(direction, radiance)| EnvironmentSample { direction, radiance, pdf: density });
        }
        samples
    }

    /// Samples directions in tiles of the source, in the lanes of `wanted`.
    fn sample_source_tiles(
        &self,
        chosen: &[TileSample; LANES],
        wanted: u16,
    ) -> [Option<EnvironmentSample>; LANES] {
        let tile = |i: usize| &self.tiles.all()[chosen[i].tile];
        let map = match &self.source {
            SkySource::Constant(radiance) => {
                return each(wanted, |i| {
                    let (z, x) = tile(i).place(chosen[i].u);
                    let direction = EqualCells::direction(z, x);
                    Some(EnvironmentSample { direction, radiance: *radiance, pdf: chosen[i].density })
                });
            }
            SkySource::Map(map) => map,
        };
        let even = |i: usize| tile(i).rows.is_none();
        let blocks = each(wanted, |i| match &tile(i).rows {
            Some(rows) => self.tiles.sample(tile(i), rows, chosen[i].u),
            None => TilePlace::default(),
        });
        let mut directions = [Vec3::ZERO; LANES];
        let places = each(wanted, |i| {
            if !even(i) && blocks[i].density == 0.0 {
                let place = map.sample(&self.tiles.cells(&blocks[i]), blocks[i].u);
                directions[i] = map.direction(place);
                return place;
            }
            let (z, x) = if even(i) { tile(i).place(chosen[i].u) } else { self.tiles.place(&blocks[i]) };
            directions[i] = map.direction_at(z, x);
            map.place_at(z, x)
        });
        let corners = each(wanted, |i| map.corners(places[i].column, places[i].row));
        each(wanted, |i| {
            let (place, direction) = (places[i], directions[i]);
            let radiance = bilinear(&corners[i], place.f);
            let within = match blocks[i].density {
                _ if even(i) => 1.0,
                0.0 => map.density(place, &corners[i], radiance),
                density => density,
            };
            let pdf = chosen[i].density * within;
            (pdf > 0.0 && pdf.is_finite()).then_some(EnvironmentSample { direction, radiance, pdf })
        })
    }

    /// Returns the distribution over tiles for each lane.
    #[inline]
    fn tables<'a>(&'a self, learned: Option<LearnedAt<'a>>) -> [&'a TileTable; LANES] {
        learned.map_or([&self.by_flux; LANES], |at| at.tables)
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
