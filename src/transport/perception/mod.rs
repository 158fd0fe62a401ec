//! Visibility thresholds: just visible differences of luminance in the previous frame of a walk-through, reprojected
//! into the next.
//!
//! Paper: Herzog et al. 2009, section 6.4 and figure 7. Thresholds follow from the cosine transform of 8x8 blocks of
//! the previous frame. Positions without a correspondence use Weber's law.
//!
//! Deviations: the previous frame is tone-mapped with its own automatic exposure. A scale of 4 is about Weber's 2 % on
//! plain surfaces: the luminance of a displayed grey of 128 changes by 1.9 % at the step that the paper's matrix sees.
//!
//! Units: positions relative to the scene's centre; depths along the camera's axis.

mod dct;

use crate::eye::SeenPixels;
use crate::reprojection::ViewProjection;
use base::film::tone::auto_factor;
use base::film::{Image, display, srgb_slope};
use base::math::{Rgb, luminance};
use dct::{SIDE, visible_step};
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use world::view::View;

/// Maximum difference between the depth of a point and the depths of the pixels around its position, as a share of
/// them.
const MAX_DIFFERENCE: f32 = 0.01;

/// Quantisation scale of the paper.
pub const Q_SCALE: f32 = 4.0;

/// Maximum grey level.
const WHITE: f32 = 255.0;

/// Visible differences in the previous frame, if there is one.
#[derive(Default, Serialize, Deserialize)]
pub struct Thresholds {
    map: Option<ThresholdMap>,
}

/// Visible differences in an image.
#[derive(Serialize, Deserialize)]
struct ThresholdMap {
    projection: ViewProjection,
    /// Per pixel, in rows.
    pixels: Vec<Visible>,
}

/// Visible difference in a pixel.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Visible {
    /// Depth of the nearest surface, along the camera's axis.
    depth: f32,
    /// Visible difference of the luminance of radiance.
    difference: f32,
}

impl Thresholds {
    /// Returns true if the thresholds are valid. Only damaged bytes give others.
    pub fn is_sound(&self) -> bool {
        let is_visible = |visible: &Visible| visible.depth >= 0.0 && visible.difference >= 0.0;
        self.map.as_ref().is_none_or(|map| {
            map.projection.is_sound_for(map.pixels.len()) && map.pixels.iter().all(is_visible)
        })
    }

    /// Replaces the thresholds by those of an image of the surfaces `seen` by `view`, with a quantisation scale. They
    /// are unknown if there is no complete image without noise.
    pub fn replace(&mut self, q_scale: f32, view: &View, seen: &SeenPixels, color: Option<&Image>) {
        self.map = color.map(|color| {
            let difference = visible_differences(color, q_scale);
            let visible = |(pixel, difference)| Visible { depth: seen.depth(pixel), difference };
            let pixels = difference.into_iter().enumerate().map(visible).collect();
            ThresholdMap { projection: ViewProjection::of(view), pixels }
        });
    }

    /// Returns the visible difference of the luminance of radiance from `position`; `None` if the previous frame did
    /// not see it.
    pub fn at(&self, position: Vec3) -> Option<f32> {
        let ThresholdMap { projection, pixels } = self.map.as_ref()?;
        let (place, depth) = projection.place(position)?;
        let at = (place + 0.5).floor();
        let pixel = |dx: f32, dy: f32| {
            let index = projection.pixel(at + Vec2::new(dx, dy))?;
            pixels.get(index)
        };
        let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| [dx as f32, dy as f32]));
        let near = around.filter_map(|[dx, dy]| pixel(dx, dy)).map(|visible| visible.depth);
        let (least, most) =
            near.fold((f32::INFINITY, 0.0f32), |(least, most), d| (least.min(d), most.max(d)));
        let is_seen = depth >= least * (1.0 - MAX_DIFFERENCE) && depth <= most * (1.0 + MAX_DIFFERENCE);
        pixel(0.0, 0.0).filter(|_| is_seen).map(|visible| visible.difference)
    }
}

/// Returns the visible difference of luminance per pixel of an image.
fn visible_differences(color: &Image, q_scale: f32) -> Vec<f32> {
    let [width, height] = [color.width, color.height].map(|side| side as usize);
    let factor = auto_factor(color);
    let grey_at = |x: usize, y: usize| {
        let pixel = color.pixels[y.min(height - 1) * width + x.min(width - 1)];
        WHITE * display(Rgb::splat(luminance(pixel)), factor).x
    };
    let columns = width.div_ceil(SIDE);
    let steps: Vec<f32> = (0..columns * height.div_ceil(SIDE))
        .into_par_iter()
        .map(|block| {
            let (left, top) = (block % columns * SIDE, block / columns * SIDE);
            let greys = std::array::from_fn(|y| std::array::from_fn(|x| grey_at(left + x, top + y)));
            visible_step(&greys, q_scale)
        })
        .collect();
    let difference = |(pixel, color): (usize, &Rgb)| {
        let step = steps[pixel / width / SIDE * columns + pixel % width / SIDE];
        step / (WHITE * srgb_slope(luminance(*color) * factor) * factor)
    };
    color.pixels.par_iter().enumerate().map(difference).collect()
}

#[cfg(test)]
mod tests;
