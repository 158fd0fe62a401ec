//! Projected materials against direct integration and against figures found independently.

use super::Random;
use crate::gradient::{Incidence, LocalVpl};
use crate::hsh::basis::*;
use crate::hsh::kernel::even_index;
use crate::hsh::projection::{KernelProjection, Quadrature};
use crate::hsh::*;
use base::math::Rgb;
use glam::{DVec3, Vec2, Vec3};
use scene::{Coat, Distribution, Fresnel, Lobe, Material, MaterialId, Principled, Reflectance, TextureId};
use std::f64::consts::{PI, TAU};
use world::material::{DullLobe, Materials};
use world::testkit::textured_materials as scene;

const GOLD: Fresnel =
    Fresnel::Conductor { eta: Rgb::new(0.143, 0.375, 1.442), k: Rgb::new(3.983, 2.386, 1.603) };

fn constant(value: f32) -> Reflectance {
    Reflectance::Constant(Rgb::splat(value))
}

fn lambert(albedo: f32) -> Material {
    Material { name: "lambert".into(), two_sided: true, diffuse: constant(albedo), ..Material::default() }
}

fn rough(alpha: f32, fresnel: Fresnel, albedo: f32, coat: Option<Coat>) -> Material {
    let (distribution, alpha) = (Distribution::Ggx, alpha.into());
    let lobe = Lobe::Rough { distribution, alpha, fresnel, scale: constant(1.0) };
    Material { coat, lobes: vec![lobe], ..lambert(albedo) }
}

fn metal(alpha: f32) -> Material {
    rough(alpha, Fresnel::One, 0.0, None)
}

fn rough_plastic(alpha: f32, albedo: f32) -> Material {
    rough(alpha, Fresnel::Dielectric(1.5), albedo, Some(Coat { eta: 1.5, nonlinear: true }))
}

/// Several lobes over a base.
fn principled(metallic: f32, sheen: f32) -> Material {
    let (metallic, sheen, base_color) = (metallic.into(), sheen.into(), constant(0.6));
    let principled =
        Principled { metallic, sheen, base_color, roughness: 0.7.into(), ..Principled::default() };
    Material { principled: Some(Box::new(principled)), ..lambert(0.0) }
}

fn with_lobe<R>(material: Material, f: impl FnOnce(DullLobe) -> R) -> R {
    let scene = scene(vec![material]);
    let materials = Materials::new(&scene);
    f(materials.at(MaterialId(0), Vec2::ZERO).dull_lobes().next().unwrap().1)
}

fn relative_error(projection: &KernelProjection, bands: usize) -> f64 {
    let kept: f64 = projection.coefficients[0][..even_index(bands, 0)].iter().map(|c| c * c).sum();
    (1.0 - kept / projection.norm_sq[0]).max(0.0).sqrt()
}

#[test]
fn kernels_lose_as_much_as_found_independently() {
    // Per cent at 8 bands, for GGX with separable Smith masking; computed from the closed formulas with numpy, without
    // any of this code. α, and 0, 30, 60, 75 degrees.
    for (alpha, expected) in [
        (0.5, [0.0, 0.1, 3.6, 9.7]),
        (0.35, [0.3, 0.6, 10.8, 25.9]),
        (0.25, [2.2, 3.5, 22.4, 45.5]),
        (0.2, [5.9, 8.3, 31.8, 57.6]),
        (0.15, [15.0, 18.8, 44.8, 70.3]),
    ] {
        with_lobe(metal(alpha), |lobe| {
            let quadrature = Quadrature::standard();
            for (degrees, expected) in [0.0f64, 30.0, 60.0, 75.0].into_iter().zip(expected) {
                let projection = quadrature.project(lobe, degrees.to_radians().cos());
                let error = 100.0 * relative_error(&projection, MAX_BANDS);
                assert!((error - expected).abs() < 0.06, "{alpha} {degrees}: {error}, not {expected}");
            }
        });
    }
}

