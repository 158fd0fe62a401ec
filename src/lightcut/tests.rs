//! Bounds are never violated, cuts stay within their error, and nothing degenerate breaks them.

use super::*;
use crate::light_tree::{Family, LightTrees, Node};
use crate::material::Materials;
use crate::math::{Frame, Rgb, luminance};
use crate::sampling::{hash, uniform_sphere};
use crate::scene::{Coat, Distribution, Fresnel, Lobe, Material, MaterialId, Reflectance, Scene};
use crate::vpl::{Origin, SpotProfile, Vpl, VplKind, VplSet};
use glam::{Vec2, Vec3};

/// A stream of numbers in [0, 1), not of samples.
pub(super) struct Numbers(pub u32);

impl Numbers {
    pub fn next(&mut self) -> f32 {
        self.0 += 1;
        (hash(self.0, 0x51ed) >> 8) as f32 / (1 << 24) as f32
    }

    pub fn vec3(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }

    pub fn direction(&mut self) -> Vec3 {
        uniform_sphere(Vec2::new(self.next(), self.next()))
    }
}

/// One material of every kind, in a scene of nothing else.
pub(super) fn all_materials() -> Scene {
    let constant = |r: f32, g: f32, b: f32| Reflectance::Constant(Rgb::new(r, g, b));
    let rough = |distribution, alpha, fresnel| Lobe::Rough {
        distribution,
        alpha,
        fresnel,
        scale: constant(0.7, 0.9, 0.5),
    };
    let gold = Fresnel::Conductor { eta: Rgb::new(0.14, 0.37, 1.44), k: Rgb::new(3.98, 2.39, 1.6) };
    let (ggx, beckmann) = (Distribution::Ggx, Distribution::Beckmann);
    let mut materials = Vec::new();
    let mut add = |two_sided, diffuse, coat, lobe| {
        let name = format!("{}", materials.len());
        materials.push(Material { name, two_sided, diffuse, coat, lobe });
    };
    let coat = Some(Coat { eta: 1.5, nonlinear: true });
    let (grey, black) = (constant(0.5, 0.4, 0.8), constant(0.0, 0.0, 0.0));
    add(true, grey, None, Lobe::None);
    add(false, grey, None, Lobe::None);
    for alpha in [0.02, 0.1, 0.3, 0.8] {
        add(true, grey, None, rough(ggx, alpha, Fresnel::One));
        add(false, black, None, rough(ggx, alpha, gold));
        add(true, grey, None, rough(beckmann, alpha, Fresnel::Dielectric(1.5)));
        add(true, grey, coat, rough(ggx, alpha, Fresnel::Dielectric(1.5)));
    }
    let mirror = |fresnel| Lobe::Mirror { fresnel, scale: constant(1.0, 1.0, 1.0) };
    add(true, grey, coat, mirror(Fresnel::Dielectric(1.5)));
    add(true, black, None, mirror(Fresnel::One));
    Scene { materials, ..Scene::default() }
}

/// VPLs in a few groups of very different size, some flat as walls, some with all normals alike.
fn grouped(n: usize, kind: VplKind, scale: f32, numbers: &mut Numbers) -> VplSet {
    let mut set = VplSet::new(kind, Origin::Indirect);
    while set.len() < n {
        let (centre, axis) = (numbers.vec3(), numbers.direction());
        let size = 10f32.powf(-4.0 * numbers.next());
        let spread = numbers.next() * numbers.next() * 2.0;
        let flat = if numbers.next() < 0.5 { Vec3::ONE - Vec3::Y } else { Vec3::ONE };
        for _ in 0..12 {
            let position = (centre + numbers.direction() * size * flat) * scale;
            let direction = (axis + numbers.direction() * spread).try_normalize().unwrap_or(axis);
            let vpl = match kind {
                VplKind::Omni if numbers.next() < 0.5 => Vpl::spot(position, 0),
                VplKind::Omni => Vpl::omni(position),
                VplKind::Oriented => Vpl::oriented(position, direction),
                VplKind::Directional => Vpl::directional(direction),
            };
            set.push(vpl, numbers.vec3() + 0.05);
        }
    }
    set
}

pub(super) const SPOTS: [SpotProfile; 1] =
    [SpotProfile { direction: Vec3::Y, inner_angle: 0.4, outer_angle: 1.0 }];

pub(super) fn three_kinds(n: usize, scale: f32, numbers: &mut Numbers) -> Vec<VplSet> {
    [VplKind::Omni, VplKind::Oriented, VplKind::Directional].map(|k| grouped(n, k, scale, numbers)).into()
}

