//! Walk-throughs: frames by the records of those before them against the same frames alone.

use crate::kit::*;
use crate::oracle::{against, count as counted, on_threads};
use crate::presets::{noiseless_records, per_pixel, with_vpls};
use glam::Vec3;
use lightsplat::film::metrics::{Variances, compare};
use lightsplat::method::{Method, path, vpl};
use lightsplat::progress::Control;
use lightsplat::session::{Goal, RenderedFrame};
use lightsplat::view::View;
use lightsplat::walk::{RetentionLimits, Walk};

const FRAMES: usize = 8;

/// A room with a lamp and a ball, and views of it as the camera comes nearer and turns.
fn room() -> (SceneAndView, Vec<View>) {
    let seen = |i: usize| {
        let t = i as f32 / FRAMES as f32;
        camera(Vec3::new(-0.3 + 0.4 * t, 0.1, 0.95 - 0.5 * t), Vec3::new(0.3 * t, -0.3, -0.4), 0.9)
    };
    let (mut scene, wall) = lit_room(seen(0), 64);
    scene.meshes.push(sphere(Vec3::new(0.3, -0.6, -0.2), 0.4, 32, wall));
    let views = (0..FRAMES).map(|i| View { camera: seen(i), ..scene.view }).collect();
    (scene, views)
}

/// Settings whose images have no noise, so that they can be compared with lightcuts per pixel.
fn settings() -> vpl::Settings {
    noiseless_records(20_000)
}

/// Value of a counter, which must be there.
#[track_caller]
fn count(frame: &RenderedFrame, name: &str) -> u64 {
    counted(&frame.stats, name).unwrap_or_else(|| panic!("{name} is not counted"))
}

fn goal() -> Goal {
    Goal { method: Method::Vpl(settings()), ..Goal::default() }
}

/// [`goal`] with half the least radius. Walks double it, and in so small an image it decides how many records there
/// are.
fn goal_of_walk() -> Goal {
    let mut settings = settings();
    settings.cache.reach[1][0] *= 0.5;
    Goal { method: Method::Vpl(settings), ..Goal::default() }
}

/// Errors of the last frame of a walk, and alone, with a seed of the lights.
fn errors_of_the_last_frame(seed: u32) -> [f32; 2] {
    let (scene, views) = room();
    let (walked, _) = session(scene.clone());
    let (alone, _) = session(scene.clone());
    let seeded = |goal: Goal| match goal.method {
        Method::Vpl(settings) => Goal { method: Method::Vpl(vpl::Settings { seed, ..settings }), ..goal },
        _ => goal,
    };
    let mut walk = Walk::new(&walked, seeded(goal_of_walk()), RetentionLimits::default());
    let mut new = 0;
    let mut last = None;
    for (i, view) in views.iter().enumerate() {
        let frame = walk.frame(view, &Control::new()).unwrap();
        assert!(frame.complete);
        // The lights stay, too.
        assert_eq!(frame.stats.get("VPLs/total").is_some(), i == 0);
        if i > 0 {
            new += count(&frame, "Walk/new records");
        }
        last = Some(frame);
    }
    let (frame, view) = (last.unwrap(), views[FRAMES - 1]);
    let same = alone.frame(&view, &seeded(goal()), &Control::new()).unwrap();
    // Views differ little, so that each alone has about as many records as the last.
    let all = (FRAMES as u64 - 1) * count(&same, "Cache/records, indirect");
    assert!(new * 4 < all, "{new} new records in the walk, {all} alone");
    let like = vpl::Settings { seed, ..settings() };
    let reference = image(&world(SceneAndView { view, ..scene }), &per_pixel(&like));
    let (mean, error) = against(&frame.film.color, &reference);
    let (mean_alone, error_alone) = against(&same.film.color, &reference);
    assert!((mean - mean_alone).abs() < 0.005, "means {mean} and alone {mean_alone}");
    [error, error_alone]
}

/// The ratio of the errors of single seeds is between 0.9 and 1.2.
#[test]
fn frames_of_a_walk_are_as_right_as_alone_with_few_new_records() {
    let (mut error, mut error_alone) = (0.0, 0.0);
    for seed in 0..8 {
        let [walked, alone] = errors_of_the_last_frame(seed);
        error += walked;
        error_alone += alone;
    }
    // A decibel.
    assert!(error < 1.12 * error_alone, "error {error}, alone {error_alone}");
}

#[test]
fn frames_of_a_walk_do_not_depend_on_threads() {
    let (scene, views) = room();
    let by_threads = |threads| {
        on_threads(threads, || {
            let (session, _) = session(scene.clone());
            let mut walk = Walk::new(
                &session,
                goal(),
                RetentionLimits { idle_frames: 1, bytes: 100_000, ..RetentionLimits::default() },
            );
            let frames = views[..3].iter().map(|view| walk.frame(view, &Control::new()).unwrap().film.color);
            frames.collect::<Vec<_>>()
        })
    };
    assert!(by_threads(1) == by_threads(3));
}