#[test]
fn the_quadrature_has_converged() {
    let (standard, fine) = (Quadrature::standard(), Quadrature::new(150, 150));
    for material in [metal(0.15), rough(0.3, GOLD, 0.0, None), rough_plastic(0.2, 0.0)] {
        with_lobe(material, |lobe| {
            for degrees in [0.0f64, 40.0, 75.0, 85.0, 89.9] {
                let (a, b) = [&standard, &fine].map(|q| q.project(lobe, degrees.to_radians().cos())).into();
                for c in 0..3 {
                    let norm = b.norm_sq[c].sqrt();
                    assert!((a.norm_sq[c].sqrt() / norm - 1.0).abs() < 1e-5, "{degrees}");
                    for (x, y) in a.coefficients[c].iter().zip(&b.coefficients[c]) {
                        assert!((x - y).abs() < 1e-5 * norm, "{degrees}: {x} {y}");
                    }
                }
            }
        });
    }
}

/// Directions and their solid angles: a product rule over the whole hemisphere, for integrands of moderate sharpness.
fn hemisphere() -> Vec<(DVec3, f64)> {
    let mut all = Vec::new();
    for (s, weight) in base::math::gauss_legendre(48) {
        let z = s * s;
        for j in 0..96 {
            let (sin, cos) = (f64::from(j) * TAU / 96.0 + 0.01).sin_cos();
            let r = (1.0 - z * z).sqrt();
            all.push((DVec3::new(r * cos, r * sin, z), 2.0 * s * weight * TAU / 96.0));
        }
    }
    all
}

/// `wo` at an inclination and azimuth.
fn outgoing(inclination: f64, azimuth: f64) -> DVec3 {
    let (sin, cos) = inclination.sin_cos();
    DVec3::new(sin * azimuth.cos(), sin * azimuth.sin(), cos)
}

/// Materials of every kind that is expanded.
fn expanded() -> Vec<Material> {
    vec![
        metal(0.5),
        rough(0.35, GOLD, 0.0, None),
        rough(0.5, Fresnel::One, 0.4, None),
        rough_plastic(0.35, 0.5),
        rough(0.7, Fresnel::Dielectric(1.5), 0.3, None),
        principled(0.0, 0.0),
        principled(0.3, 0.5),
    ]
}

#[test]
fn kernels_are_projections_from_any_azimuth() {
    let scene = scene(expanded());
    let materials = Materials::new(&scene);
    let settings = SeriesSettings { error: 0.0, max_error: 1.0, ..SeriesSettings::default() };
    let surfaces = MaterialSeries::new(&materials, &settings);
    let directions = hemisphere();
    for i in 0..scene.materials.len() {
        let id = MaterialId(i as u32);
        let bsdf = materials.at(id, Vec2::ZERO);
        assert_eq!(surfaces.caching(id), Caching::Series(8));
        for (inclination, azimuth) in [(0.0, 0.0), (0.3, 1.0), (0.8, -2.0), (1.2, 3.0)] {
            let wo = outgoing(inclination, azimuth);
            let mut expected = [DVec3::ZERO; MAX_FUNCTIONS];
            let mut norm_sq = DVec3::ZERO;
            for (wi, solid_angle) in &directions {
                let value = bsdf.eval(wo.as_vec3(), wi.as_vec3()).as_dvec3() * wi.z;
                norm_sq += value * value * *solid_angle;
                for (sum, h) in
                    expected.iter_mut().zip(evaluate(MAX_BANDS, wi.as_vec3().to_array()).map(f64::from))
                {
                    *sum += value * *solid_angle * h;
                }
            }
            let profile = surfaces.profile(&bsdf, wo.z as f32);
            let kernel = profile.towards(wo.x as f32, wo.y as f32);
            let mut error_sq = DVec3::ZERO;
            for k in 0..MAX_FUNCTIONS {
                let value = DVec3::from_array(std::array::from_fn(|c| f64::from(kernel.coefficients[c][k])));
                error_sq += (value - expected[k]).powf(2.0);
            }
            let error = (error_sq / norm_sq).max_element().sqrt();
            assert!(error < settings.interpolation_error, "{i} {inclination} {azimuth}: {error:e}");
        }
    }
}

