//! Coefficients against sums in double precision, finite differences, and rotation of the light summed.

use super::Random;
use super::basis::printed_functions;
use crate::gradient::tests::Exact;
use crate::gradient::{Incidence, LocalVpl};
use crate::hsh::basis::*;
use crate::hsh::kernel::Profile;
use crate::hsh::*;
use base::math::Rgb;
use glam::DVec3;

/// Patches around the receiver, some below its horizon, with their intensities.
fn lights(count: usize) -> Vec<(Exact, Rgb)> {
    let mut random = Random(5);
    let mut light = |i: usize| {
        let direction = random.hemisphere();
        let distance = if i % 5 == 1 { FAR } else { 0.5 + 2.0 * random.next() };
        let mut offset = direction * distance;
        if i % 9 == 8 {
            offset.z = -offset.z;
        }
        let normal = (random.hemisphere() - 2.0 * direction).normalize();
        let intensity = Rgb::new(random.next() as f32, random.next() as f32, random.next() as f32);
        (Exact { offset, normal: (i % 5 > 1).then_some(normal) }, intensity)
    };
    (0..count).map(&mut light).collect()
}

/// Distance of lights that are directional in single precision.
const FAR: f64 = 1e9;

/// Applies `f` to offset and normal.
fn mapped(source: &Exact, f: impl Fn(DVec3) -> DVec3) -> Exact {
    Exact { offset: f(source.offset), normal: source.normal.map(&f) }
}

/// Returns the light in single precision, of intensity 1 at the receiver if it is directional.
fn incidence(source: &Exact) -> Option<Incidence> {
    let vpl = match source.distance() >= 0.5 * FAR {
        true => LocalVpl::Directional { towards: source.direction().as_vec3().to_array() },
        false => source.single(),
    };
    vpl.incidence(1e-12)
}

fn accumulated(bands: usize, lights: &[(Exact, Rgb)]) -> Radiance {
    let mut accumulator = Accumulator::new(bands);
    for (source, intensity) in lights {
        if let Some(incidence) = incidence(source) {
            accumulator.add(&incidence, *intensity);
        }
    }
    accumulator.finish()
}

/// Computes the coefficients by definition, at the record moved by `motion`.
fn by_definition(lights: &[(Exact, Rgb)], motion: DVec3) -> [DVec3; MAX_FUNCTIONS] {
    let mut sums = [DVec3::ZERO; MAX_FUNCTIONS];
    for (source, intensity) in lights {
        let there = Exact { offset: source.offset - motion, ..*source };
        let (direction, factor) = (there.direction(), exact_factor(&there));
        if direction.z > 0.0 && factor > 0.0 {
            let values = printed_functions(direction.to_array());
            for (sum, h) in sums.iter_mut().zip(values) {
                *sum += intensity.as_dvec3() * factor * h;
            }
        }
    }
    sums
}

/// Factor of a light by its definition; 1 for directional lights.
fn exact_factor(source: &Exact) -> f64 {
    if source.distance() >= 0.5 * FAR { 1.0 } else { source.factor() }
}

#[test]
fn coefficients_are_sums_over_lights_and_derivatives_their_differences() {
    let lights = lights(203);
    let step = 1e-4;
    let exact = by_definition(&lights, DVec3::ZERO);
    let differences = [DVec3::X, DVec3::Y].map(|axis| {
        let (there, back) = (by_definition(&lights, axis * step), by_definition(&lights, -axis * step));
        std::array::from_fn::<_, MAX_FUNCTIONS, _>(|k| (there[k] - back[k]) / (2.0 * step))
    });
    let scale = exact[0].max_element();
    for bands in 1..=MAX_BANDS {
        let radiance = accumulated(bands, &lights);
        assert_eq!(radiance.bands(), bands);
        for k in 0..bands * bands {
            let error = (radiance.coefficient(k).as_dvec3() - exact[k]).abs().max_element();
            assert!(error < 2e-6 * scale, "{bands} {k}: {error:e}");
            for (derivative, difference) in radiance.derivatives(k).iter().zip(&differences) {
                let error = (derivative.as_dvec3() - difference[k]).abs().max_element();
                assert!(error < 5e-6 * scale * MAX_BANDS as f64, "{bands} {k}: {error:e}");
            }
        }
    }
}

