//! Reprojection of direct light: the light of the previous image is reused for surfaces that it shows.
//!
//! A pixel of the new frame is settled under three conditions: an even surface fills it and its surroundings (see
//! [`SeenPixels::even_surface`]), the previous image shows the same surface there, and its light varied little around.
//! A settled pixel gets a quarter of the samples. The denoised light of the previous image, interpolated between its
//! four nearest pixels, is mixed in. The denoiser removes the remaining noise. Edges, textures finer than pixels,
//! outlines of shadows, mirrors, glass and newly visible surfaces are rendered as in a still image.
//!
//! The light must be mixed in before denoising, and must itself be denoised: reprojection spreads noise, which the
//! denoiser then takes for texture.
//!
//! Paper: Nehab et al., *Accelerating Real-Time Shading with Reverse Reprojection Caching*, 2007. Herzog et al. 2009
//! reuse records alone.
//!
//! Units: positions relative to the scene's centre.

mod projection;

pub use projection::ViewProjection;

use crate::eye::{EvenSurface, SeenPixels, Settled};
use base::film::{Image, Window};
use base::math::{Rgb, luminance};
use glam::Vec2;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use world::view::View;

/// Weight of the new frame when the previous image is mixed in. Lower weights leave less noise, but light that moves
/// over glossy surfaces lags behind.
const NEW_WEIGHT: f32 = 0.25;

/// Offset of the albedo that light is divided by, so that it is nonzero on black surfaces.
const ALBEDO_OFFSET: f32 = 0.02;

/// Maximum distance of two points of a surface from each other's plane, in pixel spacings.
const MAX_HEIGHT: f32 = 0.5;

/// Maximum distance of two points of a surface along it, in pixel spacings.
const MAX_DISTANCE: f32 = 10.0;

/// Minimum cosine between the normals of two points of a surface.
const MIN_COS: f32 = 0.98;

/// Maximum difference between neighbouring pixels' light, over the larger one.
const MAX_CONTRAST: f32 = 0.1;

/// Minimum interpolation weight of the pixels that see the same surface, among the four nearest.
const MIN_WEIGHT: f32 = 0.25;

/// Previous image, if there is one.
#[derive(Default, Serialize, Deserialize)]
pub struct PreviousImage {
    /// Number of frames so far.
    turn: u32,
    image: Option<ReusableImage>,
}

/// Data of an image that the next frame may use.
#[derive(Serialize, Deserialize)]
struct ReusableImage {
    projection: ViewProjection,
    /// Per pixel, in rows.
    pixels: Vec<Option<Lit>>,
}

/// Light of a surface that fills a pixel.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Lit {
    surface: EvenSurface,
    /// Light over albedo.
    light: Rgb,
}

/// Light of the previous image at the surfaces of a new frame.
pub struct Reprojected {
    turn: u32,
    /// Light over albedo per pixel, in rows; `None` if unknown.
    light: Vec<Option<Rgb>>,
}

impl PreviousImage {
    /// Returns true if the image is valid. Only damaged bytes give others.
    pub fn is_sound(&self) -> bool {
        let is_lit = |lit: &Lit| lit.light.is_finite() && lit.light.min_element() >= 0.0;
        self.image.as_ref().is_none_or(|image| {
            image.projection.is_sound_for(image.pixels.len()) && image.pixels.iter().flatten().all(is_lit)
        })
    }

    /// Returns its light at the surfaces `seen` by `view`.
    pub fn reproject(&self, view: &View, seen: &SeenPixels) -> Reprojected {
        let pixels = 0..view.window.pixel_count() as usize;
        let light: Vec<Option<Rgb>> = match &self.image {
            Some(image) => pixels
                .clone()
                .into_par_iter()
                .map(|pixel| image.light(&seen.even_surface(pixel)?, view))
                .collect(),
            None => vec![None; pixels.len()],
        };
        let is_smooth = |pixel| is_smooth_around(&light, &view.window, pixel);
        let light = pixels.into_par_iter().map(|pixel| light[pixel].filter(|_| is_smooth(pixel))).collect();
        Reprojected { turn: self.turn, light }
    }

    /// Stores the image `color` of the surfaces `seen` by `view`; clears the stored image if there is none.
    pub fn replace(&mut self, view: &View, seen: &SeenPixels, color: Option<&Image>) {
        self.turn = self.turn.wrapping_add(1);
        self.image = color.map(|color| {
            let lit = |(pixel, color): (usize, &Rgb)| {
                let surface = seen.even_surface(pixel)?;
                Some(Lit { surface, light: *color / albedo(seen, pixel) })
            };
            let pixels = color.pixels.par_iter().enumerate().map(lit).collect();
            ReusableImage { projection: ViewProjection::of(view), pixels }
        });
    }
}

impl ReusableImage {
    /// Returns light over albedo of a surface that `view` sees; `None` if the image does not show it.
    fn light(&self, surface: &EvenSurface, view: &View) -> Option<Rgb> {
        let p = surface.position;
        let (place, _) = self.projection.place(p)?;
        let (corner, between) = (place.floor(), place - place.floor());
        let spacing = view.spacing(p);
        let (mut sum, mut weights) = (Rgb::ZERO, 0.0);
        for [dx, dy] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
            let pixel = self.projection.pixel(corner + Vec2::new(dx, dy));
            let Some(lit) = pixel.and_then(|pixel| self.pixels[pixel]) else { continue };
            let apart = lit.surface.position - p;
            let is_same = lit.surface.mesh == surface.mesh
                && lit.surface.normal.dot(surface.normal) >= MIN_COS
                && apart.dot(surface.normal).abs() <= MAX_HEIGHT * spacing
                && apart.length() <= MAX_DISTANCE * spacing;
            if is_same {
                let weight = (1.0 - (between.x - dx).abs()) * (1.0 - (between.y - dy).abs());
                sum += lit.light * weight;
                weights += weight;
            }
        }
        (weights >= MIN_WEIGHT).then(|| sum / weights)
    }
}

impl Reprojected {
    /// Returns the pixels whose light is known.
    pub fn settled(&self) -> Settled {
        Settled { pixels: self.light.iter().map(Option::is_some).collect(), turn: self.turn }
    }

    /// Mixes the known light into the new image.
    pub fn mix_into(&self, color: &mut Image, seen: &SeenPixels) {
        color.pixels.par_iter_mut().zip(&self.light).enumerate().for_each(|(pixel, (color, light))| {
            if let Some(light) = light {
                *color = NEW_WEIGHT * *color + (1.0 - NEW_WEIGHT) * *light * albedo(seen, pixel);
            }
        });
    }
}

/// Returns true if the known light around a pixel varies little.
fn is_smooth_around(light: &[Option<Rgb>], window: &Window, pixel: usize) -> bool {
    let (x, y) = (pixel as u32 % window.width, pixel as u32 / window.width);
    let near = |at: u32, end: u32| at.saturating_sub(1)..=(at + 1).min(end - 1);
    let around =
        || near(y, window.height).flat_map(|y| near(x, window.width).map(move |x| y * window.width + x));
    let known = around().filter_map(|i| light[i as usize]).map(luminance);
    let (least, most) = known.fold((f32::INFINITY, 0.0f32), |(least, most), v| (least.min(v), most.max(v)));
    most - least <= MAX_CONTRAST * most
}

/// Returns the albedo of a pixel that light is divided by.
fn albedo(seen: &SeenPixels, pixel: usize) -> Rgb {
    seen.albedo(pixel) + ALBEDO_OFFSET
}

#[cfg(test)]
mod tests;
