//! A picture that lacks but its lighting: the beginning of all methods that light the samples of an eye pass.

use super::lights::{LightStore, lights_wanted};
use super::{Sampling, counts};
use base::progress::Control;
use base::stats::{Stage, Stats};
use std::sync::Arc;
use transport::eye::{DirectSampling, EyePass, PointGeometry, PointSurface, ShadingPoints, TILE};
use transport::lights::{Family, LightPassSettings, Lights};
use world::view::View;
use world::{SurfacePoint, World};

/// Maximum number of points whose indirect light photons are planned for, and minimum number of shading points per
/// point.
const SEEN: usize = 16384;
const POINTS_A_PATH: usize = 4;

/// Shading points and virtual lights: all of a picture but its lighting.
pub struct Prepared<'w> {
    /// Visibility samples and the points to shade.
    pub eye: EyePass<'w>,
    /// The virtual lights.
    pub lights: Arc<Lights>,
    /// Counters and times so far.
    pub stats: Stats,
}

impl<'w> Prepared<'w> {
    /// Runs the light pass, unless `lights` holds what it would make, and the eye pass. Photons are `aimed` at what
    /// gives light to what the eye sees, or lights are those of all frames.
    pub fn new(
        world: &'w World,
        lights: &LightStore,
        view: &View,
        (sampling, drawn): (Sampling, Option<DirectSampling>),
        (wanted, aimed): ((LightPassSettings, Family), bool),
        control: &Control,
    ) -> Prepared<'w> {
        let mut stats = Stats::new();
        let rays = sampling.eye(&world.scene);
        let caustics = lights.photons.of_picture((world, view), rays, control, &mut stats);
        control.begin(Stage::EyePass, view.window.tile_count(TILE) as u64);
        let eye = stats.time(Stage::EyePass, || {
            EyePass::of(world, view, rays, drawn.as_ref(), caustics.as_ref(), control)
        });
        counts::eye(&mut stats, &eye.chains);
        if drawn.is_some() {
            stats.count("Eye/light samples", eye.light_samples.into());
        }
        // Afterwards, since most memory is taken where the eye pass is put in order.
        let seen = if aimed { seen(world, &eye) } else { Vec::new() };
        let lights = lights.get(world, lights_wanted(world, sampling, wanted, seen), control, &mut stats);
        Prepared { eye, lights, stats }
    }
}

/// Returns the points whose indirect light photons are planned for; none if all emitters contribute alike.
fn seen(world: &World, eye: &EyePass) -> Vec<SurfacePoint> {
    if !world.emitters.may_be_uneven() {
        return Vec::new();
    }
    let ShadingPoints { geometry, surfaces } = &eye.points;
    let step = geometry.len().div_ceil(SEEN).max(POINTS_A_PATH);
    let point = |(geometry, surface): (&PointGeometry, &PointSurface)| SurfacePoint {
        position: geometry.position,
        normal: geometry.normal,
        geometric_normal: surface.geometric_normal,
    };
    geometry.iter().zip(surfaces).step_by(step).map(point).collect()
}
