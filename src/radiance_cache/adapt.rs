//! Footprints that disagree visibly are shrunk.
//!
//! Paper: Herzog et al. 2009, section 5.2: at each eye sample one contribution after the other is left out; where
//! that changes the luminance visibly, the record's footprint is shrunk until it excludes the sample. On glossy
//! surfaces lit by series, luminance is that of what is reflected to the eye, elsewhere that of the irradiance.
//! The change is judged against the sum of both layers, so that each masks the other.
//!
//! Deviations: the record nearest to the sample keeps its place. Leaving it out changes most, yet it knows most.

use super::series::Glossy;
use super::splat::Layer;
use crate::eye::EyePass;
use crate::math::{Rgb, luminance};
use rayon::prelude::*;

/// A record whose light is seen to end or begin at a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seam {
    /// Layer of the record.
    pub layer: usize,
    /// The record.
    pub record: u32,
    /// The eye sample.
    pub sample: u32,
}

/// Finds all seams, leaf by leaf.
pub fn seams(samples: &EyePass, layers: &[Layer; 2], glossy: Option<&Glossy>, threshold: f32) -> Vec<Seam> {
    let by_leaf: Vec<Vec<Seam>> = (0..samples.index.leaves())
        .into_par_iter()
        .map_init(Default::default, |contributions, leaf| {
            let mut seams = Vec::new();
            for sample in samples.index.leaf(leaf) {
                at_sample(samples, layers, glossy, threshold, (leaf, sample), contributions, &mut seams);
            }
            seams
        })
        .collect();
    by_leaf.concat()
}

fn at_sample(
    samples: &EyePass,
    layers: &[Layer; 2],
    glossy: Option<&Glossy>,
    threshold: f32,
    (leaf, sample): (usize, usize),
    contributions: &mut [Vec<(u32, f32, Rgb)>; 2],
    seams: &mut Vec<Seam>,
) {
    let point = &samples.points.geometry[sample];
    let mut seen = glossy.and_then(|glossy| glossy.seen(point, &samples.points.surfaces[sample]));
    let mut sums = [(Rgb::ZERO, 0.0); 2];
    for ((layer, contributions), (sum, weights)) in layers.iter().zip(&mut *contributions).zip(&mut sums) {
        contributions.clear();
        for &id in &layer.lists[leaf] {
            let record = &layer.records[id as usize];
            if let Some((weight, irradiance)) = record.at(point) {
                let light = match &mut seen {
                    Some(seen) => seen.radiance(record, layer.series(id), irradiance),
                    None => irradiance,
                };
                contributions.push((id, weight, light));
                *sum += weight * light;
                *weights += weight;
            }
        }
    }
    let means = sums.map(|(sum, weights)| if weights > 0.0 { sum / weights } else { Rgb::ZERO });
    let visible = threshold * luminance(means[0] + means[1]);
    for (l, contributions) in contributions.iter().enumerate() {
        let (sum, weights) = sums[l];
        let heaviest = contributions.iter().fold(0.0, |w: f32, c| w.max(c.1));
        for &(id, weight, light) in contributions {
            if weight >= heaviest {
                continue;
            }
            let without = (sum - weight * light) / (weights - weight);
            if luminance((without - means[l]).abs()) > visible {
                seams.push(Seam { layer: l, record: id, sample: sample as u32 });
            }
        }
    }
}

/// Shrinks the footprints of the records at `seams` and says in which leaves that changes something; the sums
/// there must be formed anew.
pub fn shrink(
    samples: &EyePass,
    layers: &mut [Layer; 2],
    seams: &[Seam],
    least_reach: [f32; 2],
) -> Vec<bool> {
    let mut changed = vec![false; samples.index.leaves()];
    for seam in seams {
        let record = &mut layers[seam.layer].records[seam.record as usize];
        let point = &samples.points.geometry[seam.sample as usize];
        if record.delta(point) >= 1.0 {
            continue; // an earlier seam has excluded this sample
        }
        let reach = record.footprint.reach();
        if record.exclude(point, least_reach[seam.layer] * point.spacing) {
            samples.index.leaves_near(record.position, reach, |leaf| changed[leaf] = true);
        }
    }
    changed
}