#[test]
fn interpolation_keeps_its_tolerance_everywhere() {
    let scene = scene(expanded());
    let materials = Materials::new(&scene);
    let quadrature = Quadrature::standard();
    let mut random = Random(3);
    for i in 0..scene.materials.len() {
        let lobe = materials.at(MaterialId(i as u32), Vec2::ZERO).dull_lobes().next().unwrap().1;
        for tolerance in [0.01, 0.001] {
            let table = lobe_table::LobeTable::new(lobe, MAX_BANDS, tolerance, &quadrature);
            assert!(table.directions() > 16 && table.directions() < 200);
            let mut angles: Vec<f64> = (0..60).map(|_| random.next()).collect();
            angles.extend([0.0, 1e-7, 0.999, 1.0]);
            for cos_o in angles {
                let (values, exact) = (table.lookup(cos_o as f32), quadrature.project(lobe, cos_o));
                let mut error_sq = 0.0;
                for (values, exact) in values.iter().zip(&exact.coefficients) {
                    for l in 0..MAX_BANDS {
                        for m in 0..=l {
                            let value = f64::from(values[index(l, m as isize)]);
                            error_sq += (value - exact[even_index(l, m)]).powi(2);
                        }
                    }
                }
                let error = (error_sq / exact.norm_sq.iter().sum::<f64>()).sqrt();
                assert!(error < 1.2 * tolerance, "{i} {tolerance} {cos_o}: {error:e}");
            }
        }
    }
}

/// Light of unit intensity from a direction.
fn from(direction: DVec3) -> Incidence {
    LocalVpl::Directional { towards: direction.as_vec3().to_array() }.incidence(0.0).unwrap()
}

#[test]
fn smooth_light_is_reflected_within_the_product_of_what_both_series_leave_out() {
    let scene = scene(expanded());
    let materials = Materials::new(&scene);
    let surfaces = MaterialSeries::new(&materials, &SeriesSettings::default());
    let directions = hemisphere();
    let values: Vec<_> = directions
        .iter()
        .map(|(wi, _)| evaluate(MAX_BANDS, wi.as_vec3().to_array()).map(f64::from))
        .collect();
    let sun = outgoing(0.9, 0.4);
    // Uniform light, two lobes of light, and light that grows towards the horizon.
    let environments: [&dyn Fn(DVec3) -> f64; 4] =
        [&|_| 1.0, &|w| (3.0 * (w.dot(sun) - 1.0)).exp(), &|w| (12.0 * (w.dot(sun) - 1.0)).exp(), &|w| {
            (1.0 - w.z).powi(3)
        }];
    for (e, environment) in environments.iter().enumerate() {
        for i in 0..scene.materials.len() {
            let id = MaterialId(i as u32);
            let bsdf = materials.at(id, Vec2::ZERO);
            let Caching::Series(bands) = surfaces.caching(id) else { panic!("{i}") };
            let mut accumulator = Accumulator::new(usize::from(bands));
            let mut light_norm_sq = 0.0;
            for (wi, solid_angle) in &directions {
                let radiance = environment(*wi);
                light_norm_sq += radiance * radiance * solid_angle;
                accumulator.add(&from(*wi), Rgb::splat((radiance * solid_angle) as f32));
            }
            let light = accumulator.finish();
            let kept: f64 =
                (0..usize::from(bands).pow(2)).map(|k| f64::from(light.coefficient(k).x).powi(2)).sum();
            let light_left = (light_norm_sq - kept).max(0.0).sqrt();
            for (inclination, azimuth) in [(0.0, 0.0), (0.5, -2.7), (1.0, 2.0), (1.3, 3.5)] {
                let wo = outgoing(inclination, azimuth);
                let kernel = surfaces.profile(&bsdf, wo.z as f32).towards(wo.x as f32, wo.y as f32);
                let (mut expected, mut norm_sq, mut left_sq) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
                for ((wi, solid_angle), values) in directions.iter().zip(&values) {
                    let value = bsdf.eval(wo.as_vec3(), wi.as_vec3()).as_dvec3() * wi.z;
                    let series = kernel
                        .coefficients
                        .map(|row| row.iter().zip(values).map(|(k, h)| f64::from(*k) * h).sum::<f64>());
                    expected += value * environment(*wi) * *solid_angle;
                    norm_sq += value * value * *solid_angle;
                    left_sq += (value - DVec3::from(series)).powf(2.0) * *solid_angle;
                }
                let value = light.reflected(&kernel).at(0.0, 0.0).as_dvec3();
                for c in 0..3 {
                    let kernel_left = left_sq[c].sqrt();
                    let interpolated = 0.002 * (norm_sq[c] * light_norm_sq).sqrt();
                    let bound = kernel_left * light_left + interpolated + 1e-5;
                    let error = (value[c] - expected[c]).abs();
                    assert!(error < bound, "{e} {i} {inclination} {c}: {value} {expected} {bound}");
                }
            }
        }
    }
}

