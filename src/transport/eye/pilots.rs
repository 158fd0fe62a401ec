//! Pilots of the eye pass with direct light: what is found about a view, or about several views of one scene together,
//! before the samples of its pixels are taken.
//!
//! Three pilots follow each other. The first finds which scattered edges to guide ([`guide`]), the second which
//! emitters each region of the scene sees ([`learn`]), and the third how noisy the light is ([`effort`]). The cost of
//! pilots hardly depends on the film, so that it weighs on small films. Several views share one answer, which does not
//! depend on which of them are rendered.
//!
//! [`effort`]: super::effort
//! [`guide`]: super::guide
//! [`learn`]: super::learn

use super::adaptive::square_count;
use super::effort::SampledSquares;
use super::guide::GuidePaths;
use super::learn::{Looks, MAX_PATHS, path_count};
use super::pilot_results::EyePilots;
use super::tracer::Tracer;
use super::{DirectSampling, EyeCounts, EyeSettings, LightSources};
use base::progress::Control;
use base::sampling::hash;
use rayon::prelude::*;
use world::World;
use world::light::Learned;
use world::view::View;

/// Number of views whose pilots shared ones may cost.
const COST_IN_VIEWS: u32 = 4;

/// Maximum number of times by which points that learn emitters are rarer than for a view alone.
const MAX_THINNING: f32 = 2.0;

/// Seed of the pilots of several views, combined with the seed of the settings and the number of the view.
const SEED: u32 = 0x6a09_e667;

impl Tracer<'_, '_> {
    /// Runs the pilots of the view alone.
    pub(super) fn pilots(&mut self) -> EyePilots {
        let paths = self.guide_paths(GuidePaths::FOR_VIEW);
        self.edges = paths.edges(self.world);
        let looks = self.look(self.settings.seed, path_count(self.view.window.film, 1));
        let learned = looks.as_ref().map(|looks| looks.learn(self.world));
        let squares = self.squares(learned.as_ref(), square_count(self.view.window.film));
        EyePilots::of(self.world, &paths, looks.as_ref(), learned, squares)
    }
}

impl EyePilots {
    /// Runs the pilots of `views` together. A surface is seen by `overlap` views in the mean.
    ///
    /// Returns `None` if pilots of each view alone are better: for a single view, and if the views see so many
    /// different surfaces that too few points would learn about each. The views must have no light of photons, which
    /// differs from view to view.
    pub fn of_views(
        world: &World,
        views: &[View],
        settings: EyeSettings,
        direct: &DirectSampling,
        overlap: f32,
        control: &Control,
    ) -> Option<EyePilots> {
        let wanted =
            views.iter().map(|view| path_count(view.window.film, 1) as f32).sum::<f32>() / overlap.max(1.0);
        let most = (COST_IN_VIEWS * MAX_PATHS) as f32;
        if views.len() < 2 || wanted > MAX_THINNING * most {
            return None;
        }
        let thinning = overlap.max(1.0) * (wanted / most).max(1.0);
        let settings = EyeSettings { spp: settings.spp.max(1), ..settings };
        let sources = LightSources { direct, caustics: None };
        let mut tracers: Vec<Tracer> = Vec::with_capacity(views.len());
        for (number, view) in (0..).zip(views) {
            let seed = hash(settings.seed ^ SEED, number);
            tracers.push(Tracer::new(world, view, EyeSettings { seed, ..settings }, sources, control));
        }
        let share = |of_view: u32| (COST_IN_VIEWS * of_view).div_ceil(views.len() as u32).min(of_view);
        let mut paths = GuidePaths::default();
        let traced: Vec<GuidePaths> =
            tracers.par_iter().map(|tracer| tracer.guide_paths(share(GuidePaths::FOR_VIEW))).collect();
        traced.iter().for_each(|traced| paths.add(traced));
        let edges = paths.edges(world);
        tracers.iter_mut().for_each(|tracer| tracer.edges = edges);

        let look = |tracer: &Tracer| {
            let count = path_count(tracer.view.window.film, 1) as f32 / thinning;
            tracer.look(tracer.settings.seed, count.ceil() as u32)
        };
        let looks = joined(tracers.par_iter().map(look).collect(), Looks::append);
        let learned = looks.as_ref().map(|looks| looks.learn(world));
        let sample = |tracer: &mut Tracer| {
            let count = share(square_count(tracer.view.window.film));
            tracer.squares(learned.as_ref(), count)
        };
        let squares = joined(tracers.par_iter_mut().map(sample).collect(), SampledSquares::append);
        Some(EyePilots::of(world, &paths, looks.as_ref(), learned, squares))
    }

    fn of(
        world: &World,
        paths: &GuidePaths,
        looks: Option<&Looks>,
        learned: Option<Learned>,
        squares: Option<SampledSquares>,
    ) -> EyePilots {
        let mut chains = EyeCounts { rays: paths.rays.rays, ..EyeCounts::default() };
        chains.shadow_rays = paths.rays.shadow_rays;
        chains += looks.map_or_else(EyeCounts::default, |looks| looks.chains);
        EyePilots { edges: paths.edges(world), learned, squares, chains }
    }
}

