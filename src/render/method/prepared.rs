//! An image before its lighting: the first stages of all methods that light the samples of an eye pass.

use super::Sampling;
use super::lights::{LightStore, lights_wanted};
use super::tally::Tally;
use base::progress::Control;
use base::stats::Stage;
use std::sync::Arc;
use transport::eye::{DirectSampling, EyePass, LightSources, ShadingPoints, TILE};
use transport::lights::{LightPassSettings, Lights};
use world::view::View;
use world::{SurfacePoint, World};

/// Maximum number of points whose indirect light photons are planned for.
pub const MAX_SEEN: usize = 16384;
/// Minimum number of shading points for each of them.
const MIN_STEP: usize = 4;

/// Surfaces that virtual lights are made for.
#[derive(Clone, Copy, Debug)]
pub enum LitSurfaces<'a> {
    /// Surfaces in view. Photons are planned for them.
    InView,
    /// Surfaces that several views see. Photons are planned for them, and the views can share the lights.
    Seen(&'a [SurfacePoint]),
    /// All surfaces. All frames can share the lights.
    All,
}

/// Settings of the first stages.
pub struct Preparation<'a> {
    /// Samples, seed and path length.
    pub sampling: Sampling,
    /// Sampling of direct light, if the eye pass does it.
    pub direct: Option<DirectSampling>,
    /// Numbers of VPLs.
    pub lights: LightPassSettings,
    /// Surfaces that the lights are made for.
    pub lit: LitSurfaces<'a>,
}

/// Shading points and virtual lights: an image before its lighting.
pub struct Prepared<'w> {
    /// Visibility samples and the points to shade.
    pub eye: EyePass<'w>,
    /// The virtual lights.
    pub lights: Arc<Lights>,
    /// Counters, times and work so far.
    pub tally: Tally,
}

impl<'w> Prepared<'w> {
    /// Runs the eye pass, and the light pass unless `lights` holds its result.
    pub fn new(
        world: &'w World,
        lights: &LightStore,
        view: &View,
        preparation: &Preparation,
        control: &Control,
    ) -> Prepared<'w> {
        let Preparation { sampling, direct, lights: numbers, lit } = preparation;
        let mut tally = Tally::default();
        let settings = sampling.eye(&world.scene);
        let caustics = lights.photons.for_image(world, view, settings, control, &mut tally);
        let known = direct.as_ref().map(|direct| {
            let learn = || lights.learned(world, view, sampling.spp, control);
            (direct, tally.time(Stage::EyePass, learn))
        });
        let bends = direct.is_some() && world.specular.bends_light();
        let path_ends = bends.then(|| lights.path_ends(world, view, settings, control, &mut tally)).flatten();
        let sources = known.as_ref().map(|(direct, known)| LightSources {
            direct,
            caustics: caustics.as_ref(),
            learned: known.light.as_ref(),
            path_ends: path_ends.as_deref(),
        });
        control.begin(Stage::EyePass, view.window.tile_count(TILE) as u64);
        let eye = tally
            .time(Stage::EyePass, || EyePass::of(world, view, settings, sources, caustics.as_ref(), control));
        tally.eye(&eye.chains);
        if let Some((_, known)) = &known {
            tally.rays(known.counts.rays);
            tally.shadow_rays("Rays/shadow", known.counts.shadow_rays);
        }
        if direct.is_some() {
            tally.count("Eye/light samples", eye.light_samples.into());
        }
        // The light pass comes second, since the eye pass takes the most memory when it sorts its points.
        let seen = match lit {
            LitSurfaces::InView => seen(world, &eye, MAX_SEEN),
            LitSurfaces::Seen(points) => points.to_vec(),
            LitSurfaces::All => Vec::new(),
        };
        let wanted = lights_wanted(world, *sampling, *numbers, seen);
        let lights = lights.get(world, wanted, control, &mut tally);
        Prepared { eye, lights, tally }
    }
}

/// Returns about `most` points whose indirect light photons are planned for; none if no light comes from infinitely
/// far.
pub fn seen(world: &World, eye: &EyePass, most: usize) -> Vec<SurfacePoint> {
    if !world.emitters.have_far() {
        return Vec::new();
    }
    let ShadingPoints { geometry, surfaces } = &eye.points;
    let step = geometry.len().div_ceil(most.max(1)).max(MIN_STEP);
    let point = |i: usize| SurfacePoint {
        position: geometry[i].position,
        normal: geometry[i].normal,
        geometric_normal: surfaces.geometric_normal(i),
    };
    (0..geometry.len()).step_by(step).map(point).collect()
}
