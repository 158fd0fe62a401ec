//! Virtual lights of a scene, which methods over them share: the light pass, its trees, and the store that
//! keeps them from frame to frame.

use crate::bias_compensation::Compensation;
use crate::bias_compensation::intensities::Intensities;
use crate::caustics::{CausticPhotons, Caustics, FirstPaths};
use crate::eye::{EyePass, EyeSettings};
use crate::light_tree::{Family, LightTrees};
use crate::lightcut::Transfer;
use crate::method::Sampling;
use crate::progress::Control;
use crate::shade::ShadingContext;
use crate::stats::{Stage, Stats};
use crate::view::View;
use crate::vpl::{LightPassSettings, light_pass, min_dist_sq, near_sq_of_size};
use crate::world::{SurfacePoint, World};
use std::sync::{Arc, Mutex, PoisonError};

/// Facts that virtual lights depend on, besides the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightsWanted {
    /// Numbers of VPLs and the seed.
    pub pass: LightPassSettings,
    /// Builder of the trees.
    pub family: Family,
    /// Longest path in edges.
    pub max_depth: u32,
}

impl LightsWanted {
    /// Lights by the builder and the numbers of `settings`, with the seed and the path limit of the eye samples.
    pub fn new(world: &World, sampling: Sampling, settings: (LightPassSettings, Family)) -> LightsWanted {
        let (numbers, family) = settings;
        let pass = LightPassSettings { seed: sampling.seed, ..numbers };
        LightsWanted { pass, family, max_depth: world.scene.path_limit(sampling.max_depth) }
    }
}

/// Facts that virtual lights depend on, and the points whose indirect light is wanted: of all where there are none.
type LightsFor = (LightsWanted, Vec<SurfacePoint>);

/// Binary logarithms of the numbers of photons over the usual one: of the few that tell how many a view is worth, and
/// the largest. Steps of two are coarse enough that most frames of a walk share their photons.
const FEW: i32 = -4;
const MANY: i32 = 2;

/// Seed and longest path in edges that photons depend on, besides the scene.
type PhotonsFor = (u32, u32);

/// Photons by mirrors and glass, few and more.
struct PhotonsOf {
    first: FirstPaths,
    few: CausticPhotons,
    /// Those made last, of those that are more than few, and the binary logarithm of their number over the usual one.
    more: Mutex<Option<(i32, Arc<CausticPhotons>)>>,
}

/// Light of photons in a view, and what finding it took.
#[derive(Default)]
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

/// Virtual lights, and photons by mirrors and glass, kept from frame to frame: those made last, for as long as the same
/// are wanted.
#[derive(Default)]
pub struct LightStore {
    lights: Mutex<Option<(LightsFor, Arc<Lights>)>>,
    photons: Mutex<Option<(PhotonsFor, Arc<PhotonsOf>)>>,
}

impl LightStore {
    /// Returns the lights of `world`, for the indirect light of the points `seen` or of all if there are none; made
    /// anew if others were made last. Lights are not kept if `control` is cancelled while they are made.
    pub fn get(
        &self,
        world: &World,
        (wanted, seen): (LightsWanted, Vec<SurfacePoint>),
        control: &Control,
        stats: &mut Stats,
    ) -> Arc<Lights> {
        let make = |(wanted, seen): &LightsFor| Lights::new(world, (wanted, seen), control, stats);
        kept(&self.lights, (wanted, seen), control, make)
    }

    /// Photons by mirrors and glass as they light the surfaces of a view, as many as it is worth.
    pub fn caustics(
        &self,
        (world, view): (&World, &View),
        settings: EyeSettings,
        control: &Control,
    ) -> FoundCaustics {
        let EyeSettings { seed, max_depth, .. } = settings;
        let of = kept(&self.photons, (seed, max_depth), control, |_| {
            let first = FirstPaths::new(world, seed, max_depth, control);
            let few = first.photons(world, 2.0f32.powi(FEW), control);
            PhotonsOf { first, few, more: Mutex::default() }
        });
        let seen = |photons: &CausticPhotons| {
            photons.seen(view.camera.origin, view.pixel_angle(), settings.max_depth)
        };
        let paths = of.first.paths() + of.few.paths;
        let rays = of.first.rays() + of.few.rays;
        let mut found = FoundCaustics { paths, rays, ..FoundCaustics::default() };
        let Some(few) = seen(&of.few) else { return found };
        let (worth, chains) = EyePass::photons_worth(world, view, settings, &few, control);
        found.rays += chains.rays;
        found.shadow_rays = chains.shadow_rays;
        let many = (worth.log2().round() as i32).clamp(FEW, MANY);
        if many == FEW {
            return FoundCaustics { caustics: Some(few), photons: of.few.len() as u64, ..found };
        }
        let more = kept(&of.more, many, control, |_| of.first.photons(world, 2.0f32.powi(many), control));
        found.paths += more.paths;
        found.rays += more.rays;
        FoundCaustics { caustics: seen(&more), photons: more.len() as u64, ..found }
    }

