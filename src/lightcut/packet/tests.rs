//! A group's lanes must agree with the single-point functions, which have tests of their own.

use super::receivers::lanes_of;
use super::*;
use crate::light_tree::{Family, LightTrees, Node};
use crate::lightcut::fixtures::{
    Ball, EXACT, Numbers, SPOTS, all_materials, low_lamps, members, points_near_vpls, random_reflector, rms,
    room, three_kinds,
};
use crate::lightcut::{
    CutSettings, Lightcut, Receiver, ReconstructionCut, Transfer, Unoccluded, Visibility, gather_all,
};
use crate::material::Materials;
use crate::math::{Rgb, luminance};
use crate::scene::{MaterialId, Scene};
use crate::vpl::{Vpl, VplKind};
use glam::{Vec2, Vec3};

impl PacketVisibility for Ball {
    fn visible16(&self, points: &ReceiverPacket, lanes: u16, vpl: &Vpl, node: &Node) -> u16 {
        let sees = |&lane: &usize| self.visible(points.get(lane).position(), Vec3::ZERO, vpl, node);
        lanes_of(lanes).filter(sees).fold(0, |mask, lane| mask | 1 << lane)
    }
}

/// Neighbours on a slightly bent surface.
fn neighbours<'m>(
    materials: &'m Materials,
    scene: &Scene,
    scale: f32,
    count: usize,
    numbers: &mut Numbers,
) -> Vec<Receiver<'m>> {
    let first = random_reflector(materials, scene, scale, numbers);
    let lambert = materials.at(scene, MaterialId(0), Vec2::ZERO);
    // In half of the groups two materials that are not alike.
    let another = random_reflector(materials, scene, scale, numbers).bsdf().filter(|_| numbers.next() < 0.5);
    let other = another.map_or(lambert, |(bsdf, _)| bsdf);
    (0..count)
        .map(|i| {
            let normal = (first.place().1 + numbers.direction() * 0.1).normalize();
            let out = (normal + numbers.direction() * 0.5).normalize();
            let bsdf = match (i % 3, first.bsdf()) {
                (0, Some((bsdf, _))) => bsdf,
                (1, _) => other,
                _ => lambert,
            };
            let frame = crate::math::Frame::from_normal(normal);
            let position = first.position() + numbers.direction() * 0.01 * scale;
            Receiver::new(position, normal, &frame, bsdf, out)
        })
        .collect()
}

#[test]
fn lanes_have_the_responses_of_single_points_and_bounds_above_them() {
    let scene = all_materials();
    let materials = Materials::new(&scene);
    let mut points = ReceiverPacket::new();
    for round in 0..60u32 {
        let mut numbers = Numbers(round << 20);
        let scale = [1e-6, 1.0, 1e6][round as usize % 3];
        let sets = three_kinds(60, scale, &mut numbers);
        let trees = LightTrees::build(&sets, SPOTS.to_vec(), 2.0 * scale, Family::Divisive);
        let transfer = Transfer::new(&trees, 2.0 * scale);
        for count in [16, 1, 5] {
            points.set(neighbours(&materials, &scene, scale, count, &mut numbers));
            for (id, node) in trees.nodes.iter().enumerate().filter(|(_, n)| n.intensity != Rgb::ZERO) {
                let (bounds, _) = transfer.bounds16(&points, node);
                assert!(bounds[count..].iter().all(|b| *b == 0.0), "a lane without a point");
                let mut found = Vec::new();
                members(&trees, id as u32, &mut found);
                for vpl in found {
                    let mut responses = [[0.0; LANES]; 3];
                    let lit = transfer.unshadowed16(&points, &trees.vpls[vpl], node.kind(), &mut responses);
                    assert_eq!(u32::from(lit) >> count, 0);
                    for lane in 0..count {
                        let single = transfer.unshadowed(points.get(lane), &trees.vpls[vpl], node.kind());
                        let response = Rgb::from_array(std::array::from_fn(|c| responses[c][lane]));
                        let difference = (response - single).abs();
                        // Cosines near 0 lose digits, at most these of what a cosine of 1 would give.
                        let offset = trees.vpls[vpl].position - points.get(lane).position();
                        let falloff = match node.kind() {
                            VplKind::Directional => 1.0,
                            _ => 1.0 / offset.length_squared().max(transfer.min_dist_sq),
                        };
                        let allowed = single * 1e-4 + 1e-6 * falloff;
                        assert!(difference.cmple(allowed).all(), "{response} {single}");
                        assert_eq!(lit >> lane & 1 != 0, response != Rgb::ZERO);
                        let contribution = luminance(response * node.intensity);
                        assert!(contribution <= bounds[lane] * 1.00002, "{contribution} {}", bounds[lane]);
                    }
                }
            }
        }
    }
}

