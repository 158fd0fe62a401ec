//! The choice among few and many emitters of all kinds, against brute force.

use super::*;
use base::math::{LANES, Rgb, Vec2x16, Vec3x16, luminance};
use base::sampling::{Sampler, uniform_sphere};
use glam::{Vec2, Vec3};
use scene::{DeltaLight, Emission, Environment, MaterialId, Mesh, Scene};
use std::f32::consts::PI;

/// Numbers of emitters that are all candidates, and that are more than those.
const COUNTS: [usize; 4] = [5, 32, 60, 400];

/// Returns emitters of all kinds in a cube of side 10, whose sizes and powers span orders of magnitude, and an
/// environment.
fn scene(count: usize, seed: u32) -> Scene {
    let mut sampler = Sampler::new(seed, 0);
    let mut scene = Scene::default();
    for i in 0..count - 1 {
        let direction = uniform_sphere(sampler.next_2d());
        let (place, y) = (sampler.next_2d(), sampler.next_1d());
        let position = 10.0 * Vec3::new(place.x, y, place.y) - 5.0;
        let strength = Rgb::splat(10f32.powf(2.0 * sampler.next_1d()));
        let size = 10f32.powf(1.5 * sampler.next_1d() - 1.5);
        match i % 6 {
            0 => scene.lights.push(DeltaLight::Point { position, intensity: strength }),
            1 => {
                let (inner_angle, outer_angle) = (0.3 + size, 0.5 + size);
                scene.lights.push(DeltaLight::Spot {
                    position,
                    direction,
                    intensity: strength,
                    inner_angle,
                    outer_angle,
                    image: None,
                });
            }
            2 if i % 5 == 0 => {
                scene.lights.push(DeltaLight::Directional { direction, irradiance: 0.01 * strength });
            }
            kind => scene.meshes.push(lamp(position, direction, size, strength / (size * size), kind == 3)),
        }
    }
    scene.environment = Some(Environment::Constant(Rgb::splat(0.1)));
    scene
}

/// Returns two emitting triangles with a common edge and an angle between them.
fn lamp(position: Vec3, direction: Vec3, size: f32, radiance: Rgb, two_sided: bool) -> Mesh {
    let a = size * direction.any_orthonormal_vector();
    let b = direction.cross(a);
    Mesh {
        name: "lamp".into(),
        positions: vec![position, position + a, position + b, position + a + b + 0.3 * size * direction],
        normals: Vec::new(),
        uvs: Vec::new(),
        tangents: Vec::new(),
        triangles: vec![[0, 1, 2], [2, 1, 3]],
        material: MaterialId(0),
        emission: Some(Emission { radiance, texture: None, two_sided }),
        attributes: Vec::new(),
    }
}

/// Samples a point in or around the cube, near an emitter in some cases, and a normal.
fn receiver(scene: &Scene, sampler: &mut Sampler) -> (Vec3, Vec3) {
    let (place, y) = (sampler.next_2d(), sampler.next_1d());
    let mut x = 14.0 * Vec3::new(place.x, y, place.y) - 7.0;
    let pick = sampler.next_1d();
    if pick < 0.3 {
        let corner = scene.meshes[(pick / 0.3 * scene.meshes.len() as f32) as usize].positions[1];
        x = corner + 0.02 * x;
    }
    (x, uniform_sphere(sampler.next_2d()))
}

fn emitters(scene: &Scene) -> Emitters {
    Emitters::new(scene, 10.0 * 3f32.sqrt())
}

/// Returns the learned visibility if two of three emitters are hidden from all points of positive x.
fn learned(emitters: &Emitters) -> Learned {
    let count = emitters.environment_index();
    let (mut observers, mut rays) = (Vec::new(), LightRays::default());
    for point in 0..4096 {
        let mut sampler = Sampler::new(8, point);
        let (place, z) = (sampler.next_2d(), sampler.next_1d());
        let x = 14.0 * place.extend(z) - 7.0;
        observers.push(x);
        rays.emitters.extend((0..32).map(|ray| {
            let lamp = (point * 32 + ray) * 97 % count;
            (ray % 3 > 0).then_some((lamp, is_seen(lamp as usize, x)))
        }));
    }
    let mut observed = emitters.observed_from(&observers);
    observed.add(rays);
    emitters.learn(&observed)
}

fn is_seen(lamp: usize, x: Vec3) -> bool {
    lamp.is_multiple_of(3) || x.x < 0.0
}

