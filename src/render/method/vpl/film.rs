//! The image of a film in memory: eye pass, light pass, trees, records, and the light of the points that records do not
//! reach.

use super::Settings;
use super::frame_inputs::FrameInputs;
use super::gathering::by_origin;
use super::resolve::resolve;
use crate::method::Output;
use crate::method::lights::LightStore;
use crate::method::prepared::{Preparation, Prepared};
use crate::method::sampling::HasSampling;
use crate::method::tally::Tally;
use base::progress::Control;
use base::stats::Stage;
use transport::eye::{DirectSampling, EyePass};
use transport::perception::Thresholds;
use transport::photon::indirect_light::{GatherCounts, IndirectLight};
use transport::photon::records::FinalGatherSource;
use transport::photon::strata::Strata;
use transport::radiance_cache::fill::CacheFrame;
use transport::radiance_cache::glossy::Glossy;
use transport::radiance_cache::source::{LightcutSource, RecordSource};
use transport::radiance_cache::store::Records;
use transport::radiance_cache::targets::Targets;
use transport::radiance_cache::vantage::Vantage;
use transport::shade::{ShadedImage, ShadingContext, ShadingCounts, ShadingTask};
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
        let (sampling, family) = (self.sampling(), self.family);
        let preparation = Preparation { sampling, direct, lights: self.light, family, lit };
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