#[test]
fn an_accumulator_begins_anew() {
    let lights = lights(21);
    let first = accumulated(5, &lights);
    let mut accumulator = Accumulator::new(8);
    for round in 0..2 {
        for (source, intensity) in &lights {
            if let Some(incidence) = incidence(source) {
                accumulator.add(&incidence, *intensity);
            }
        }
        if round == 0 {
            accumulator.reset(5);
        }
    }
    assert_eq!(accumulator.finish(), first);
    assert_eq!(accumulator.finish(), Radiance::black(5));
}

#[test]
fn two_bands_hold_the_irradiance_exactly() {
    let lights = lights(100);
    let (mut value, mut gradient) = (DVec3::ZERO, [DVec3::ZERO; 2]);
    for (source, intensity) in &lights {
        let Some(incidence) = incidence(source) else { continue };
        let irradiance = incidence.irradiance();
        value += intensity.as_dvec3() * f64::from(irradiance.value.z);
        for axis in 0..2 {
            gradient[axis] += intensity.as_dvec3() * f64::from(irradiance.gradient[axis].z);
        }
    }
    for bands in 2..=MAX_BANDS {
        let irradiance = accumulated(bands, &lights).irradiance();
        assert!((irradiance.value.as_dvec3() / value - 1.0).abs().max_element() < 2e-6);
        for axis in 0..2 {
            let error = irradiance.gradient[axis].as_dvec3() - gradient[axis];
            assert!(error.abs().max_element() < 1e-5 * value.max_element(), "{axis} {error}");
        }
    }
}

#[test]
fn turning_the_frame_turns_the_light() {
    let lights = lights(60);
    for angle in [0.0f64, 0.3, 1.9, -2.5] {
        // A rotation of the axes rotates everything the other way relative to them.
        let (sin, cos) = angle.sin_cos();
        let turn = |v: DVec3| DVec3::new(cos * v.x + sin * v.y, cos * v.y - sin * v.x, v.z);
        let there: Vec<_> = lights.iter().map(|(s, i)| (mapped(s, turn), *i)).collect();
        for bands in [1, 2, 5, 8] {
            let turned = accumulated(bands, &lights).turned(angle as f32);
            let expected = accumulated(bands, &there);
            for k in 0..bands * bands {
                assert!((turned.coefficient(k) - expected.coefficient(k)).abs().max_element() < 4e-4);
                for (a, b) in turned.derivatives(k).iter().zip(expected.derivatives(k)) {
                    assert!((*a - b).abs().max_element() < 2e-3, "{angle} {bands} {k}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn a_kernel_may_be_turned_instead_of_the_light() {
    let mut random = Random(9);
    let mut profile = Profile { coefficients: [[0.0; MAX_FUNCTIONS]; 3] };
    for row in &mut profile.coefficients {
        let mut even = [0.0; kernel::MAX_EVEN];
        even[..kernel::even_index(7, 0)].fill_with(|| random.next() - 0.5);
        *row = kernel::repeated(&even);
    }
    let lights = lights(60);
    for bands in [3, 7, 8] {
        let radiance = accumulated(bands, &lights);
        for angle in [0.0f32, 0.7, 3.0, -1.2] {
            let (sin, cos) = angle.sin_cos();
            let one_way = radiance.reflected(&profile.towards(3.0 * cos, 3.0 * sin));
            let other_way = radiance.turned(angle).reflected(&profile.towards(1.0, 0.0));
            assert!((one_way.value - other_way.value).abs().max_element() < 2e-3, "{bands} {angle}");
            // Derivatives are along the axes of each frame.
            let [u, v] = other_way.gradient;
            let along_u = cos * u - sin * v;
            assert!((one_way.gradient[0] - along_u).abs().max_element() < 1e-2, "{bands} {angle}");
            let at = one_way.at(0.1, 0.2);
            let linear = one_way.value + 0.1 * one_way.gradient[0] + 0.2 * one_way.gradient[1];
            assert_eq!(at, linear.max(Rgb::ZERO));
        }
    }
}
