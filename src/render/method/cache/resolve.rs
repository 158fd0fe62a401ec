//! Resolves records: adds their light to the image, and lists shading tasks for the rest.

use base::math::Rgb;
use transport::eye::EyePass;
use transport::lights::{DirectIndirect, Origin};
use transport::radiance_cache::fill::CacheFrame;
use transport::radiance_cache::resolve::{Interpolated, Remainder};
use transport::radiance_cache::store::Records;
use transport::shade::{ShadedImage, ShadingTask};

/// Light of records at a point, and what is left to do.
struct Resolved {
    base: DirectIndirect<Rgb>,
    lobe: Rgb,
    /// Origin of the light of `lobe`; `None` for both.
    lobe_origin: Option<Origin>,
    tasks: [Option<ShadingTask>; 2],
}

impl Resolved {
    /// Divides the light of a point.
    fn new(point: usize, light: &Interpolated) -> Resolved {
        let &Interpolated { base, lobe, baseline_luminance, remainder } = light;
        let task = |(part, lobe_only)| {
            let remaining = remainder.map(|remainder| remainder == part);
            let (point, origin) = (point as u32, remaining.only());
            remaining.any().then_some(ShadingTask { point, lobe_only, origin, baseline_luminance })
        };
        Resolved {
            base,
            lobe,
            lobe_origin: remainder.map(|part| part != Remainder::All).only(),
            tasks: [(Remainder::All, false), (Remainder::Lobe, true)].map(task),
        }
    }
}

/// Adds the light of records to the image. Returns tasks for the light that they lack.
///
/// With `samples_direct`, the eye pass has found the direct light.
pub fn resolve(
    frame: &CacheFrame,
    records: &Records,
    eye: &EyePass,
    samples_direct: bool,
    image: &mut ShadedImage,
) -> Vec<ShadingTask> {
    let each = |point: usize, mut light: Interpolated| {
        if samples_direct {
            light.remainder.direct = Remainder::Nothing;
            light.baseline_luminance += eye.known_luminance(point);
        }
        Resolved::new(point, &light)
    };
    let mut tasks = Vec::new();
    for (point, light) in frame.interpolate(records, each).enumerate() {
        let parts = Origin::ALL.map(|origin| (Some(origin), light.base[origin]));
        for (origin, radiance) in parts.into_iter().chain([(light.lobe_origin, light.lobe)]) {
            // One thread adds all light, in order.
            if radiance != Rgb::ZERO {
                image.add(eye, point, origin, radiance);
            }
        }
        tasks.extend(light.tasks.into_iter().flatten());
    }
    tasks
}