    /// The same for a picture, whose time and counters it reports.
    pub fn caustics_of_picture(
        &self,
        eye: (&World, &View),
        settings: EyeSettings,
        control: &Control,
        stats: &mut Stats,
    ) -> Option<Caustics> {
        let found = stats.time(Stage::LightPass, || self.caustics(eye, settings, control));
        if found.paths > 0 {
            stats.count("Caustics/photons", found.photons);
            stats.count("Caustics/photon paths", found.paths);
            stats.count("Rays/closest hit", found.rays);
            stats.count("Rays/shadow", found.shadow_rays);
        }
        found.caustics
    }
}

/// The value in a store if it was made for the same, or one made anew, which stays in the store unless cancelled.
fn kept<K: PartialEq, V>(
    store: &Mutex<Option<(K, Arc<V>)>>,
    wanted: K,
    control: &Control,
    make: impl FnOnce(&K) -> V,
) -> Arc<V> {
    // Values are complete when they are stored: a panic elsewhere cannot have left them half-made.
    let mut kept = store.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((made_for, value)) = &*kept
        && *made_for == wanted
    {
        return Arc::clone(value);
    }
    let value = Arc::new(make(&wanted));
    *kept = (!control.is_cancelled()).then(|| (wanted, Arc::clone(&value)));
    value
}

/// Virtual lights of a scene.
pub struct Lights {
    /// The trees over them.
    pub trees: LightTrees,
    /// Squared distance below which a point cannot represent the patch around it, by mesh; 0 for meshes that
    /// do not emit.
    near_sq: Vec<f32>,
    /// `None` if no light is indirect.
    intensities: Option<Intensities>,
    diagonal: f32,
}

impl Lights {
    /// Makes them; stops early if `control` is cancelled.
    fn new(
        world: &World,
        (wanted, seen): (&LightsWanted, &[SurfacePoint]),
        control: &Control,
        stats: &mut Stats,
    ) -> Lights {
        control.begin(Stage::LightPass, u64::from(wanted.pass.indirect));
        let pass = || light_pass(world, &wanted.pass, seen, wanted.max_depth, control);
        let found = stats.time(Stage::LightPass, pass);
        stats.count("VPLs/total", found.len() as u64);
        stats.count("VPLs/photon paths", found.photons.paths);
        if found.photons.gain > 0.0 {
            stats.add("VPLs/gain of aims", found.photons.gain.into());
        }
        stats.count("Rays/closest hit", found.photons.rays);

        control.begin(Stage::Tree, 0);
        let build = || {
            let intensities = Intensities::new(&found.sets, &found.profiles);
            let trees =
                LightTrees::build(&found.sets, found.profiles, world.diagonal, wanted.family, control);
            (trees, intensities)
        };
        let (trees, intensities) = stats.time(Stage::Tree, build);
        let least_sq = min_dist_sq(world.diagonal);
        let near_sq = |&size: &u32| if size > 0 { near_sq_of_size(size, least_sq) } else { 0.0 };
        let near_sq = found.sizes.iter().map(near_sq).collect();
        Lights { trees, near_sq, intensities, diagonal: world.diagonal }
    }

    /// Transfer from the lights to a point; `compensated` where short rays find the light lost close to them.
    pub fn transfer(&self, compensated: bool) -> Transfer<'_> {
        Transfer { patches: compensated, ..Transfer::new(&self.trees, self.diagonal) }
    }

    /// Context for shading by the lights; with `compensated`, light lost close to them is found by short rays.
    pub fn context<'a>(&'a self, world: &'a World, compensated: bool) -> ShadingContext<'a> {
        let compensation = compensated.then(|| self.compensation(world));
        ShadingContext { world, transfer: self.transfer(compensated), compensation }
    }

    /// Compensation for light lost close to the lights.
    pub fn compensation<'a>(&'a self, world: &'a World) -> Compensation<'a> {
        Compensation::new(world, self.transfer(true), self.intensities.as_ref(), &self.near_sq)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;
    use crate::scene::{Camera, DeltaLight};
    use crate::test_scenes::*;
    use glam::Vec3;

    #[test]
    fn views_of_light_by_glass_are_worth_more_photons_than_others() {
        let mut scene = scene(Camera::default(), [128, 128]);
        let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
        let ball = add_material(&mut scene, glass(1.5));
        scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, grey));
        scene.meshes.push(sphere(Vec3::new(0.0, 0.0, -0.3), 0.2, 48, ball));
        scene.lights.push(DeltaLight::Point { position: Vec3::Z * 0.5, intensity: Rgb::ONE });
        let (lights, control) = (LightStore::default(), Control::new());
        let settings = EyeSettings { spp: 16, seed: 0, max_depth: u32::MAX };
        let WorldAndView { world, view } = world(scene);
        let photons = |forward: Vec3| {
            let camera = Camera { forward, right: forward.cross(view.camera.up), ..view.camera };
            lights.caustics((&world, &View { camera, ..view }), settings, &control).photons
        };
        let [towards, away, again] = [Vec3::NEG_Z, Vec3::Z, Vec3::NEG_Z].map(photons);
        assert!(away > 0 && towards > 8 * away, "{towards} {away}");
        assert_eq!(towards, again);
    }
}