#[test]
fn hundreds_of_virtual_lights_are_reflected_as_by_the_brdf() {
    let scene = scene(vec![metal(0.5), rough_plastic(0.35, 0.5)]);
    let materials = Materials::new(&scene);
    let surfaces = MaterialSeries::new(&materials, &SeriesSettings::default());
    for i in 0..2 {
        let id = MaterialId(i);
        let bsdf = materials.at(id, Vec2::ZERO);
        let bands = surfaces.caching(id).bands().unwrap();
        let mut random = Random(11);
        let (mut sum_sq, mut compared) = (0.0, 0);
        for _ in 0..40 {
            // 300 patches in a room, facing every way.
            let mut accumulator = Accumulator::new(bands);
            let mut seen = Vec::new();
            for _ in 0..300 {
                let direction = random.hemisphere();
                let offset = direction * (0.4 + random.next());
                let normal = (random.hemisphere() * 0.9 - direction).normalize();
                let source = LocalVpl::Oriented {
                    offset: offset.as_vec3().to_array(),
                    normal: normal.as_vec3().to_array(),
                };
                let Some(incidence) = source.incidence(1e-6) else { continue };
                let intensity = Rgb::new(1.0, random.next() as f32, 0.2);
                accumulator.add(&incidence, intensity);
                seen.push((incidence, intensity));
            }
            let light = accumulator.finish();
            for inclination in [0.1, 0.5, 0.9, 1.1] {
                let wo = outgoing(inclination, TAU * random.next());
                let expected = seen.iter().fold(DVec3::ZERO, |sum, (incidence, intensity)| {
                    let wi = Vec3::from(incidence.direction);
                    let value = bsdf.eval(wo.as_vec3(), wi) * (wi.z * incidence.factor) * *intensity;
                    sum + value.as_dvec3()
                });
                let kernel = surfaces.profile(&bsdf, wo.z as f32).towards(wo.x as f32, wo.y as f32);
                let value = light.reflected(&kernel).at(0.0, 0.0).as_dvec3();
                let error = ((value - expected) / expected).abs().max_element();
                assert!(error < 0.05, "{i} {inclination}: {value} {expected}");
                sum_sq += error * error;
                compared += 1;
            }
        }
        let rms = (sum_sq / f64::from(compared)).sqrt();
        assert!(rms < 0.01, "{i}: {rms}");
    }
}

