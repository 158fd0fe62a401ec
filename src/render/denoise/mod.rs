//! Denoising of images by Open Image Denoise 2. The library is loaded at run time, so that all else works without it.
//!
//! [`Denoiser::denoise`] takes the colour of an image and, as guides, albedo and normals of the surfaces seen.
//! [`guides`] finds guides among the layers of a file. The result has the same bits for any number of threads.
//!
//! Network and weights: the filter `RT` of Open Image Denoise for high dynamic range, at a [`Quality`] that [`effort`]
//! chooses.
//! Deviations: the network darkens images smaller than [`MIN_SIDE`] pixels, so their edges are extended to that size.
//! Black images stay black. Pixels without a surface may keep their value, of which the network knows nothing.
//! Units: radiance as in the image. The filter finds the exposure itself. Images far from ordinary brightness, which it
//! takes for black, are scaled by a power of two first.

pub mod effort;
pub mod guides;

use base::film::Image;
use base::math::Rgb;
use bytemuck::{cast_slice, cast_vec};
use rayon::prelude::*;
use std::borrow::Cow;

pub use oidn::Error as DenoiseError;
pub use oidn::Quality;

/// Layer of the image before denoising.
pub const NOISY: &str = "noisy";
/// Layer of the variance of its pixels.
pub const NOISY_VARIANCE: &str = "noisy.variance";

/// Minimum number of pixels along each side of an image for the network.
const MIN_SIDE: u32 = 64;

/// The library, ready to denoise.
pub struct Denoiser {
    device: oidn::Device,
}

/// Features that guide the denoiser. It preserves edges in them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Guides<'a> {
    /// Albedo of the surfaces seen.
    pub albedo: Option<&'a Image>,
    /// Unit normals of the surfaces seen, in world or camera space; 0 if nothing is seen. They need an albedo beside
    /// them.
    pub normal: Option<&'a Image>,
    /// True if both are free of noise.
    pub noise_free: bool,
    /// True if pixels without a surface, whose albedo and normal are 0, are to stay as they are.
    pub keeps_background: bool,
}

impl Denoiser {
    /// Loads the library. It will use as many threads as the current pool has.
    ///
    /// # Errors
    /// If no version 2 with a CPU device is found, with the places tried and the remedy.
    pub fn load() -> Result<Denoiser, DenoiseError> {
        Ok(Denoiser { device: oidn::Device::load(rayon::current_num_threads())? })
    }

    /// Returns the name and the version of the library.
    pub fn name(&self) -> String {
        format!("Open Image Denoise {}", self.device.version())
    }

    /// Removes the noise of an image of linear radiance.
    ///
    /// Channels that are not finite count as 0. All channels of the result are finite.
    ///
    /// # Errors
    /// If the size of a guide is not that of the image, or the library fails.
    pub fn denoise(&self, color: &Image, guides: &Guides, quality: Quality) -> Result<Image, DenoiseError> {
        let radiance = |p: Rgb| p.map(|x| if x.is_finite() { x.max(0.0) } else { 0.0 });
        let noisy = suited(&color.pixels, radiance);
        let size = [color.width, color.height].map(|side| side as usize);
        if noisy.iter().all(|p| *p == Rgb::ZERO) {
            return Ok(Image { pixels: noisy.into_owned(), ..*color });
        }
        let extended = size.map(|side| side.max(MIN_SIDE as usize));
        let albedo = guide(guides.albedo, "albedo", 0.0, [size, extended])?;
        let normal = guide(guides.normal, "normal", -1.0, [size, extended])?;
        let scale = scale(&noisy);
        let input = continued(suited(&noisy, |p| p * scale), size, extended);
        let clean = self.device.denoise(&oidn::Picture {
            size: extended,
            color: cast_slice(&input),
            albedo: albedo.as_deref().map(cast_slice),
            normal: normal.as_deref().map(cast_slice),
            clean_guides: guides.noise_free,
            quality,
        })?;
        let mut pixels: Vec<Rgb> = cast_vec(clean);
        if size != extended {
            let rows = pixels.chunks_exact(extended[0]).take(size[1]);
            pixels = rows.flat_map(|row| &row[..size[0]]).copied().collect();
        }
        let is_background = |pixel: usize| {
            let is_nothing = |guide: &Image| guide.pixels.get(pixel) == Some(&Rgb::ZERO);
            guides.keeps_background
                && guides.albedo.is_some_and(is_nothing)
                && guides.normal.is_some_and(is_nothing)
        };
        pixels.par_iter_mut().zip(&*noisy).enumerate().for_each(|(i, (p, noisy))| {
            let clean = *p / scale;
            // The result must be finite even if the network overflows.
            *p = if clean.is_finite() && !is_background(i) { clean.max(Rgb::ZERO) } else { *noisy };
        });
        Ok(Image { pixels, ..*color })
    }
}

/// Returns a guide with values from `low` to 1, extended from the size of the image to another size.
fn guide<'a>(
    image: Option<&'a Image>,
    name: &'static str,
    low: f32,
    [size, extended]: [[usize; 2]; 2],
) -> Result<Option<Cow<'a, [Rgb]>>, DenoiseError> {
    let Some(image) = image else { return Ok(None) };
    let own = [image.width, image.height].map(|side| side as usize);
    if own != size {
        return Err(DenoiseError::Size { image: name, size: own, picture: size });
    }
    let within = |p: Rgb| p.map(|x| if x.is_finite() { x.clamp(low, 1.0) } else { 0.0 });
    Ok(Some(continued(suited(&image.pixels, within), size, extended)))
}

/// Returns the power of two that scales an image to ordinary brightness; 1 if it has that, so that its bits stay.
fn scale(pixels: &[Rgb]) -> f32 {
    let sum: f64 = pixels.iter().map(|p| p.as_dvec3().element_sum()).sum();
    let exponent = (sum / (3 * pixels.len()) as f64).log2().floor().clamp(-120.0, 120.0);
    if (-10.0..20.0).contains(&exponent) { 1.0 } else { (-exponent).exp2() as f32 }
}

/// Returns the values of pixels. Pixels are copied only if a value differs: they take much of a large image's memory.
fn suited(pixels: &[Rgb], value: impl Fn(Rgb) -> Rgb + Sync) -> Cow<'_, [Rgb]> {
    let bits = |p: Rgb| p.to_array().map(f32::to_bits);
    match pixels.par_iter().all(|p| bits(value(*p)) == bits(*p)) {
        true => Cow::Borrowed(pixels),
        false => Cow::Owned(pixels.par_iter().map(|p| value(*p)).collect()),
    }
}

/// Returns an image of another size, extended to the right and downwards by its last column and row.
fn continued(pixels: Cow<'_, [Rgb]>, from: [usize; 2], to: [usize; 2]) -> Cow<'_, [Rgb]> {
    if from == to {
        return pixels;
    }
    let at = |x: usize, y: usize| pixels[y.min(from[1] - 1) * from[0] + x.min(from[0] - 1)];
    (0..to[1]).flat_map(|y| (0..to[0]).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect()
}

#[cfg(test)]
mod tests;
