//! Cuts of single points: bounds are never violated, cuts stay within their error, and nothing degenerate breaks them.

use super::*;
use crate::lightcut::fixtures::*;
use crate::lightcut::{CutSettings, Receiver, Transfer, Visibility, clamp, gather_all};
use crate::lights::{LightNode, LightTrees, Origin, Vpl, VplKind, VplSet};
use base::math::{Frame, Rgb, luminance};
use base::progress::Control;
use glam::Vec3;
use world::material::Materials;

#[test]
fn no_member_contributes_more_than_the_clusters_bound() {
    let scene = all_materials();
    let materials = Materials::new(&scene);
    let mut checked = 0u64;
    for round in 0..24u32 {
        let mut numbers = RandomNumbers(round << 20);
        let scale = [1e-6, 1.0, 1e6][round as usize % 3];
        let diagonal = scale * 2.0;
        let trees =
            LightTrees::build(&all_kinds(60, scale, &mut numbers), profiles(), diagonal, &Control::new());
        let transfer = Transfer::new(&trees, diagonal);
        let mut points = ReceiverPacket::new();
        for _ in 0..2 {
            let receivers: Vec<Receiver> = (0..13)
                .map(|_| {
                    let receiver = random_receiver(&materials, &scene, scale, &mut numbers);
                    if numbers.next() < 0.8 {
                        return receiver;
                    }
                    // On top of a VPL, or next to it.
                    let vpl = trees.vpls[(numbers.next() * trees.vpls.len() as f32) as usize];
                    let distance = if numbers.next() < 0.5 { 0.0 } else { 1e-7 * scale };
                    receiver.moved(vpl.position + numbers.direction() * distance)
                })
                .collect();
            points.set(receivers);
            // Nodes without light are the gaps behind roots.
            for (id, node) in trees.nodes.iter().enumerate().filter(|(_, n)| n.intensity != Rgb::ZERO) {
                let bounds = transfer.bounds16(&points, node).0.to_array();
                let mut found = Vec::new();
                members(&trees, id as u32, &mut found);
                for (vpl, lane) in found.into_iter().flat_map(|vpl| (0..13).map(move |lane| (vpl, lane))) {
                    let (bound, receiver) = (bounds[lane], points.get(lane));
                    let response = transfer.unshadowed(receiver, &trees.vpls[vpl], node.kind());
                    let actual = luminance(response * node.intensity);
                    assert!(
                        bound.is_finite() && actual <= bound * 1.00001,
                        "round {round}: {actual} above {bound}: {receiver:?} {node:?}"
                    );
                    checked += 1;
                }
            }
        }
    }
    assert!(checked > 1_000_000, "{checked}");
}

/// Relative errors of cuts against the full sum, over points in the room and materials of every kind.
fn relative_errors(trees: &LightTrees, settings: &CutSettings, rays: &impl Visibility) -> (Vec<f32>, f64) {
    let scene = all_materials();
    let materials = Materials::new(&scene);
    let transfer = Transfer::new(trees, 3f32.sqrt());
    let mut cut = Lightcut::new();
    let mut errors = Vec::new();
    let mut numbers = RandomNumbers(9);
    while errors.len() < 300 {
        let receiver = random_receiver(&materials, &scene, 1.0, &mut numbers);
        let receiver = receiver.moved(receiver.position() * 0.9 + 0.05);
        let exact = luminance(gather_all(&transfer, rays, &receiver));
        if exact > 0.0 {
            let estimate = luminance(cut.gather(&transfer, rays, &alone(receiver), settings).sum.radiance[0]);
            errors.push((estimate - exact) / exact);
        }
    }
    (errors, cut.counts.clusters as f64 / cut.counts.cuts as f64)
}

#[test]
fn cuts_are_within_their_error_and_shrink_with_epsilon() {
    let set = room(20_000, &mut RandomNumbers(1));
    let ball = Ball { centre: Vec3::splat(0.5), radius: 0.25 };
    let trees = LightTrees::build(std::slice::from_ref(&set), Vec::new(), 3f32.sqrt(), &Control::new());
    let at = |epsilon| {
        let (errors, size) = relative_errors(&trees, &CutSettings { epsilon, ..EXACT }, &ball);
        (rms(&errors), size)
    };
    let (fine, medium, coarse) = (at(0.005), at(0.02), at(0.1));
    println!("{fine:?} {medium:?} {coarse:?}");
    assert!(medium.0 <= 0.035, "relative RMS error {}", medium.0);
    assert!(fine.0 < medium.0 && medium.0 < coarse.0, "{fine:?} {medium:?} {coarse:?}");
    assert!(fine.1 > medium.1 && medium.1 > coarse.1, "{fine:?} {medium:?} {coarse:?}");
}