pub(super) fn random_reflector<'m>(
    materials: &'m Materials,
    scene: &Scene,
    scale: f32,
    n: &mut Numbers,
) -> Reflector<'m> {
    let id = MaterialId((n.next() * scene.materials.len() as f32) as u32);
    let normal = n.direction();
    let geometric = (normal + n.direction() * 0.2).normalize();
    let bsdf = materials.at(scene, id, Vec2::ZERO);
    Reflector::new(n.vec3() * scale, geometric, &Frame::from_normal(normal), bsdf, n.direction())
}

pub(super) fn members(trees: &LightTrees, id: u32, found: &mut Vec<usize>) {
    let node = &trees.nodes[id as usize];
    match node.children() {
        None => found.push(node.representative()),
        Some(left) => (left..left + 2).for_each(|child| members(trees, child, found)),
    }
}

#[test]
fn no_member_contributes_more_than_the_clusters_bound() {
    let scene = all_materials();
    let materials = Materials::new(&scene);
    let mut checked = 0u64;
    for round in 0..60u32 {
        let mut numbers = Numbers(round << 20);
        let scale = [1e-6, 1.0, 1e6][round as usize % 3];
        let family = if round % 2 == 0 { Family::Divisive } else { Family::Agglomerative };
        let diagonal = scale * 2.0;
        let trees =
            LightTrees::build(&three_kinds(60, scale, &mut numbers), SPOTS.to_vec(), diagonal, family);
        let transfer = Transfer::new(&trees, diagonal);
        for _ in 0..25 {
            let mut receiver = random_reflector(&materials, &scene, scale, &mut numbers);
            if numbers.next() < 0.2 {
                // On top of a VPL, or next to it.
                let vpl = trees.vpls[(numbers.next() * trees.vpls.len() as f32) as usize];
                let distance = if numbers.next() < 0.5 { 0.0 } else { 1e-7 * scale };
                receiver = receiver.moved(vpl.position + numbers.direction() * distance);
            }
            for (id, node) in trees.nodes.iter().enumerate() {
                if node.intensity == Rgb::ZERO {
                    continue; // the gaps behind roots
                }
                let bound = transfer.bound(&receiver, node).most;
                assert!(bound.is_finite() && bound.cmpge(Rgb::ZERO).all(), "{bound} of {node:?}");
                let mut found = Vec::new();
                members(&trees, id as u32, &mut found);
                for vpl in found {
                    let actual = transfer.unshadowed(&receiver, &trees.vpls[vpl], node.kind());
                    assert!(
                        actual.cmple(bound * 1.00001).all(),
                        "round {round}: {actual} above {bound}: {receiver:?} {node:?}"
                    );
                    checked += 1;
                }
            }
        }
    }
    assert!(checked > 1_000_000, "{checked}");
}

/// A ball that casts shadows.
pub(super) struct Ball {
    pub centre: Vec3,
    pub radius: f32,
}

impl Visibility for Ball {
    fn visible(&self, x: Vec3, _: Vec3, vpl: &Vpl, node: &Node) -> bool {
        let (direction, t_max) = match node.kind() {
            VplKind::Directional => (vpl.position, f32::INFINITY),
            _ => ((vpl.position - x).normalize_or_zero(), (vpl.position - x).length()),
        };
        let t = (self.centre - x).dot(direction).clamp(0.0, t_max);
        (x + direction * t - self.centre).length() > self.radius
    }
}

/// The inside of a box: VPLs on its six walls, facing inwards.
pub(super) fn room(n: usize, numbers: &mut Numbers) -> VplSet {
    let mut set = VplSet::new(VplKind::Oriented, Origin::Indirect);
    for i in 0..n {
        let axis = i % 3;
        let side = if i / 3 % 2 == 0 { 0.0 } else { 1.0 };
        let mut position = numbers.vec3();
        position[axis] = side;
        let mut normal = Vec3::ZERO;
        normal[axis] = 1.0 - 2.0 * side;
        set.push(Vpl::oriented(position, normal), numbers.vec3() * numbers.next());
    }
    set
}

/// Relative errors of cuts against the full sum, over points in the room and materials of every kind.
fn relative_errors(trees: &LightTrees, settings: &CutSettings, rays: &impl Visibility) -> (Vec<f32>, f64) {
    let scene = all_materials();
    let materials = Materials::new(&scene);
    let transfer = Transfer::new(trees, 3f32.sqrt());
    let mut cut = Lightcut::new();
    let mut errors = Vec::new();
    let mut numbers = Numbers(9);
    while errors.len() < 300 {
        let receiver = random_reflector(&materials, &scene, 1.0, &mut numbers);
        let receiver = receiver.moved(receiver.position() * 0.9 + 0.05);
        let exact = luminance(gather_all(&transfer, rays, &receiver));
        if exact > 0.0 {
            let estimate = luminance(cut.gather(&transfer, rays, &receiver, settings));
            errors.push((estimate - exact) / exact);
        }
    }
    (errors, cut.counts.clusters as f64 / cut.counts.cuts as f64)
}

