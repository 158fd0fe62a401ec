//! A tile of the image, sampled in passes.

use base::film::{ExrFile, Image, Layer, SAMPLES};
use base::math::Rgb;
use transport::eye::{FullPaths, SurveyedPixel};
use transport::irradiance::PathEnds;
use transport::paths::{Batch, Coverage, Estimand, PathStart, Position, RayCounts, start};
use world::World;
use world::light::Learned;
use world::view::View;

/// Side of a tile in pixels.
pub const TILE: u32 = 16;

/// Samples per pixel of a pass. A cancelled render keeps complete passes of each tile.
pub const PASS: u32 = 16;

/// Samples per pixel that are traced together: enough to fill packets, few enough for the second-level cache.
const BATCH: u32 = 4;

/// Running mean and sum of squared differences of one pixel (Welford).
#[derive(Clone, Copy, Default)]
pub struct RunningMean {
    /// Mean radiance.
    pub mean: Rgb,
    /// Sum of squared differences from the mean.
    pub squares: Rgb,
}

/// Inputs shared by all tiles.
pub struct TileInputs<'a> {
    /// The scene.
    pub world: &'a World,
    /// The camera and the window.
    pub view: &'a View,
    /// Quantity that a pixel estimates.
    pub estimand: Estimand,
    /// Samples per pixel of the complete image.
    pub spp: u32,
    /// Random seed.
    pub seed: u32,
    /// Maximum path length in edges.
    pub max_depth: u32,
    /// Survey of the window, by which positions of paths are chosen; `None` if they are not.
    pub survey: Option<&'a Image<SurveyedPixel>>,
    /// Learned light that guides light samples.
    pub learned: Option<&'a Learned>,
    /// Light by which paths end; `None` if they go on.
    pub path_ends: Option<&'a PathEnds>,
}

/// Pixels of a tile and their counts.
#[derive(Default)]
pub struct PathTile {
    /// Pixels of the tile, row by row; empty before the first pass.
    pub pixels: Vec<RunningMean>,
    /// Samples per pixel.
    pub samples: u32,
    /// Paths traced in this run.
    pub paths: u64,
    /// Rays traced in this run.
    pub counts: RayCounts,
    /// Eye rays that chose positions in this run. They take much less time than others.
    pub covering: u64,
    /// Radiances that were not finite and count as 0.
    pub nonfinite: u64,
}

impl PathTile {
    /// Restores a tile of an interrupted image of `spp` samples; `None` if no pass ends at its samples.
    pub fn of(partial: &PartialImage, view: &View, spp: u32, index: usize) -> Option<PathTile> {
        let (mut pixels, mut samples) = (Vec::new(), None);
        for [x, y] in view.window.tile(index, TILE) {
            let at = (y * view.window.width + x) as usize;
            let [mean, squares] =
                [&partial.color, &partial.squares].map(|image| image.pixels.get(at).copied());
            pixels.push(RunningMean { mean: mean?, squares: squares? });
            let own = *partial.samples.pixels.get(at)?;
            if *samples.get_or_insert(own) != own {
                return None;
            }
        }
        let samples = samples.filter(|n| *n <= spp && (n % PASS == 0 || *n == spp))?;
        Some(PathTile { pixels, samples, ..PathTile::default() })
    }

