//! Tests of Embree's answers against a brute-force intersection in double precision, for every kind of query.

mod extremes;
mod oracle;
mod placed;

use super::*;
use oracle::{Soup, Verdict};
use rayon::prelude::*;

/// Returns one device for each set of kernels that this processor has.
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
fn every_triangle_crossed_is_met_once_until_there_are_enough() {
    let soup = Soup::random(300, 5);
    for device in devices() {
        let accel = soup.build(&device);
        let mut several = 0;
        for ray in soup.rays(4096, 6) {
            let mut met = Vec::new();
            let is_free = accel.each_crossed(&ray, |hit| {
                let id = TriangleId { geometry: hit.geometry, primitive: hit.primitive };
                let [a, b, c] = soup.corners(id);
                let point = a + hit.u * (b - a) + hit.v * (c - a);
                assert!(point.distance(ray.at(hit.t)) < 1e-4, "barycentrics are of corners 1 and 2");
                met.push(id);
                true
            });
            assert!(is_free);
            let (certain, close) = soup.crossed(&ray);
            assert!(certain.iter().all(|id| met.contains(id)), "{ray:?}: {met:?} {certain:?}");
            assert!(met.iter().all(|id| certain.contains(id) || close.contains(id)), "{met:?} {certain:?}");
            let mut once = met.clone();
            once.sort_by_key(|&id| <(u32, u32)>::from(id));
            once.dedup();
            assert_eq!(once.len(), met.len(), "{met:?}");
            several += usize::from(met.len() > 2);
            let (wanted, mut count) = (met.len().min(2), 0);
            let is_free = accel.each_crossed(&ray, |_| {
                count += 1;
                count < wanted
            });
            assert_eq!((is_free, count), (wanted == 0, wanted));
        }
        assert!(several > 50, "the test meets too little: {several}");
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
                    let single = accel.occluder(ray);
                    assert_eq!(single.is_some(), expected.is_some());
                    single.into_iter().for_each(|occluder| assert_real(&soup, ray, occluder));
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

/// Asserts that the occluder lies on the ray, at the stated distance.
fn assert_real(soup: &Soup, ray: &Ray, occluder: Occluder) {
    let id = TriangleId { geometry: occluder.geometry, primitive: occluder.primitive };
    let t = soup.distance(ray, id).unwrap_or_else(|| panic!("{id:?} is not on {ray:?}"));
    assert!((f64::from(occluder.t) - t).abs() <= 1e-4 * t, "{occluder:?} is at {t}");
}

#[test]
fn prepared_rays_of_every_width_find_the_hits_of_packets() {
    let soup = Soup::random(300, 9);
    let packets = packets(&soup.rays(1024, 10));
    for accel in devices().iter().map(|device| soup.build(device)) {
        let count = |packet: &Rays16| u64::from(accel.occluded16(packet, 0x7ff7, false).count_ones());
        let expected: u64 = packets.iter().map(count).sum();
        for (width, coherent) in Width::ALL.into_iter().flat_map(|width| [(width, false), (width, true)]) {
            let packets = || packets.iter().map(|packet| (packet, 0x7ff7));
            assert_eq!(PreparedRays::new(packets(), width).occluded(&accel, coherent), expected);
        }
    }
}

#[test]
fn only_valid_lanes_are_traced_and_written() {
    let soup = Soup::random(300, 7);
    let rays = soup.rays(256, 8);
    // Single rays replace widths without kernels.
    let widths = [Width::Four, Width::Eight, Width::Sixteen];
    let masks = [0, 1, 0x8000, 0x5555, 0xf00f, 0x7fff];
    for (accel, width) in devices().iter().flat_map(|device| widths.map(|width| (soup.build(device), width)))
    {
        for (packet, (valid, coherent)) in
            packets(&rays).iter().zip(masks.iter().flat_map(|mask| [(mask, false), (mask, true)]).cycle())
        {
            let all = accel.occluded_by(width, packet, u16::MAX, coherent);
            assert_eq!(accel.occluded_by(width, packet, *valid, coherent), all & valid);
            let mut found = Occluders16 { t: [-1.0; 16], ..Default::default() };
            let lanes = accel.occluders_by(width, packet, *valid, coherent, &mut found);
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
    // The structure may be dropped on another thread.
    std::thread::spawn(move || drop(accel)).join().unwrap();
}