/// Returns the probability of choosing each emitter at a point.
fn probabilities(emitters: &Emitters, (x, n): (Vec3, Vec3), learned: Option<&Learned>) -> Vec<f32> {
    let (x, n) = (Vec3x16::splat(x), Vec3x16::splat(n));
    let at = Receivers16 { position: &x, normal: &n, learned };
    let one = |i| emitters.choice.probability(at, &[i; LANES], 1)[0];
    (0..=emitters.environment_index()).map(one).collect()
}

/// Integrates the irradiance by one emitter at a point, without occluders, over `steps` squared points. The result is
/// not zero if light arrives.
fn irradiance(emitters: &Emitters, index: usize, (x, n): (Vec3, Vec3), steps: u32) -> f64 {
    if let Some(light) = emitters.areas.get(index) {
        let mut sum = 0.0;
        for i in 0..steps * steps {
            let u = Vec2::new((i % steps) as f32 + 0.5, (i / steps) as f32 + 0.5) / steps as f32;
            let point = light.sample(u);
            let offset = point.position - x;
            let direction = offset.normalize();
            let cosines = n.dot(direction).max(0.0) * point.normal.dot(direction).abs();
            let radiance = luminance(light.radiance(&point, -direction));
            sum += f64::from(radiance * cosines * light.area / offset.length_squared());
        }
        return sum / f64::from(steps * steps);
    }
    match emitters.deltas.get(index - emitters.areas.len()) {
        Some(light) => {
            let (direction, _, irradiance) = light.irradiance(x);
            f64::from(luminance(irradiance) * n.dot(direction).max(0.0))
        }
        None => f64::from(PI * 0.1),
    }
}

#[test]
fn frequencies_are_the_probabilities_and_all_that_shines_can_be_chosen() {
    const DRAWS: usize = 1 << 14;
    for count in COUNTS {
        let scene = scene(count, 1);
        let emitters = emitters(&scene);
        let knowledge = learned(&emitters);
        let mut sampler = Sampler::new(2, 0);
        for round in 0..60 {
            let (x, n) = receiver(&scene, &mut sampler);
            let learned = (round % 3 == 0).then_some(&knowledge);
            let expected = probabilities(&emitters, (x, n), learned);
            let (positions, normals) = (Vec3x16::splat(x), Vec3x16::splat(n));
            let at = Receivers16 { position: &positions, normal: &normals, learned };
            let mut drawn = vec![0u32; expected.len()];
            let mut none = 0;
            for first in (0..DRAWS).step_by(LANES) {
                let u = std::array::from_fn(|i| (first + i) as f32 / DRAWS as f32);
                let (chosen, choice) = emitters.choice.sample(at, &u, u16::MAX);
                for (emitter, choice) in chosen.iter().zip(choice) {
                    if choice > 0.0 {
                        drawn[*emitter as usize] += 1;
                        let known = expected[*emitter as usize];
                        assert!((choice - known).abs() <= 1e-4 * known, "{choice} for {known}");
                    } else {
                        none += 1;
                    }
                }
            }
            // An emitter is chosen by the numbers of an interval.
            for (drawn, expected) in drawn.iter().zip(&expected) {
                let difference = (*drawn as f32 - expected * DRAWS as f32).abs();
                assert!(difference < 1.2, "{drawn} of {DRAWS} for {expected}");
            }
            let sum = expected.iter().sum::<f32>() + none as f32 / DRAWS as f32;
            assert!((sum - 1.0).abs() < 0.02, "{sum}");
            for (index, probability) in expected.iter().enumerate() {
                let arrives = irradiance(&emitters, index, (x, n), 16);
                assert!(arrives == 0.0 || *probability > 0.0, "{arrives} of emitter {index}");
            }
        }
    }
}

#[test]
fn lamps_hidden_from_a_region_are_hardly_chosen_there() {
    for count in COUNTS {
        let scene = scene(count, 3);
        let emitters = emitters(&scene);
        let learned = learned(&emitters);
        let mut sampler = Sampler::new(9, 0);
        let (mut before, mut after, mut open) = (0.0, 0.0, 0.0f32);
        for _ in 0..400 {
            let (mut x, n) = receiver(&scene, &mut sampler);
            x.x = x.x.abs() + 1.0;
            let hidden = |learned: Option<&Learned>| -> f32 {
                let of = probabilities(&emitters, (x, n), learned);
                (0..count - 1).filter(|lamp| !is_seen(*lamp, x)).map(|lamp| of[lamp]).sum()
            };
            before += hidden(None);
            after += hidden(Some(&learned));
            let there = (x * Vec3::new(-1.0, 1.0, 1.0), n);
            let [by_none, by_all] = [None, Some(&learned)].map(|l| probabilities(&emitters, there, l));
            let moved: f32 = by_none.iter().zip(&by_all).map(|(a, b)| (a - b).abs()).sum();
            open = open.max(moved);
        }
        // Down a tree, bright lamps that are hidden stand beside dim ones that are seen.
        let share = if count <= 32 { 0.4 } else { 0.8 };
        assert!(after < share * before, "{after} of {before} with {count} emitters");
        assert!(open < 1e-3, "{open} with {count} emitters");
    }
}

