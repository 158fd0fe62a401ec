//! Indirect light at single eye samples that records cannot light: rays sampled from the reflecting lobes.

use super::indirect_light::{GatherCounts, IndirectLight};
use crate::eye::EyePass;
use base::math::{Frame, LANES, Rgb, first_lanes};
use base::sampling::{Sampler, hash};
use embree::Rays16;
use world::material::Bsdf;
use world::shadow;

/// Gathering at a single eye sample.
#[derive(Clone, Copy, Debug)]
pub struct SampleGather {
    /// Index of the eye sample.
    pub sample: u32,
    /// True if only the lobe on the base is sampled.
    pub lobe_only: bool,
    /// Approximate number of rays.
    pub rays: u32,
    /// Seed of the rays.
    pub seed: u32,
}

/// Estimates the indirect radiance that an eye sample reflects to the eye.
pub fn reflected(
    light: &IndirectLight,
    samples: &EyePass,
    task: &SampleGather,
    counts: &mut GatherCounts,
) -> Rgb {
    let SampleGather { sample, lobe_only, rays, seed } = *task;
    let (point, surface) =
        (&samples.points.geometry[sample as usize], samples.points.surfaces.get(sample as usize));
    let lobe = if lobe_only { surface.bsdf.split_base(1.0).1 } else { None };
    let bsdf: Bsdf = lobe.unwrap_or(surface.bsdf);
    let frame = Frame::from_normal(point.normal);
    let wo = frame.to_local(surface.out);
    let seed = hash(sample, seed);
    let packets = rays.div_ceil(LANES as u32).max(1);
    let (light, mut sum) = (light.within(point.edges), Rgb::ZERO);
    for packet in 0..packets {
        let mut rays = Rays16::default();
        let mut weights = [Rgb::ZERO; LANES];
        let mut used = 0;
        for i in 0..LANES as u32 {
            let mut sampler = Sampler::new(seed, packet * LANES as u32 + i);
            let Some(s) = bsdf.sample(wo, sampler.next_1d(), sampler.next_2d()) else { continue };
            if s.delta || s.weight == Rgb::ZERO {
                continue;
            }
            let direction = frame.to_world(s.wi);
            rays.set(used, &shadow::ray_from(point.position, surface.geometric_normal, direction));
            weights[used] = s.weight;
            used += 1;
        }
        counts.own_rays += used as u64;
        let incoming = light.along16(&rays, first_lanes(used), false, hash(packet, seed), counts);
        sum += incoming.iter().zip(weights).map(|(seen, weight)| seen.radiance * weight).sum::<Rgb>();
    }
    sum / (packets * LANES as u32) as f32
}
