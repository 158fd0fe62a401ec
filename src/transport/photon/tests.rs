//! The photon map against known solutions: density of photons, leaks, and gathering against plain sampling.

use super::hemisphere::{GatherPoint, gather};
use super::indirect_light::{GatherCounts, IndirectLight};
use super::strata::{Strata, StrataHits};
use crate::emission::PhotonSettings;
use crate::irradiance::density::{IrradianceEstimate, estimates};
use crate::irradiance::{IrradianceMap, PhotonMap};
use base::math::{Frame, LANES, Rgb};
use base::progress::Control;
use base::sampling::{cosine_hemisphere, owen_sobol_2d};
use embree::Rays16;
use glam::{Vec2, Vec3};
use scene::DeltaLight;
use world::SurfacePoint;
use world::shadow;
use world::testkit::*;

fn map(world: &WorldAndView, photons: u32) -> PhotonMap {
    PhotonMap::new(world, &PhotonSettings { photons, seen: &[], max_edges: 6, seed: 0 }, &Control::new())
}

/// A dark floor from -1 to 1 with a thin wall along z, in sunlight that comes over the wall from +x.
fn sunlit_floor() -> (WorldAndView, f32) {
    let mut scene = scene(camera(Vec3::Y, Vec3::ZERO, 1.0), [4, 4]);
    // Almost black, so that there is no light but the sun's.
    let black = add_material(&mut scene, diffuse(Rgb::splat(1e-6)));
    scene.meshes.push(quad(Vec3::new(-1.0, 0.0, -1.0), Vec3::Z * 2.0, Vec3::X * 2.0, black));
    scene.meshes.push(quad(Vec3::new(0.0, 0.0, -1.0), Vec3::Z * 2.0, Vec3::Y * 0.5, black));
    let direction = Vec3::new(-1.0, -2.0, 0.0).normalize();
    scene.lights.push(DeltaLight::Directional { direction, irradiance: Rgb::splat(3.0) });
    (world(scene), -3.0 * direction.y)
}

/// Mean of the irradiance over a rectangle of the floor, on a grid of points.
fn mean(map: &IrradianceMap, low: Vec2, high: Vec2) -> f32 {
    let at = |i: u32| {
        let p = low + (high - low) * owen_sobol_2d(i, 3);
        map.at(Vec3::new(p.x, 0.0, p.y), Vec3::Y).map_or(0.0, |(irradiance, _)| irradiance.x)
    };
    (0..4096).map(at).sum::<f32>() / 4096.0
}

#[test]
fn density_is_the_irradiance_inside_at_edges_at_walls_and_at_corners() {
    let (world, expected) = sunlit_floor();
    // The sun's photons are evenly distributed, by Sobol's sequence, for which the estimate is up to 1 / (2 ·
    // nearest) low.
    for nearest in [30, 100] {
        let photons = map(&world, 160_000);
        let (found, _) = estimates(&world, &photons, nearest, &Control::new()).expect("not cancelled");
        let floor: Vec<&IrradianceEstimate> = found.iter().filter(|e| e.normal.y > 0.9).collect();
        let radius = floor.iter().map(|e| e.radius).sum::<f32>() / floor.len() as f32;
        let lit = IrradianceMap::new(&found, &photons.site_index);
        for (name, low, high, tolerance) in [
            ("inside", Vec2::new(0.2, -0.8), Vec2::new(0.8, 0.8), 0.02),
            ("edge", Vec2::new(0.2, 1.0 - radius), Vec2::new(0.8, 1.0), 0.05),
            ("wall", Vec2::new(1e-4, -0.8), Vec2::new(radius, 0.8), 0.05),
            ("corner", Vec2::new(1.0 - radius, 1.0 - radius), Vec2::ONE, 0.15),
        ] {
            let ratio = mean(&lit, low, high) / expected;
            assert!((ratio - 1.0).abs() < tolerance, "{name} with {nearest} photons: {ratio}");
        }
        // Behind the wall, away from the end of its shadow, and farther from the wall than half the disc of
        // as many photons.
        let shadow = mean(&lit, Vec2::new(-0.25 + 4.0 * radius, -0.8), Vec2::new(-2.0 * radius, 0.8));
        assert!(shadow < 0.05 * expected, "{nearest}: {shadow} in the shadow");
    }
}