#[test]
fn the_mean_of_direct_light_is_the_sum_over_all_emitters() {
    const DRAWS: u32 = 1 << 16;
    for count in COUNTS {
        let scene = scene(count, 5);
        let emitters = emitters(&scene);
        let knowledge = learned(&emitters);
        let mut sampler = Sampler::new(4, 0);
        let (mut sum_of_z_sq, mut points) = (0.0, 0.0);
        while points < 12.0 {
            // Away from the lamps, where the plain sum over points on them has converged.
            let (x, n) = receiver(&scene, &mut sampler);
            if emitters
                .areas
                .iter()
                .any(|light| x.distance(light.shapes()[0].corner) < 5.0 * light.area.sqrt())
            {
                continue;
            }
            let all = 0..=emitters.environment_index() as usize;
            let expected: f64 = all.map(|i| irradiance(&emitters, i, (x, n), 32)).sum();
            let (positions, normals) = (Vec3x16::splat(x), Vec3x16::splat(n));
            let learned = (points as u32).is_multiple_of(2).then_some(&knowledge);
            let at = Receivers16 { position: &positions, normal: &normals, learned };
            let (mut sum, mut sum_sq) = (0.0, 0.0);
            for _ in 0..DRAWS / LANES as u32 {
                let (mut choices, mut places) = ([0.0; LANES], Vec2x16::default());
                for i in 0..LANES {
                    let mut numbers = Sampler::new(sampler.next_1d().to_bits(), i as u32);
                    choices[i] = numbers.next_1d();
                    places.set(i, numbers.next_2d());
                }
                let lights = emitters.sample_direct(at, &choices, &places, u16::MAX);
                for i in base::math::lanes_in(lights.useful()) {
                    let cos = n.dot(lights.direction.get(i)).max(0.0);
                    let value = f64::from(luminance(lights.radiance.get(i)) * cos / lights.pdf[i]);
                    sum += value;
                    sum_sq += value * value;
                }
            }
            let mean = sum / f64::from(DRAWS);
            let variance = (sum_sq / f64::from(DRAWS) - mean * mean) / f64::from(DRAWS);
            let z = (mean - expected) / (variance.sqrt() + 1e-3 * expected);
            assert!(z.abs() < 4.5, "{mean} for {expected}, {z} standard errors, {count} emitters");
            sum_of_z_sq += z * z;
            points += 1.0;
        }
        assert!(sum_of_z_sq < 36.0, "{sum_of_z_sq} over {points} points");
    }
}

#[test]
fn lanes_that_share_lamps_have_the_samples_of_each_lane_alone() {
    let mut scene = scene(20, 8);
    // A lamp of more triangles than are tried for all lanes together.
    let one = scene.meshes[0].clone();
    let triangles = one.triangles.iter().cycle().take(40).copied().collect();
    scene.meshes.push(Mesh { triangles, ..one });
    let emitters = emitters(&scene);
    let mut sampler = Sampler::new(11, 0);
    for _ in 0..200 {
        let (mut x, mut n, mut places) = (Vec3x16::default(), Vec3x16::default(), Vec2x16::default());
        let near = receiver(&scene, &mut sampler);
        let step = sampler.next_1d().powi(4);
        let choices = std::array::from_fn(|i| {
            let (position, normal) = if i % 3 > 0 { near } else { receiver(&scene, &mut sampler) };
            x.set(i, position);
            n.set(i, normal);
            places.set(i, sampler.next_2d());
            (step * sampler.next_1d()).min(1.0 - f32::EPSILON)
        });
        let at = Receivers16 { position: &x, normal: &n, learned: None };
        let wanted = sampler.next_1d().to_bits() as u16 | 1;
        let together = emitters.sample_direct(at, &choices, &places, wanted);
        for i in base::math::lanes_in(wanted) {
            let alone = emitters.sample_direct(at, &choices, &places, 1 << i);
            assert_eq!(together.useful() & 1 << i, alone.useful());
            if alone.useful() != 0 {
                assert_eq!(together.direction.get(i), alone.direction.get(i));
                assert_eq!(together.normal.get(i), alone.normal.get(i));
                assert_eq!(together.radiance.get(i), alone.radiance.get(i));
                assert_eq!((together.distance[i], together.pdf[i]), (alone.distance[i], alone.pdf[i]));
                assert_eq!(together.delta[i], alone.delta[i]);
            }
        }
        assert_eq!(together.useful() & !wanted, 0);
    }
}

