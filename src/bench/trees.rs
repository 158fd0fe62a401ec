//! Light trees: time to build and size of the cuts through them.

use super::lit_scene::{LitScene, packet};
use super::measure::{Case, Clock, measure};
use super::{Benchmark, Context, Kind, Table};
use base::progress::Control;
use std::hint::black_box;
use transport::lightcut::{CutSettings, Lightcut, Transfer};
use transport::lights::{LightPass, LightPassSettings, LightTrees, light_pass};
use world::shadow::Engine;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "trees",
    about: "Light trees built per second, and the cuts through them",
    kind: Kind::Parts(run),
};

/// Numbers of indirect virtual lights.
const LIGHTS: [u32; 2] = [300_000, 1_000_000];
/// Number of eye samples whose cuts are averaged.
const CUTS: usize = 1024;

fn run(context: &Context) -> Vec<Table> {
    let lit = LitScene::new(context);
    let (world, diagonal) = (lit.world, lit.world.diagonal);
    let mut cases = Vec::new();
    for indirect in LIGHTS {
        (context.say)(&format!("{indirect} indirect lights"));
        let light = LightPassSettings { indirect, ..LightPassSettings::default() };
        let depth = world.scene.path_limit(None);
        let LightPass { sets, profiles, .. } = light_pass(world, &light, &[], depth, &Control::new());
        let sets = std::rc::Rc::new(sets);
        let trees = LightTrees::build(&sets, profiles.clone(), diagonal, &Control::new());
        let cuts = [0.02, 0.01].map(|epsilon| mean_cut(&lit, &trees, epsilon));
        let (sets, spots) = (sets.clone(), profiles.clone());
        let labels = [&*indirect.to_string()];
        let lights = trees.vpls.len() as f64;
        let build = move || {
            black_box(LightTrees::build(&sets, spots.clone(), diagonal, &Control::new()));
        };
        cases.push(Case::new(&labels, cases.len(), lights, build).with(&cuts));
    }
    let table = Table {
        title: "Light trees",
        about: "Virtual lights clustered per second. Cuts of single points, not capped.",
        labels: &["indirect lights"],
        unit: "M lights/s",
        figures: &["mean cut at 2 %", "at 1 %"],
        ..Table::default()
    };
    vec![measure(table, Clock::Process, cases, &context.settings)]
}

/// Computes the mean size of the cuts of eye samples spread over the image.
fn mean_cut(lit: &LitScene, trees: &LightTrees, epsilon: f32) -> f64 {
    let settings = CutSettings { epsilon, max_cut: usize::MAX, ..CutSettings::default() };
    let transfer = Transfer::new(trees, lit.world.diagonal);
    let (mut cut, engine) = (Lightcut::new(), Engine::new(lit.world));
    for sample in (0..lit.samples.len()).step_by(lit.samples.len().div_ceil(CUTS).max(1)) {
        cut.gather(&transfer, &engine, &packet([lit.surface(sample)]), &settings);
    }
    cut.counts.clusters as f64 / cut.counts.cuts.max(1) as f64
}
