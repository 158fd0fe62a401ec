//! Embree's answers against a brute-force intersection in double precision, through every path.

mod extremes;
mod oracle;

use super::*;
use glam::Vec3;
use oracle::{Soup, Verdict};
use rayon::prelude::*;

/// One device for each set of kernels that this processor has.
fn devices() -> Vec<Device> {
    let mut configs = vec!["threads=2"];
    if cfg!(target_arch = "x86_64") {
        configs.extend(["threads=2,isa=avx2", "threads=2,isa=sse2"]);
    }
    configs.into_iter().map(|c| Device::with_config(c).unwrap()).collect()
}

fn packets(rays: &[Ray]) -> Vec<Rays16> {
    rays.chunks_exact(16)
        .map(|chunk| {
            let mut packet = Rays16::default();
            chunk.iter().enumerate().for_each(|(lane, ray)| packet.set(lane, ray));
            packet
        })
        .collect()
}

#[test]
fn closest_hit_is_the_brute_force_one() {
    let soup = Soup::random(300, 1);
    let rays = soup.rays(4096, 2);
    for device in devices() {
        let accel = soup.build(&device);
        let mut hits = 0;
        for ray in &rays {
            let hit = accel.closest_hit(ray);
            let Verdict::Certain(expected) = soup.closest(ray) else { continue };
            assert_eq!(hit.is_some(), expected.is_some(), "{ray:?}");
            let (Some(hit), Some(expected)) = (hit, expected) else { continue };
            hits += 1;
            let id = TriangleId { geometry: hit.geometry, primitive: hit.primitive };
            assert_eq!(id, expected.id);
            assert!((f64::from(hit.t) - expected.t).abs() <= 1e-4 * expected.t, "{hit:?} {expected:?}");
            let [a, b, c] = soup.corners(id);
            let point = a + hit.u * (b - a) + hit.v * (c - a);
            assert!(point.distance(ray.at(hit.t)) < 1e-4, "barycentrics are of corners 1 and 2");
        }
        assert!(hits > 500, "the test meets too little: {hits}");
    }
}

#[test]
fn packets_agree_with_brute_force() {
    let soup = Soup::random(300, 3);
    let rays = soup.rays(4096, 4);
    for device in devices() {
        let accel = soup.build(&device);
        for (packet, rays) in packets(&rays).iter().zip(rays.chunks_exact(16)) {
            for coherent in [false, true] {
                let mut hits = Hits16::default();
                let hit = accel.closest_hit16(packet, u16::MAX, coherent, &mut hits);
                let occluded = accel.occluded16(packet, u16::MAX, coherent);
                let mut found = Occluders16::default();
                let filtered = accel.occluders16(packet, u16::MAX, coherent, &mut found);
                for (lane, ray) in rays.iter().enumerate() {
                    let bit = |mask: u16| (mask >> lane) & 1 != 0;
                    let Verdict::Certain(expected) = soup.closest(ray) else { continue };
                    assert_eq!(bit(hit), expected.is_some());
                    assert_eq!(bit(occluded), expected.is_some());
                    assert_eq!(accel.occluded(ray), expected.is_some());
                    assert_eq!(bit(filtered), expected.is_some());
                    let Some(expected) = expected else { continue };
                    assert_eq!((hits.geometry[lane], hits.primitive[lane]), expected.id.into());
                    assert!((f64::from(hits.t[lane]) - expected.t).abs() <= 1e-4 * expected.t);
                    let occluder = Occluder {
                        t: found.t[lane],
                        geometry: found.geometry[lane],
                        primitive: found.primitive[lane],
                    };
                    assert_real(&soup, ray, occluder);
                }
            }
        }
    }
}

/// The occluder lies on the ray, at the distance it says.
fn assert_real(soup: &Soup, ray: &Ray, occluder: Occluder) {
    let id = TriangleId { geometry: occluder.geometry, primitive: occluder.primitive };
    let t = soup.distance(ray, id).unwrap_or_else(|| panic!("{id:?} is not on {ray:?}"));
    assert!((f64::from(occluder.t) - t).abs() <= 1e-4 * t, "{occluder:?} is at {t}");
}

