//! First edges of paths: their positions in pixels.

use super::batch::Batch;
use super::estimand::{Estimand, pixel_seed};
use super::pixel_order::sequence;
use base::math::LANES;
use base::sampling::Samplers16;
use world::World;
use world::view::View;

/// Path to start.
#[derive(Clone, Copy, Debug)]
pub struct PathStart {
    /// Pixel of the film.
    pub pixel: [u32; 2],
    /// Number of the sample in its pixel.
    pub sample: u32,
    /// Number of the sample whose position it has.
    pub position: u32,
    /// Random seed.
    pub seed: u32,
}

impl PathStart {
    /// Creates a path at the position of its sample.
    pub fn new(pixel: [u32; 2], sample: u32, seed: u32) -> PathStart {
        PathStart { pixel, sample, position: sample, seed }
    }
}

/// Adds `paths` to the batch, in order. `samples` is the number of paths per pixel. With [`Estimand::EyeSamples`] they
/// take the positions of the eye samples in turn.
pub fn start(
    batch: &mut Batch,
    mut paths: impl Iterator<Item = PathStart>,
    world: &World,
    view: &View,
    estimand: Estimand,
    samples: u32,
) {
    let cone = view.cone(match estimand {
        Estimand::Pixels => samples,
        Estimand::EyeSamples { spp, .. } => spp,
    });
    loop {
        let mut samplers = Samplers16::default();
        let mut starts = [PathStart { pixel: [0; 2], sample: 0, position: 0, seed: 0 }; LANES];
        let mut count = 0;
        for path in paths.by_ref().take(LANES) {
            starts[count] = path;
            count += 1;
        }
        if count == 0 {
            return;
        }
        let (mut pixels, mut seeds, mut numbers) = ([[0; 2]; LANES], [0; LANES], [0; LANES]);
        for (i, PathStart { pixel, position, seed, .. }) in starts.into_iter().enumerate() {
            samplers.seed[i] = pixel_seed(pixel, seed);
            samplers.index[i] = position;
            pixels[i] = pixel;
            (seeds[i], numbers[i]) = estimand.numbers(seed, position);
        }
        let mut jitter = samplers.point(1);
        let pixel_seeds = samplers.seed;
        samplers.index = starts.map(|start| start.sample);
        for (i, PathStart { pixel, sample, seed, .. }) in starts.into_iter().enumerate() {
            match estimand {
                Estimand::Pixels => {
                    [samplers.seed[i], samplers.index[i]] = sequence(pixel, seed, sample, samples);
                }
                _ => jitter.set(i, estimand.eye_sampler(pixel, seed, sample).1),
            }
        }
        let mut rays = view.sample_rays(&pixels, &jitter, &seeds, &numbers);
        world.put_behind_hidden(&mut rays);
        batch.push(rays, samplers, pixel_seeds, cone, count);
    }
}
