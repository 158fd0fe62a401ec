//! Trees must be valid over any VPLs, however degenerate.

use super::*;
use crate::lightcut::fixtures::profiles;
use crate::lights::{Origin, VplKind};
use base::math::Rgb;
use base::progress::Control;
use glam::{DVec3, Vec3};
use std::time::Duration;

/// A small generator of test data (not of samples).
struct Lcg(u64);

impl Lcg {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 24) as f32
    }

    fn vec3(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }

    fn direction(&mut self) -> Vec3 {
        (self.vec3() * 2.0 - 1.0).try_normalize().unwrap_or(Vec3::X)
    }
}

fn random_set(n: usize, kind: VplKind) -> VplSet {
    let mut rng = Lcg(n as u64 + 17);
    let mut set = VplSet::new(kind, Origin::Indirect);
    for _ in 0..n {
        let vpl = match kind {
            VplKind::Omni => Vpl::omni(rng.vec3()),
            VplKind::Oriented => Vpl::oriented(rng.vec3(), rng.direction()),
            VplKind::Directional => Vpl::directional(rng.direction()),
            VplKind::Lobed => Vpl::lobed(rng.vec3(), (rng.next() * 36.0) as u32),
        };
        set.push(vpl, rng.vec3() + 0.01);
    }
    set
}

fn build(set: &VplSet) -> LightTrees {
    LightTrees::build(std::slice::from_ref(set), profiles(), 3f32.sqrt(), &Control::new())
}

/// Checks all properties that lightcuts rely on.
fn assert_valid(trees: &LightTrees, sets: &[VplSet]) {
    let total: usize = sets.iter().map(VplSet::len).sum();
    assert_eq!(trees.vpls.len(), total);
    let mut seen = vec![0; total];
    let mut visited = 0;
    let mut stack = trees.roots.clone();
    while let Some(id) = stack.pop() {
        visited += 1;
        let node = &trees.nodes[id as usize];
        assert!(node.cos_beta >= -1.0 && node.cos_beta <= 1.0 && node.sin_beta() >= 0.0);
        assert!((node.axis.length() - 1.0).abs() < 1e-5);
        let Some(left) = node.children() else {
            seen[node.representative()] += 1;
            let vpl = &trees.vpls[node.representative()];
            assert_eq!((node.min, node.max), (vpl.position, vpl.position));
            if let VplKind::Oriented | VplKind::Lobed = node.kind() {
                assert!(axis(trees, node).dot(node.axis) >= node.cos_beta);
            }
            continue;
        };
        let children = [left, left + 1].map(|c| &trees.nodes[c as usize]);
        for child in children {
            assert!(child.min.cmpge(node.min).all() && child.max.cmple(node.max).all(), "box of {id}");
            assert_eq!((child.kind(), child.origin()), (node.kind(), node.origin()));
        }
        assert!(
            children.iter().any(|c| c.representative() == node.representative()),
            "representative of {id}"
        );
        let sum = children.iter().fold(DVec3::ZERO, |s, c| s + c.intensity.as_dvec3());
        let error = (node.intensity.as_dvec3() - sum).abs();
        assert!((error / sum).max_element() < 3e-6, "intensity of {id}: {} {sum}", node.intensity);
        stack.extend([left, left + 1]);
    }
    assert!(seen.iter().all(|&k| k == 1), "every VPL is exactly one leaf");
    assert_eq!(visited, sets.iter().map(|s| (2 * s.len()).saturating_sub(1)).sum::<usize>());
}

/// Normal, or axis of the lobe, of the VPL of a leaf.
fn axis(trees: &LightTrees, leaf: &LightNode) -> Vec3 {
    let vpl = &trees.vpls[leaf.representative()];
    match leaf.kind() {
        VplKind::Lobed => trees.profiles.lobes[vpl.lobe()].axis(),
        _ => vpl.normal(),
    }
}

