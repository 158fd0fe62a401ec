//! Gradients that include occluders' edges against irradiance summed over all virtual lights, around a ball
//! and a table.

use super::cells::Candidate;
use super::compute::{LightcutSource, RecordSource};
use super::record::Record;
use super::{CacheSettings, CellLimits, Footprints};
use crate::eye::{EyePass, EyeSettings};
use crate::lightcut::{CutSettings, Receiver, Transfer, gather_all};
use crate::lights::{DirectIndirect, LightPassSettings, LightTrees, Origin, light_pass};
use crate::shade::ShadingContext;
use base::math::{Frame, luminance};
use base::progress::Control;
use glam::Vec3;
use world::SurfacePoint;
use world::shadow::Engine;
use world::testkit::*;

/// Distance of extrapolation; the room is 2 wide.
const STEP: f32 = 0.06;

/// A room of different walls, seen from above, with a ball and a table on its floor.
fn furnished_room() -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.0, 0.9, 0.01), Vec3::new(0.0, -1.0, 0.0), 1.0), [64, 64]);
    let white = add_material(&mut scene, diffuse(Vec3::splat(0.7)));
    let dark = add_material(&mut scene, diffuse(Vec3::new(0.1, 0.2, 0.1)));
    let mut walls = room(Vec3::splat(-1.0), Vec3::ONE, white);
    walls[0].material = dark;
    scene.meshes.extend(walls);
    let lamp = quad(Vec3::new(0.2, 0.99, -0.3), Vec3::X * 0.6, Vec3::Z * 0.6, white);
    scene.meshes.push(emitting(lamp, Vec3::splat(10.0)));
    scene.meshes.push(sphere(Vec3::new(0.4, -0.7, 0.3), 0.3, 48, dark));
    scene.meshes.push(quad(Vec3::new(-0.7, -0.6, -0.6), Vec3::Z * 0.6, Vec3::X * 0.6, dark));
    world(scene)
}

/// Returns candidates on the open floor: neither under the ball or the table nor within a step of a wall, where light
/// varies by its own distance.
fn open_floor(samples: &EyePass) -> Vec<Candidate> {
    let open = |p: Vec3| {
        let from_ball = (p - Vec3::new(0.4, -1.0, 0.3)).length();
        let table = (p - Vec3::new(-0.4, -1.0, -0.3)).abs();
        p.y < -0.999
            && from_ball > 0.2
            && p.abs().with_y(0.0).max_element() < 0.8
            && (table.max_element() - 0.3).abs() > 0.1
    };
    let floor = (0..samples.len()).filter(|&i| open(samples.points.geometry[i].position));
    let candidate = |i: usize| {
        let point = &samples.points.geometry[i];
        let (position, normal, geometric_normal) = (point.position, point.normal, point.normal);
        Candidate {
            sample: i as u32,
            point: SurfacePoint { position, normal, geometric_normal },
            cell: 256,
            spacing: point.spacing,
            clearance: f32::INFINITY,
            coat: 0,
            edges: u16::MAX,
            bands: 0,
            missing: DirectIndirect { direct: false, indirect: true },
            baseline_luminance: 0.0,
        }
    };
    floor.step_by(4).map(candidate).collect()
}

/// Extrapolates the room's indirect irradiance at points of the floor by `STEP` in four directions. Returns the mean
/// relative error, and the scalar product of estimated and true gradients over the square of the true ones.
fn extrapolate(world: &WorldAndView, footprints: Footprints, probe_rays: u32) -> (f32, f32) {
    let settings = EyeSettings { spp: 1, seed: 0, max_depth: 8 };
    let samples = EyePass::trace(world, &world.view, settings, &Control::new());
    let light = LightPassSettings { indirect: 20_000, ..LightPassSettings::default() };
    let mut pass = light_pass(world, &light, &[], 8, &Control::new());
    pass.sets.retain(|set| set.origin == Origin::Indirect);
    let trees = LightTrees::build(&pass.sets, pass.profiles, world.diagonal, &Control::new());
    let transfer = Transfer::new(&trees, world.diagonal);
    let cut = CutSettings { epsilon: 0.002, max_cut: 20_000, clamp: None, ..CutSettings::default() };
    let settings =
        &CacheSettings { epsilon: cut.epsilon, footprints, probe_rays, ..CacheSettings::default() };
    let context = ShadingContext { world, transfer, compensation: None, samples: None };
    let cells = CellLimits::new(settings);
    let source = LightcutSource { context, settings, cells, cut: &cut, share: true };

    let candidates = open_floor(&samples);
    assert!(candidates.len() > 60, "{}", candidates.len());
    let (found, _) = source.records(&candidates);

    let irradiance = |position: Vec3| {
        let receiver = Receiver::irradiance(position, Vec3::Y, &Frame::from_normal(Vec3::Y));
        luminance(gather_all(&transfer, &Engine::new(world), &receiver))
    };
    let (mut error, mut agreement, mut square, mut count) = (0.0, 0.0, 0.0, 0.0);
    for new in found {
        let Record { position, gradient, .. } = new.record;
        let here = irradiance(position);
        for step in [Vec3::X, Vec3::Z].map(|axis| axis * STEP) {
            let truth = [-step, step].map(|by| irradiance(position + by));
            let slope = luminance(gradient.transpose() * step);
            error += ((truth[0] - (here - slope)).abs() + (truth[1] - (here + slope)).abs()) / here;
            let true_slope = 0.5 * (truth[1] - truth[0]);
            agreement += slope * true_slope;
            square += true_slope * true_slope;
            count += 2.0;
        }
    }
    (error / count, agreement / square)
}

#[test]
fn edges_of_occluders_complete_the_gradient() {
    let world = furnished_room();
    let (held_error, held_agreement) = extrapolate(&world, Footprints::Anisotropic, 128);
    let (error, agreement) = extrapolate(&world, Footprints::Occlusion, 128);
    println!(
        "visibility held: error {held_error}, agreement {held_agreement}; with edges: {error}, {agreement}"
    );
    assert!(error < 0.75 * held_error, "{error} against {held_error}");
    assert!((agreement - 1.0).abs() < 0.3, "{agreement}; with visibility held {held_agreement}");
    let of_rays = [16, 64, 256, 1024].map(|rays| extrapolate(&world, Footprints::Occlusion, rays));
    println!("by 16, 64, 256 and 1024 probe rays: {of_rays:?}");
    assert!(of_rays[3].0 < 0.9 * of_rays[0].0, "{of_rays:?}");
}
