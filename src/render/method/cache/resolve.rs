//! Resolves records: adds their light to the image, and lists shading tasks for the rest.

use transport::eye::EyePass;
use transport::lights::Origin;
use transport::radiance_cache::resolve::{Interpolated, Remainder};
use transport::shade::{ShadedImage, ShadingTask};

/// Adds the light of records to the image. Returns tasks for the light that they lack.
///
/// With `samples_direct`, the eye pass has found the direct light.
pub fn resolve(
    light: impl Iterator<Item = Interpolated>,
    eye: &EyePass,
    samples_direct: bool,
    image: &mut ShadedImage,
) -> Vec<ShadingTask> {
    let mut tasks = Vec::new();
    for (point, mut light) in light.enumerate() {
        if samples_direct {
            light.remainder.direct = Remainder::Nothing;
            light.baseline_luminance += eye.known_luminance(point);
        }
        for origin in Origin::ALL {
            image.add(eye, point, Some(origin), light.base[origin]);
        }
        image.add(eye, point, light.remainder.map(|part| part != Remainder::All).only(), light.lobe);
        for (part, lobe_only) in [(Remainder::All, false), (Remainder::Lobe, true)] {
            let remaining = light.remainder.map(|remainder| remainder == part);
            if remaining.any() {
                let (point, origin) = (point as u32, remaining.only());
                let baseline_luminance = light.baseline_luminance;
                tasks.push(ShadingTask { point, lobe_only, origin, baseline_luminance });
            }
        }
    }
    tasks
}