/// Checks that every member's normal lies in the cone of every cluster above it, and that no lobe is wider than it
/// says.
fn assert_cones_hold_members(trees: &LightTrees) {
    fn members(trees: &LightTrees, id: u32) -> Vec<Vec3> {
        let node = &trees.nodes[id as usize];
        let normals = match node.children() {
            None => vec![axis(trees, node)],
            Some(left) => [members(trees, left), members(trees, left + 1)].concat(),
        };
        for n in &normals {
            assert!(n.dot(node.axis) >= node.cos_beta, "{n} outside {:?}", node);
        }
        if let (VplKind::Lobed, Some(left)) = (node.kind(), node.children()) {
            let width = |child: u32| trees.nodes[child as usize].width_sq();
            assert_eq!(node.width_sq(), width(left).max(width(left + 1)));
        }
        normals
    }
    for &root in &trees.roots {
        members(trees, root);
    }
}

#[test]
fn trees_are_left_out_if_building_is_cancelled() {
    let control = Control::new();
    control.cancel();
    let sets = [random_set(5000, VplKind::Oriented)];
    let trees = LightTrees::build(&sets, Vec::new(), 3f32.sqrt(), &control);
    assert!(trees.roots.is_empty() && trees.nodes.is_empty() && trees.vpls.is_empty());
}

#[test]
fn trees_that_are_there_when_building_is_cancelled_are_whole() {
    let sets = [random_set(20_000, VplKind::Oriented), random_set(20_000, VplKind::Omni)];
    let mut left_out = 0;
    for delay in (0..30).map(|step| Duration::from_micros(700 * step)) {
        let control = Control::new();
        let trees = std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(delay);
                control.cancel();
            });
            LightTrees::build(&sets, Vec::new(), 3f32.sqrt(), &control)
        });
        assert_valid(&trees, &sets[..trees.roots.len()]);
        left_out += sets.len() - trees.roots.len();
    }
    assert!(left_out > 0);
}

#[test]
fn trees_of_every_kind_and_size_are_valid() {
    for kind in [VplKind::Omni, VplKind::Oriented, VplKind::Directional, VplKind::Lobed] {
        for n in [0, 1, 2, 3, 5, 16, 17, 100, 1000] {
            let set = random_set(n, kind);
            let trees = build(&set);
            assert_valid(&trees, std::slice::from_ref(&set));
            if let VplKind::Oriented | VplKind::Lobed = kind {
                assert_cones_hold_members(&trees);
            }
        }
    }
}

#[test]
fn several_sets_share_one_array_and_keep_their_origin() {
    let mut sets = vec![random_set(50, VplKind::Omni), random_set(70, VplKind::Oriented)];
    sets[0].origin = Origin::Direct;
    sets.push(VplSet::new(VplKind::Directional, Origin::Direct));
    let trees = LightTrees::build(&sets, Vec::new(), 1.0, &Control::new());
    assert_valid(&trees, &sets);
    assert_eq!(trees.roots.len(), 2, "no tree over nothing");
    let origins: Vec<_> = trees.roots.iter().map(|&r| trees.nodes[r as usize].origin()).collect();
    assert_eq!(origins, [Origin::Direct, Origin::Indirect]);
}

#[test]
fn vpls_keep_their_numbers_of_edges() {
    let mut sets = [random_set(50, VplKind::Omni), VplSet::new(VplKind::Omni, Origin::Indirect)];
    sets[0].origin = Origin::Direct;
    for edges in 1..200u8 {
        sets[1].push_behind(edges, Vpl::omni(Vec3::X * f32::from(edges.reverse_bits())), Rgb::ONE);
        sets[1].push_behind(edges, Vpl::omni(Vec3::X), Rgb::ZERO);
    }
    let trees = LightTrees::build(&sets, Vec::new(), 1.0, &Control::new());
    for leaf in trees.leaves() {
        let (vpl, edges) = trees.representative(leaf);
        let expected = match leaf.origin() {
            Origin::Direct => 0,
            Origin::Indirect => (vpl.position.x as u8).reverse_bits(),
        };
        assert_eq!(edges, expected);
    }
}

