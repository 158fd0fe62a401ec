//! Tests of empty scenes, unusable rays, refused meshes, and Embree's own errors.

use super::super::*;
use super::devices;
use embree4_sys as sys;
use glam::Vec3;
use std::hint::black_box;

const TRIANGLE: [Vec3; 3] = [Vec3::new(-9.0, -9.0, 1.0), Vec3::new(9.0, -9.0, 1.0), Vec3::new(0.0, 9.0, 1.0)];

fn mesh<'a>(positions: &'a [Vec3], triangles: &'a [[u32; 3]]) -> TriangleMesh<'a> {
    TriangleMesh { positions, triangles, occludes: true }
}

fn meets_nothing(accel: &Accel, ray: &Ray) -> bool {
    let mut packet = Rays16::default();
    (0..16).for_each(|lane| packet.set(lane, ray));
    let (mut hits, mut found) = (Hits16::default(), Occluders16::default());
    accel.closest_hit(ray).is_none()
        && !accel.occluded(ray)
        && accel.occluder(ray).is_none()
        && [false, true].into_iter().all(|coherent| {
            accel.closest_hit16(&packet, u16::MAX, coherent, &mut hits) == 0
                && accel.occluded16(&packet, u16::MAX, coherent) == 0
                && accel.occluders16(&packet, u16::MAX, coherent, &mut found) == 0
        })
}

#[test]
fn an_empty_scene_has_no_bounds_and_no_hits() {
    let device = Device::new(2).unwrap();
    for meshes in [&[][..], &[mesh(&[], &[])], &[mesh(&TRIANGLE, &[]), mesh(&[], &[])]] {
        let accel = Accel::build(&device, meshes).unwrap();
        assert!(accel.is_empty());
        assert_eq!(accel.bounds(), None);
        assert!(meets_nothing(&accel, &Ray::new(Vec3::ZERO, Vec3::Z)));
    }
}

#[test]
fn meshes_that_do_not_occlude_are_hit_and_nothing_else() {
    let behind = TRIANGLE.map(|p| p + 2.0 * Vec3::Z);
    for device in devices() {
        let clear = TriangleMesh { occludes: false, ..mesh(&TRIANGLE, &[[0, 1, 2]]) };
        let accel = Accel::build(&device, &[clear, mesh(&behind, &[[0, 1, 2]])]).unwrap();
        for (t_far, occluded) in [(2.0, false), (4.0, true)] {
            let ray = Ray { t_far, ..Ray::new(Vec3::ZERO, Vec3::Z) };
            let mut packet = Rays16::default();
            (0..16).for_each(|lane| packet.set(lane, &ray));
            let all = if occluded { u16::MAX } else { 0 };
            let mut found = Occluders16::default();
            assert_eq!(accel.closest_hit(&ray).map(|hit| hit.geometry), Some(0));
            assert_eq!(accel.occluded(&ray), occluded);
            assert_eq!(accel.occluder(&ray).map(|occluder| occluder.geometry), occluded.then_some(1));
            assert_eq!(accel.occluders16(&packet, u16::MAX, true, &mut found), all);
            for width in Width::ALL {
                assert_eq!(accel.occluded_by(width, &packet, u16::MAX, true), all);
            }
        }
    }
}

#[test]
fn bounds_are_those_of_the_vertices_in_use() {
    let positions = [TRIANGLE[0], TRIANGLE[1], TRIANGLE[2], Vec3::splat(1e3), Vec3::NAN];
    let accel = Accel::build(&Device::new(1).unwrap(), &[mesh(&positions, &[[0, 1, 2]])]).unwrap();
    assert_eq!(accel.bounds(), Some((Vec3::new(-9.0, -9.0, 1.0), Vec3::new(9.0, 9.0, 1.0))));
}

