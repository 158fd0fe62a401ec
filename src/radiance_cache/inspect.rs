//! What the cache did, as images: the paper's figures 2 to 6 and 10 of any scene.
//!
//! | layer | red, green, blue |
//! |---|---|
//! | `direct`, `indirect` | radiance of that origin, through the pixel |
//! | `both` | radiance of samples whose own cut held either; `direct` + `indirect` + `both` + emitters in view = the picture |
//! | `records` | number of records placed in the pixel: direct, indirect, 0 |
//! | `footprint` | long over short radius of the indirect record that weighs most; both radii |
//! | `gradient` | gradient of that record's luminance over its luminance, 1/m: x, y, z |
//! | `weights` | sum of weights: direct, indirect, 0 |
//! | `cut` | clusters in the cut of the record that weighs most: direct, indirect, 0 |
//! | `clamped` | share of that indirect record's light taken by clamping, share given back, 0 |
//! | `seams.1`, `seams.2`, ... | eye samples at visible seams before each pass: direct, indirect, 0 |
//!
//! Where a pixel has several eye samples, the last in the order of the index stands for all but in sums and
//! counts.

use super::adapt::Seam;
use super::record::Record;
use super::splat::Layer;
use crate::eye::EyePass;
use crate::film::Image;
use crate::math::{LUMINANCE, Rgb};
use rayon::prelude::*;

/// Layers by name.
pub type Layers = Vec<(String, Image)>;

/// All layers that are known once the cache is complete.
pub fn layers(samples: &EyePass, layers: &[Layer; 2], seams: &[Vec<Seam>]) -> Layers {
    let blank = || Image::new(samples.emitted.width, samples.emitted.height);
    let mut placed = blank();
    for (l, layer) in layers.iter().enumerate() {
        for record in &layer.records {
            pixels(samples, record.facts.sample as usize).for_each(|pixel| placed.pixels[pixel][l] += 1.0);
        }
    }
    let mut weights = blank();
    for i in 0..samples.len() {
        let sums = Rgb::new(layers[0].sums[i].weight, layers[1].sums[i].weight, 0.0);
        pixels(samples, i).for_each(|pixel| weights.pixels[pixel] += sums);
    }
    let heaviest: Vec<[Option<u32>; 2]> = (0..samples.index.leaves())
        .into_par_iter()
        .flat_map_iter(|leaf| {
            samples.index.leaf(leaf).map(move |i| [0, 1].map(|l| heaviest(samples, &layers[l], leaf, i)))
        })
        .collect();
    let of = |l: usize, i: usize| heaviest[i][l].map(|id| &layers[l].records[id as usize]);
    let image = |value: &dyn Fn(usize) -> Option<Rgb>| {
        let mut image = blank();
        for i in 0..samples.len() {
            if let Some(value) = value(i) {
                pixels(samples, i).for_each(|pixel| image.pixels[pixel] = value);
            }
        }
        image
    };
    let cut = |i: usize| {
        let [direct, indirect] = [0, 1].map(|l| of(l, i).map_or(0.0, |r| r.facts.cut as f32));
        Some(Rgb::new(direct, indirect, 0.0))
    };
    let mut found: Layers = [
        ("records", placed),
        ("footprint", image(&|i| of(1, i).map(footprint))),
        ("gradient", image(&|i| of(1, i).map(gradient))),
        ("weights", weights),
        ("cut", image(&cut)),
        ("clamped", image(&|i| of(1, i).map(clamped))),
    ]
    .map(|(name, image)| (name.to_owned(), image))
    .into();
    for (pass, seams) in (1..).zip(seams) {
        let mut image = blank();
        for seam in seams {
            pixels(samples, seam.sample as usize).for_each(|pixel| image.pixels[pixel][seam.layer] += 1.0);
        }
        found.push((format!("seams.{pass}"), image));
    }
    found
}

/// Pixels that see a shading point.
fn pixels(samples: &EyePass, point: usize) -> impl Iterator<Item = usize> {
    samples.visibility.of(point).iter().map(|seen| seen.pixel as usize)
}

/// The record of `layer` that weighs most at a sample.
fn heaviest(samples: &EyePass, layer: &Layer, leaf: usize, sample: usize) -> Option<u32> {
    let point = &samples.points.geometry[sample];
    let weight = |&id: &u32| layer.records[id as usize].at(point).map(|(weight, _)| (weight, id));
    layer.lists[leaf].iter().filter_map(weight).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, id)| id)
}

fn footprint(record: &Record) -> Rgb {
    let [a, b] = record.footprint.radii;
    Rgb::new(a.max(b) / a.min(b).max(f32::MIN_POSITIVE), a.max(b), a.min(b))
}

fn gradient(record: &Record) -> Rgb {
    record.gradient * LUMINANCE / record.luminance.max(f32::MIN_POSITIVE)
}

fn clamped(record: &Record) -> Rgb {
    let facts = &record.facts;
    let whole = (record.luminance - facts.compensated + facts.clamped).max(f32::MIN_POSITIVE);
    Rgb::new(facts.clamped, facts.compensated, 0.0) / whole
}
