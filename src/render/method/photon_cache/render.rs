//! The picture: eye pass, photons, trees of direct light, the cache, and the rest by single samples.

use crate::method::cache::direct_sampling::direct_sampling;
use crate::method::cache::resolve::resolve;
use crate::method::lights::LightStore;
use crate::method::sampling::method_settings;
use crate::method::{Output, Prepared, Renderer, Sampled, counts};
use base::film::Window;
use base::kd_tree::KdTree;
use base::math::Rgb;
use base::progress::Control;
use base::setting::{Each, INSPECT, Settings as _};
use base::stats::{Stage, Stats};
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
use transport::radiance_cache::work::rays_beside_samples;
use transport::radiance_cache::{CacheSettings, DirectBy, MAX_CUT};
use transport::shade::{ShadeSettings, ShadedImage, ShadingContext, ShadingTask};
use world::World;
use world::view::View;

/// Memory of a photon with its place in the map, in bytes, as measured.
const PHOTON_BYTES: u64 = 180;

method_settings! {
    /// Settings of the method.
    spp = 4, "Photon map" {
        /// Photons on diffuse surfaces, about.
        photons: u32 = 600_000 => [];
        /// Photons in an estimate of irradiance, at least 16: its bias grows with it, its variance falls.
        nearest: usize = 64 => [.at_least(16.0)];
        /// Rays of a record's final gathering, about.
        rays: u32 = 2000 => [.named("gather_rays").range(16.0, 1e6)];
        /// Rays of a sample that records do not serve.
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
        /// Accuracy of the cut of an eye sample.
        cut: CutSettings = CutSettings { max_cut: MAX_CUT, ..CutSettings::default() } => [by Settings::each_of_cut];
        /// Builder of the light trees.
        family: Family = Family::default() => [group];
        /// Images of the records, beside the picture; see `radiance_cache::inspect`.
        inspect: bool = false => [is INSPECT];
    }
}

impl Settings {
    /// Visits the settings of cuts, less the clamp, which is of indirect virtual lights; records have the same cap.
    fn each_of_cut(&mut self, each: Each) {
        self.cut.each(&mut |spec, value| {
            if spec.key != "clamp" {
                each(spec, value)
            }
        });
        self.cache.cut.max_cut = self.cut.max_cut;
    }
}

