//! Denoising of images by Open Image Denoise 2. The library is loaded at run time, so that all else works without it.
//!
//! [`Denoiser::denoise`] takes the colour of an image and, as guides, albedo and normals of the surfaces seen.
//! [`guides`] finds guides among the layers of a file. The result has the same bits for any number of threads.
//!
//! Network and weights: the filter `RT` of Open Image Denoise for high dynamic range, at a [`Quality`] that [`effort`]
//! chooses.
//! Deviations: the network darkens images smaller than [`MIN_SIDE`] pixels, so their edges are extended to that size.
//! Black images stay black.
//! Units: radiance as in the image. The filter finds the exposure itself. Images far from ordinary brightness, which it
//! takes for black, are scaled by a power of two first.

pub mod effort;
pub mod guides;

use base::film::Image;
use base::math::Rgb;

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
        // The result must be finite even if the network overflows.
        let finite = |(p, noisy): (Rgb, &Rgb)| if p.is_finite() { p.max(Rgb::ZERO) } else { *noisy };
        let pixels = clean.zip(&noisy.pixels).map(finite).collect();
        Ok(Image { pixels, ..noisy })
    }
}

/// Returns the power of two that scales an image to ordinary brightness; 1 if it has that, so that its bits stay.
fn scale(image: &Image) -> f32 {
    let sum: f64 = image.pixels.iter().map(|p| p.as_dvec3().element_sum()).sum();
    let exponent = (sum / (3 * image.pixels.len()) as f64).log2().floor().clamp(-120.0, 120.0);
    if (-10.0..20.0).contains(&exponent) { 1.0 } else { (-exponent).exp2() as f32 }
}

/// Returns the image as three floats per pixel, extended to the right and downwards by its last column and row.
fn continued(image: &Image, [width, height]: [usize; 2], value: impl Fn(Rgb) -> Rgb) -> Vec<[f32; 3]> {
    let [right, bottom] = [image.width as usize - 1, image.height as usize - 1];
    let at = |x: usize, y: usize| value(image.pixels[y.min(bottom) * (right + 1) + x.min(right)]).to_array();
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect()
}

#[cfg(test)]
mod tests;