pub(super) fn rms(errors: &[f32]) -> f32 {
    (errors.iter().map(|e| e * e).sum::<f32>() / errors.len() as f32).sqrt()
}

pub(super) const EXACT: CutSettings =
    CutSettings { epsilon: 0.02, max_cut: usize::MAX, clamp: None, only: None };

#[test]
fn cuts_are_within_their_error_and_shrink_with_epsilon() {
    let set = room(20_000, &mut Numbers(1));
    let ball = Ball { centre: Vec3::splat(0.5), radius: 0.25 };
    for family in [Family::Divisive, Family::Agglomerative] {
        let trees = LightTrees::build(std::slice::from_ref(&set), Vec::new(), 3f32.sqrt(), family);
        let at = |epsilon| {
            let (errors, size) = relative_errors(&trees, &CutSettings { epsilon, ..EXACT }, &ball);
            (rms(&errors), size)
        };
        let (fine, medium, coarse) = (at(0.005), at(0.02), at(0.1));
        println!("{family:?}: {fine:?} {medium:?} {coarse:?}");
        assert!(medium.0 <= 0.035, "{family:?}: relative RMS error {}", medium.0);
        assert!(fine.0 < medium.0 && medium.0 < coarse.0, "{fine:?} {medium:?} {coarse:?}");
        assert!(fine.1 > medium.1 && medium.1 > coarse.1, "{fine:?} {medium:?} {coarse:?}");
    }
}

/// Points a millimetre to a decimetre above the floor of a room of VPLs, some of which are that near.
pub(super) fn points_near_vpls(numbers: &mut Numbers, count: usize) -> Vec<Reflector<'static>> {
    let frame = Frame::from_normal(Vec3::Y);
    let at = |numbers: &mut Numbers| {
        let p = numbers.vec3() * 0.9 + 0.05;
        Reflector::collector(p.with_y(0.1f32.powf(1.0 + 2.0 * p.y)), Vec3::Y, &frame)
    };
    (0..count).map(|_| at(numbers)).collect()
}

/// A room whose floor is covered by lamps, a hand's breadth above it and shining down.
pub(super) fn low_lamps(numbers: &mut Numbers) -> LightTrees {
    let mut set = room(3000, numbers);
    for _ in 0..300 {
        let position = numbers.vec3().with_y(0.05 + 0.05 * numbers.next());
        set.push(Vpl::oriented(position, -Vec3::Y), numbers.vec3());
    }
    LightTrees::build(&[set], Vec::new(), 1.7, Family::Divisive)
}

#[test]
fn no_cluster_gives_more_than_a_quarter_however_coarse_the_cut() {
    let mut numbers = Numbers(8);
    let trees = low_lamps(&mut numbers);
    let transfer = Transfer::new(&trees, 1.7);
    let mut cut = Lightcut::new();
    let mut clusters = 0;
    for receiver in points_near_vpls(&mut numbers, 300) {
        let settings = CutSettings { epsilon: 0.5, ..EXACT };
        let total = luminance(cut.gather(&transfer, &Unoccluded, &receiver, &settings));
        for entry in cut.entries().iter().filter(|e| !trees.nodes[e.node as usize].is_leaf()) {
            let share = luminance(entry.contribution) / total;
            assert!(share <= 1.001 * refine::DOMINANT, "{share} of {total} at {}", receiver.position());
            clusters += 1;
        }
    }
    assert!(clusters > 3000, "a cut so coarse is made of clusters: {clusters}");
}

#[test]
fn with_no_tolerance_the_cut_is_the_full_sum() {
    let mut numbers = Numbers(5);
    let trees =
        LightTrees::build(&three_kinds(300, 1.0, &mut numbers), SPOTS.to_vec(), 2.0, Family::Divisive);
    let (errors, _) = relative_errors(&trees, &CutSettings { epsilon: 0.0, ..EXACT }, &Unoccluded);
    assert!(errors.iter().all(|e| e.abs() < 1e-4), "{errors:?}");
}