#[test]
fn photons_in_the_next_room_do_not_count() {
    // Equal sunlight on both sides of the wall, so that photons from behind it would double the estimate.
    let (world, _) = sunlit_floor();
    let photons = map(&world, 40_000);
    let (found, _) = estimates(&world, &photons, 30, &Control::new()).expect("not cancelled");
    let just_lit = found.iter().filter(|e| e.normal.y > 0.9 && e.position.x.abs() < 0.2 * e.radius);
    // A site right at the wall has half a disc, all of whose photons are on its side.
    let (mut sum, mut count) = (0.0, 0);
    for e in just_lit {
        sum += e.irradiance.x;
        count += 1;
    }
    assert!(count > 20, "{count} sites");
    let ratio = sum / (count as f32 * 3.0 * (2.0f32 / 5.0f32.sqrt()));
    assert!((ratio - 1.0).abs() < 0.15, "{ratio}");
}

#[test]
fn there_are_no_estimates_once_they_are_cancelled() {
    let (world, _) = sunlit_floor();
    let photons = map(&world, 4_000);
    let control = Control::new();
    control.cancel();
    assert!(estimates(&world, &photons, 30, &control).is_none());
}

/// A room with a shelf in it, lit by a lamp.
fn room_with_shelf() -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.0, 0.0, 0.9), Vec3::ZERO, 1.0), [4, 4]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.5, 0.6)));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    scene.meshes.push(quad(Vec3::new(-0.9, -0.3, -0.5), Vec3::Z, Vec3::X * 0.8, wall));
    let lamp = quad(Vec3::new(-0.3, 0.99, -0.3), Vec3::X * 0.6, Vec3::Z * 0.6, wall);
    scene.meshes.push(emitting(lamp, Rgb::new(10.0, 9.0, 8.0)));
    world(scene)
}

#[test]
fn gathering_agrees_with_plain_sampling() {
    let world = room_with_shelf();
    let photons = map(&world, 30_000);
    let (found, _) = estimates(&world, &photons, 50, &Control::new()).expect("not cancelled");
    let map = IrradianceMap::new(&found, &photons.site_index);
    let light = IndirectLight { world: &world, map: &map, edges: u16::MAX };
    let mut counts = GatherCounts::default();
    for position in [Vec3::new(0.4, -1.0, 0.1), Vec3::new(-0.6, -1.0, 0.0), Vec3::new(-0.5, -1.0, 0.8)] {
        let point = SurfacePoint { position, normal: Vec3::Y, geometric_normal: Vec3::Y };
        let mut met = StrataHits::default();
        let strata = Strata::new(4000);
        let at = GatherPoint { point, coat: 0, seed: 1, max_nearness: f32::INFINITY };
        let g = gather(&light, &strata, &at, &mut met, &mut counts);
        let frame = Frame::from_normal(Vec3::Y);
        let (mut plain, packets) = (Rgb::ZERO, 4000);
        for packet in 0..packets {
            let mut rays = Rays16::default();
            for lane in 0..LANES {
                let u = owen_sobol_2d(packet * LANES as u32 + lane as u32, 9);
                let direction = frame.to_world(cosine_hemisphere(u));
                rays.set(lane, &shadow::ray_from(position, Vec3::Y, direction));
            }
            let seen = light.along16(&rays, u16::MAX, false, packet, &mut counts);
            plain += seen.iter().map(|seen| seen.radiance).sum::<Rgb>();
        }
        plain *= std::f32::consts::PI / (packets * LANES as u32) as f32;
        let error = (g.irradiance / plain - Rgb::ONE).abs().max_element();
        assert!(error < 0.01, "{position}: {} against {plain}", g.irradiance);
    }
}
