//! Samples of cuts against all virtual lights.

use super::*;
use crate::lightcut::fixtures::{
    Ball, RandomNumbers, all_kinds, all_materials, profiles, random_receiver, room,
};
use crate::lightcut::{Receiver, gather_all};
use crate::lights::LightTrees;
use base::math::Frame;
use base::progress::Control;
use glam::Vec3;
use world::material::Materials;

const SETTINGS: CutSettings = CutSettings { epsilon: 0.02, max_cut: usize::MAX, clamp: None, origin: None };
const FEW: Samples = Samples { whole: 20.0, least: 4.0 };
const BALL: Ball = Ball { centre: Vec3::splat(0.5), radius: 0.2 };

/// Mean radiance of each lane over so many seeds, and the variance of that mean's luminance.
fn mean(transfer: &Transfer, points: &ReceiverPacket, settings: &CutSettings, seeds: u32) -> Vec<(Rgb, f32)> {
    let mut cut = SampledCut::default();
    let mut sums = vec![(Rgb::ZERO, 0.0, 0.0); points.len()];
    for seed in 0..seeds {
        let found = cut
            .gather(transfer, &BALL, points, &SampledSettings { cut: settings, samples: &FEW, seed })
            .expect("few samples");
        for ((sum, y, squares), radiance) in sums.iter_mut().zip(found.radiance) {
            *sum += radiance;
            *y += luminance(radiance);
            *squares += luminance(radiance).powi(2);
        }
    }
    let n = seeds as f32;
    let of = |(sum, y, squares): (Rgb, f32, f32)| (sum / n, (squares / n - (y / n).powi(2)).max(0.0) / n);
    sums.into_iter().map(of).collect()
}

#[test]
fn samples_have_the_mean_of_all_virtual_lights() {
    let scene = all_materials();
    let materials = Materials::new(&scene);
    let mut points = ReceiverPacket::new();
    let (mut squares, mut count) = (0.0, 0);
    for round in 0..8u32 {
        let mut numbers = RandomNumbers(round << 20);
        let trees = LightTrees::build(&all_kinds(60, 1.0, &mut numbers), profiles(), 2.0, &Control::new());
        let transfer = Transfer::new(&trees, 2.0);
        let receivers: Vec<Receiver> =
            (0..16).map(|_| random_receiver(&materials, &scene, 1.0, &mut numbers)).collect();
        points.set(receivers.iter().map(|receiver| receiver.with_baseline(numbers.next())));
        for (lane, (mean, variance)) in mean(&transfer, &points, &SETTINGS, 1000).into_iter().enumerate() {
            let exact = gather_all(&transfer, &BALL, &receivers[lane]);
            let error = luminance(mean) - luminance(exact);
            let tolerated = 1e-4 * luminance(exact);
            assert!(
                error.abs() <= 6.0 * variance.sqrt() + tolerated,
                "{round} {lane}: {mean} for {exact} +- {}",
                variance.sqrt()
            );
            squares += error * error / (variance + tolerated * tolerated).max(f32::MIN_POSITIVE);
            count += 1;
        }
    }
    let deviation = (squares / count as f32).sqrt();
    assert!(deviation < 1.3, "{deviation} standard errors");
}

#[test]
fn single_lights_give_no_more_than_their_share() {
    let mut numbers = RandomNumbers(3);
    let trees = LightTrees::build(&[room(3000, &mut numbers)], Vec::new(), 1.7, &Control::new());
    let transfer = Transfer::new(&trees, 1.7);
    // Each point is close to one of the lights, and looks past it into the room.
    let close = |i: usize| {
        let light = &trees.vpls[180 * i + 90];
        let wall = Frame::from_normal(light.normal());
        let normal = (wall.tangent - 0.3 * wall.normal).normalize();
        Receiver::irradiance(light.position + 0.01 * wall.normal, Vec3::ZERO, &Frame::from_normal(normal))
    };
    let mut points = ReceiverPacket::new();
    points.set((0..16).map(close));
    let clamped = CutSettings { clamp: Some(0.02), ..SETTINGS };
    let mut cuts = Lightcut::new();
    let expected = cuts.gather(&transfer, &BALL, &points, &CutSettings { epsilon: 0.002, ..clamped }).sum;
    let all = |lane: usize| luminance(gather_all(&transfer, &BALL, points.get(lane)));
    let kept = |lane: usize| luminance(expected.radiance[lane]) / all(lane);
    assert!((0..16).all(|lane| kept(lane) < 0.5), "nothing to clamp");
    for (lane, (mean, variance)) in mean(&transfer, &points, &clamped, 500).into_iter().enumerate() {
        let (mean, expected) = (luminance(mean), luminance(expected.radiance[lane]));
        // Lights of nodes above leaves give a little more.
        let tolerated = 0.03 * all(lane) + 4.0 * variance.sqrt();
        assert!((mean - expected).abs() < tolerated, "{lane}: {mean} for {expected} +- {tolerated}");
    }
}