fn errors(settings: &CutSettings) -> Vec<f32> {
    let scene = all_materials();
    let materials = Materials::new(&scene);
    let ball = Ball { centre: Vec3::splat(0.5), radius: 0.25 };
    let trees = LightTrees::build(&[room(20_000, &mut Numbers(1))], Vec::new(), 1.73, Family::Divisive);
    let transfer = Transfer::new(&trees, 1.73);
    let (mut cut, mut points) = (PacketLightcut::new(), ReceiverPacket::new());
    let mut numbers = Numbers(77);
    let mut errors = Vec::new();
    for _ in 0..30 {
        points.set(neighbours(&materials, &scene, 1.0, 16, &mut numbers));
        let mut radiance = [Rgb::ZERO; LANES];
        cut.gather(&transfer, &ball, &points, settings, &mut radiance);
        for (lane, radiance) in radiance.iter().enumerate() {
            let exact = luminance(gather_all(&transfer, &ball, points.get(lane)));
            if exact > 0.0 {
                errors.push(luminance(*radiance) / exact - 1.0);
            }
        }
    }
    errors
}

#[test]
fn shared_cuts_are_within_the_error_of_single_ones() {
    let (fine, medium) = (errors(&CutSettings { epsilon: 0.005, ..EXACT }), errors(&EXACT));
    assert!(medium.len() > 200);
    assert!(rms(&medium) <= 0.035, "{}", rms(&medium));
    assert!(rms(&fine) < rms(&medium), "{} {}", rms(&fine), rms(&medium));
}

#[test]
fn no_cluster_gives_the_lanes_more_than_a_quarter_however_coarse_the_cut() {
    let mut numbers = Numbers(8);
    let trees = low_lamps(&mut numbers);
    let transfer = Transfer::new(&trees, 1.7);
    let (mut cut, mut points) = (PacketLightcut::new(), ReceiverPacket::new());
    let settings = CutSettings { epsilon: 0.5, ..EXACT };
    for _ in 0..40 {
        points.set(points_near_vpls(&mut numbers, LANES));
        let mut radiance = [Rgb::ZERO; LANES];
        cut.gather(&transfer, &Unoccluded, &points, &settings, &mut radiance);
        let brightest = radiance.iter().map(|&r| luminance(r)).fold(0.0, f32::max);
        for (node, responses) in cut.entries().filter(|e| !trees.nodes[e.0 as usize].is_leaf()) {
            let share = |lane: usize| {
                let response = Rgb::from_array(std::array::from_fn(|c| responses[c][lane]));
                let given = luminance(trees.nodes[node as usize].intensity * response);
                given / luminance(radiance[lane]).max(brightest / 256.0)
            };
            let cubes: f32 = (0..LANES).map(|lane| share(lane).powi(3)).sum();
            let share = (cubes / LANES as f32).cbrt();
            assert!(share <= 1.001 * crate::lightcut::single::DOMINANT, "{share}");
        }
    }
}

