//! Light trees: time to build and size of the cuts through them, for both families of builders.

use super::measure::Case;
use super::setting::Setting;
use super::{Benchmark, Clock, Context, Kind, Table};
use base::progress::Control;
use std::hint::black_box;
use transport::lightcut::{CutSettings, Lightcut, Transfer};
use transport::lights::{Family, LightPass, LightPassSettings, LightTrees, light_pass};

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "trees",
    about: "Light trees built a second, and the cuts through them",
    kind: Kind::Parts { needs_scene: true, run },
};

/// Indirect virtual lights.
const LIGHTS: [u32; 2] = [300_000, 1_000_000];
/// Number of eye samples whose cuts are averaged.
const CUTS: usize = 1024;

fn run(context: &Context) -> Vec<Table> {
    let Some(setting) = Setting::new(context) else { return Vec::new() };
    let (world, diagonal) = (setting.world, setting.world.diagonal);
    let mut cases = Vec::new();
    for indirect in LIGHTS {
        (context.say)(&format!("{indirect} indirect lights"));
        let light = LightPassSettings { indirect, ..LightPassSettings::default() };
        let depth = world.scene.path_limit(None);
        let LightPass { sets, profiles, .. } = light_pass(world, &light, &[], depth, &Control::new());
        let sets = std::rc::Rc::new(sets);
        let against = cases.len();
        for family in [Family::Divisive, Family::Agglomerative] {
            let trees = LightTrees::build(&sets, profiles.clone(), diagonal, family, &Control::new());
            let cuts = [0.02, 0.01].map(|epsilon| Some(mean_cut(&setting, &trees, epsilon)));
            let (sets, spots) = (sets.clone(), profiles.clone());
            let labels = [&indirect.to_string(), &*format!("{family:?}").to_lowercase()];
            let lights = trees.vpls.len() as f64;
            let mut case = Case::new(&labels, against, lights, move || {
                black_box(LightTrees::build(&sets, spots.clone(), diagonal, family, &Control::new()));
            });
            case.figures = cuts.to_vec();
            cases.push(case);
        }
    }
    vec![Table::measured(
        (
            "Light trees",
            "Virtual lights clustered a second. Ratio to the divisive family. Cuts of single points, not capped.",
        ),
        (&["indirect lights", "family"], "M lights/s", &["mean cut at 2 %", "at 1 %"]),
        (Clock::Process, &context.settings, 1e-6),
        cases,
    )]
}

/// Computes the mean size of the cuts of eye samples spread over the picture.
fn mean_cut(setting: &Setting, trees: &LightTrees, epsilon: f32) -> f64 {
    let settings = CutSettings { epsilon, max_cut: usize::MAX, ..CutSettings::default() };
    let transfer = Transfer::new(trees, setting.world.diagonal);
    let mut cut = Lightcut::new();
    for sample in (0..setting.samples.len()).step_by(setting.samples.len().div_ceil(CUTS).max(1)) {
        cut.gather(&transfer, setting.world, &setting.reflector(sample), &settings);
    }
    cut.counts.clusters as f64 / cut.counts.cuts.max(1) as f64
}