#[test]
fn skipped_triangles_do_not_occlude() {
    let soup = Soup::random(60, 5);
    let rays = soup.rays(4096, 6);
    for device in devices() {
        let accel = soup.build(&device);
        let mut revealed = 0;
        for (packet, rays) in packets(&rays).iter().zip(rays.chunks_exact(16)) {
            // Skip the first two triangles along each ray, as single rays find them.
            let mut skip = Skip16::default();
            let mut skips = [[TriangleId::NONE; 2]; 16];
            for (lane, ray) in rays.iter().enumerate() {
                for end in 0..2 {
                    if let Some(o) = accel.occluder_except(ray, skips[lane], ALL_GEOMETRY) {
                        assert_real(&soup, ray, o);
                        skips[lane][end] = TriangleId { geometry: o.geometry, primitive: o.primitive };
                    }
                }
                skip.set(lane, skips[lane]);
            }
            for coherent in [false, true] {
                let mut found = Occluders16::default();
                let lanes = accel.occluders16_except(packet, u16::MAX, coherent, &skip, &mut found);
                for (lane, ray) in rays.iter().enumerate() {
                    let Verdict::Certain(expected) = soup.closest_except(ray, &skips[lane]) else { continue };
                    let is_occluded = (lanes >> lane) & 1 != 0;
                    assert_eq!(is_occluded, expected.is_some());
                    let single = accel.occluder_except(ray, skips[lane], ALL_GEOMETRY);
                    assert_eq!(single.is_some(), expected.is_some());
                    revealed += usize::from(!is_occluded && skips[lane][0] != TriangleId::NONE);
                    if is_occluded {
                        let id =
                            TriangleId { geometry: found.geometry[lane], primitive: found.primitive[lane] };
                        assert!(!skips[lane].contains(&id));
                    }
                }
            }
        }
        assert!(revealed > 100, "the test reveals too little: {revealed}");
    }
}

#[test]
fn only_valid_lanes_are_traced_and_written() {
    let soup = Soup::random(300, 7);
    let rays = soup.rays(256, 8);
    let accel = soup.build(&Device::new(1).unwrap());
    for (packet, valid) in packets(&rays).iter().zip([0, 1, 0x8000, 0x5555, 0xf00f, 0x7fff].iter().cycle()) {
        for coherent in [false, true] {
            let all = accel.occluded16(packet, u16::MAX, coherent);
            assert_eq!(accel.occluded16(packet, *valid, coherent), all & valid);
            let mut found = Occluders16 { t: [-1.0; 16], ..Default::default() };
            let lanes = accel.occluders16(packet, *valid, coherent, &mut found);
            assert_eq!(lanes, all & valid);
            let mut hits = Hits16 { t: [-1.0; 16], ..Default::default() };
            assert_eq!(accel.closest_hit16(packet, *valid, coherent, &mut hits), all & valid);
            for lane in 0..16 {
                let is_written = (lanes >> lane) & 1 != 0;
                assert_eq!(found.t[lane] >= 0.0, is_written);
                assert_eq!(hits.t[lane] >= 0.0, is_written);
            }
        }
    }
}

#[test]
fn masks_choose_the_geometry() {
    let square = |z: f32| [Vec3::new(-9.0, -9.0, z), Vec3::new(9.0, -9.0, z), Vec3::new(0.0, 9.0, z)];
    let (near, far) = (square(1.0), square(2.0));
    let mesh = |positions, mask| TriangleMesh { positions, triangles: &[[0, 1, 2]], mask };
    let accel = Accel::build(&Device::new(1).unwrap(), &[mesh(&near, 0b01), mesh(&far, 0b10)]).unwrap();
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    for (mask, expected) in [(0b01, Some(0)), (0b10, Some(1)), (0b11, Some(0)), (0b100, None), (0, None)] {
        assert_eq!(accel.closest_hit_masked(&ray, mask).map(|h| h.geometry), expected);
        assert_eq!(accel.occluded_masked(&ray, mask), expected.is_some());
        let occluder = accel.occluder_except(&ray, [TriangleId::NONE; 2], mask);
        assert_eq!(occluder.is_some(), expected.is_some());
        let mut packet = Rays16 { mask: [mask; 16], ..Default::default() };
        packet.set(5, &ray);
        let lanes = if expected.is_some() { 1 << 5 } else { 0 };
        assert_eq!(accel.occluded16(&packet, u16::MAX, true), lanes);
        let mut hits = Hits16::default();
        assert_eq!(accel.closest_hit16(&packet, u16::MAX, false, &mut hits), lanes);
        assert_eq!(expected.is_some().then_some(hits.geometry[5]), expected);
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let soup = Soup::random(2000, 9);
    let rays = soup.rays(4096, 10);
    let bits =
        |h: Option<Hit>| h.map(|h| (h.t.to_bits(), h.u.to_bits(), h.v.to_bits(), h.geometry, h.primitive));
    let sequential: Vec<_> = {
        let accel = soup.build(&Device::new(1).unwrap());
        rays.iter().map(|ray| bits(accel.closest_hit(ray))).collect()
    };
    let accel = soup.build(&Device::new(4).unwrap());
    let parallel: Vec<_> = rays.par_iter().map(|ray| bits(accel.closest_hit(ray))).collect();
    assert_eq!(sequential, parallel);
    // The structure may also go on another thread than the one it was built on.
    std::thread::spawn(move || drop(accel)).join().unwrap();
}
