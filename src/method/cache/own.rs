//! Eye samples with cuts of their own, or nearly so.
//!
//! Samples close together, seen in the order of the index, form patches. Sixteen spread over each patch share a
//! cut; it is lent to the others, which trace shadow rays where the sixteen disagree (see [`ReconstructionCut`]). The
//! others are taken in packets spread over the patch, so that neighbours leave different clusters to chance. Patches of few samples have cuts of their own.

use crate::compensation::samples::{NearCounts, NearLight};
use crate::eye::EyePass;
use crate::lightcut::{
    CoherenceLimit, CutCounts, CutSettings, Lightcut, PacketLightcut, PacketSum, PacketVisibility, Receiver,
    ReceiverPacket, ReconstructionCut, Visibility, group_coherent,
};
use crate::math::{Frame, LANES, Rgb};
use crate::progress::Control;
use crate::radiance_cache::compute::Source;
use crate::radiance_cache::settings::LEAST_PATCH;
use crate::sampling::hash;
use crate::shadow::{Engine, ShadowCounts};
use crate::vpl::Origin;
use rayon::prelude::*;

/// Steps of this, modulo 1, stay far from each other.
const GOLDEN: f32 = 0.618_034;

/// What of an eye sample is to be lit by a cut.
#[derive(Clone, Copy, Debug)]
pub struct Job {
    /// The eye sample.
    pub sample: u32,
    /// Only the lobe on the base.
    pub lobe_only: bool,
    /// Only direct or only indirect light.
    pub origin: Option<Origin>,
    /// Luminance of the radiance that the sample is known to reflect besides.
    pub known: f32,
}

/// What a thread makes cuts with.
#[derive(Default)]
pub struct Cutters<'w> {
    single: Lightcut,
    group: PacketLightcut,
    reconstruction: ReconstructionCut,
    points: ReceiverPacket<'w>,
    near: NearLight,
}

/// What jobs came to.
#[derive(Default)]
pub struct Lit {
    /// Radiance that each job's sample reflects, in a fixed order.
    pub radiance: Vec<(Job, Rgb)>,
    /// Of the cuts.
    pub cuts: CutCounts,
    /// Of their shadow rays.
    pub shadows: ShadowCounts,
    /// Of what clamping took and was found again.
    pub near: NearCounts,
}

/// Lights all jobs, unless cancelled.
pub fn light<'w>(
    source: &Source<'w>,
    samples: &EyePass<'w>,
    jobs: &[Job],
    cut: &CutSettings,
    control: &Control,
) -> Lit {
    light_patches(source, samples, &patches(source, samples, jobs), cut, control)
}

/// Lights patches, each of jobs that are lit together; none any more once cancelled.
pub fn light_patches<'w>(
    source: &Source<'w>,
    samples: &EyePass<'w>,
    patches: &[Vec<Job>],
    cut: &CutSettings,
    control: &Control,
) -> Lit {
    let (settings, size) = (source.settings, source.settings.shadows.cache);
    let cached = settings.shadows.for_samples(settings.share);
    let done: Vec<Lit> = patches
        .par_iter()
        .map_init(
            || (Engine::with(source.world, cached, size), Cutters::default()),
            |(shadows, work), jobs| {
                if control.is_cancelled() {
                    return Lit::default();
                }
                shadows.begin_chunk();
                work.take_cut_counts();
                let cut = CutSettings { origin: jobs[0].origin, ..*cut };
                let mut lit = Vec::with_capacity(jobs.len());
                work.light(source, shadows, samples, jobs, &cut, &mut lit);
                let cuts = work.take_cut_counts();
                control.advance(jobs.len() as u64);
                let (shadows, near) = (shadows.take_counts(), work.near.take_counts());
                Lit { radiance: lit, cuts, shadows, near }
            },
        )
        .collect();
    let mut all = Lit { radiance: Vec::new(), ..Lit::default() };
    for lit in done {
        all.radiance.extend(lit.radiance);
        all.cuts += lit.cuts;
        all.shadows += lit.shadows;
        all.near += lit.near;
    }
    all
}

/// Jobs that are lit together.
pub fn patches(source: &Source, samples: &EyePass, jobs: &[Job]) -> Vec<Vec<Job>> {
    let place = |job: &Job| {
        let point = &samples.points.geometry[job.sample as usize];
        (point.position, point.normal)
    };
    let bsdf = |job: &Job| &samples.points.surfaces[job.sample as usize].bsdf;
    let same =
        |a: &Job, b: &Job| a.lobe_only == b.lobe_only && a.origin == b.origin && bsdf(a).same_lobes(bsdf(b));
    let diagonal = source.world.diagonal;
    let most = source.settings.patch(samples.len());
    let patches = group_coherent(CoherenceLimit::CLOSE, jobs.iter().copied(), most, diagonal, place, same);
    // A cut costs nearly as much for few points as for sixteen: remnants make do with less likeness.
    let (mut patches, remnants): (Vec<_>, Vec<_>) =
        patches.into_iter().partition(|patch| patch.len() >= LEAST_PATCH);
    let remnants = remnants.into_iter().flatten();
    patches.extend(group_coherent(CoherenceLimit::REMOTE, remnants, LEAST_PATCH, diagonal, place, same));
    patches
}