#[test]
fn degenerate_vpls_build_valid_shallow_trees() {
    let coincident = {
        let mut set = VplSet::new(VplKind::Oriented, Origin::Indirect);
        (0..5000).for_each(|_| set.push(Vpl::oriented(Vec3::ONE, Vec3::Y), Rgb::ONE));
        set
    };
    let antiparallel = {
        let mut set = VplSet::new(VplKind::Oriented, Origin::Indirect);
        for i in 0..5000 {
            set.push(Vpl::oriented(Vec3::ONE, if i % 2 == 0 { Vec3::Z } else { -Vec3::Z }), Rgb::ONE);
        }
        set
    };
    let geometric = {
        let mut set = VplSet::new(VplKind::Omni, Origin::Direct);
        for i in 0..2000 {
            let x = i as f32 / 2000.0;
            set.push(Vpl::omni(Vec3::X * x), Rgb::splat(10f32.powf(20.0 * x - 10.0)));
        }
        set
    };
    let far_apart = {
        let mut set = VplSet::new(VplKind::Omni, Origin::Direct);
        (0..3000).for_each(|i| set.push(Vpl::omni(Vec3::X * 2f32.powf(i as f32 * 0.02 - 40.0)), Rgb::ONE));
        set
    };
    for set in [&coincident, &antiparallel, &geometric, &far_apart] {
        let trees = build(set);
        assert_valid(&trees, std::slice::from_ref(set));
        assert!(depth(&trees) < 400, "depth {}", depth(&trees));
    }
}

fn depth(trees: &LightTrees) -> usize {
    let mut deepest = 0;
    let mut stack: Vec<(u32, usize)> = trees.roots.iter().map(|&r| (r, 1)).collect();
    while let Some((id, depth)) = stack.pop() {
        deepest = deepest.max(depth);
        if let Some(left) = trees.nodes[id as usize].children() {
            stack.extend([(left, depth + 1), (left + 1, depth + 1)]);
        }
    }
    deepest
}

#[test]
fn trees_are_the_same_for_any_number_of_threads() {
    let set = random_set(100_000, VplKind::Oriented);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| build(&set))
    };
    let one = with(1);
    assert_valid(&one, std::slice::from_ref(&set));
    for threads in [2, 4] {
        let other = with(threads);
        assert!(one.nodes == other.nodes && one.vpls == other.vpls, "{threads} threads");
    }
}

#[test]
fn representatives_are_drawn_in_proportion_to_intensity() {
    // Over many trees of two VPLs, the one with three times the intensity is the representative of three in
    // four.
    let mut bright = 0;
    let sets: Vec<VplSet> = (0..4000)
        .map(|_| {
            let mut set = VplSet::new(VplKind::Omni, Origin::Direct);
            set.push(Vpl::omni(Vec3::X), Rgb::ONE);
            set.push(Vpl::omni(Vec3::Y), Rgb::splat(3.0));
            set
        })
        .collect();
    let trees = LightTrees::build(&sets, Vec::new(), 1.0, &Control::new());
    for &root in &trees.roots {
        bright += usize::from(trees.vpls[trees.nodes[root as usize].representative()].position == Vec3::Y);
    }
    // Standard deviation 27: five of them.
    assert!((2865..=3135).contains(&bright), "{bright} of 4000");
}

#[test]
fn a_million_vpls_build() {
    let set = random_set(1_000_000, VplKind::Oriented);
    let trees = build(&set);
    assert_eq!(trees.leaves().count(), 1_000_000);
    assert!(depth(&trees) < 200, "{}", depth(&trees));
}

/// `cargo test --release --lib light_tree -- --ignored --nocapture`
#[test]
#[ignore = "a study: a measurement"]
fn measure_build_time() {
    for n in [500_000, 1_000_000] {
        let set = random_set(n, VplKind::Oriented);
        let start = std::time::Instant::now();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let trees = pool.install(|| build(&set));
        println!("{n}: {:.2} s, depth {}", start.elapsed().as_secs_f64(), depth(&trees));
    }
}