impl Renderer for Settings {
    fn name(&self) -> &'static str {
        "photon-cache"
    }

    fn about(&self) -> &'static str {
        "The same cache, its indirect light by final gathering over a photon map, for comparison"
    }

    fn render(&self, world: &World, lights: &LightStore, view: &View, control: &Control) -> Output {
        let wanted = (self.light, self.family);
        let glossy = Glossy::new(world, &self.cache);
        let pixels = view.window.film_pixel_count() as f64;
        let other_rays = rays_beside_samples(pixels, self.spp.into(), self.photons.into());
        let drawn = direct_sampling(glossy.as_ref(), &self.cache, Settled::default(), Some(other_rays));
        let Prepared { eye: samples, lights, mut stats } =
            Prepared::new(world, lights, view, (self.sampling(), drawn), (wanted, false), control);
        let context = ShadingContext::new(world, &lights, true);
        let direct = LightcutSource { context, settings: &self.cache };

        let map = irradiance(world, self, control, &mut stats);
        let light = IndirectLight { world, map: &map };
        let source = FinalGatherSource::new(direct, light, Strata::new(self.rays), self.seed);
        let mut records = Records::default();
        let glossy = glossy.as_ref().and_then(|glossy| glossy.for_points(&samples.points, &self.cache));
        let frame = self.cache.cached().any().then(|| {
            let targets = Targets::new(&samples.points, &samples.index, glossy);
            CacheFrame::fill(targets, &mut records, &source, control, &mut stats)
        });
        if let Some(frame) = &frame {
            counts::cuts(&mut stats, "Records", &frame.cuts);
        }

        let mut picture = ShadedImage::new(&samples, self.inspect);
        let tasks = stats.time(Stage::Splat, || match &frame {
            Some(frame) => resolve(
                frame.interpolate(&records),
                &samples,
                self.cache.samples_direct_light(),
                &mut picture,
            ),
            None => (0..samples.len() as u32).map(ShadingTask::all).collect(),
        });
        picture.came_by("records");
        let direct: Vec<ShadingTask> = tasks
            .iter()
            .filter(|task| task.origin != Some(Origin::Indirect))
            .map(|task| ShadingTask { origin: Some(Origin::Direct), ..*task })
            .collect();
        let indirect: Vec<ShadingTask> =
            tasks.into_iter().filter(|task| task.origin != Some(Origin::Direct)).collect();
        control.begin(Stage::Render, (direct.len() + indirect.len()) as u64);
        let shading = ShadeSettings {
            cut: self.cut,
            share: self.cache.share,
            samples: None,
            shadows: self.cache.shadows,
        };
        let counts = stats.time(Stage::Render, || {
            picture.shade(&context, &samples, &direct, self.cache.patches, &shading, control)
        });
        picture.came_by("cuts");
        counts::cuts(&mut stats, "Lightcut", &counts.cuts);
        counts.shadows.report(&mut stats);
        let gathered = stats.time(Stage::Render, || own_gathers(&source, &samples, &indirect, self, control));
        let mut rays = *source.counts();
        for (task, (radiance, used)) in indirect.iter().zip(gathered) {
            picture.add(&samples, task.point as usize, Some(Origin::Indirect), radiance);
            rays += used;
        }
        picture.came_by("gathering");
        stats.count("Shading/tasks by cuts", direct.len() as u64);
        stats.count("Shading/tasks by gathering", indirect.len() as u64);
        stats.count("Gathering/rays of records", rays.record_rays);
        stats.count("Gathering/rays of samples", rays.own_rays);
        stats.count("Gathering/rays followed", rays.followed);
        stats.count("Gathering/near surfaces", rays.near);
        let complete = samples.complete && !control.is_cancelled();
        let (color, mut extra, nonfinite) = picture.finish(&mut stats);
        if self.inspect {
            extra.extend(frame.iter().flat_map(|frame| frame.inspect(&records, &samples)));
        }
        Output { extra, complete, nonfinite, ..Output::new(color, stats) }
    }

    fn expected_bytes(&self, window: &Window) -> u64 {
        let lights = LightPassSettings { indirect: 0, ..self.light }.expected_bytes()
            + u64::from(self.photons) * PHOTON_BYTES;
        EyePass::expected_bytes(window, self.cache.points_per_pixel(self.spp)).saturating_add(lights)
    }

    fn estimand(&self) -> Estimand {
        self.cache.estimand(self.spp, self.seed)
    }

    fn leaves_noise(&self) -> bool {
        self.cache.samples_direct_light()
    }
}

/// Traces the photons and estimates irradiance from them.
fn irradiance(world: &World, settings: &Settings, control: &Control, stats: &mut Stats) -> IrradianceMap {
    // One edge is the eye's, one that of the gathering.
    let max_edges = world.scene.path_limit(settings.max_depth).saturating_sub(2);
    let wanted = PhotonSettings { photons: settings.photons, seen: &[], max_edges, seed: settings.seed };
    control.begin(Stage::LightPass, u64::from(settings.photons));
    let photons = stats.time(Stage::LightPass, || PhotonMap::new(world, &wanted, control));
    stats.count("Photons/total", photons.photons.len() as u64);
    stats.count("Photons/paths", photons.counts.paths);
    stats.count("Rays/closest hit", photons.counts.rays);
    control.begin(Stage::Tree, 0);
    let (map, rays) =
        stats.time(Stage::Tree, || match estimates(world, &photons, settings.nearest, control) {
            Some((estimates, rays)) => (IrradianceMap::new(&estimates, &photons.site_index), rays),
            None => (IrradianceMap::new(&[], &KdTree::empty()), 0),
        });
    stats.count("Photons/estimates of irradiance", map.len() as u64);
    stats.count("Rays/closest hit", rays);
    map
}

/// Indirect light at samples that records do not serve.
fn own_gathers(
    source: &FinalGatherSource,
    samples: &EyePass,
    tasks: &[ShadingTask],
    settings: &Settings,
    control: &Control,
) -> Vec<(Rgb, GatherCounts)> {
    tasks
        .par_iter()
        .map(|task| {
            let mut counts = GatherCounts::default();
            if control.is_cancelled() {
                return (Rgb::ZERO, counts);
            }
            let ShadingTask { point, lobe_only, .. } = *task;
            let task =
                SampleGather { sample: point, lobe_only, rays: settings.own_rays, seed: settings.seed };
            let radiance = reflected(&source.light, samples, &task, &mut counts);
            control.advance(1);
            (radiance, counts)
        })
        .collect()
}