#[test]
fn one_lane_clamps_as_a_single_point_does() {
    let scene = all_materials();
    let materials = Materials::new(&scene);
    let mut set = room(2000, &mut Numbers(4));
    let x = Vec3::splat(0.5);
    set.push(Vpl::oriented(x + Vec3::Y * 1e-3, -Vec3::Y), Rgb::splat(0.1));
    // Below the horizon.
    set.push(Vpl::oriented(x - Vec3::Y * 1e-3, -Vec3::Y), Rgb::splat(0.1));
    let trees = LightTrees::build(&[set], Vec::new(), 1.7, Family::Divisive);
    let transfer = Transfer::new(&trees, 1.7);
    let frame = crate::math::Frame::from_normal(Vec3::Y);
    let lambert = materials.at(&scene, MaterialId(0), Vec2::ZERO);
    let at = |p| Receiver::new(p, Vec3::Y, &frame, lambert, Vec3::Y);
    let settings = CutSettings { epsilon: 0.002, max_cut: 100_000, clamp: Some(0.02), origin: None };
    let mut points = ReceiverPacket::new();
    points.set([at(x), at(x + Vec3::X * 0.02)]);
    let mut radiance = [Rgb::ZERO; LANES];
    let mut cut = PacketLightcut::new();
    cut.gather(&transfer, &Unoccluded, &points, &settings, &mut radiance);
    assert!(cut.counts.clamped > 0);
    for (lane, radiance) in radiance.iter().enumerate().take(2) {
        let single = Lightcut::new().gather(&transfer, &Unoccluded, points.get(lane), &settings);
        assert!((luminance(*radiance) / luminance(single) - 1.0).abs() < 0.01, "{radiance} {single}");
    }
    // What random corrections leave besides the leaves may be anything.
    let whole = luminance(radiance[0]);
    for share in (0..200).map(|n| 0.01 * n as f32) {
        let strong = [[-share * whole; LANES]; 3];
        cut.sum(&trees, &points, settings.clamp, &strong, &mut radiance);
        assert!(radiance.iter().all(|r| r.is_finite()), "{share}: {radiance:?}");
    }
}

#[test]
fn the_cap_holds_for_the_group() {
    let scene = all_materials();
    let materials = Materials::new(&scene);
    let trees = LightTrees::build(&[room(5000, &mut Numbers(2))], Vec::new(), 1.7, Family::Divisive);
    let mut points = ReceiverPacket::new();
    points.set(neighbours(&materials, &scene, 1.0, 16, &mut Numbers(3)));
    let settings = CutSettings { epsilon: 1e-4, max_cut: 77, clamp: None, origin: None };
    let mut cut = PacketLightcut::new();
    let mut radiance = [Rgb::ZERO; LANES];
    cut.gather(&Transfer::new(&trees, 1.7), &Unoccluded, &points, &settings, &mut radiance);
    assert_eq!((cut.size(), cut.counts.capped, cut.counts.cuts), (77, 16, 16));
}

#[test]
fn a_lent_cut_gives_points_nearly_what_cuts_of_their_own_would() {
    let mut numbers = Numbers(77);
    let ball = Ball { centre: Vec3::new(0.5, 0.5, 0.6), radius: 0.15 };
    let trees = LightTrees::build(&[room(3000, &mut numbers)], Vec::new(), 1.7, Family::Divisive);
    let transfer = Transfer::new(&trees, 1.7);
    let frame = crate::math::Frame::from_normal(Vec3::Z);
    let at = |i: usize| Vec3::new(0.3 + 0.02 * (i % 8) as f32, 0.4 + 0.02 * (i / 8) as f32, 0.01);
    let reflectors: Vec<Receiver> = (0..32).map(|i| Receiver::irradiance(at(i), Vec3::Z, &frame)).collect();
    let (mut group, mut points, mut lent) =
        (PacketLightcut::new(), ReceiverPacket::new(), ReconstructionCut::default());
    let (mut own, mut again) = ([Rgb::ZERO; LANES], [Rgb::ZERO; LANES]);
    points.set(reflectors.iter().step_by(2).copied());
    group.gather(&transfer, &ball, &points, &EXACT, &mut own);
    lent.keep(&group, &transfer, &points, &own, &EXACT);
    let rays = group.counts.rays;
    group.gather_lent(&lent, &transfer, &ball, &points, 0.5, &mut again);
    assert!(group.counts.rays - rays < rays / 2, "most clusters are agreed upon");
    for (own, again) in own.iter().zip(again) {
        assert!((*own - again).abs().max_element() < 0.04 * own.max_element(), "{own} {again}");
    }
    // The points in between, against cuts of their own.
    points.set(reflectors.iter().skip(1).step_by(2).copied());
    group.gather_lent(&lent, &transfer, &ball, &points, 0.5, &mut again);
    group.gather(&transfer, &ball, &points, &EXACT, &mut own);
    for (own, again) in own.iter().zip(again) {
        assert!((*own - again).abs().max_element() < 0.04 * own.max_element(), "{own} {again}");
    }
}