#[test]
fn a_view_seen_twice_has_no_new_records_and_the_same_light() {
    let (scene, views) = room();
    let (session, _) = session(scene);
    // The first frame has no thresholds but Weber's.
    let limits = RetentionLimits { q_scale: None, ..RetentionLimits::default() };
    let mut walk = Walk::new(&session, goal(), limits);
    let mut frame = || walk.frame(&views[2], &Control::new()).unwrap();
    let first = frame();
    // The second may adapt footprints that the first has left.
    let second = frame();
    assert!(count(&second, "Walk/new records") * 20 < count(&first, "Walk/new records"));
    let (mean, difference) = against(&second.film.color, &first.film.color);
    assert!((mean - 1.0).abs() < 1e-3 && difference < 0.01, "{mean} {difference}");
    // A memory limit holds between frames.
    let kept = count(&second, "Walk/bytes kept");
    let mut small =
        Walk::new(&session, goal(), RetentionLimits { bytes: kept / 3, ..RetentionLimits::default() });
    for view in &views[..3] {
        let frame = small.frame(view, &Control::new()).unwrap();
        assert!(count(&frame, "Walk/bytes kept") <= kept / 3);
        assert!(count(&frame, "Walk/records evicted for memory") > 0);
    }
}

/// Settings whose direct light is sampled per pixel.
fn sampled() -> Goal {
    let mut settings = with_vpls(20_000);
    settings.cache.least_cell = 8;
    Goal { method: Method::Vpl(settings), ..Goal::default() }
}

#[test]
fn drawn_light_is_carried_from_frame_to_frame() {
    let (scene, views) = room();
    let views: Vec<View> = views.iter().map(|view| View::whole(view.camera, [64, 64])).collect();
    let (session, _) = session(scene.clone());
    let mut last = Vec::new();
    for reprojects in [false, true] {
        let limits = RetentionLimits { reprojects, ..RetentionLimits::default() };
        let mut walk = Walk::new(&session, sampled(), limits);
        last.extend(views.iter().map(|view| walk.frame(view, &Control::new()).unwrap()).last());
    }
    if lacks_denoiser(&last[0]) {
        return;
    }
    let [rays, fewer] = [0, 1].map(|i| count(&last[i], "Eye/shadow rays"));
    assert!(fewer * 3 < rays * 2, "{fewer} shadow rays, {rays} by all samples");
    let method = Method::Path(path::Settings { spp: 512, ..Default::default() });
    let reference = frame(&session, &views[FRAMES - 1], method, false).film.color;
    let error = |frame: &RenderedFrame| {
        compare(&frame.film.color, &reference, Variances::default()).unwrap().rel_mse_trimmed.sqrt()
    };
    // A decibel.
    let [all, few] = [0, 1].map(|i| error(&last[i]));
    assert!(few < 1.12 * all, "error {few}, by all samples {all}");
    let (mean, _) = against(&last[1].film.color, &last[0].film.color);
    assert!((mean - 1.0).abs() < 0.005, "mean {mean}");
}

#[test]
fn a_walk_restored_goes_on_with_the_same_bits_on_any_number_of_threads() {
    let (scene, views) = room();
    let by_threads = |threads: usize, save: bool, q_scale: Option<f32>| {
        on_threads(threads, || {
            let (session, _) = session(scene.clone());
            let limits = RetentionLimits { q_scale, ..RetentionLimits::default() };
            let mut walk = Walk::new(&session, sampled(), limits);
            for view in &views[..2] {
                walk.frame(view, &Control::new()).unwrap();
            }
            if save {
                let saved = walk.save();
                walk = Walk::restored(&session, sampled(), limits, &saved).unwrap();
                for length in [0, 7, 8, saved.len() / 2, saved.len() - 1] {
                    let part = &saved[..length];
                    assert!(Walk::restored(&session, sampled(), limits, part).is_none());
                }
            }
            walk.frame(&views[2], &Control::new()).unwrap().film.color
        })
    };
    for q_scale in [None, Some(4.0)] {
        let whole = by_threads(1, false, q_scale);
        assert!(by_threads(2, true, q_scale) == whole);
        assert!(by_threads(3, false, q_scale) == whole);
    }
}

#[test]
fn contrasts_of_the_frame_before_spare_records() {
    let (scene, views) = room();
    let (session, _) = session(scene);
    let made = |q_scale| {
        let limits = RetentionLimits { q_scale, ..RetentionLimits::default() };
        let mut walk = Walk::new(&session, goal_of_walk(), limits);
        let frames = views.iter().map(|view| walk.frame(view, &Control::new()).unwrap());
        let frames: Vec<[u64; 2]> = frames
            .map(|frame| ["Walk/new records", "Cache/samples at seams"].map(|name| count(&frame, name)))
            .collect();
        frames
    };
    let [weber, fine, coarse] = [None, Some(0.01), Some(1000.0)].map(made);
    assert_eq!(weber[0], coarse[0]);
    let later = |made: &[[u64; 2]], i: usize| made[1..].iter().map(|frame| frame[i]).sum::<u64>();
    assert!(
        later(&coarse, 1) < later(&weber, 1) && later(&weber, 1) < later(&fine, 1),
        "{weber:?} {fine:?} {coarse:?}"
    );
    assert!(later(&coarse, 0) < later(&fine, 0), "{weber:?} {fine:?} {coarse:?}");
}
