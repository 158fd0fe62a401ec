//! The first edges of paths: through which place of which pixel they go.

use super::batch::Batch;
use super::look::{Look, pixel_seed};
use base::math::LANES;
use base::sampling::Samplers16;
use embree::Rays16;
use world::World;
use world::view::View;

/// A path to start.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// Pixel of the film.
    pub pixel: [u32; 2],
    /// Number of the sample in its pixel.
    pub sample: u32,
    /// Another seed, other random numbers.
    pub seed: u32,
}

/// Adds `paths` to the batch, in order, of which `samples` are to share a pixel. With [`Look::EyeSamples`] they
/// take the eye samples' places in turn.
pub fn start(
    batch: &mut Batch,
    mut paths: impl Iterator<Item = Start>,
    (world, view): (&World, &View),
    (look, samples): (Look, u32),
) {
    let cone = view.cone(match look {
        Look::Pixels => samples,
        Look::EyeSamples { spp, .. } => spp,
    });
    loop {
        let mut samplers = Samplers16::default();
        let mut starts = [Start { pixel: [0; 2], sample: 0, seed: 0 }; LANES];
        let mut count = 0;
        for path in paths.by_ref().take(LANES) {
            starts[count] = path;
            count += 1;
        }
        if count == 0 {
            return;
        }
        for (i, Start { pixel, sample, seed }) in starts.into_iter().enumerate() {
            samplers.seed[i] = pixel_seed(pixel, seed);
            samplers.index[i] = sample;
        }
        let anywhere = samplers.point(1);
        let mut rays = Rays16::default();
        for (i, path) in starts.into_iter().enumerate() {
            let jitter = match look {
                Look::Pixels => anywhere.get(i),
                Look::EyeSamples { .. } => look.eye_sampler(path.pixel, path.seed, path.sample).1,
            };
            let of = look.numbers(path.seed, path.sample);
            rays.set(i, &world.behind_hidden(view.sample_ray(path.pixel, jitter, of)));
        }
        batch.push(rays, samplers, cone, count);
    }
}
