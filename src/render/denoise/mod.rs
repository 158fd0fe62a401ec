//! Denoising of pictures by Open Image Denoise 2, which is loaded at run time, so that all else works without it.
//!
//! [`Denoiser::denoise`] takes a picture's colour and, as guides, albedo and normals of the surfaces seen; [`guides`]
//! finds those among the layers of a file. The result has the same bits for any number of threads.
//!
//! Network and weights: Open Image Denoise's filter `RT` for high dynamic range, of a [`Quality`] that [`effort`]
//! finds.
//! Deviations: pictures less than [`MIN_SIDE`] pixels wide or high are continued by their edges up to that, since the
//! network darkens them; black ones stay black.
//! Units: radiance as in the picture, whatever its scale; the filter finds the exposure by itself, but for pictures far
//! from ordinary brightness, which it would take for black: those are brought there by a power of two.

pub mod effort;
pub mod guides;

use base::film::Image;
use base::math::Rgb;

pub use oidn::Error as DenoiseError;
pub use oidn::Quality;

/// Layer that keeps the picture as it was before denoising.
pub const NOISY: &str = "noisy";
/// Layer that keeps the variance of that picture's pixels.
pub const NOISY_VARIANCE: &str = "noisy.variance";

/// Minimum number of pixels along each side of a picture that the network sees.
const MIN_SIDE: u32 = 64;

/// The library, ready to denoise.
pub struct Denoiser {
    device: oidn::Device,
}

/// Features that guide the denoiser: edges in them are kept.
#[derive(Clone, Copy, Debug, Default)]
pub struct Guides<'a> {
    /// Share of light that the surfaces seen reflect.
    pub albedo: Option<&'a Image>,
    /// Their unit normals, in world or camera space; 0 where nothing is seen. They count beside albedo only.
    pub normal: Option<&'a Image>,
    /// True if both are free of noise.
    pub noise_free: bool,
}

impl Denoiser {
    /// Loads the library; it will use as many threads as the current pool has.
    ///
    /// # Errors
    /// If none of version 2 with a CPU device is found, with the places tried and the remedy.
    pub fn load() -> Result<Denoiser, DenoiseError> {
        Ok(Denoiser { device: oidn::Device::load(rayon::current_num_threads())? })
    }

    /// Name and version of the library.
    pub fn name(&self) -> String {
        format!("Open Image Denoise {}", self.device.version())
    }

    /// The picture of linear radiance `color` without its noise. Channels that are not finite count as 0, and none of
    /// the result's are.
    ///
    /// # Errors
    /// If a guide's size is not the picture's, or the library fails.
    pub fn denoise(&self, color: &Image, guides: &Guides, quality: Quality) -> Result<Image, DenoiseError> {
        let radiance = |p: Rgb| p.map(|x| if x.is_finite() { x.max(0.0) } else { 0.0 });
        let noisy = color.map(|p| radiance(*p));
        if noisy.pixels.iter().all(|p| *p == Rgb::ZERO) {
            return Ok(noisy);
        }
        let [width, height] = [color.width, color.height].map(|side| side.max(MIN_SIDE) as usize);
        let within = |low: f32| move |p: Rgb| p.map(|x| if x.is_finite() { x.clamp(low, 1.0) } else { 0.0 });
        let guide = |image: Option<&Image>, name, low| match image {
            None => Ok(None),
            Some(image) if [image.width, image.height] == [color.width, color.height] => {
                Ok(Some(continued(image, [width, height], within(low))))
            }
            Some(image) => Err(DenoiseError::Size {
                image: name,
                size: [image.width as usize, image.height as usize],
                picture: [color.width as usize, color.height as usize],
            }),
        };
        let albedo = guide(guides.albedo, "albedo", 0.0)?;
        let normal = guide(guides.normal, "normal", -1.0)?;
        let scale = scale(&noisy);
        let clean = self.device.denoise(&oidn::Picture {
            size: [width, height],
            color: &continued(&noisy, [width, height], |p| p * scale),
            albedo: albedo.as_deref(),
            normal: normal.as_deref(),
            clean_guides: guides.noise_free,
            quality,
        })?;
        let rows = clean.chunks_exact(width).take(color.height as usize);
        let clean = rows.flat_map(|row| &row[..color.width as usize]).map(|&p| Rgb::from(p) / scale);
        // The network's own limits are far off; a picture must be finite even there.
        let finite = |(p, noisy): (Rgb, &Rgb)| if p.is_finite() { p.max(Rgb::ZERO) } else { *noisy };
        let pixels = clean.zip(&noisy.pixels).map(finite).collect();
        Ok(Image { pixels, ..noisy })
    }
}

/// Power of two that brings a picture to ordinary brightness; 1 if it is there, so that its bits stay.
fn scale(image: &Image) -> f32 {
    let sum: f64 = image.pixels.iter().map(|p| p.as_dvec3().element_sum()).sum();
    let exponent = (sum / (3 * image.pixels.len()) as f64).log2().floor().clamp(-120.0, 120.0);
    if (-10.0..20.0).contains(&exponent) { 1.0 } else { (-exponent).exp2() as f32 }
}

/// The image as three floats a pixel, continued to the right and downwards by its last column and row.
fn continued(image: &Image, [width, height]: [usize; 2], value: impl Fn(Rgb) -> Rgb) -> Vec<[f32; 3]> {
    let [right, bottom] = [image.width as usize - 1, image.height as usize - 1];
    let at = |x: usize, y: usize| value(image.pixels[y.min(bottom) * (right + 1) + x.min(right)]).to_array();
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect()
}

#[cfg(test)]
mod tests;
