//! The image: eye pass, photons, trees of direct light, records, and final gathering at the points that they do not
//! reach.

use crate::cost::PRICES;
use crate::method::Output;
use crate::method::cache::direct_sampling::direct_sampling;
use crate::method::cache::resolve::resolve;
use crate::method::lights::LightStore;
use crate::method::prepared::{LitSurfaces, Preparation, Prepared};
use crate::method::renderer::{Noisy, Renderer};
use crate::method::sampling::{HasSampling, method_settings};
use crate::method::tally::Tally;
use base::film::Window;
use base::kd_tree::KdTree;
use base::math::Rgb;
use base::progress::Control;
use base::setting::INSPECT;
use base::stats::Stage;
use rayon::prelude::*;
use transport::emission::PhotonSettings;
use transport::eye::{EyePass, Settled};
use transport::lightcut::CutSettings;
use transport::lights::{Family, LightPassSettings, Origin};
use transport::paths::Estimand;
use transport::photon::density::estimates;
use transport::photon::indirect_light::{GatherCounts, IndirectLight};
use transport::photon::own::{SampleGather, reflected};
use transport::photon::records::FinalGatherSource;
use transport::photon::strata::Strata;
use transport::photon::{IrradianceMap, PhotonMap};
use transport::radiance_cache::fill::CacheFrame;
use transport::radiance_cache::glossy::Glossy;
use transport::radiance_cache::source::LightcutSource;
use transport::radiance_cache::store::Records;
use transport::radiance_cache::targets::Targets;
use transport::radiance_cache::{CacheSettings, DirectBy, MAX_CUT};
use transport::shade::{Reflected, ShadeSettings, ShadedImage, ShadingContext, ShadingCounts, ShadingTask};
use world::World;
use world::view::View;

/// Memory of a photon and its place in the map, in bytes.
const PHOTON_BYTES: u64 = 180;

method_settings! {
    /// Settings of the method.
    spp = 4, "Photon map" {
        /// Approximate number of photons on diffuse surfaces.
        photons: u32 = 600_000 => [];
        /// Number of photons per estimate of irradiance, at least 16. More photons increase bias and reduce variance.
        nearest: usize = 64 => [.at_least(16.0)];
        /// Approximate number of final gathering rays per record.
        rays: u32 = 2000 => [.named("gather_rays").range(16.0, 1e6)];
        /// Number of final gathering rays per sample without a record.
        own_rays: u32 = 64 => [.named("sample_rays").range(1.0, 1e6)];
        /// Numbers of VPLs, of direct light only.
        light: LightPassSettings = LightPassSettings { indirect: 0, ..LightPassSettings::default() } => [
            group without ["vpls"]
        ];
        /// Number and reach of records. Cells of 32 samples have as many rays of their own as a record.
        cache: CacheSettings = CacheSettings {
            direct: DirectBy::Cuts,
            least_cell: 32,
            ..CacheSettings::default()
        } => [
            group without ["indirect"]
        ];
        /// Accuracy of the cut of an eye sample; the cap is that of records, too. The clamp is for indirect virtual
        /// lights.
        cut: CutSettings = CutSettings { max_cut: MAX_CUT, ..CutSettings::default() } => [group without ["clamp"]];
        /// Builder of the light trees.
        family: Family = Family::default() => [group];
        /// Images of the records, beside the image; see `radiance_cache::inspect`.
        inspect: bool = false => [is INSPECT];
    }
}

impl Settings {
    /// Returns the settings of records, whose cuts have the cap of other cuts.
    fn record_settings(&self) -> CacheSettings {
        let cut = CutSettings { max_cut: self.cut.max_cut, ..self.cache.cut };
        CacheSettings { cut, ..self.cache }
    }

    /// Traces photons, and returns a map of their irradiance.
    fn irradiance(&self, world: &World, control: &Control, tally: &mut Tally) -> IrradianceMap {
        // One edge is the eye's, another that of the gathering.
        let max_edges = world.scene.path_limit(self.max_depth).saturating_sub(2);
        let wanted = PhotonSettings { photons: self.photons, seen: &[], max_edges, seed: self.seed };
        control.begin(Stage::LightPass, u64::from(self.photons));
        let photons = tally.time(Stage::LightPass, || PhotonMap::new(world, &wanted, control));
        tally.count("Photons/total", photons.photons.len() as u64);
        tally.count("Photons/paths", photons.counts.paths);
        tally.rays(photons.counts.rays);
        control.begin(Stage::Tree, 0);
        let (map, rays) =
            tally.time(Stage::Tree, || match estimates(world, &photons, self.nearest, control) {
                Some((estimates, rays)) => (IrradianceMap::new(&estimates, &photons.site_index), rays),
                None => (IrradianceMap::new(&[], &KdTree::empty()), 0),
            });
        tally.count("Photons/estimates of irradiance", map.len() as u64);
        tally.rays(rays);
        map
    }

    /// Shades tasks of direct light by cuts, and of indirect light by final gathering.
    fn shade_tasks(
        &self,
        image: &mut ShadedImage,
        eye: &EyePass,
        tasks: &[ShadingTask],
        source: &FinalGatherSource,
        control: &Control,
    ) -> ShadedTasks {
        let of = |other: Origin| tasks.iter().filter(move |task| task.origin != Some(other));
        let direct: Vec<ShadingTask> =
            of(Origin::Indirect).map(|task| ShadingTask { origin: Some(Origin::Direct), ..*task }).collect();
        let indirect: Vec<ShadingTask> = of(Origin::Direct).copied().collect();
        control.begin(Stage::Render, (direct.len() + indirect.len()) as u64);
        let CacheSettings { share, shadows, patches, .. } = self.cache;
        let shading = ShadeSettings { cut: self.cut, share, samples: None, shadows };
        let counts = image.shade(&source.direct.context, eye, &direct, patches, &shading, control);
        image.came_by("cuts");
        let mut rays = *source.counts();
        let mut light = Vec::with_capacity(indirect.len());
        for (task, (radiance, used)) in indirect.iter().zip(self.gathers(source, eye, &indirect, control)) {
            light.push(Reflected { point: task.point, origin: Some(Origin::Indirect), radiance });
            rays += used;
        }
        image.add(eye, &[light], |light| *light);
        image.came_by("gathering");
        ShadedTasks { direct: direct.len() as u64, indirect: indirect.len() as u64, counts, rays }
    }

