//! The image of a film in memory: eye pass, light pass, trees, records, and the light of the points that records do not
//! reach.

use super::Settings;
use super::gathering::by_origin;
use crate::calibration::PRICES;
use crate::method::Output;
use crate::method::lights::LightStore;
use crate::method::prepared::{LitSurfaces, Preparation, Prepared};
use crate::method::renderer::FormerFrames;
use crate::method::sampling::HasSampling;
use crate::method::tally::Tally;
use base::math::Rgb;
use base::progress::Control;
use base::stats::Stage;
use transport::eye::{DirectSampling, EyePass, Settled};
use transport::lights::Origin;
use transport::perception::Thresholds;
use transport::photon::indirect_light::{GatherCounts, IndirectLight};
use transport::photon::records::FinalGatherSource;
use transport::photon::strata::Strata;
use transport::radiance_cache::compute::{LightcutSource, RecordSource};
use transport::radiance_cache::fill::CacheFrame;
use transport::radiance_cache::glossy::Glossy;
use transport::radiance_cache::resolve::{Interpolated, Remainder};
use transport::radiance_cache::retained::RetainedRecords;
use transport::radiance_cache::store::Records;
use transport::radiance_cache::targets::Targets;
use transport::radiance_cache::vantage::Vantage;
use transport::radiance_cache::{CacheSettings, CellLimits};
use transport::shade::{Reflected, ShadedImage, ShadingContext, ShadingCounts, ShadingTask};
use world::World;
use world::view::View;

impl Settings {
    /// Renders the image of `view`, whose eye samples are all kept.
    pub(super) fn film(
        &self,
        world: &World,
        lights: &LightStore,
        inputs: FrameInputs,
        view: &View,
        control: &Control,
    ) -> Output {
        let FrameInputs { cache, cells, mut kept, lit, is_film, settled, thresholds, other_rays } = inputs;
        let vantage = if is_film { Vantage::in_film(view) } else { Vantage::of(view) };
        let glossy = (!cache.lights_by_cuts()).then(|| Glossy::new(world, &cache)).flatten();
        let direct = Settings::direct_sampling(glossy.as_ref(), &cache, settled, other_rays);
        let direct = direct.map(|direct| DirectSampling { guides: !is_film && !self.gathers(), ..direct });
        let sampling = self.sampling();
        let preparation = Preparation { sampling, direct, lights: self.light, lit };
        let Prepared { eye, lights, mut tally } = Prepared::new(world, lights, view, &preparation, control);
        let context = ShadingContext::new(world, &lights, self.compensation);
        let map = self.gathers().then(|| self.gathering.irradiance(world, sampling, control, &mut tally));

        let cuts = LightcutSource { context, settings: &cache, cells, cut: &self.cut, share: self.share };
        let gathering = map.as_ref().map(|map| {
            let strata = Strata::new(self.gathering.rays);
            FinalGatherSource::new(cuts, IndirectLight { world, map, edges: u16::MAX }, strata, self.seed)
        });

        let mut own = Records::default();
        let records = match &mut kept {
            Some(kept) => kept.begin(&vantage, &cache),
            None => &mut own,
        };
        let glossy = glossy.as_ref().and_then(|glossy| glossy.for_points(&eye.points, &cache));
        let frame = (!cache.lights_by_cuts()).then(|| {
            let source = gathering.as_ref().map_or(&cuts as &dyn RecordSource, |source| source);
            let targets = self.targets(&eye, glossy, thresholds);
            CacheFrame::fill(targets, records, source, control, &mut tally.stats)
        });
        let mut image = ShadedImage::new(&eye, self.inspect);
        let tasks = self.resolve(frame.as_ref(), records, &eye, &mut image, &mut tally);
        // Noise that the previous frame did not have would flicker.
        let samples = self.cut_samples(if is_film { 0.0 } else { eye.noise });
        let context = ShadingContext { samples, ..context };
        let shade = || self.shade(&mut image, &context, &eye, tasks, gathering.as_ref(), control);
        tally.time(Stage::Render, shade).report(self, &mut tally);

        let complete = eye.complete && !control.is_cancelled();
        let (color, mut extra, nonfinite) = image.finish(&mut tally.stats);
        if self.inspect {
            extra.extend(frame.iter().flat_map(|frame| frame.inspect(records, &eye)));
        }
        if let (Some(kept), Some(frame)) = (kept, &frame) {
            kept.end(frame, &vantage, &mut tally.stats);
        }
        let guides = eye.guides.as_ref().map_or_else(Vec::new, |guides| guides.layers(&view.window));
        Output { extra, guides, complete, nonfinite, ..Output::new(color, tally) }
    }

