//! Caustic photons: as many as a view needs, stored from frame to frame.
//!
//! Few photons are traced first. A pilot of the view's eye samples tells from them how many more reduce its noise.

use super::tally::Tally;
use base::progress::Control;
use base::stats::Stage;
use std::sync::{Arc, Mutex, PoisonError};
use transport::caustics::{CausticPhotons, Caustics, PhotonCount, PilotPaths, pilot_tasks};
use transport::eye::{EyePass, EyeSettings};
use world::World;
use world::view::View;

/// Tasks of pilot paths, seed and maximum path length on which photons depend, besides the scene.
type PhotonKey = (u32, u32, u32);

/// Photons of a seed and a path length: those of the pilot, and more.
struct PhotonLevels {
    first: PilotPaths,
    pilot: CausticPhotons,
    /// Photons made last that are more than the pilot's, by their number.
    more: Memo<PhotonCount, CausticPhotons>,
}

impl PhotonLevels {
    fn new(world: &World, (tasks, seed, max_depth): PhotonKey, control: &Control) -> PhotonLevels {
        let first = PilotPaths::new(world, tasks, seed, max_depth, control);
        let pilot = first.photons(world, PhotonCount::PILOT, control);
        PhotonLevels { first, pilot, more: Mutex::default() }
    }

    /// Returns the light of some of the photons in a view.
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

/// Light of caustic photons in a view, and the work of finding it.
pub struct FoundCaustics {
    /// The light; `None` if there is none.
    pub caustics: Option<Caustics>,
    /// Number of photons.
    pub photons: u64,
    /// Number of photon paths, with those of the pilot.
    pub paths: u64,
    /// Closest-hit rays.
    pub rays: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
}

/// Caustic photons of the last frame. Frames reuse them if they want the same ones.
#[derive(Default)]
pub struct PhotonStore {
    levels: Memo<PhotonKey, PhotonLevels>,
}

impl PhotonStore {
    /// Returns the light of the pilot's photons in a view. It is accurate enough for plans.
    pub fn pilot(
        &self,
        world: &World,
        view: &View,
        settings: EyeSettings,
        control: &Control,
    ) -> FoundCaustics {
        let levels = self.levels(world, view, settings, control);
        levels.light(&levels.pilot, view, settings)
    }

    /// Returns the light of as many photons as reduce the noise of the view.
    pub fn for_view(
        &self,
        world: &World,
        view: &View,
        settings: EyeSettings,
        control: &Control,
    ) -> FoundCaustics {
        let levels = self.levels(world, view, settings, control);
        let pilot = levels.light(&levels.pilot, view, settings);
        let Some(light) = &pilot.caustics else { return pilot };
        let (factor, chains) = EyePass::photon_count_factor(world, view, settings, light, control);
        let count = PhotonCount::nearest(factor);
        let mut found = pilot;
        if count > PhotonCount::PILOT {
            let make = |count: &PhotonCount| levels.first.photons(world, *count, control);
            found = levels.light(&recall_own(&levels.more, count, control, make), view, settings);
            found.paths += levels.pilot.paths;
            found.rays += levels.pilot.rays;
        }
        found.rays += chains.rays;
        found.shadow_rays += chains.shadow_rays;
        found
    }

    /// Returns the light of [`PhotonStore::for_view`] for an image, and reports its time and counters.
    pub fn for_image(
        &self,
        world: &World,
        view: &View,
        settings: EyeSettings,
        control: &Control,
        tally: &mut Tally,
    ) -> Option<Caustics> {
        let view_photons = tally.time(Stage::LightPass, || self.for_view(world, view, settings, control));
        if view_photons.paths > 0 {
            tally.count("Caustics/photons", view_photons.photons);
            tally.count("Caustics/photon paths", view_photons.paths);
            tally.rays(view_photons.rays);
            tally.shadow_rays("Rays/shadow", view_photons.shadow_rays);
        }
        view_photons.caustics
    }

    /// Drops all photons.
    pub fn forget(&self) {
        forget(&self.levels);
    }

    fn levels(
        &self,
        world: &World,
        view: &View,
        settings: EyeSettings,
        control: &Control,
    ) -> Arc<PhotonLevels> {
        let key = (pilot_tasks(view.window.film_pixel_count()), settings.seed, settings.max_depth);
        recall(&self.levels, key, control, |key| PhotonLevels::new(world, *key, control))
    }
}

/// A value with the key that it was made for, if there is one.
pub type Memo<K, V> = Mutex<Option<(K, Arc<V>)>>;

/// Returns the value of `memo` if it was made for `key`. Otherwise makes it, and stores it unless cancelled.
pub fn recall<K: PartialEq, V>(
    memo: &Memo<K, V>,
    key: K,
    control: &Control,
    make: impl FnOnce(&K) -> V,
) -> Arc<V> {
    // Values are complete when they are stored: a panic elsewhere cannot have left them half-made.
    let mut stored = memo.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((made_for, value)) = &*stored
        && *made_for == key
    {
        return Arc::clone(value);
    }
    let value = Arc::new(make(&key));
    *stored = (!control.is_cancelled()).then(|| (key, Arc::clone(&value)));
    value
}

/// Returns the value of `memo` as [`recall`] does, for values that differ from image to image. Images that are rendered
/// side by side make theirs at one time.
pub fn recall_own<K: PartialEq, V>(
    memo: &Memo<K, V>,
    key: K,
    control: &Control,
    make: impl FnOnce(&K) -> V,
) -> Arc<V> {
    let stored = || memo.lock().unwrap_or_else(PoisonError::into_inner);
    let is_it = |(made_for, value): &(K, Arc<V>)| (*made_for == key).then(|| Arc::clone(value));
    let known = stored().as_ref().and_then(is_it);
    known.unwrap_or_else(|| {
        let value = Arc::new(make(&key));
        *stored() = (!control.is_cancelled()).then(|| (key, Arc::clone(&value)));
        value
    })
}

/// Drops the value of `memo`.
pub fn forget<K, V>(memo: &Memo<K, V>) {
    *memo.lock().unwrap_or_else(PoisonError::into_inner) = None;
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::Rgb;
    use glam::Vec3;
    use scene::{Camera, DeltaLight};
    use world::testkit::*;

    #[test]
    fn views_of_caustics_get_more_photons_than_others() {
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
            store.for_view(&world, &View { camera, ..view }, settings, &control).photons
        };
        let [towards, away, again] = [Vec3::NEG_Z, Vec3::Z, Vec3::NEG_Z].map(photons);
        assert!(away > 0 && towards > 8 * away, "{towards} {away}");
        assert_eq!(towards, again);
    }
}