    /// Gathers indirect light at samples without records.
    fn gathers(
        &self,
        source: &FinalGatherSource,
        eye: &EyePass,
        tasks: &[ShadingTask],
        control: &Control,
    ) -> Vec<(Rgb, GatherCounts)> {
        let gather = |task: &ShadingTask| {
            let mut counts = GatherCounts::default();
            if control.is_cancelled() {
                return (Rgb::ZERO, counts);
            }
            let ShadingTask { point, lobe_only, .. } = *task;
            let task = SampleGather { sample: point, lobe_only, rays: self.own_rays, seed: self.seed };
            let radiance = reflected(&source.light, eye, &task, &mut counts);
            control.advance(1);
            (radiance, counts)
        };
        tasks.par_iter().map(gather).collect()
    }
}

/// Counts of shading tasks.
struct ShadedTasks {
    /// Number of tasks by cuts.
    direct: u64,
    /// Number of tasks by gathering.
    indirect: u64,
    counts: ShadingCounts,
    /// Rays of records and of tasks.
    rays: GatherCounts,
}

impl ShadedTasks {
    fn report(&self, tally: &mut Tally) {
        tally.cuts("Lightcut", &self.counts.cuts);
        self.counts.shadows.report(&mut tally.stats);
        tally.count("Shading/tasks by cuts", self.direct);
        tally.count("Shading/tasks by gathering", self.indirect);
        tally.count("Gathering/rays of records", self.rays.record_rays);
        tally.count("Gathering/rays of samples", self.rays.own_rays);
        tally.count("Gathering/rays followed", self.rays.followed);
        tally.count("Gathering/near surfaces", self.rays.near);
    }
}

impl Renderer for Settings {
    fn name(&self) -> &'static str {
        "photon-cache"
    }

    fn about(&self) -> &'static str {
        "Radiance cache with final gathering over a photon map, for comparison"
    }

    fn render(&self, world: &World, lights: &LightStore, view: &View, control: &Control) -> Output {
        let cache = self.record_settings();
        let glossy = Glossy::new(world, &cache);
        let pixels = view.window.film_pixel_count() as f64;
        let other_rays = PRICES.rays_beside_samples(pixels, self.spp.into(), self.photons.into());
        let direct = direct_sampling(glossy.as_ref(), &cache, Settled::default(), Some(other_rays));
        let (sampling, family) = (self.sampling(), self.family);
        let preparation = Preparation { sampling, direct, lights: self.light, family, lit: LitSurfaces::All };
        let Prepared { eye, lights, mut tally } = Prepared::new(world, lights, view, &preparation, control);
        let direct = LightcutSource { context: ShadingContext::new(world, &lights, true), settings: &cache };

        let map = self.irradiance(world, control, &mut tally);
        let light = IndirectLight { world, map: &map, edges: u16::MAX };
        let source = FinalGatherSource::new(direct, light, Strata::new(self.rays), self.seed);
        let mut records = Records::default();
        let glossy = glossy.as_ref().and_then(|glossy| glossy.for_points(&eye.points, &cache));
        let frame = cache.cached().any().then(|| {
            let targets = Targets::new(&eye.points, &eye.index, glossy);
            CacheFrame::fill(targets, &mut records, &source, control, &mut tally.stats)
        });
        if let Some(frame) = &frame {
            tally.cuts("Records", &frame.cuts);
        }

        let mut image = ShadedImage::new(&eye, self.inspect);
        let tasks = tally.time(Stage::Splat, || match &frame {
            Some(frame) => resolve(frame, &records, &eye, cache.samples_direct_light(), &mut image),
            None => (0..eye.len() as u32).map(ShadingTask::all).collect(),
        });
        image.came_by("records");
        let shade = || self.shade_tasks(&mut image, &eye, &tasks, &source, control);
        tally.time(Stage::Render, shade).report(&mut tally);
        let complete = eye.complete && !control.is_cancelled();
        let (color, mut extra, nonfinite) = image.finish(&mut tally.stats);
        if self.inspect {
            extra.extend(frame.iter().flat_map(|frame| frame.inspect(&records, &eye)));
        }
        Output { extra, complete, nonfinite, ..Output::new(color, tally) }
    }

    fn expected_bytes(&self, window: &Window) -> u64 {
        let lights = LightPassSettings { indirect: 0, ..self.light }.expected_bytes()
            + u64::from(self.photons) * PHOTON_BYTES;
        EyePass::expected_bytes(window, self.cache.points_per_pixel(self.spp)).saturating_add(lights)
    }

    fn estimand(&self) -> Estimand {
        self.cache.estimand(self.spp, self.seed)
    }

    fn as_noisy(&self) -> Option<&dyn Noisy> {
        Some(self)
    }
}

impl Noisy for Settings {
    fn leaves_noise(&self) -> bool {
        self.cache.samples_direct_light()
    }

    fn finds_guides(&self) -> bool {
        false
    }
}
