//! Images of the cache's records: the paper's figures 2 to 6 and 10 of any scene.
//!
//! | layer | red, green, blue |
//! |---|---|
//! | `direct`, `indirect` | radiance of that origin, through the pixel |
//! | `both` | radiance of samples whose cut has both origins; the parts and visible emitters add up to the image |
//! | `records` | number of records placed in the pixel: direct, indirect, 0 |
//! | `footprint` | long over short radius of the indirect record of the largest weight; both radii |
//! | `gradient` | relative gradient of that record's luminance, 1/m: x, y, z |
//! | `weights` | sum of weights: direct, indirect, 0 |
//! | `cut` | clusters in the cut of the record of the largest weight: direct, indirect, 0 |
//! | `clamped` | share of that indirect record's light lost to clamping, share recovered, 0 |
//! | `visible` | visible difference of irradiance (of radiance, if lit by series); irradiance of records; 0 |
//! | `seams.1`, `seams.2`, ... | eye samples at visible seams before each pass: direct, indirect, 0 |
//!
//! The layer `visible` exists in walk-throughs, if the previous frame gives visible differences: the paper's figure 7.
//! Both of its values are luminances.
//!
//! Sums and counts cover all eye samples of a pixel. Otherwise the last one in the order of the index represents it.

use super::fill::CacheFrame;
use super::record::{Diagnostics, Record};
use super::store::Records;
use crate::eye::EyePass;
use crate::lights::{DirectIndirect, Origin};
use base::film::{Image, Layer, Preview};
use base::math::{LUMINANCE, Rgb, luminance};
use rayon::prelude::*;

impl CacheFrame<'_> {
    /// Returns all layers except those of the image's parts. `eye` is the pass that found the targets.
    pub fn inspect(&self, records: &Records, eye: &EyePass) -> Vec<Layer> {
        let heaviest: Vec<DirectIndirect<Option<&Record>>> = (0..eye.index.leaves())
            .into_par_iter()
            .flat_map_iter(|leaf| {
                let heaviest = move |i| DirectIndirect::from_fn(|l| self.heaviest(records, l, leaf, i));
                eye.index.leaf(leaf).map(heaviest)
            })
            .collect();
        let image = |value: &dyn Fn(&DirectIndirect<Option<&Record>>) -> Option<Rgb>| {
            let mut image = blank(eye);
            for (i, heaviest) in heaviest.iter().enumerate() {
                if let Some(value) = value(heaviest) {
                    pixels(eye, i).for_each(|pixel| image.pixels[pixel] = value);
                }
            }
            image
        };
        let cut = |heaviest: &DirectIndirect<Option<&Record>>| {
            let [direct, indirect] =
                heaviest.map(|r| r.map_or(0.0, |r| r.diagnostics.cut as f32)).into_array();
            Some(Rgb::new(direct, indirect, 0.0))
        };
        let sum = Preview::Magma { weights: Rgb::new(1.0, 1.0, 0.0), offset: 0.0 };
        let first = |offset| Preview::Magma { weights: Rgb::X, offset };
        let of_indirect = |value: fn(&Record) -> Rgb| image(&|heaviest| heaviest.indirect.map(value));
        let mut layers = vec![
            Layer::color("records", self.placed_image(eye)).shown(Preview::Marks),
            Layer::color("footprint", of_indirect(footprint)).shown(first(1.0)),
            Layer::vector("gradient", of_indirect(gradient)).shown(Preview::Hues),
            Layer::color("weights", self.weights_image(eye)).shown(sum),
            Layer::color("cut", image(&cut)).shown(sum),
            Layer::color("clamped", of_indirect(clamped)).shown(first(0.0)),
        ];
        let visible = self.visible_image(eye);
        if visible.pixels.iter().any(|seen| *seen != Rgb::ZERO) {
            layers.push(Layer::color("visible", visible).shown(first(0.0)));
        }
        for (pass, discontinuities) in (1..).zip(&self.discontinuities) {
            let mut image = blank(eye);
            for discontinuity in discontinuities {
                let seam = |pixel: usize| image.pixels[pixel][discontinuity.origin as usize] += 1.0;
                pixels(eye, discontinuity.sample as usize).for_each(seam);
            }
            layers.push(Layer::color(format!("seams.{pass}"), image).shown(Preview::Marks));
        }
        layers
    }

    /// Returns the number of records placed in each pixel.
    fn placed_image(&self, eye: &EyePass) -> Image {
        let mut placed = blank(eye);
        for origin in Origin::ALL {
            for &sample in &self.placed[origin] {
                pixels(eye, sample as usize).for_each(|pixel| placed.pixels[pixel][origin as usize] += 1.0);
            }
        }
        placed
    }

    /// Returns the sums of weights in each pixel.
    fn weights_image(&self, eye: &EyePass) -> Image {
        let mut weights = blank(eye);
        for i in 0..eye.len() {
            let [direct, indirect] = self.splats.as_ref().map(|splat| splat.sums[i].weight).into_array();
            let sums = Rgb::new(direct, indirect, 0.0);
            pixels(eye, i).for_each(|pixel| weights.pixels[pixel] += sums);
        }
        weights
    }

    /// Returns the visible differences, and the irradiance of records beside them.
    fn visible_image(&self, eye: &EyePass) -> Image {
        let mut visible = blank(eye);
        for i in 0..eye.len() {
            let mean = self.splats.as_ref().map(|splat| splat.sums[i].mean().map_or(0.0, luminance));
            let seen = self.targets.visible(i).map(|seen| Rgb::new(seen, mean.direct + mean.indirect, 0.0));
            pixels(eye, i).for_each(|pixel| visible.pixels[pixel] = seen.unwrap_or(visible.pixels[pixel]));
        }
        visible
    }

    /// Returns the record of a layer with the largest weight at a sample of a leaf.
    fn heaviest<'r>(
        &self,
        records: &'r Records,
        origin: Origin,
        leaf: usize,
        sample: usize,
    ) -> Option<&'r Record> {
        let (point, bands) = (&self.targets.points.geometry[sample], self.targets.bands[sample]);
        let weighed = self.splats[origin].lists[leaf].iter().filter_map(|&id| {
            let record = &records[origin].records[id as usize];
            record.at(point, bands).map(|(weight, _)| (weight, record))
        });
        weighed.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, record)| record)
    }
}

fn blank(eye: &EyePass) -> Image {
    Image::new(eye.known.width, eye.known.height)
}

/// Returns the pixels that see a shading point.
fn pixels(eye: &EyePass, point: usize) -> impl Iterator<Item = usize> {
    eye.visibility.at_point(point).iter().map(|seen| seen.pixel as usize)
}

fn footprint(record: &Record) -> Rgb {
    let [a, b] = record.footprint.radii;
    Rgb::new(a.max(b) / a.min(b).max(f32::MIN_POSITIVE), a.max(b), a.min(b))
}

fn gradient(record: &Record) -> Rgb {
    record.gradient * LUMINANCE / record.luminance.max(f32::MIN_POSITIVE)
}

fn clamped(record: &Record) -> Rgb {
    let Diagnostics { clamped, compensated, .. } = record.diagnostics;
    let whole = (record.luminance - compensated + clamped).max(f32::MIN_POSITIVE);
    Rgb::new(clamped, compensated, 0.0) / whole
}
