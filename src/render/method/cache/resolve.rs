//! Light of records added to the picture, and shading tasks for the rest.

use transport::eye::EyePass;
use transport::lights::Origin;
use transport::radiance_cache::resolve::{Interpolated, Left};
use transport::shade::{Picture, ShadingTask};

/// Adds the light of records to the picture. Returns tasks for the rest, which is shaded by cuts; if `drawn`, the eye
/// pass has found the direct light.
pub fn resolve(
    light: impl Iterator<Item = Interpolated>,
    eye: &EyePass,
    drawn: bool,
    picture: &mut Picture,
) -> Vec<ShadingTask> {
    let mut tasks = Vec::new();
    for (point, mut light) in light.enumerate() {
        if drawn {
            light.left.direct = Left::Nothing;
            light.baseline_luminance += eye.known_luminance(point);
        }
        for origin in Origin::ALL {
            picture.add(eye, point, Some(origin), light.base[origin]);
        }
        picture.add(eye, point, light.left.map(|left| left != Left::All).only(), light.lobe);
        for (part, lobe_only) in [(Left::All, false), (Left::Lobe, true)] {
            let left = light.left.map(|left| left == part);
            if left.any() {
                let (point, origin) = (point as u32, left.only());
                let baseline_luminance = light.baseline_luminance;
                tasks.push(ShadingTask { point, lobe_only, origin, baseline_luminance });
            }
        }
    }
    tasks
}
