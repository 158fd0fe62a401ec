//! Light of records at the eye samples of a frame, and the parts left to cuts.
//!
//! Paper: Herzog et al. 2009, section 6.

use super::fill::CacheFrame;
use super::glossy_point::GlossyPoint;
use super::placement::missing;
use super::store::Records;
use crate::lights::{DirectIndirect, Origin};
use base::math::{Rgb, luminance};
use rayon::prelude::*;

/// Number of index leaves interpolated at a time.
const LEAVES: usize = 16384;

/// Number of index leaves in a run, a divisor of [`LEAVES`].
const RUN: usize = 32;

/// Sum of weights up to which records do not light a sample: a single footprint reaches it, and it lies beyond 0.9 of
/// the way to the edge. Such samples occur where a wall continues beyond the image frame, which hides it from the
/// record's light.
const MIN_WEIGHT: f32 = 0.1;

/// Part of a layer's light at an eye sample that is left to cuts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remainder {
    /// No light.
    Nothing,
    /// Reflection by the lobe on the base, which is too sharp for records.
    Lobe,
    /// All light.
    All,
}

/// Light of records at an eye sample.
#[derive(Clone, Copy, Debug)]
pub struct Interpolated {
    /// Radiance reflected by the base.
    pub base: DirectIndirect<Rgb>,
    /// Radiance reflected by the lobe, over all layers with records.
    pub lobe: Rgb,
    /// Luminance of the radiance, if records give all of their layers; 0 otherwise.
    pub baseline_luminance: f32,
    /// Parts left to cuts.
    pub remainder: DirectIndirect<Remainder>,
}

impl CacheFrame<'_> {
    /// Maps the light of the records by runs of eye samples, in order; `of_run` gets the samples of a run. Light is
    /// computed in blocks of runs, since the light of all samples would dominate the memory of large images.
    pub fn interpolate<T: Send>(
        &self,
        records: &Records,
        of_run: impl Fn(&mut dyn Iterator<Item = (usize, Interpolated)>) -> T + Copy + Sync + Send,
    ) -> impl Iterator<Item = Vec<T>> {
        let index = self.targets.index;
        let of_leaf = move |leaf| index.leaf(leaf).map(move |s| (s, self.at_sample(records, leaf, s)));
        (0..index.leaves()).step_by(LEAVES).map(move |first| {
            let runs = (first..(first + LEAVES).min(index.leaves())).into_par_iter().step_by(RUN);
            let leaves = |start: usize| start..(start + RUN).min(index.leaves());
            runs.map(|start| of_run(&mut leaves(start).flat_map(of_leaf))).collect()
        })
    }

    fn at_sample(&self, records: &Records, leaf: usize, sample: usize) -> Interpolated {
        let targets = &self.targets;
        let (point, surface) = (&targets.points.geometry[sample], targets.points.surfaces.get(sample));
        let mut light = Interpolated {
            base: DirectIndirect::default(),
            lobe: Rgb::ZERO,
            baseline_luminance: 0.0,
            remainder: DirectIndirect { direct: Remainder::All, indirect: Remainder::All },
        };
        if missing(targets, &self.splats, self.cached, sample, MIN_WEIGHT).any() {
            return light;
        }
        let (base, lobe) = surface.bsdf.split_base(surface.out.dot(point.normal));
        let glossy = GlossyPoint::new(targets, sample);
        let remainder =
            if lobe.is_some() && targets.bands[sample] == 0 { Remainder::Lobe } else { Remainder::Nothing };
        light.remainder = self.cached.map(|cached| if cached { remainder } else { Remainder::All });
        if !targets.cacheable[sample] {
            return light;
        }
        let mean = |origin: Origin| self.splats[origin].sums[sample].mean().unwrap_or(Rgb::ZERO);
        let irradiance = DirectIndirect::from_fn(mean);
        if let Some(mut glossy) = glossy {
            let mut mean = |origin: Origin| glossy.mean(&records[origin], &self.splats[origin], leaf);
            light.lobe = mean(Origin::Direct) + mean(Origin::Indirect);
        }
        light.base = irradiance.map(|irradiance| base * irradiance);
        light.baseline_luminance = luminance(base * (irradiance.direct + irradiance.indirect) + light.lobe);
        light
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{ALBEDO, Floor, record};
    use super::super::record::NewRecord;
    use super::super::splat::Splat;
    use super::*;
    use crate::lightcut::CutCounts;
    use glam::Vec3;
    use std::f32::consts::FRAC_1_PI;

    const IRRADIANCE: DirectIndirect<Rgb> =
        DirectIndirect { direct: Rgb::new(1.0, 2.0, 3.0), indirect: Rgb::new(0.5, 0.25, 0.125) };

    #[test]
    fn covered_samples_reflect_irradiance_and_uncovered_ones_are_left() {
        let floor = Floor::grid(16);
        let mut records = Records::default();
        for origin in Origin::ALL {
            // Indirect light covers less.
            let radius = if origin == Origin::Direct { 0.44 } else { 0.22 };
            let record = record(Vec3::new(0.5, 0.5, 0.0), [radius; 2], IRRADIANCE[origin]);
            records[origin].push(NewRecord { origin, sample: 0, record, series: None });
        }
        for cached in [(true, true), (true, false), (false, true)] {
            let cached = DirectIndirect { direct: cached.0, indirect: cached.1 };
            let targets = floor.targets();
            let splat = |origin| {
                let none = Default::default();
                Splat::new(&targets, if cached[origin] { &records[origin] } else { &none })
            };
            let splats = DirectIndirect::from_fn(splat);
            let frame = CacheFrame {
                targets,
                cached,
                splats,
                placed: DirectIndirect::default(),
                discontinuities: Vec::new(),
                cuts: CutCounts::default(),
            };
            let light: Vec<Interpolated> = frame
                .interpolate(&records, |run| run.map(|(_, light)| light).collect::<Vec<_>>())
                .flatten()
                .flatten()
                .collect();
            assert_eq!(light.len(), floor.points.len());
            for (point, light) in floor.points.geometry.iter().zip(light) {
                let distance = point.position.distance(Vec3::new(0.5, 0.5, 0.0));
                let covered = distance < if cached.indirect { 0.2 } else { 0.4 };
                let left = |cached| if covered && cached { Remainder::Nothing } else { Remainder::All };
                assert_eq!(light.remainder, cached.map(left), "{distance}");
                let mut whole = Rgb::ZERO;
                for origin in Origin::ALL {
                    let given = if covered && cached[origin] { 1.0 } else { 0.0 };
                    let expected = IRRADIANCE[origin] * ALBEDO * FRAC_1_PI * given;
                    assert!((light.base[origin] - expected).length() < 1e-5, "{expected}");
                    whole += expected;
                }
                assert!((light.baseline_luminance - luminance(whole)).abs() < 1e-5);
                assert_eq!(light.lobe, Rgb::ZERO);
            }
        }
    }
}
