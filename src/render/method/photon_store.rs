//! Photons by mirrors and glass for views, as many as each is worth, kept from frame to frame.

use super::kept::kept;
use base::progress::Control;
use base::stats::{Stage, Stats};
use std::sync::{Arc, Mutex};
use transport::caustics::{CausticPhotons, Caustics, PhotonCount, PilotPaths};
use transport::eye::{EyePass, EyeSettings};
use world::World;
use world::view::View;

/// Seed and longest path in edges that photons depend on, besides the scene.
type PhotonsFor = (u32, u32);

/// Photons by mirrors and glass, few and more.
struct PhotonsOf {
    first: PilotPaths,
    few: CausticPhotons,
    /// Photons made last, of those that are more than few, and their number.
    more: Mutex<Option<(PhotonCount, Arc<CausticPhotons>)>>,
}

impl PhotonsOf {
    /// Light of some of them in a view.
    fn light(&self, photons: &CausticPhotons, view: &View, settings: EyeSettings) -> FoundCaustics {
        FoundCaustics {
            caustics: photons.seen(view.camera.origin, view.pixel_angle(), settings.max_depth),
            photons: photons.len() as u64,
            paths: self.first.paths() + photons.paths,
            rays: self.first.rays() + photons.rays,
            shadow_rays: 0,
        }
    }
}

/// Light of photons in a view, and what finding it took.
pub struct FoundCaustics {
    /// `None` if there is none.
    pub caustics: Option<Caustics>,
    /// Number of photons.
    pub photons: u64,
    /// Number of their paths, and of those that were traced before.
    pub paths: u64,
    /// Closest-hit queries.
    pub rays: u64,
    /// Occlusion queries.
    pub shadow_rays: u64,
}

/// The photons made last, for as long as the same are wanted.
#[derive(Default)]
pub struct PhotonStore {
    kept: Mutex<Option<(PhotonsFor, Arc<PhotonsOf>)>>,
}

impl PhotonStore {
    /// A few photons by mirrors and glass as they light the surfaces of a view: enough for plans.
    pub fn few(
        &self,
        (world, view): (&World, &View),
        settings: EyeSettings,
        control: &Control,
    ) -> FoundCaustics {
        let of = self.of(world, settings, control);
        of.light(&of.few, view, settings)
    }

    /// The same of as many photons as the view is worth.
    pub fn of_view(
        &self,
        (world, view): (&World, &View),
        settings: EyeSettings,
        control: &Control,
    ) -> FoundCaustics {
        let of = self.of(world, settings, control);
        let few = of.light(&of.few, view, settings);
        let Some(light) = &few.caustics else { return few };
        let (worth, chains) = EyePass::photon_count_factor(world, view, settings, light, control);
        let count = PhotonCount::nearest(worth);
        let mut found = few;
        if count > PhotonCount::PILOT {
            let make = |count: &PhotonCount| of.first.photons(world, *count, control);
            found = of.light(&kept(&of.more, count, control, make), view, settings);
            found.paths += of.few.paths;
            found.rays += of.few.rays;
        }
        found.rays += chains.rays;
        found.shadow_rays += chains.shadow_rays;
        found
    }

    fn of(&self, world: &World, settings: EyeSettings, control: &Control) -> Arc<PhotonsOf> {
        let EyeSettings { seed, max_depth, .. } = settings;
        kept(&self.kept, (seed, max_depth), control, |_| {
            let first = PilotPaths::new(world, seed, max_depth, control);
            let few = first.photons(world, PhotonCount::PILOT, control);
            PhotonsOf { first, few, more: Mutex::default() }
        })
    }

    /// The same for a picture, whose time and counters it reports.
    pub fn of_picture(
        &self,
        eye: (&World, &View),
        settings: EyeSettings,
        control: &Control,
        stats: &mut Stats,
    ) -> Option<Caustics> {
        let found = stats.time(Stage::LightPass, || self.of_view(eye, settings, control));
        if found.paths > 0 {
            stats.count("Caustics/photons", found.photons);
            stats.count("Caustics/photon paths", found.paths);
            stats.count("Rays/closest hit", found.rays);
            stats.count("Rays/shadow", found.shadow_rays);
        }
        found.caustics
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::Rgb;
    use glam::Vec3;
    use scene::{Camera, DeltaLight};
    use world::testkit::*;

    #[test]
    fn views_of_light_by_glass_are_worth_more_photons_than_others() {
        let mut scene = scene(Camera::default(), [128, 128]);
        let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
        let ball = add_material(&mut scene, glass(1.5));
        scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, grey));
        scene.meshes.push(sphere(Vec3::new(0.0, 0.0, -0.3), 0.2, 48, ball));
        scene.lights.push(DeltaLight::Point { position: Vec3::Z * 0.5, intensity: Rgb::ONE });
        let (store, control) = (PhotonStore::default(), Control::new());
        let settings = EyeSettings { spp: 16, seed: 0, max_depth: u32::MAX };
        let WorldAndView { world, view } = world(scene);
        let photons = |forward: Vec3| {
            let camera = Camera { forward, right: forward.cross(view.camera.up), ..view.camera };
            store.of_view((&world, &View { camera, ..view }), settings, &control).photons
        };
        let [towards, away, again] = [Vec3::NEG_Z, Vec3::Z, Vec3::NEG_Z].map(photons);
        assert!(away > 0 && towards > 8 * away, "{towards} {away}");
        assert_eq!(towards, again);
    }
}
