//! Resolves records: adds their light to the image, and lists shading tasks for the rest.

use base::math::Rgb;
use transport::eye::EyePass;
use transport::lights::Origin;
use transport::radiance_cache::fill::CacheFrame;
use transport::radiance_cache::resolve::{Interpolated, Remainder};
use transport::radiance_cache::store::Records;
use transport::shade::{Reflected, ShadedImage, ShadingTask};

/// Light of records at some points, and what is left to do.
#[derive(Default)]
struct Resolved {
    light: Vec<Reflected>,
    tasks: Vec<ShadingTask>,
}

impl Resolved {
    /// Divides the light of a point.
    fn add(&mut self, point: usize, light: &Interpolated) {
        let &Interpolated { base, lobe, baseline_luminance, remainder } = light;
        let lobe_origin = remainder.map(|part| part != Remainder::All).only();
        let parts = Origin::ALL.map(|origin| (Some(origin), base[origin]));
        for (origin, radiance) in parts.into_iter().chain([(lobe_origin, lobe)]) {
            if radiance != Rgb::ZERO {
                self.light.push(Reflected { point: point as u32, origin, radiance });
            }
        }
        for (part, lobe_only) in [(Remainder::All, false), (Remainder::Lobe, true)] {
            let remaining = remainder.map(|remainder| remainder == part);
            if remaining.any() {
                let (point, origin) = (point as u32, remaining.only());
                self.tasks.push(ShadingTask { point, lobe_only, origin, baseline_luminance });
            }
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
    let of_run = |points: &mut dyn Iterator<Item = (usize, Interpolated)>| {
        let mut resolved = Resolved::default();
        for (point, mut light) in points {
            if samples_direct {
                light.remainder.direct = Remainder::Nothing;
                light.baseline_luminance += eye.known_luminance(point);
            }
            resolved.add(point, &light);
        }
        resolved
    };
    let mut tasks = Vec::new();
    for runs in frame.interpolate(records, of_run) {
        let (light, found): (Vec<_>, Vec<_>) = runs.into_iter().map(|run| (run.light, run.tasks)).unzip();
        image.add(eye, &light, |light| *light);
        tasks.extend(found.into_iter().flatten());
    }
    tasks
}