    /// Returns the eye samples as records light them.
    fn targets<'a>(
        &self,
        eye: &'a EyePass,
        glossy: Option<&'a Glossy>,
        thresholds: Option<&Thresholds>,
    ) -> Targets<'a> {
        let mut targets = Targets::new(&eye.points, &eye.index, glossy);
        if self.cache.samples_direct_light() && !self.gathers() {
            targets = targets.with_baseline(|point| eye.known_luminance(point));
        }
        match thresholds {
            Some(thresholds) => targets.with_visible(|position| thresholds.at(position)),
            None => targets,
        }
    }

    /// Adds the light of records to the image. Returns tasks for the light that they lack: all light without records.
    fn resolve(
        &self,
        frame: Option<&CacheFrame>,
        records: &Records,
        eye: &EyePass,
        image: &mut ShadedImage,
        tally: &mut Tally,
    ) -> Vec<ShadingTask> {
        let Some(frame) = frame else { return (0..eye.len() as u32).map(ShadingTask::all).collect() };
        tally.cuts("Records", &frame.cuts);
        let samples_direct = self.cache.samples_direct_light();
        let tasks = tally.time(Stage::Splat, || resolve(frame, records, eye, samples_direct, image));
        image.came_by("records");
        tasks
    }

    /// Lights the points that records do not reach.
    fn shade<'w>(
        &self,
        image: &mut ShadedImage,
        context: &ShadingContext<'w>,
        eye: &EyePass<'w>,
        tasks: Vec<ShadingTask>,
        gathering: Option<&FinalGatherSource>,
        control: &Control,
    ) -> ShadedRest {
        let [by_cuts, by_gathering] = match gathering {
            Some(_) => by_origin(&tasks),
            None => [tasks, Vec::new()],
        };
        control.begin(Stage::Render, (by_cuts.len() + by_gathering.len()) as u64);
        let counts = image.shade(context, eye, &by_cuts, &self.shading(), control);
        image.came_by("cuts");
        let rays = gathering.map(|source| {
            let (light, rays) = self.gathering.gather(source, eye, &by_gathering, self.seed, control);
            image.add(eye, &[light], |light| *light);
            image.came_by("gathering");
            rays
        });
        let tasks = [by_cuts, by_gathering].map(|tasks| tasks.len() as u64);
        ShadedRest { points: eye.points.len() as u64, tasks, counts, rays }
    }
}

/// Counts of the shading stage.
struct ShadedRest {
    points: u64,
    /// Number of tasks by cuts and by gathering.
    tasks: [u64; 2],
    counts: ShadingCounts,
    /// Rays of gathering, if there was any.
    rays: Option<GatherCounts>,
}

impl ShadedRest {
    fn report(&self, settings: &Settings, tally: &mut Tally) {
        let [by_cuts, by_gathering] = self.tasks;
        tally.count("Shading/points", self.points);
        tally.count("Shading/tasks by cuts", by_cuts);
        settings.report(&self.counts, tally);
        if let Some(rays) = &self.rays {
            tally.count("Shading/tasks by gathering", by_gathering);
            tally.count("Gathering/rays of records", rays.record_rays);
            tally.count("Gathering/rays of samples", rays.own_rays);
            tally.count("Gathering/rays followed", rays.followed);
            tally.count("Gathering/near surfaces", rays.near);
        }
    }
}

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
        let lobe_origin = remainder.map(|part| part != Remainder::All).single_origin();
        let parts = Origin::ALL.map(|origin| (Some(origin), base[origin]));
        for (origin, radiance) in parts.into_iter().chain([(lobe_origin, lobe)]) {
            if radiance != Rgb::ZERO {
                self.light.push(Reflected { point: point as u32, origin, radiance });
            }
        }
        for (part, lobe_only) in [(Remainder::All, false), (Remainder::Lobe, true)] {
            let remaining = remainder.map(|remainder| remainder == part);
            if remaining.any() {
                let (point, origin) = (point as u32, remaining.single_origin());
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

/// Inputs of an image, besides the settings.
pub struct FrameInputs<'a> {
    /// Settings of records.
    pub cache: CacheSettings,
    /// Cells that get a record.
    pub cells: CellLimits,
    /// Records of former frames; `None` for a still.
    pub kept: Option<&'a mut RetainedRecords>,
    /// Surfaces that virtual lights are made for.
    pub lit: LitSurfaces<'a>,
    /// True for a frame of a film, whose noise must not flicker and whose guides are computed before.
    pub is_film: bool,
    /// Pixels whose direct light is reprojected.
    pub settled: Settled,
    /// Visibility thresholds of the previous frame.
    pub thresholds: Option<&'a Thresholds>,
    /// Expected work besides the eye samples, in rays; unknown in a film, which has records already.
    pub other_rays: Option<f64>,
}

impl<'a> FrameInputs<'a> {
    /// Returns the inputs of a still.
    pub fn still(settings: &Settings, view: &View) -> FrameInputs<'a> {
        let pixels = view.window.film_pixel_count() as f64;
        let (lights, lit) = match settings.gathers() {
            true => (settings.gathering.photons, LitSurfaces::All),
            false => (settings.light.indirect, LitSurfaces::InView),
        };
        FrameInputs {
            cache: settings.cache,
            cells: CellLimits::new(&settings.cache),
            kept: None,
            lit,
            is_film: false,
            settled: Settled::default(),
            thresholds: None,
            other_rays: Some(PRICES.rays_beside_samples(pixels, settings.spp.into(), lights.into())),
        }
    }

    /// Returns the inputs of the next frame of a film, or of the next view of a list.
    pub fn next(settings: &Settings, former: FormerFrames<'a>, view: &View) -> FrameInputs<'a> {
        let FormerFrames { records, settled, thresholds, outlook } = former;
        let still = FrameInputs { kept: Some(records), ..FrameInputs::still(settings, view) };
        if let Some(outlook) = outlook {
            let cells = CellLimits::of_views(&settings.cache, outlook.overlap, settings.cut.epsilon);
            return FrameInputs { cells, lit: LitSurfaces::Seen(&outlook.points), ..still };
        }
        let cache = settings.cache.for_walk();
        let (cells, lit) = (CellLimits::new(&cache), LitSurfaces::All);
        FrameInputs { cache, cells, lit, is_film: true, settled, thresholds, other_rays: None, ..still }
    }
}
