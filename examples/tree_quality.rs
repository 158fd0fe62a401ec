//! Measures light trees: build time and mean cut of both families on a scene.
//!
//! `cargo run --release --example tree_quality -- SCENE [VPLS ...]`
//!
//! Cuts are computed one by one for eye samples on a coarse grid over the film, without a cap on their size.

use glam::Vec2;
use lightsplat::eye::{ChainCounts, Window, primary_ray, trace};
use lightsplat::light_tree::{Family, LightTrees};
use lightsplat::lightcut::{CutSettings, Lightcut, Reflector, Transfer};
use lightsplat::method::Control;
use lightsplat::sampling::Sampler;
use lightsplat::scene::formats::{LoadOptions, load};
use lightsplat::stats::Stopwatch;
use lightsplat::vpl::{LightPassSettings, light_pass};
use lightsplat::world::World;
use std::path::Path;

/// Eye samples along the longer edge of the film.
const GRID: u32 = 64;

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or_else(|| anyhow::anyhow!("which scene?"))?;
    let mut counts: Vec<u32> = arguments.map(|a| a.parse()).collect::<Result<_, _>>()?;
    if counts.is_empty() {
        counts = vec![500_000, 1_000_000];
    }
    let world = World::new(load(Path::new(&path), &LoadOptions::default())?.scene, 0)?;
    println!("VPLs      pass s  family          tree s  cut 2 %  cut 1 %  rays/s 2 %");
    for indirect in counts {
        let settings = LightPassSettings { indirect, ..LightPassSettings::default() };
        let watch = Stopwatch::start();
        let lights = light_pass(&world, &settings, u32::MAX, &Control::new());
        let pass = watch.elapsed().cpu_seconds;
        for family in [Family::Divisive, Family::Agglomerative] {
            let watch = Stopwatch::start();
            let trees = LightTrees::build(&lights.sets, lights.spots.clone(), world.diagonal, family);
            let tree = watch.elapsed().cpu_seconds;
            let (two, rate) = mean_cut(&world, &trees, 0.02);
            let (one, _) = mean_cut(&world, &trees, 0.01);
            let name = format!("{family:?}");
            println!(
                "{:<9} {pass:6.2}  {name:<15} {tree:6.2}  {two:7.0}  {one:7.0}  {:.2} M",
                lights.len(),
                rate * 1e-6
            );
        }
    }
    Ok(())
}

/// Mean size of the cuts of eye samples spread over the film, and the shadow rays per CPU second.
fn mean_cut(world: &World, trees: &LightTrees, epsilon: f32) -> (f64, f64) {
    let window = Window::whole(world.scene.resolution);
    let settings = CutSettings { epsilon, max_cut: usize::MAX, ..CutSettings::default() };
    let transfer = Transfer::new(&trees.spots, world.diagonal);
    let step = window.width.max(window.height).div_ceil(GRID) as usize;
    let mut cut = Lightcut::new();
    let watch = Stopwatch::start();
    for y in (0..window.height).step_by(step) {
        for x in (0..window.width).step_by(step) {
            let ray = primary_ray(&world.scene.camera, &window, [x, y], Vec2::splat(0.5));
            let mut sampler = Sampler::new(0, 0);
            trace(world, ray, u32::MAX, &mut sampler, &mut ChainCounts::default(), |eye| {
                let s = &eye.surface;
                let receiver = Reflector::new(s.position, s.normal, &s.frame, eye.bsdf, eye.out);
                cut.gather(trees, &transfer, world, &receiver, &settings);
            });
        }
    }
    let seconds = watch.elapsed().cpu_seconds;
    (cut.counts.clusters as f64 / cut.counts.cuts.max(1) as f64, cut.counts.rays as f64 / seconds)
}
