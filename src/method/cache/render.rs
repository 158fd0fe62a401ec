//! The picture: eye pass, light pass, trees, the cache, and what it leaves to cuts.
//!
//! What is seen and what shines is [`Prepared`] first and lit after, so that a plan can try how long lighting takes.

use super::resolve::resolve;
use crate::eye::EyePass;
use crate::film::Window;
use crate::light_tree::Family;
use crate::lightcut::CutSettings;
use crate::method::ladder::CUTS;
use crate::method::lights::Lights;
use crate::method::sampling::method_settings;
use crate::method::{Move, Output, Renderer, Sampled, counts};
use crate::progress::Control;
use crate::radiance_cache::CacheSettings;
use crate::radiance_cache::fill::CacheFrame;
use crate::radiance_cache::series::Glossy;
use crate::radiance_cache::source::LightcutSource;
use crate::radiance_cache::store::Records;
use crate::radiance_cache::targets::Targets;
use crate::setting::{COMPENSATION, Each, INSPECT, Settings as _};
use crate::shade::{Picture, ShadeSettings, ShadingContext, ShadingTask, patches, shade};
use crate::stats::{Stage, StageTime, Stats, Stopwatch};
use crate::view::View;
use crate::vpl::LightPassSettings;
use crate::world::World;

/// Fewer patches than this do not tell how long others take.
const LEAST_TRIED: usize = 32;

method_settings! {
    /// Settings of the method.
    spp = 4, "Records" {
        /// Numbers of VPLs; their seed is not used.
        light: LightPassSettings = LightPassSettings::default() => [group];
        /// Accuracy of the cut of an eye sample.
        cut: CutSettings = CutSettings::default() => [by Settings::each_of_cut];
        /// Compensation by short rays for light lost to clamping.
        compensation: bool = true => [is COMPENSATION];
        /// Builder of the light trees.
        family: Family = Family::default() => [group];
        /// Number and accuracy of records.
        cache: CacheSettings = CacheSettings::default() => [group];
        /// Images of the records, beside the picture; see `radiance_cache::inspect`.
        inspect: bool = false => [is INSPECT];
    }
}

impl Settings {
    /// Visits the settings of cuts; the cap and the clamp are those of records too.
    fn each_of_cut(&mut self, each: Each) {
        self.cut.each(each);
        self.cache.cut.max_cut = self.cut.max_cut;
        self.cache.cut.clamp = self.cut.clamp;
    }

    /// True if all light is found by cuts, none by records.
    fn lights_by_cuts(&self) -> bool {
        !self.cache.cached().any()
    }

    /// Settings of the shading stage.
    fn shading(&self) -> ShadeSettings {
        ShadeSettings { cut: self.cut, share: self.cache.share, shadows: self.cache.shadows }
    }
}

impl Renderer for Settings {
    fn name(&self) -> &'static str {
        "cache"
    }

    fn about(&self) -> &'static str {
        "The radiance cache: records of direct or indirect light, splatted onto the eye samples around them"
    }

    fn render(&self, world: &World, view: &View, control: &Control) -> Output {
        render(world, view, self, control)
    }

    fn check(&self) -> Result<(), String> {
        match self.lights_by_cuts() {
            true => {
                Err("without records, direct and indirect light by cuts are --method reconstruction"
                    .to_owned())
            }
            false => Ok(()),
        }
    }

    fn expected_bytes(&self, window: &Window) -> Option<u64> {
        Some(EyePass::expected_bytes(window, self.spp))
    }

    fn ladder(&self) -> &'static [Move] {
        &CUTS
    }
}

/// Renders what `view` sees.
pub fn render(world: &World, view: &View, settings: &Settings, control: &Control) -> Output {
    Prepared::new(world, view, settings, control).light(settings, control)
}

/// Eye samples and virtual lights: all that the picture needs but lighting.
pub struct Prepared<'w> {
    world: &'w World,
    samples: EyePass<'w>,
    lights: Lights,
    stats: Stats,
}

