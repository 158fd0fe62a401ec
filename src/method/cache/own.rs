//! Eye samples with cuts of their own, shared among neighbours.

use crate::cache::compute::Source;
use crate::eye::EyeSamples;
use crate::lightcut::group::{GroupLightcut, LANES, LEAST_SHARED, Points, group_alike};
use crate::lightcut::{CutCounts, CutSettings, Lightcut, Reflector};
use crate::math::{Frame, Rgb};
use crate::vpl::Origin;
use rayon::prelude::*;

/// What of an eye sample is to be lit by a cut.
#[derive(Clone, Copy, Debug)]
pub struct Job {
    /// The eye sample.
    pub sample: u32,
    /// Only the lobe on the base.
    pub lobe_only: bool,
    /// Only direct or only indirect light.
    pub only: Option<Origin>,
    /// Luminance of the radiance that the sample is known to reflect besides.
    pub known: f32,
}

/// Radiance that each job's sample reflects, in the order of the jobs' groups.
pub fn light<'w>(
    source: &Source<'w>,
    samples: &EyeSamples<'w>,
    jobs: &[Job],
    cut: &CutSettings,
) -> (Vec<(u32, Rgb)>, CutCounts) {
    let place = |job: &Job| {
        let point = &samples.points[job.sample as usize];
        (point.position, point.normal)
    };
    let same = |a: &Job, b: &Job| a.lobe_only == b.lobe_only && a.only == b.only;
    let groups = group_alike(jobs.iter().copied(), source.world.diagonal, place, same);
    let done: Vec<(Vec<(u32, Rgb)>, CutCounts)> = groups
        .par_iter()
        .map_init(
            || (Lightcut::new(), GroupLightcut::new(), Points::new()),
            |(single, group, points), jobs| {
                let reflectors = jobs.iter().map(|job| reflector(samples, job));
                let cut = CutSettings { only: jobs[0].only, ..*cut };
                let mut radiance = [Rgb::ZERO; LANES];
                (single.counts, group.counts) = Default::default();
                if jobs.len() < LEAST_SHARED {
                    for (radiance, reflector) in radiance.iter_mut().zip(reflectors) {
                        *radiance =
                            single.gather(source.trees, &source.transfer, source.world, &reflector, &cut);
                    }
                } else {
                    points.set(reflectors);
                    group.gather(source.trees, &source.transfer, source.world, points, &cut, &mut radiance);
                }
                let mut counts = single.counts;
                counts.add(&group.counts);
                (jobs.iter().map(|job| job.sample).zip(radiance).collect(), counts)
            },
        )
        .collect();
    let mut counts = CutCounts::default();
    let mut lit = Vec::with_capacity(jobs.len());
    for (radiance, used) in done {
        lit.extend(radiance);
        counts.add(&used);
    }
    (lit, counts)
}

fn reflector<'w>(samples: &EyeSamples<'w>, job: &Job) -> Reflector<'w> {
    let (point, surface) = (&samples.points[job.sample as usize], &samples.surfaces[job.sample as usize]);
    let frame = Frame::from_normal(point.normal);
    let lobe = if job.lobe_only { surface.bsdf.split_base(1.0).1 } else { None };
    let bsdf = lobe.unwrap_or(surface.bsdf);
    Reflector::new(point.position, surface.geometric_normal, &frame, bsdf, surface.out).knowing(job.known)
}
