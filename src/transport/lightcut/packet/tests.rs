//! A packet's lanes must agree with the light of single points, and cuts with cuts of single points.

use super::*;
use crate::lightcut::fixtures::{
    Ball, EXACT, RandomNumbers, Unoccluded, all_kinds, all_materials, alone, low_lamps, members,
    points_near_vpls, profiles, random_receiver, rms, room,
};
use crate::lightcut::{CutCounts, CutSettings, Receiver, Transfer, gather_all};
use crate::lights::{LightTrees, Vpl, VplKind};
use base::math::{LANES, Rgb, Vec3x16, luminance};
use base::progress::Control;
use glam::{Vec2, Vec3};
use scene::{MaterialId, Scene};
use world::material::Materials;

/// Neighbours on a slightly bent surface.
fn neighbours<'m>(
    materials: &'m Materials,
    scene: &Scene,
    scale: f32,
    count: usize,
    numbers: &mut RandomNumbers,
) -> Vec<Receiver<'m>> {
    let first = random_receiver(materials, scene, scale, numbers);
    let lambert = materials.at(MaterialId(0), Vec2::ZERO);
    // In half of the groups two materials that are not uniform.
    let another = random_receiver(materials, scene, scale, numbers).bsdf().filter(|_| numbers.next() < 0.5);
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
            let frame = base::math::Frame::from_normal(normal);
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
    for round in 0..24u32 {
        let mut numbers = RandomNumbers(round << 20);
        let scale = [1e-6, 1.0, 1e6][round as usize % 3];
        let sets = all_kinds(60, scale, &mut numbers);
        let trees = LightTrees::build(&sets, profiles(), 2.0 * scale, &Control::new());
        let transfer = Transfer::new(&trees, 2.0 * scale);
        for count in [16, 1, 5] {
            points.set(neighbours(&materials, &scene, scale, count, &mut numbers));
            for (id, node) in trees.nodes.iter().enumerate().filter(|(_, n)| n.intensity != Rgb::ZERO) {
                let bounds = transfer.bounds16(&points, node).0.to_array();
                assert!(bounds[count..].iter().all(|b| *b == 0.0), "a lane without a point");
                let mut found = Vec::new();
                members(&trees, id as u32, &mut found);
                for vpl in found {
                    let (lit, responses) = transfer.unshadowed16(&points, &trees.vpls[vpl], node.kind());
                    assert_eq!(u32::from(lit) >> count, 0);
                    for lane in 0..count {
                        let single = transfer.unshadowed(points.get(lane), &trees.vpls[vpl], node.kind());
                        let response = responses.get(lane);
                        let difference = (response - single).abs();
                        // Cosines near 0 lose digits, at most these of the value for a cosine of 1.
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
    let trees = LightTrees::build(&[room(20_000, &mut RandomNumbers(1))], Vec::new(), 1.73, &Control::new());
    let transfer = Transfer::new(&trees, 1.73);
    let (mut cut, mut points) = (Lightcut::new(), ReceiverPacket::new());
    let mut numbers = RandomNumbers(77);
    let mut errors = Vec::new();
    for _ in 0..30 {
        points.set(neighbours(&materials, &scene, 1.0, 16, &mut numbers));
        let radiance = cut.gather(&transfer, &ball, &points, settings).sum.radiance;
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
    let mut numbers = RandomNumbers(8);
    let trees = low_lamps(&mut numbers);
    let transfer = Transfer::new(&trees, 1.7);
    let (mut lightcut, mut points) = (Lightcut::new(), ReceiverPacket::new());
    let settings = CutSettings { epsilon: 0.5, ..EXACT };
    for _ in 0..40 {
        points.set(points_near_vpls(&mut numbers, LANES));
        let cut = lightcut.gather(&transfer, &Unoccluded, &points, &settings);
        let radiance = cut.sum.radiance;
        let brightest = radiance.iter().map(|&r| luminance(r)).fold(0.0, f32::max);
        for cluster in cut.clusters.iter().filter(|c| !trees.nodes[c.node as usize].is_leaf()) {
            let share = |lane: usize| {
                let node = &trees.nodes[cluster.node as usize];
                let given = luminance(node.intensity * cluster.responses.get(lane));
                given / luminance(radiance[lane]).max(brightest / 256.0)
            };
            let cubes: f32 = (0..LANES).map(|lane| share(lane).powi(3)).sum();
            let share = (cubes / LANES as f32).cbrt();
            assert!(share <= 1.001 * crate::lightcut::clamp::DOMINANT, "{share}");
        }
    }
}

#[test]
fn lanes_clamp_as_single_points_do() {
    let scene = all_materials();
    let materials = Materials::new(&scene);
    let mut set = room(2000, &mut RandomNumbers(4));
    let x = Vec3::splat(0.5);
    set.push(Vpl::oriented(x + Vec3::Y * 1e-3, -Vec3::Y), Rgb::splat(0.1));
    // Below the horizon.
    set.push(Vpl::oriented(x - Vec3::Y * 1e-3, -Vec3::Y), Rgb::splat(0.1));
    let trees = LightTrees::build(&[set], Vec::new(), 1.7, &Control::new());
    let transfer = Transfer::new(&trees, 1.7);
    let frame = base::math::Frame::from_normal(Vec3::Y);
    let lambert = materials.at(MaterialId(0), Vec2::ZERO);
    let at = |p| Receiver::new(p, Vec3::Y, &frame, lambert, Vec3::Y);
    let settings = CutSettings { epsilon: 0.002, max_cut: 100_000, clamp: Some(0.02), origin: None };
    let mut points = ReceiverPacket::new();
    points.set([at(x), at(x + Vec3::X * 0.02)]);
    let mut lightcut = Lightcut::new();
    let PacketCut { sum, clusters, .. } = lightcut.gather(&transfer, &Unoccluded, &points, &settings);
    for (lane, radiance) in sum.radiance.iter().enumerate().take(2) {
        let point = alone(*points.get(lane));
        let single = Lightcut::new().gather(&transfer, &Unoccluded, &point, &settings).sum.radiance[0];
        assert!((luminance(*radiance) / luminance(single) - 1.0).abs() < 0.01, "{radiance} {single}");
    }
    // The residue of random corrections may be anything.
    let whole = luminance(sum.radiance[0]);
    for share in (0..200).map(|n| 0.01 * n as f32) {
        let light = PacketLight { clusters, strong: Vec3x16::splat(Rgb::splat(-share * whole)) };
        let PacketSum { radiance, .. } =
            light.sum(&transfer, &points, settings.clamp, &mut CutCounts::default());
        assert!(radiance.iter().all(|r| r.is_finite()), "{share}: {radiance:?}");
    }
    assert!(lightcut.counts.clamped > 0);
}

#[test]
fn the_cap_holds_for_the_packet() {
    let scene = all_materials();
    let materials = Materials::new(&scene);
    let trees = LightTrees::build(&[room(5000, &mut RandomNumbers(2))], Vec::new(), 1.7, &Control::new());
    let mut points = ReceiverPacket::new();
    points.set(neighbours(&materials, &scene, 1.0, 16, &mut RandomNumbers(3)));
    let settings = CutSettings { epsilon: 1e-4, max_cut: 77, clamp: None, origin: None };
    let mut cut = Lightcut::new();
    let size = cut.gather(&Transfer::new(&trees, 1.7), &Unoccluded, &points, &settings).clusters.len();
    assert_eq!((size, cut.counts.capped, cut.counts.cuts), (77, 16, 16));
}
