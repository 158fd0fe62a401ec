//! Tests of groups that are seen at several places against copies of their meshes.

use super::super::*;
use super::devices;
use super::oracle::Random;
use base::math::{Placement, lanes_in};
use glam::{Affine3, Quat, Vec3};

type Mesh = (Vec<Vec3>, Vec<[u32; 3]>);

/// Meshes in coordinates of their own, and their places.
struct Groups {
    own: Vec<Mesh>,
    groups: Vec<(Vec<Mesh>, Vec<Placement>)>,
}

/// Returns a mesh of loose triangles.
fn soup(random: &mut Random, count: u32) -> Mesh {
    let corner = |random: &mut Random, centre: Vec3| centre + 0.4 * random.point();
    let positions = (0..count).flat_map(|_| {
        let centre = random.point();
        [(); 3].map(|()| corner(random, centre))
    });
    (positions.collect(), (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

/// Returns turned, stretched and mirrored places.
fn places(random: &mut Random, count: usize) -> Vec<Placement> {
    let place = |i: usize| {
        let turn = Quat::from_axis_angle(random.point().normalize_or(Vec3::X), 3.0 * random.next());
        let sign = if i.is_multiple_of(3) { -1.0 } else { 1.0 };
        let scale = Vec3::new(0.4, 0.3 + random.next(), 0.7 * sign);
        Placement(Affine3::from_scale_rotation_translation(scale, turn, 3.0 * random.point()))
    };
    (0..count).map(place).collect()
}

impl Groups {
    fn random() -> Groups {
        let mut random = Random::new(7);
        let own = vec![soup(&mut random, 20), (Vec::new(), Vec::new())];
        let first = vec![soup(&mut random, 30), soup(&mut random, 5), soup(&mut random, 11)];
        let second = vec![soup(&mut random, 17)];
        let groups = vec![
            (first, places(&mut random, 9)),
            (vec![(Vec::new(), Vec::new())], places(&mut random, 2)),
            (second, places(&mut random, 4)),
        ];
        Groups { own, groups }
    }

    fn build(&self, device: &Device) -> Accel {
        let own = view(&self.own);
        let members: Vec<Vec<TriangleMesh>> = self.groups.iter().map(|group| view(&group.0)).collect();
        let groups: Vec<PlacedGroup> = members
            .iter()
            .zip(&self.groups)
            .map(|(meshes, group)| PlacedGroup { meshes, placements: &group.1 })
            .collect();
        Accel::build_placed(device, &own, &groups).unwrap()
    }

    /// Returns all meshes at all places, in the order of their numbers.
    fn copies(&self) -> Vec<Mesh> {
        let mut copies = self.own.clone();
        for (meshes, placements) in &self.groups {
            for placement in placements {
                let placed = |(positions, triangles): &Mesh| {
                    (positions.iter().map(|p| placement.point(*p)).collect(), triangles.clone())
                };
                copies.extend(meshes.iter().map(placed));
            }
        }
        copies
    }
}

fn view(meshes: &[Mesh]) -> Vec<TriangleMesh<'_>> {
    meshes.iter().map(triangles).collect()
}

fn triangles((positions, triangles): &Mesh) -> TriangleMesh<'_> {
    TriangleMesh { positions, triangles, occludes: triangles.len() != 5 }
}

#[test]
fn groups_at_their_places_are_met_as_copies_are() {
    let groups = Groups::random();
    let copies = groups.copies();
    let copies: Vec<TriangleMesh> = copies.iter().map(triangles).collect();
    for device in devices() {
        let (placed, copied) = (groups.build(&device), Accel::build(&device, &copies).unwrap());
        let mut random = Random::new(8);
        let (mut different, mut met, mut shadowed) = (0, 0, 0);
        for _ in 0..1000 {
            let mut packet = Rays16::default();
            (0..16).for_each(|lane| {
                let origin = 4.0 * random.point();
                let ray = Ray::new(origin, 3.0 * random.point() - origin);
                packet.set(lane, &Ray { t_far: 2.0 * random.next(), ..ray });
            });
            let (mut hits, mut others) = (Hits16::default(), Hits16::default());
            let found = placed.closest_hit16(&packet, u16::MAX, false, &mut hits);
            let expected = copied.closest_hit16(&packet, u16::MAX, false, &mut others);
            let (mut occluders, mut ids) = (Occluders16::default(), Occluders16::default());
            let dark = placed.occluders16(&packet, u16::MAX, true, &mut occluders);
            different += (found ^ expected).count_ones();
            different += (dark ^ copied.occluders16(&packet, u16::MAX, true, &mut ids)).count_ones();
            shadowed += dark.count_ones();
            for lane in lanes_in(found & expected) {
                met += 1;
                let (a, b) = (hits.get(lane), others.get(lane));
                let single = placed.closest_hit(&packet.get(lane));
                different += u32::from(single.is_none_or(|single| single.geometry != a.geometry));
                match (a.geometry, a.primitive) == (b.geometry, b.primitive) {
                    true => assert!((a.t - b.t).abs() < 1e-4 && (a.u - b.u).abs() < 1e-3, "{a:?} {b:?}"),
                    false => different += 1,
                }
            }
            for lane in lanes_in(dark) {
                let ray = packet.get(lane);
                let occluder = placed.occluder(&ray);
                let occludes = |number: u32| copies[number as usize].occludes;
                assert!(occludes(occluders.geometry[lane]) && occluder.is_none_or(|o| occludes(o.geometry)));
                different += u32::from(occluder.is_none()) + u32::from(!placed.occluded(&ray));
                let mut crossed = 0;
                placed.each_crossed(&ray, |hit| {
                    crossed += u32::from(hit.geometry == occluders.geometry[lane]);
                    true
                });
                different += u32::from(crossed == 0);
            }
        }
        // Rays within rounding of an edge may go either way.
        assert!(different < 8 && met > 1000 && shadowed > 1000, "{different} of {met} and {shadowed}");
        let ([low, high], [l, h]) = (bounds(&placed), bounds(&copied));
        // Boxes around turned boxes are larger.
        assert!(
            (l - low).min_element() > -1e-4
                && (high - h).min_element() > -1e-4
                && (high - low).max_element() < 20.0
        );
    }
}

fn bounds(accel: &Accel) -> [Vec3; 2] {
    let (low, high) = accel.bounds().unwrap();
    [low, high]
}

#[test]
fn damaged_groups_are_refused_and_empty_ones_stay_empty() {
    let device = Device::new(1).unwrap();
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let bad = [TriangleMesh { positions: &positions, triangles: &[[0, 1, 3]], occludes: true }];
    let group = PlacedGroup { meshes: &bad, placements: &[Placement::IDENTITY] };
    let refused = Accel::build_placed(&device, &[], &[group]);
    assert!(matches!(refused, Err(EmbreeError::VertexIndex { index: 3, .. })));
    let good = [TriangleMesh { positions: &positions, triangles: &[[0, 1, 2]], occludes: true }];
    for (meshes, placements) in [(&good[..], &[][..]), (&[], &[Placement::IDENTITY])] {
        let group = PlacedGroup { meshes, placements };
        assert!(Accel::build_placed(&device, &[], &[group]).unwrap().is_empty());
    }
}