/// Joins the results of all views in their order; `None` if no view has one.
fn joined<T: Default>(by_view: Vec<Option<T>>, append: impl Fn(&mut T, T)) -> Option<T> {
    let mut all = None;
    for found in by_view.into_iter().flatten() {
        append(all.get_or_insert_default(), found);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::super::{ExtraSamples, EyePass};
    use super::*;
    use base::film::Window;
    use base::math::Rgb;
    use glam::Vec3;
    use std::sync::Arc;
    use world::testkit::*;

    const SETTINGS: EyeSettings = EyeSettings { spp: 8, seed: 3, max_depth: 16 };

    /// A room with many lamps, a screen and a glass ball, whose photons are left out, and views from around its middle.
    fn room_seen_by(count: usize) -> (WorldAndView, Vec<View>) {
        let (mut scene, grey) = lit_room(camera(Vec3::new(0.0, 0.0, 0.9), Vec3::ZERO, 0.8), 48);
        let ball = add_material(&mut scene, glass(1.5));
        scene.meshes.push(sphere(Vec3::new(0.3, -0.5, 0.0), 0.3, 16, ball));
        for i in 0..32 {
            let at = Vec3::new(-0.9 + 0.22 * (i % 8) as f32, 0.95, -0.9 + 0.1 * (i / 8) as f32);
            let lamp = quad(at, Vec3::X * 0.1, Vec3::Z * 0.05, grey);
            scene.meshes.push(emitting(lamp, Rgb::splat(10.0)));
        }
        scene.meshes.push(quad(Vec3::new(-1.0, 0.2, -0.5), Vec3::X * 1.5, Vec3::Y * 0.8, grey));
        let world = world(scene);
        let view = |i: usize| {
            let eye = Vec3::new(0.1 * (i as f32 / count as f32 - 0.5), 0.0, 0.9);
            View { camera: camera(eye, Vec3::ZERO, 0.8), ..world.view }
        };
        let views = (0..count).map(view).collect();
        (world, views)
    }

    fn direct(pilots: Option<EyePilots>) -> DirectSampling {
        let extra_samples = ExtraSamples { most: 1.0, other_rays: Some(1e6) };
        DirectSampling { extra_samples, pilots: pilots.map(Arc::new), ..DirectSampling::default() }
    }

    fn shared(world: &World, views: &[View], overlap: f32, seed: u32) -> Option<EyePilots> {
        let settings = EyeSettings { seed, ..SETTINGS };
        EyePilots::of_views(world, views, settings, &direct(None), overlap, &Control::new())
    }

    fn pass<'w>(world: &'w World, view: &View, pilots: Option<EyePilots>, seed: u32) -> EyePass<'w> {
        let direct = direct(pilots);
        let sources = LightSources { direct: &direct, caustics: None };
        EyePass::with_direct_light(world, view, EyeSettings { seed, ..SETTINGS }, sources, &Control::new())
    }

    #[test]
    fn views_share_pilots_unless_they_are_alone_or_see_too_many_places() {
        let (world, views) = room_seen_by(16);
        assert!(shared(&world, &views[..1], 1.0, 0).is_none());
        let film = Window::whole([4096, 4096]);
        let large: Vec<View> = views.iter().map(|view| View { window: film, ..*view }).collect();
        assert!(shared(&world, &large, 1.0, 0).is_none());
        let found = shared(&world, &views, 16.0, 0).unwrap();
        assert!(found.learned.is_some() && found.squares.is_some());
    }

    #[test]
    fn shared_pilots_cost_few_views_and_decide_as_the_pilots_of_each_view() {
        let (world, views) = room_seen_by(16);
        let (sources, control) = (direct(None), Control::new());
        let sources = LightSources { direct: &sources, caustics: None };
        let own = Tracer::new(&world, &views[0], SETTINGS, sources, &control).pilots();
        let together = shared(&world, &views, 16.0, 0).unwrap();
        let rays = |pilots: &EyePilots| pilots.chains().rays + pilots.chains().shadow_rays;
        let cost = rays(&together) as f32 / rays(&own) as f32;
        assert!(cost < 1.5 * COST_IN_VIEWS as f32, "{cost}");
        assert!((together.edges.guided - own.edges.guided).abs() < 0.1, "{:?}", together.edges);
        assert!((together.edges.blind / own.edges.blind - 1.0).abs() < 0.3, "{:?}", together.edges);
        let effort = |pilots: &EyePilots| {
            let squares = pilots.squares.as_ref().unwrap();
            squares.effort(SETTINGS.spp, 48 * 48, &sources.direct.extra_samples)
        };
        let [a, b] = [&own, &together].map(effort);
        assert!(a.light_samples.abs_diff(b.light_samples) <= 1);
        assert!((a.noise / b.noise - 1.0).abs() < 0.5, "{} {}", a.noise, b.noise);
    }

    #[test]
    fn light_found_with_shared_pilots_has_the_same_mean_and_one_image_for_any_threads() {
        let (world, views) = room_seen_by(8);
        let mean = |is_shared: bool| {
            let seeds = 0..16;
            let sum: f64 = seeds
                .clone()
                .map(|seed| {
                    let pilots = shared(&world, &views, 8.0, seed).filter(|_| is_shared);
                    pass(&world, &views[5], pilots, seed).known.luminance()
                })
                .sum();
            sum / seeds.len() as f64
        };
        let [own, together] = [false, true].map(mean);
        assert!((together / own - 1.0).abs() < 0.01, "{own} {together}");
        let by_threads = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| pass(&world, &views[5], shared(&world, &views, 8.0, 0), 0).known)
        };
        assert_eq!(by_threads(1), by_threads(4));
    }
}