#[test]
fn the_cap_is_respected_and_counted() {
    let trees = LightTrees::build(&[room(5000, &mut Numbers(2))], Vec::new(), 1.7, Family::Divisive);
    let settings = CutSettings { epsilon: 0.001, max_cut: 77, clamp: None, only: None };
    let transfer = Transfer::new(&trees, 1.7);
    let receiver = Reflector::collector(Vec3::splat(0.4), Vec3::Y, &Frame::from_normal(Vec3::Y));
    let mut cut = Lightcut::new();
    cut.gather(&transfer, &Unoccluded, &receiver, &settings);
    assert_eq!((cut.entries().len(), cut.counts.capped), (77, 1));
    let roomy = CutSettings { epsilon: 0.5, max_cut: 1000, clamp: None, only: None };
    cut.gather(&transfer, &Unoccluded, &receiver, &roomy);
    assert_eq!(cut.counts.capped, 1, "a cut that converged is not counted as capped");
}

fn irradiance(trees: &LightTrees, diagonal: f32, position: Vec3, settings: &CutSettings) -> Rgb {
    let transfer = Transfer::new(trees, diagonal);
    let receiver = Reflector::collector(position, Vec3::Y, &Frame::from_normal(Vec3::Y));
    Lightcut::new().gather(&transfer, &Unoccluded, &receiver, settings)
}

#[test]
fn nothing_degenerate_breaks_a_cut() {
    let build = |vpls: &[(Vpl, f32)]| {
        let kind = VplKind::Oriented;
        let mut set = VplSet::new(kind, Origin::Indirect);
        vpls.iter().for_each(|&(vpl, i)| set.push(vpl, Rgb::splat(i)));
        LightTrees::build(&[set], Vec::new(), 1.0, Family::Divisive)
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
    let reference = room(3000, &mut Numbers(3));
    let at_scale = |s: f32| {
        let mut set = VplSet::new(VplKind::Oriented, Origin::Indirect);
        for (vpl, &intensity) in reference.vpls.iter().zip(&reference.intensities) {
            set.push(Vpl::oriented(vpl.position * s, vpl.normal()), intensity * s * s);
        }
        let trees = LightTrees::build(&[set], Vec::new(), 1.7 * s, Family::Divisive);
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
    let mut set = room(2000, &mut Numbers(4));
    let x = Vec3::new(0.5, 0.5, 0.5);
    let trees_of =
        |set: &VplSet| LightTrees::build(std::slice::from_ref(set), Vec::new(), 1.7, Family::Divisive);
    let settings = CutSettings { epsilon: 0.002, max_cut: 100_000, clamp: Some(0.02), only: None };
    let without = luminance(irradiance(&trees_of(&set), 1.7, x, &settings));
    set.push(Vpl::oriented(x + Vec3::Y * 1e-3, -Vec3::Y), Rgb::splat(0.1));
    let spike = luminance(irradiance(&trees_of(&set), 1.7, x, &CutSettings { clamp: None, ..settings }));
    assert!(spike > 100.0 * without, "{spike}");
    let clamped = luminance(irradiance(&trees_of(&set), 1.7, x, &settings));
    assert!(clamped > without && clamped < 1.05 * without, "{clamped} {without}");
    let mut light = VplSet::new(VplKind::Omni, Origin::Direct);
    light.push(Vpl::omni(x + Vec3::Y * 1e-3), Rgb::splat(0.1));
    let trees = LightTrees::build(&[set, light], Vec::new(), 1.7, Family::Divisive);
    assert!(luminance(irradiance(&trees, 1.7, x, &settings)) > 0.9e5, "a lamp keeps its light");
}

#[test]
fn few_vpls_share_the_light_and_lose_none_of_it_while_it_is_refined() {
    // Ten equal VPLs: each is far above 2 % of the whole, so each is clamped to 2 % of the frozen sum.
    let mut set = VplSet::new(VplKind::Oriented, Origin::Indirect);
    for i in 0..10 {
        set.push(Vpl::oriented(Vec3::new(0.01 * i as f32, 1.0, 0.0), -Vec3::Y), Rgb::ONE);
    }
    let trees = LightTrees::build(&[set], Vec::new(), 1.0, Family::Divisive);
    let free = irradiance(&trees, 1.0, Vec3::ZERO, &EXACT).x;
    let clamped = irradiance(&trees, 1.0, Vec3::ZERO, &CutSettings { clamp: Some(0.02), ..EXACT }).x;
    assert!((clamped / free - 0.2).abs() < 0.002, "{clamped} {free}");
}

#[test]
fn an_unlit_node_is_no_node() {
    // The gap behind each root is never reached.
    let trees = LightTrees::build(&[room(7, &mut Numbers(6))], Vec::new(), 1.7, Family::Divisive);
    let blank = |n: &&Node| n.intensity == Rgb::ZERO;
    assert_eq!(trees.nodes.iter().filter(blank).count(), 1);
    assert_eq!(trees.leaves().count(), 7);
}