#[test]
fn small_lamps_alone_send_light_from_few_directions() {
    let room = |size: f32, radiance: f32| {
        let meshes = vec![
            lamp(Vec3::ZERO, Vec3::Y, 0.01, Rgb::splat(1e4), false),
            lamp(Vec3::ONE, Vec3::Y, size, Rgb::splat(radiance), false),
        ];
        emitters(&Scene { meshes, ..Scene::default() }).send_from_few_directions()
    };
    assert!(room(0.1, 1.0) && !room(10.0, 1.0));
    // A large lamp counts by its power.
    assert!(room(10.0, 1e-9));
    let lights = vec![DeltaLight::Point { position: Vec3::ONE, intensity: Rgb::ONE }];
    let point = Scene { lights, ..Scene::default() };
    assert!(emitters(&point).send_from_few_directions());
    let environment = Some(Environment::Constant(Rgb::ONE));
    assert!(!emitters(&Scene { environment, ..point }).send_from_few_directions());
}

#[test]
fn densities_of_points_are_those_of_sampling_them() {
    for count in COUNTS {
        let scene = scene(count, 7);
        let emitters = emitters(&scene);
        let mut sampler = Sampler::new(6, 0);
        for _ in 0..50 {
            let (x, n) = receiver(&scene, &mut sampler);
            let (x, n) = (Vec3x16::splat(x), Vec3x16::splat(n));
            let at = Receivers16 { position: &x, normal: &n, learned: None };
            let choices = std::array::from_fn(|_| sampler.next_1d());
            let mut places = Vec2x16::default();
            for i in 0..LANES {
                places.set(i, sampler.next_2d());
            }
            let (chosen, _) = emitters.choice.sample(at, &choices, u16::MAX);
            let lights = emitters.sample_direct(at, &choices, &places, u16::MAX);
            for i in base::math::lanes_in(lights.useful()) {
                let Some(light) = emitters.areas.get(chosen[i] as usize) else { continue };
                let cos = lights.normal.get(i).dot(lights.direction.get(i));
                let (mesh, distance, cos) = ([light.mesh; LANES], [lights.distance[i]; LANES], [cos; LANES]);
                let density = emitters.pdf_areas(at, &mesh, &distance, &cos)[0];
                assert!((density / lights.pdf[i] - 1.0).abs() < 1e-3, "{density} for {}", lights.pdf[i]);
            }
        }
    }
}

#[test]
fn lanes_that_meet_no_lamp_have_no_density_among_any_number_of_lamps() {
    for count in 1..40 {
        let lamps = |i: usize| lamp(Vec3::X * i as f32, Vec3::Y, 0.5, Rgb::ONE, true);
        let mut scene = Scene { meshes: (0..count).map(lamps).collect(), ..Scene::default() };
        scene.meshes.push(Mesh { emission: None, ..lamp(Vec3::ZERO, Vec3::Y, 1.0, Rgb::ONE, false) });
        let (emitters, dark) = (emitters(&scene), count as u32);
        let (x, n) = (Vec3x16::splat(Vec3::Y * 3.0), Vec3x16::splat(Vec3::NEG_Y));
        let at = Receivers16 { position: &x, normal: &n, learned: None };
        let mesh = std::array::from_fn(|i| if i % 3 == 0 { i as u32 % dark } else { dark });
        let densities = emitters.pdf_areas(at, &mesh, &[3.0; LANES], &[1.0; LANES]);
        for (i, density) in densities.iter().enumerate() {
            assert_eq!(*density > 0.0, i % 3 == 0, "{count} lamps, lane {i}: {density}");
        }
    }
}

#[test]
fn rays_that_meet_a_lamp_are_never_said_to_miss_all_and_most_others_are() {
    let mut sampler = Sampler::new(7, 0);
    let (mut missing, rays) = (0, 4000);
    let scene = scene(32, 5);
    let emitters = emitters(&scene);
    for _ in 0..rays {
        let (x, away) = receiver(&scene, &mut sampler);
        // The point moves up to a hundred times as far away.
        let x = x * 100f32.powf(sampler.next_1d());
        let lamp = &emitters.areas[(sampler.next_1d() * emitters.areas.len() as f32) as usize];
        let towards = (lamp.sample(sampler.next_2d()).position - x).normalize();
        let met = |direction| emitters.may_be_met(&Vec3x16::splat(x), &Vec3x16::splat(direction)) == u16::MAX;
        assert!(met(towards), "{x} {towards}");
        missing += u32::from(!met(away));
    }
    assert!(missing > rays / 2, "{missing}");
}