impl<'w> Cutters<'w> {
    /// Work done since this was last asked.
    fn take_cut_counts(&mut self) -> CutCounts {
        let mut counts = std::mem::take(&mut self.single.counts);
        counts += std::mem::take(&mut self.group.counts);
        counts += std::mem::take(&mut self.reconstruction.counts);
        counts
    }

    /// Lights a patch.
    pub fn light<V: Visibility + PacketVisibility>(
        &mut self,
        s: &Source<'_>,
        rays: &V,
        samples: &EyePass<'w>,
        jobs: &[Job],
        cut: &CutSettings,
        lit: &mut Vec<(Job, Rgb)>,
    ) {
        let compensation = s.compensation.as_ref();
        if !s.settings.shares(jobs.len()) {
            jobs.chunks(LANES).for_each(|jobs| self.alone(s, rays, samples, jobs, cut, lit));
            return;
        }
        let makes = makers(samples, jobs);
        let chosen =
            |wanted| jobs.iter().zip(&makes).filter(move |(_, makes)| **makes == wanted).map(|(j, _)| j);
        self.points.set(chosen(true).map(|job| reflector(samples, job)));
        let mut anchors_cut = self.group.gather(&s.transfer, rays, &self.points, cut);
        if let Some(c) = compensation {
            self.near.begin(c, cut.origin, &self.points, &mut anchors_cut.sum);
        }
        lit.extend(chosen(true).copied().zip(anchors_cut.sum.radiance));
        if lit.len() == jobs.len() {
            return;
        }
        self.reconstruction.set(&s.transfer, &self.points, &anchors_cut, cut);
        let others: Vec<&Job> = chosen(false).collect();
        let first = hash(jobs[0].sample, 0) as f32 * (1.0 / 4_294_967_296.0);
        let chunks = others.len().div_ceil(LANES);
        for chunk in 0..chunks {
            let jobs = || others.iter().skip(chunk).step_by(chunks);
            let start = (first + chunk as f32 * GOLDEN).fract();
            self.points.set(jobs().map(|job| reflector(samples, job)));
            let mut sum = self.reconstruction.gather(&s.transfer, rays, &self.points, start);
            if let Some(c) = compensation {
                self.near.add(c, &self.points, &mut sum);
            }
            lit.extend(jobs().map(|job| **job).zip(sum.radiance));
        }
    }
}

impl<'w> Cutters<'w> {
    /// Lights up to sixteen samples, each with a cut of its own.
    fn alone<V: Visibility>(
        &mut self,
        s: &Source<'_>,
        rays: &V,
        samples: &EyePass<'w>,
        jobs: &[Job],
        cut: &CutSettings,
        lit: &mut Vec<(Job, Rgb)>,
    ) {
        let mut sum = PacketSum::default();
        for (lane, job) in jobs.iter().enumerate() {
            let own = self.single.gather(&s.transfer, rays, &reflector(samples, job), cut);
            (sum.radiance[lane], sum.limits[lane]) = (own.radiance, own.limit);
        }
        if let Some(c) = &s.compensation {
            self.points.set(jobs.iter().map(|job| reflector(samples, job)));
            self.near.begin(c, cut.origin, &self.points, &mut sum);
        }
        lit.extend(jobs.iter().copied().zip(sum.radiance));
    }
}

/// Which jobs of a patch make its cut: the outermost, so that light is never extrapolated, and every so many others,
/// from the middle of each stretch.
fn makers(samples: &EyePass, jobs: &[Job]) -> Vec<bool> {
    if jobs.len() <= LANES {
        return vec![true; jobs.len()];
    }
    let point = |job: &Job| &samples.points.geometry[job.sample as usize];
    let frame = Frame::from_normal(point(&jobs[0]).normal);
    let mut makes = vec![false; jobs.len()];
    let axes = [frame.tangent, -frame.tangent, frame.bitangent, -frame.bitangent];
    for axis in axes {
        let along = |i: &usize| point(&jobs[*i]).position.dot(axis);
        let outermost = (0..jobs.len()).max_by(|a, b| along(a).total_cmp(&along(b)));
        outermost.into_iter().for_each(|i| makes[i] = true);
    }
    let stride = jobs.len().div_ceil(LANES - axes.len());
    makes.iter_mut().skip(stride / 2).step_by(stride).for_each(|makes| *makes = true);
    makes
}

fn reflector<'w>(samples: &EyePass<'w>, job: &Job) -> Receiver<'w> {
    let (point, surface) =
        (&samples.points.geometry[job.sample as usize], &samples.points.surfaces[job.sample as usize]);
    let frame = Frame::from_normal(point.normal);
    let lobe = if job.lobe_only { surface.bsdf.split_base(1.0).1 } else { None };
    let bsdf = lobe.unwrap_or(surface.bsdf);
    Receiver::new(point.position, surface.geometric_normal, &frame, bsdf, surface.out)
        .with_baseline(job.known)
}
