//! The picture: eye pass, light pass, trees, the cache, and what it leaves to cuts.

use super::filled::Cache;
use super::inspect;
use super::own;
use super::picture::Picture;
use crate::cache::compensate::Compensation;
use crate::cache::compute::Source;
use crate::cache::series::Glossy;
use crate::cache::{CacheSettings, FoundBy};
use crate::eye::{EyeSamples, EyeSettings, Window};
use crate::light_tree::Family;
use crate::lightcut::CutSettings;
use crate::method::lights::Lights;
use crate::method::{Control, Output, counts};
use crate::stats::{Stage, Stats};
use crate::vpl::LightPassSettings;
use crate::world::World;

/// What the user may set.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Eye samples a pixel.
    pub spp: u32,
    /// Another seed, other VPLs and eye samples. Overrides that of `light`.
    pub seed: u32,
    /// Longest path in edges; `None` for the scene's own limit.
    pub max_depth: Option<u32>,
    /// How many VPLs.
    pub light: LightPassSettings,
    /// How many records, and how good.
    pub cache: CacheSettings,
    /// When the cut of an eye sample is good enough.
    pub cut: CutSettings,
    /// How light trees are built.
    pub family: Family,
    /// Whether to return the images of [`super::inspect`] too.
    pub inspect: bool,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            spp: 4,
            seed: 0,
            max_depth: None,
            light: LightPassSettings::default(),
            cache: CacheSettings::default(),
            cut: CutSettings::default(),
            family: Family::default(),
            inspect: false,
        }
    }
}

/// Renders `window` of the scene's film.
pub fn render(world: &World, window: &Window, settings: &Settings, control: &Control) -> Output {
    let mut stats = Stats::new();
    let max_depth = settings.max_depth.or(world.scene.max_depth).unwrap_or(u32::MAX);
    let spp = settings.spp.max(1);

    let eye = EyeSettings { spp, seed: settings.seed, max_depth };
    control.begin(Stage::EyePass, window.tile_count(16) as u64);
    let mut samples = stats.time(Stage::EyePass, || EyeSamples::look(world, window, eye, control));
    let recorded = (0..2).any(|layer| settings.cache.found(layer) == FoundBy::Records);
    let glossy = stats.time(Stage::EyePass, || {
        recorded.then(|| Glossy::find(world, &mut samples, &settings.cache.series)).flatten()
    });

    counts::eye(&mut stats, &samples.chains);

    let light = LightPassSettings { seed: settings.seed, ..settings.light };
    let lights = Lights::new(world, &light, settings.family, max_depth, control, &mut stats);
    let (trees, transfer) = (&lights.trees, lights.transfer());
    let compensation = settings.cache.compensation.then(|| Compensation::new(trees));
    let source = Source { world, trees, transfer, settings: &settings.cache, compensation };

    let cache = Cache::complete(&source, &samples, glossy, control, &mut stats);

    let mut picture = Picture::new(&samples, settings.inspect);
    let jobs = stats.time(Stage::Splat, || cache.resolve(&samples, &mut picture));
    control.begin(Stage::Render, jobs.len() as u64);
    let lit = stats.time(Stage::Render, || own::light(&source, &samples, &jobs, &settings.cut));
    for (job, radiance) in lit.radiance {
        picture.add(&samples, job.sample as usize, job.only, radiance);
    }
    stats.count("Cache/samples with own cuts", jobs.len() as u64);
    counts::cuts(&mut stats, "Lightcut", &lit.cuts);
    lit.shadows.report(&mut stats);
    let complete = samples.complete && !control.is_cancelled();
    let (color, mut extra, nonfinite) = picture.finish();
    if settings.inspect {
        extra.extend(inspect::layers(&samples, &cache.layers, &cache.seams));
    }
    Output { color, variance: None, extra, stats, complete, nonfinite }
}
