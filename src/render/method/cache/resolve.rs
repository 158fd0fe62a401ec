//! Light of records added to the picture, and shading tasks for the rest.

use transport::eye::EyePass;
use transport::lights::Origin;
use transport::radiance_cache::resolve::{Interpolated, Remainder};
use transport::shade::{ShadedImage, ShadingTask};

/// Adds the light of records to the picture. Returns tasks for the rest, which is shaded by cuts; if `drawn`, the eye
/// pass has found the direct light.
pub fn resolve(
    light: impl Iterator<Item = Interpolated>,
    eye: &EyePass,
    drawn: bool,
    picture: &mut ShadedImage,
) -> Vec<ShadingTask> {
    let mut tasks = Vec::new();
    for (point, mut light) in light.enumerate() {
        if drawn {
            light.remainder.direct = Remainder::Nothing;
            light.baseline_luminance += eye.known_luminance(point);
        }
        for origin in Origin::ALL {
            picture.add(eye, point, Some(origin), light.base[origin]);
        }
        picture.add(eye, point, light.remainder.map(|part| part != Remainder::All).only(), light.lobe);
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