#[test]
fn no_cluster_gives_more_than_a_quarter_however_coarse_the_cut() {
    let mut numbers = RandomNumbers(8);
    let trees = low_lamps(&mut numbers);
    let transfer = Transfer::new(&trees, 1.7);
    let mut lightcut = Lightcut::new();
    let mut clusters = 0;
    for receiver in points_near_vpls(&mut numbers, 300) {
        let settings = CutSettings { epsilon: 0.5, ..EXACT };
        let cut = lightcut.gather(&transfer, &Unoccluded, &alone(receiver), &settings);
        let total = luminance(cut.sum.radiance[0]);
        for cluster in cut.clusters.iter().filter(|c| !trees.nodes[c.node as usize].is_leaf()) {
            let node = &trees.nodes[cluster.node as usize];
            let share = luminance(node.intensity * cluster.responses.get(0)) / total;
            assert!(share <= 1.001 * clamp::DOMINANT, "{share} of {total} at {}", receiver.position());
            clusters += 1;
        }
    }
    assert!(clusters > 3000, "a cut so coarse is made of clusters: {clusters}");
}

#[test]
fn with_no_tolerance_the_cut_is_the_full_sum() {
    let mut numbers = RandomNumbers(5);
    let trees = LightTrees::build(&all_kinds(300, 1.0, &mut numbers), profiles(), 2.0, &Control::new());
    let (errors, _) = relative_errors(&trees, &CutSettings { epsilon: 0.0, ..EXACT }, &Unoccluded);
    assert!(errors.iter().all(|e| e.abs() < 1e-4), "{errors:?}");
}

#[test]
fn the_cap_is_respected_and_counted() {
    let trees = LightTrees::build(&[room(5000, &mut RandomNumbers(2))], Vec::new(), 1.7, &Control::new());
    let settings = CutSettings { epsilon: 0.001, max_cut: 77, clamp: None, origin: None };
    let transfer = Transfer::new(&trees, 1.7);
    let point = alone(Receiver::irradiance(Vec3::splat(0.4), Vec3::Y, &Frame::from_normal(Vec3::Y)));
    let mut cut = Lightcut::new();
    assert_eq!(cut.gather(&transfer, &Unoccluded, &point, &settings).clusters.len(), 77);
    assert_eq!(cut.counts.capped, 1);
    let roomy = CutSettings { epsilon: 0.5, max_cut: 1000, clamp: None, origin: None };
    cut.gather(&transfer, &Unoccluded, &point, &roomy);
    assert_eq!(cut.counts.capped, 1, "a cut that converged is not counted as capped");
}

fn irradiance(trees: &LightTrees, diagonal: f32, position: Vec3, settings: &CutSettings) -> Rgb {
    let transfer = Transfer::new(trees, diagonal);
    let receiver = Receiver::irradiance(position, Vec3::Y, &Frame::from_normal(Vec3::Y));
    Lightcut::new().gather(&transfer, &Unoccluded, &alone(receiver), settings).sum.radiance[0]
}

#[test]
fn nothing_degenerate_breaks_a_cut() {
    let build = |vpls: &[(Vpl, f32)]| {
        let kind = VplKind::Oriented;
        let mut set = VplSet::new(kind, Origin::Indirect);
        vpls.iter().for_each(|&(vpl, i)| set.push(vpl, Rgb::splat(i)));
        LightTrees::build(&[set], Vec::new(), 1.0, &Control::new())
    };
    let down = |p: Vec3| Vpl::oriented(p, -Vec3::Y);
    let settings = CutSettings { epsilon: 0.0, ..EXACT };
    assert_eq!(irradiance(&build(&[]), 1.0, Vec3::ZERO, &settings), Rgb::ZERO, "no VPL");
    let one = irradiance(&build(&[(down(Vec3::Y), 3.0)]), 1.0, Vec3::ZERO, &settings);
    assert!((one.x - 3.0).abs() < 1e-4, "one VPL a metre above: {one}");
    assert_eq!(irradiance(&build(&[(down(Vec3::ZERO), 3.0)]), 1.0, Vec3::ZERO, &settings), Rgb::ZERO);
    let near = irradiance(&build(&[(down(Vec3::Y * 1e-7), 3.0)]), 1.0, Vec3::ZERO, &settings);
    assert!(near.is_finite() && near.x > 0.0, "1e-7 away: {near}");
    let behind = irradiance(&build(&[(down(-Vec3::Y), 3.0)]), 1.0, Vec3::ZERO, &settings);
    assert_eq!(behind, Rgb::ZERO, "behind the receiver, total 0");
    let coincident = irradiance(&build(&[(down(Vec3::Y), 1e-3); 5000]), 1.0, Vec3::ZERO, &EXACT);
    assert!((coincident.x - 5.0).abs() < 1e-3, "coincident: {coincident}");
    let mixed: Vec<(Vpl, f32)> = (0..2000)
        .map(|i| (down(Vec3::new(i as f32 / 2000.0, 1.0, 0.0)), if i == 1234 { 1e10 } else { 1e-10 }))
        .collect();
    let bright = irradiance(&build(&mixed), 1.0, Vec3::ZERO, &EXACT);
    let x: f32 = 1234.0 / 2000.0;
    let expected = 1e10 / (1.0 + x * x).powi(2);
    assert!((bright.x / expected - 1.0).abs() < 1e-4, "1e10 beside 1e-10: {bright} {expected}");
}