#[test]
fn each_material_gets_the_records_it_needs() {
    let smooth = Lobe::Mirror { fresnel: Fresnel::Dielectric(1.5), scale: constant(1.0) };
    let plastic =
        Material { coat: Some(Coat { eta: 1.5, nonlinear: false }), lobes: vec![smooth], ..lambert(0.5) };
    let mut dull = metal(0.5);
    if let [Lobe::Rough { scale, .. }] = &mut dull.lobes[..] {
        *scale = constant(0.0);
    }
    let list = [
        (lambert(0.7), Some(Caching::Irradiance)),
        (plastic, Some(Caching::Irradiance)),
        (Material { lobes: vec![smooth], ..lambert(0.0) }, Some(Caching::Irradiance)),
        (dull, Some(Caching::Irradiance)),
        (rough_plastic(0.05, 0.5), Some(Caching::Irradiance)), // the eye pass follows its lobe
        (rough_plastic(0.15, 0.5), Some(Caching::PerSample)),
        (metal(0.2), Some(Caching::PerSample)),
        (metal(0.3), None),
        (metal(0.5), None),
        (metal(0.8), None),
        (rough_plastic(0.35, 0.5), None),
        (rough(0.5, Fresnel::One, 0.4, None), None),
        (principled(0.3, 0.5), None),
    ];
    let scene = scene(list.iter().map(|(m, _)| m.clone()).collect());
    let materials = Materials::new(&scene);
    let settings = SeriesSettings::default();
    let surfaces = MaterialSeries::new(&materials, &settings);
    let mut bands = Vec::new();
    for (i, (_, expected)) in list.iter().enumerate() {
        let id = MaterialId(i as u32);
        match (surfaces.caching(id), expected) {
            (caching, Some(expected)) => assert_eq!(caching, *expected, "{i}"),
            (Caching::Series(n), None) => bands.push(n),
            (other, None) => panic!("{i}: {other:?}"),
        }
    }
    // Rougher surfaces need fewer bands, as do those with a base beside the lobe.
    assert!(bands[0] >= bands[1] && bands[1] > bands[2] && bands[4] <= bands[1], "{bands:?}");
    // One table serves the lobe of α = 0.5 with and without a base; four are of the principled material's lobes.
    assert_eq!(surfaces.tables(), 8);
    // Bases alone, of irradiance materials too, are reflected as well as a series can.
    let bsdf = materials.at(MaterialId(1), Vec2::ZERO);
    let mut accumulator = Accumulator::new(3);
    let mut expected = 0.0;
    for (wi, solid_angle) in hemisphere() {
        accumulator.add(&from(wi), Rgb::splat(solid_angle as f32));
        expected += f64::from(bsdf.eval(Vec3::Z, wi.as_vec3()).x) * wi.z * solid_angle;
    }
    let value = accumulator.finish().reflected(&surfaces.profile(&bsdf, 1.0).towards(0.0, 0.0)).value.x;
    assert!((f64::from(value) / expected - 1.0).abs() < 1e-3, "{value} {expected}");
}

#[test]
fn textures_scale_base_and_lobe_at_each_point() {
    let textured = Reflectance::Textured { texture: TextureId(0), scale: Rgb::splat(0.8) };
    let mut metal = rough(0.5, GOLD, 0.0, None);
    if let [Lobe::Rough { scale, .. }] = &mut metal.lobes[..] {
        *scale = textured;
    }
    let scene = scene(vec![metal, Material { diffuse: textured, ..rough_plastic(0.4, 0.5) }]);
    let materials = Materials::new(&scene);
    let surfaces = MaterialSeries::new(&materials, &SeriesSettings::default());
    let wo = outgoing(0.6, 0.0);
    for i in 0..2 {
        let id = MaterialId(i);
        let bands = surfaces.caching(id).bands().unwrap();
        let mut accumulator = Accumulator::new(bands);
        let directions = hemisphere();
        for (wi, solid_angle) in &directions {
            accumulator.add(&from(*wi), Rgb::splat((solid_angle / PI) as f32));
        }
        let light = accumulator.finish();
        for u in [0.25, 0.75] {
            let bsdf = materials.at(id, Vec2::new(u, 0.5));
            let expected = directions.iter().fold(DVec3::ZERO, |sum, (wi, solid_angle)| {
                sum + bsdf.eval(wo.as_vec3(), wi.as_vec3()).as_dvec3() * wi.z * *solid_angle / PI
            });
            let kernel = surfaces.profile(&bsdf, wo.z as f32).towards(wo.x as f32, wo.y as f32);
            let value = light.reflected(&kernel).at(0.0, 0.0).as_dvec3();
            let error = (value - expected).abs().max_element();
            assert!(error < 2e-3 * expected.max_element(), "{i} {u}: {value} {expected}");
            assert!((expected.x > expected.y) == (u < 0.5));
        }
    }
}

#[test]
fn tables_are_the_same_for_any_number_of_threads() {
    let scene = scene(expanded());
    let materials = Materials::new(&scene);
    let quadrature = Quadrature::standard();
    let tables = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            (0..scene.materials.len())
                .map(|i| {
                    let lobe = materials.at(MaterialId(i as u32), Vec2::ZERO).dull_lobes().next().unwrap().1;
                    lobe_table::LobeTable::new(lobe, 6, 0.002, &quadrature)
                })
                .collect::<Vec<_>>()
        })
    };
    assert!(tables(1) == tables(3));
}