impl<'w> Prepared<'w> {
    /// By the settings that say how many, and whether surfaces need series.
    pub fn new(world: &'w World, view: &View, settings: &Settings, control: &Control) -> Prepared<'w> {
        let mut stats = Stats::new();
        let eye = settings.sampling().eye(&world.scene);
        control.begin(Stage::EyePass, view.window.tile_count(16) as u64);
        let samples = stats.time(Stage::EyePass, || EyePass::trace(world, view, eye, control));
        counts::eye(&mut stats, &samples.chains);

        let light = LightPassSettings { seed: settings.seed, ..settings.light };
        let lights = Lights::new(world, &light, settings.family, eye.max_depth, control, &mut stats);
        Prepared { world, samples, lights, stats }
    }

    /// What lighting by cuts would take, tried on one patch in `every`, or on more where those would be few;
    /// `None` where records light too.
    pub fn lighting_time(&self, settings: &Settings, every: usize) -> Option<StageTime> {
        if !settings.lights_by_cuts() {
            return None;
        }
        let samples = &self.samples;
        let context = self.lights.context(self.world, settings.compensation);
        let watch = Stopwatch::start();
        let tasks: Vec<ShadingTask> = (0..samples.len() as u32).map(ShadingTask::all).collect();
        let patches = patches(&samples.points, &tasks, settings.cache.patches, self.world.diagonal);
        let mut time = watch.elapsed();
        let every = every.min(patches.len() / LEAST_TRIED).max(1);
        let some: Vec<Vec<ShadingTask>> = patches.iter().skip(every / 2).step_by(every).cloned().collect();
        let watch = Stopwatch::start();
        shade(&context, &samples.points, &some, &settings.shading(), &Control::new());
        let share = samples_of(&patches) / samples_of(&some).max(1.0);
        let StageTime { wall_seconds, cpu_seconds } = watch.elapsed();
        time += StageTime { wall_seconds: wall_seconds * share, cpu_seconds: cpu_seconds * share };
        Some(time)
    }

    /// The picture.
    pub fn light(self, settings: &Settings, control: &Control) -> Output {
        let Prepared { world, samples, lights, mut stats } = self;
        let context = lights.context(world, settings.compensation);
        let source = source(&context, &settings.cache);

        let mut records = Records::default();
        let glossy = Glossy::new(world, &samples.points, &settings.cache);
        let frame = (!settings.lights_by_cuts()).then(|| {
            let targets = Targets::new(&samples.points, &samples.index, glossy.as_ref());
            CacheFrame::fill(targets, &mut records, &source, control, &mut stats)
        });
        if let Some(frame) = &frame {
            counts::cuts(&mut stats, "Records", &frame.cuts);
        }

        let mut picture = Picture::new(&samples, settings.inspect);
        let tasks = stats.time(Stage::Splat, || match &frame {
            Some(frame) => resolve(&frame.interpolate(&records), &samples, &mut picture),
            None => (0..samples.len() as u32).map(ShadingTask::all).collect(),
        });
        control.begin(Stage::Render, tasks.len() as u64);
        let counts = stats.time(Stage::Render, || {
            let patches = patches(&samples.points, &tasks, settings.cache.patches, world.diagonal);
            let shading = shade(&context, &samples.points, &patches, &settings.shading(), control);
            picture.add_patches(&samples, &shading.patches);
            shading.counts
        });
        stats.count("Shading/tasks by cuts", tasks.len() as u64);
        counts::cuts(&mut stats, "Lightcut", &counts.cuts);
        if !settings.cache.cached().indirect {
            counts::clamping(&mut stats, &counts.cuts, settings.compensation.then_some(&counts.compensation));
        }
        counts.shadows.report(&mut stats);
        let complete = samples.complete && !control.is_cancelled();
        let (color, mut extra, nonfinite) = picture.finish();
        if settings.inspect {
            extra.extend(frame.iter().flat_map(|frame| frame.inspect(&records, &samples)));
        }
        Output { color, variance: None, extra, stats, complete, nonfinite }
    }
}

fn source<'a>(context: &ShadingContext<'a>, settings: &'a CacheSettings) -> LightcutSource<'a> {
    let ShadingContext { world, transfer, compensation } = *context;
    LightcutSource { world, transfer, settings, compensation }
}

fn samples_of(patches: &[Vec<ShadingTask>]) -> f64 {
    patches.iter().map(Vec::len).sum::<usize>() as f64
}