#[test]
fn what_a_lent_cut_leaves_to_chance_is_right_on_average() {
    // Half in the shadow of a ball: the makers disagree about many small clusters.
    let mut numbers = Numbers(78);
    let ball = Ball { centre: Vec3::new(0.5, 0.5, 0.25), radius: 0.15 };
    let trees = LightTrees::build(&[room(3000, &mut numbers)], Vec::new(), 1.7, Family::Divisive);
    let transfer = Transfer::new(&trees, 1.7);
    let frame = crate::math::Frame::from_normal(Vec3::Z);
    let at = |i: usize| Vec3::new(0.3 + 0.02 * (i % 8) as f32, 0.4 + 0.02 * (i / 8) as f32, 0.01);
    let reflectors: Vec<Receiver> = (0..64).map(|i| Receiver::irradiance(at(i), Vec3::Z, &frame)).collect();
    let (mut group, mut points, mut lent) =
        (PacketLightcut::new(), ReceiverPacket::new(), ReconstructionCut::default());
    let mut radiance = [Rgb::ZERO; LANES];
    points.set(reflectors.iter().skip(1).step_by(4).copied());
    group.gather(&transfer, &ball, &points, &EXACT, &mut radiance);
    lent.keep(&group, &transfer, &points, &radiance, &EXACT);
    let nodes: Vec<u32> = group.entries().map(|(node, _)| node).collect();
    points.set(reflectors.iter().skip(3).step_by(4).copied());
    // The same clusters, each with a shadow ray.
    let exact: Vec<f32> = (0..LANES)
        .map(|lane| {
            let given = |&node: &u32| {
                let n = &trees.nodes[node as usize];
                let vpl = &trees.vpls[n.representative()];
                let x = points.get(lane).position();
                let seen = ball.visible(x, Vec3::ZERO, vpl, n);
                let response = transfer.unshadowed(points.get(lane), vpl, n.kind());
                if seen { luminance(n.intensity * response) } else { 0.0 }
            };
            nodes.iter().map(given).sum()
        })
        .collect();
    let starts = 256;
    let (mut means, mut squares) = ([0.0f32; LANES], 0.0);
    let rays = group.counts.rays;
    for start in 0..starts {
        let start = (start as f32 + 0.5) / starts as f32;
        group.gather_lent(&lent, &transfer, &ball, &points, start, &mut radiance);
        for lane in 0..LANES {
            let error = luminance(radiance[lane]) / exact[lane] - 1.0;
            means[lane] += error / starts as f32;
            squares += error * error / (starts * LANES) as f32;
        }
    }
    let per_cut = (group.counts.rays - rays) / starts as u64;
    assert!(per_cut < (nodes.len() * LANES / 4) as u64, "{per_cut} rays for {} clusters", nodes.len());
    // What chance leaves of a patch half in shadow is a few times ε; on average, a tenth of it.
    assert!(squares.sqrt() < 0.06 && squares.sqrt() > 0.001, "{}", squares.sqrt());
    // Odd lanes lie beyond the last makers, at the mercy of what no maker sees.
    let among: Vec<f32> = means.into_iter().step_by(2).collect();
    assert!(rms(&among) < 0.003, "{means:?}");
}