#[test]
fn light_too_faint_to_divide_among_samples_is_none() {
    let mut numbers = RandomNumbers(5);
    let mut set = room(500, &mut numbers);
    set.intensities.iter_mut().for_each(|intensity| *intensity *= 1e-46);
    let trees = LightTrees::build(&[set], Vec::new(), 1.7, &Control::new());
    let transfer = Transfer::new(&trees, 1.7);
    let receiver = Receiver::irradiance(Vec3::new(0.3, 0.4, 0.2), Vec3::Y, &Frame::from_normal(Vec3::Y));
    let mut points = ReceiverPacket::new();
    points.set([receiver]);
    let samples = Samples { whole: 100.0, least: 4.0 };
    let settings = SampledSettings { cut: &SETTINGS, samples: &samples, seed: 1 };
    let sum = SampledCut::default().gather(&transfer, &BALL, &points, &settings).expect("few");
    assert!(luminance(sum.radiance[0]) < 1e-40, "{}", sum.radiance[0]);
}

#[test]
fn a_sample_stands_for_all_light_of_its_cluster() {
    // A right child that has all but the last bits of the light, below one that has half of it.
    let mut numbers = RandomNumbers(9);
    let mut set = room(4, &mut numbers);
    for (intensity, y) in set.intensities.iter_mut().zip([1.0, 1e-30, 1.0, 1e-30]) {
        *intensity = Rgb::splat(y);
    }
    let trees = LightTrees::build(&[set], Vec::new(), 1.7, &Control::new());
    for u in [0.0, 0.25, 0.499_999_97, 0.5, 0.75, 0.999_999_94] {
        let mut sample = Descent { node: trees.roots[0], u, of_cluster: 1.0, density: 1.0, lane: 0 };
        (0..LEVELS).for_each(|_| sample.descend(&trees.nodes));
        let node = &trees.nodes[sample.node as usize];
        let of_all = luminance(node.intensity) / sample.density;
        assert!(node.is_leaf() && (of_all - 2.0).abs() < 1e-3, "{u}: {of_all}");
    }
}

#[test]
fn samples_are_as_many_as_the_light_is_worth() {
    let mut numbers = RandomNumbers(5);
    let trees = LightTrees::build(&[room(500, &mut numbers)], Vec::new(), 1.7, &Control::new());
    let transfer = Transfer::new(&trees, 1.7);
    let receiver = Receiver::irradiance(Vec3::new(0.3, 0.4, 0.2), Vec3::Y, &Frame::from_normal(Vec3::Y));
    let total = luminance(gather_all(&transfer, &BALL, &receiver));
    let mut cut = SampledCut::default();
    let mut points = ReceiverPacket::new();
    let mut number = |baseline: f32, whole: f32| {
        points.set([receiver.with_baseline(baseline)]);
        let samples = Samples { whole, least: 4.0 };
        cut.counts = CutCounts::default();
        let settings = SampledSettings { cut: &SETTINGS, samples: &samples, seed: 1 };
        cut.gather(&transfer, &BALL, &points, &settings).map(|_| cut.counts.clusters)
    };
    assert_eq!(number(0.0, 20.0), Some(20));
    let shared = number(total, 100.0).expect("few");
    assert!((40..90).contains(&shared), "{shared}");
    assert!((4..=6).contains(&number(1000.0 * total, 100.0).expect("few")));
    // Where a cut takes less time.
    assert_eq!((number(0.0, 200.0), number(0.0, f32::INFINITY), number(0.0, f32::NAN)), (None, None, None));
    assert!(number(10.0 * total, 200.0).is_some());
}

/// Blocks light from all but a share of the directions.
struct Screen(f32);

impl Visibility for Screen {
    fn visible16(&self, rays: &Rays16, lanes: u16, _: Option<u32>) -> u16 {
        let is_free = |&lane: &usize| {
            let direction = rays.get(lane).direction;
            direction.z.atan2(direction.x).abs() <= self.0 * std::f32::consts::PI
        };
        lanes_in(lanes).filter(is_free).fold(0, |mask, lane| mask | 1 << lane)
    }
}

#[test]
fn points_that_see_less_of_the_light_take_more_samples() {
    let mut numbers = RandomNumbers(7);
    let trees = LightTrees::build(&[room(2000, &mut numbers)], Vec::new(), 1.7, &Control::new());
    let transfer = Transfer::new(&trees, 1.7);
    let frame = Frame::from_normal(Vec3::Y);
    let mut points = ReceiverPacket::new();
    let at = |i: usize| Vec3::new(0.4 + 0.01 * i as f32, 0.3, 0.5);
    points.set((0..16).map(|i| Receiver::irradiance(at(i), Vec3::Y, &frame)));
    let samples = Samples { whole: 40.0, least: 4.0 };
    let number = |visible: f32| {
        let mut cut = SampledCut::default();
        let settings = SampledSettings { cut: &SETTINGS, samples: &samples, seed: 1 };
        cut.gather(&transfer, &Screen(visible), &points, &settings).expect("few samples");
        cut.counts.clusters as f32 / 16.0
    };
    let found = [0.1, 0.5, 0.9].map(number);
    // √((1 - v) / v) times the number wanted, but for the distribution of the light.
    for (found, expected) in found.into_iter().zip([120.0, 40.0, 20.0]) {
        assert!((0.75 * expected..1.4 * expected).contains(&found), "{found} for {expected}");
    }
}