#[test]
fn the_same_room_at_any_scale_gives_the_same_cut() {
    // Lengths times s, intensities times s²: the same irradiance.
    let reference = room(3000, &mut RandomNumbers(3));
    let at_scale = |s: f32| {
        let mut set = VplSet::new(VplKind::Oriented, Origin::Indirect);
        for (vpl, &intensity) in reference.vpls.iter().zip(&reference.intensities) {
            set.push(Vpl::oriented(vpl.position * s, vpl.normal()), intensity * s * s);
        }
        let trees = LightTrees::build(&[set], Vec::new(), 1.7 * s, &Control::new());
        irradiance(&trees, 1.7 * s, Vec3::new(0.3, 0.2, 0.6) * s, &EXACT)
    };
    let unit = at_scale(1.0);
    for s in [1e-6, 1e-3, 1e3, 1e6] {
        let scaled = at_scale(s);
        assert!(((scaled - unit) / unit).abs().max_element() < 0.02, "scale {s}: {scaled} {unit}");
    }
    // Powers of two change nothing at all.
    assert_eq!(at_scale(1024.0), unit);
}

#[test]
fn a_weak_singularity_is_clamped_once_and_lights_are_not() {
    let mut set = room(2000, &mut RandomNumbers(4));
    let x = Vec3::new(0.5, 0.5, 0.5);
    let trees_of =
        |set: &VplSet| LightTrees::build(std::slice::from_ref(set), Vec::new(), 1.7, &Control::new());
    let settings = CutSettings { epsilon: 0.002, max_cut: 100_000, clamp: Some(0.02), origin: None };
    let without = luminance(irradiance(&trees_of(&set), 1.7, x, &settings));
    set.push(Vpl::oriented(x + Vec3::Y * 1e-3, -Vec3::Y), Rgb::splat(0.1));
    let spike = luminance(irradiance(&trees_of(&set), 1.7, x, &CutSettings { clamp: None, ..settings }));
    assert!(spike > 100.0 * without, "{spike}");
    let clamped = luminance(irradiance(&trees_of(&set), 1.7, x, &settings));
    assert!(clamped > without && clamped < 1.05 * without, "{clamped} {without}");
    let mut light = VplSet::new(VplKind::Omni, Origin::Direct);
    light.push(Vpl::omni(x + Vec3::Y * 1e-3), Rgb::splat(0.1));
    let trees = LightTrees::build(&[set, light], Vec::new(), 1.7, &Control::new());
    assert!(luminance(irradiance(&trees, 1.7, x, &settings)) > 0.9e5, "a lamp keeps its light");
}

#[test]
fn few_vpls_share_the_light_and_lose_none_of_it_while_it_is_refined() {
    // Ten equal VPLs: each is far above 2 % of the whole, so each is clamped to 2 % of the frozen sum.
    let mut set = VplSet::new(VplKind::Oriented, Origin::Indirect);
    for i in 0..10 {
        set.push(Vpl::oriented(Vec3::new(0.01 * i as f32, 1.0, 0.0), -Vec3::Y), Rgb::ONE);
    }
    let trees = LightTrees::build(&[set], Vec::new(), 1.0, &Control::new());
    let free = irradiance(&trees, 1.0, Vec3::ZERO, &EXACT).x;
    let clamped = irradiance(&trees, 1.0, Vec3::ZERO, &CutSettings { clamp: Some(0.02), ..EXACT }).x;
    assert!((clamped / free - 0.2).abs() < 0.002, "{clamped} {free}");
}

#[test]
fn an_unlit_node_is_no_node() {
    // The gap behind each root is never reached.
    let trees = LightTrees::build(&[room(7, &mut RandomNumbers(6))], Vec::new(), 1.7, &Control::new());
    let blank = |n: &&LightNode| n.intensity == Rgb::ZERO;
    assert_eq!(trees.nodes.iter().filter(blank).count(), 1);
    assert_eq!(trees.leaves().count(), 7);
}