    /// Takes all samples up to `end` of every pixel of the tile of this index.
    pub fn render(&mut self, inputs: &TileInputs, index: usize, end: u32, batch: &mut Batch) {
        let TileInputs { world, view, estimand, spp, seed, max_depth, learned, path_ends, .. } = *inputs;
        let begin = self.samples;
        if begin >= end {
            return;
        }
        // Film coordinates, so that a crop has the pixels of the full image.
        let film_pixels: Vec<[u32; 2]> =
            view.window.tile(index, TILE).map(|at| view.window.film_pixel(at)).collect();
        if self.pixels.is_empty() {
            self.pixels = vec![RunningMean::default(); film_pixels.len()];
        }
        let positions = inputs.survey.map(|survey| self.positions(inputs, survey, index, end));
        let mut paths = FullPaths { learned, path_ends };
        for first in (begin..end).step_by(BATCH as usize) {
            let samples = first..(first + BATCH).min(end);
            let position = |pixel: usize, sample: u32| match &positions {
                Some(found) => found[pixel * (end - begin) as usize + (sample - begin) as usize],
                None => Position::own(sample),
            };
            let numbers =
                || (0..film_pixels.len()).flat_map(|i| samples.clone().map(move |sample| (i, sample)));
            let starts = numbers().map(|(i, sample)| PathStart {
                pixel: film_pixels[i],
                sample,
                position: position(i, sample).ray,
                seed,
            });
            start(batch, starts, world, view, estimand, spp);
            let mut values = batch.trace(world, max_depth, &mut paths, &mut self.counts);
            for (i, pixel) in self.pixels.iter_mut().enumerate() {
                for (sample, value) in samples.clone().zip(values.by_ref()) {
                    let value = value * position(i, sample).weight;
                    self.nonfinite += u64::from(!value.is_finite());
                    pixel.add(sample, if value.is_finite() { value } else { Rgb::ZERO });
                }
            }
        }
        self.paths += u64::from(end - begin) * self.pixels.len() as u64;
        self.samples = end;
    }

    /// Chooses the positions of the paths of the pixels up to number `end`.
    fn positions(
        &mut self,
        inputs: &TileInputs,
        survey: &Image<SurveyedPixel>,
        index: usize,
        end: u32,
    ) -> Vec<Position> {
        let TileInputs { world, view, seed, .. } = *inputs;
        let numbers = self.samples..end;
        let mut found = Vec::with_capacity(self.pixels.len() * numbers.len());
        let mut coverage = Coverage::new(world, view, seed, numbers);
        for [x, y] in view.window.tile(index, TILE) {
            let is_even = survey.pixels[(y * survey.width + x) as usize].is_even;
            coverage.add(view.window.film_pixel([x, y]), is_even, &mut found);
        }
        self.covering += coverage.covering;
        found
    }
}

impl RunningMean {
    /// Adds the sample of this index.
    fn add(&mut self, sample: u32, value: Rgb) {
        let difference = value - self.mean;
        self.mean += difference / (sample + 1) as f32;
        self.squares += difference * (value - self.mean);
    }
}

/// Layer of the sums of squared differences from the means.
const SQUARES: &str = "squares";

/// Samples of an interrupted image.
#[derive(Clone, Debug)]
pub struct PartialImage {
    /// Mean radiance per pixel.
    pub color: Image,
    /// Sum of squared differences from the mean, per pixel.
    pub squares: Image,
    /// Number of samples per pixel.
    pub samples: Image<u32>,
    /// Samples that were not finite and count as 0.
    pub nonfinite: u64,
    /// Seconds that rendering took.
    pub seconds: f64,
}

impl PartialImage {
    /// Reads the samples of an image file; `None` if the file cannot be resumed.
    pub fn of(file: &ExrFile) -> Option<PartialImage> {
        let facts = file.metadata();
        let number = |key| facts.number(key).unwrap_or_default();
        Some(PartialImage {
            color: file.color().ok()?,
            squares: file.layer(SQUARES).ok()?,
            samples: file.numbers(SAMPLES)?,
            nonfinite: number("nonfinite") as u64,
            seconds: number("render_seconds"),
        })
    }

    /// Removes the sums of squares from a file.
    pub fn remove_squares(file: &mut ExrFile) {
        file.remove_layer(SQUARES);
    }

    /// Returns the layers from which an interrupted image is resumed, besides its colour.
    pub fn layers(squares: Image, samples: Image<u32>) -> Vec<Layer> {
        vec![Layer::color(SQUARES, squares), Layer::id(SAMPLES, samples)]
    }
}