#[test]
fn unusable_rays_meet_nothing() {
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let good = Ray::new(Vec3::ZERO, Vec3::Z);
    for device in devices() {
        let accel = Accel::build(&device, &[mesh(&TRIANGLE, &[[0, 1, 2]])]).unwrap();
        assert!(!meets_nothing(&accel, &good));
        for x in bad {
            for axis in 0..3 {
                let (mut origin, mut direction) = (good, good);
                origin.origin[axis] = x;
                direction.direction[axis] = x;
                assert!(meets_nothing(&accel, &origin), "{origin:?}");
                assert!(meets_nothing(&accel, &direction), "{direction:?}");
            }
        }
        assert!(meets_nothing(&accel, &Ray { direction: Vec3::ZERO, ..good }));
        assert!(meets_nothing(&accel, &Ray { t_near: f32::NAN, ..good }));
        assert!(meets_nothing(&accel, &Ray { t_far: f32::NAN, ..good }));
        assert!(meets_nothing(&accel, &Ray { t_near: 2.0, t_far: 0.5, ..good }));
        assert!(meets_nothing(&accel, &Ray { t_far: f32::NEG_INFINITY, ..good }));
        assert!(
            meets_nothing(&accel, &Ray { t_near: 0.5, t_far: 0.5, ..good }),
            "an empty stretch before it"
        );
        // Unusable lanes do not disturb their neighbours.
        let mut packet = Rays16::default();
        packet.set(3, &good);
        packet.set(4, &Ray { origin: Vec3::NAN, ..good });
        assert_eq!(accel.occluded16(&packet, u16::MAX, true), 1 << 3);
    }
}

#[test]
fn segments_are_open_at_t_near_and_closed_at_t_far() {
    let accel = Accel::build(&Device::new(1).unwrap(), &[mesh(&TRIANGLE, &[[0, 1, 2]])]).unwrap();
    let at = |t_near, t_far| accel.occluded(&Ray { t_near, t_far, ..Ray::new(Vec3::ZERO, Vec3::Z) });
    assert!(at(0.0, 1.0) && at(1.0f32.next_down(), 1.0));
    assert!(!at(0.0, 1.0f32.next_down()) && !at(1.0, 2.0) && !at(1.0, 1.0));
}

#[test]
fn meshes_that_embree_would_mistreat_are_refused() {
    let device = Device::new(1).unwrap();
    for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 2e18, -2e18] {
        let mut positions = TRIANGLE.repeat(2);
        positions[4].y = x;
        let error = Accel::build(&device, &[mesh(&TRIANGLE, &[]), mesh(&positions, &[[0, 1, 2], [3, 4, 5]])]);
        let Err(EmbreeError::InvalidTriangles { mesh: 1, first: 1, count: 1 }) = error else {
            panic!("{x}: {:?}", error.err());
        };
    }
    let error = Accel::build(&device, &[mesh(&TRIANGLE, &[[0, 1, 3]])]).err();
    assert!(
        matches!(error, Some(EmbreeError::VertexIndex { mesh: 0, triangle: 0, index: 3, vertices: 3 })),
        "{error:?}"
    );
    // Embree accepts coordinates up to the maximum, and triangles without area.
    let huge = TRIANGLE.map(|p| p * 1.8e17);
    assert!(Accel::build(&device, &[mesh(&huge, &[[0, 1, 2]])]).is_ok());
    let flat = Accel::build(&device, &[mesh(&[Vec3::Z; 3], &[[0, 1, 2], [0, 0, 0]])]).unwrap();
    assert!(meets_nothing(&flat, &Ray::new(Vec3::ZERO, Vec3::Z)));
}

#[test]
fn errors_of_the_library_reach_the_caller() {
    let device = Device::new(1).unwrap();
    assert!(device.check("nothing").is_ok());
    // SAFETY: the device is live, and an unknown property is an error that Embree reports.
    unsafe { sys::rtcGetDeviceProperty(device.handle(), 9999) };
    let Err(EmbreeError::Call { during, message, .. }) = device.check("asking nonsense") else {
        panic!("the error was lost");
    };
    assert_eq!(during, "asking nonsense");
    assert!(message.contains("property"), "{message}");
    assert!(device.check("after the error").is_ok(), "an error is reported once");
}

#[test]
fn versions_below_4_3_and_from_5_are_refused() {
    let version = |major, minor| Version { major, minor, patch: 1 };
    assert!(version(4, 3).is_supported() && version(4, 10).is_supported());
    assert!(!version(4, 2).is_supported() && !version(3, 13).is_supported() && !version(5, 0).is_supported());
    assert!(Device::new(1).unwrap().version() >= Version { major: 4, minor: 3, patch: 0 });
}

#[test]
fn subnormal_numbers_survive() {
    // Embree flushes subnormal numbers on its own threads. On other threads that would be undefined behaviour.
    let accel = Accel::build(&Device::new(2).unwrap(), &[mesh(&TRIANGLE, &[[0, 1, 2]])]).unwrap();
    assert!(accel.occluded(&Ray::new(Vec3::ZERO, Vec3::Z)));
    let subnormal = black_box(f32::MIN_POSITIVE) * black_box(0.5);
    assert!(subnormal > 0.0 && black_box(subnormal) * black_box(2.0) == f32::MIN_POSITIVE);
}
