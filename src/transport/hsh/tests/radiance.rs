//! Coefficients against sums in double precision, finite differences, and rotation of the light summed.

use super::Random;
use crate::gradient::LocalVpl;
use crate::hsh::basis::*;
use crate::hsh::kernel::Profile;
use crate::hsh::*;
use base::math::Rgb;
use glam::DVec3;

/// Patches around the receiver, some below its horizon, with their intensities.
fn lights(count: usize) -> Vec<(LocalVpl<f64>, Rgb)> {
    let mut random = Random(5);
    let mut light = |i: usize| {
        let direction = random.hemisphere();
        let mut offset = direction * (0.5 + 2.0 * random.next());
        if i % 9 == 8 {
            offset.z = -offset.z;
        }
        let normal = (random.hemisphere() - 2.0 * direction).normalize();
        let intensity = Rgb::new(random.next() as f32, random.next() as f32, random.next() as f32);
        let source = match i % 5 {
            0 => LocalVpl::Omni { offset: offset.to_array() },
            1 => LocalVpl::Directional { towards: direction.to_array() },
            _ => LocalVpl::Oriented { offset: offset.to_array(), normal: normal.to_array() },
        };
        (source, intensity)
    };
    (0..count).map(&mut light).collect()
}

/// Applies `f` to every offset, direction and normal.
fn mapped(source: &LocalVpl<f64>, offset_by: DVec3, f: impl Fn(DVec3) -> DVec3) -> LocalVpl<f64> {
    let apply = |v: [f64; 3], by: DVec3| f(DVec3::from(v) + by).to_array();
    match *source {
        LocalVpl::Oriented { offset, normal } => {
            LocalVpl::Oriented { offset: apply(offset, offset_by), normal: apply(normal, DVec3::ZERO) }
        }
        LocalVpl::Omni { offset } => LocalVpl::Omni { offset: apply(offset, offset_by) },
        LocalVpl::Directional { towards } => LocalVpl::Directional { towards: apply(towards, DVec3::ZERO) },
    }
}

fn single(source: &LocalVpl<f64>) -> LocalVpl<f32> {
    let round = |v: [f64; 3]| v.map(|c| c as f32);
    match *source {
        LocalVpl::Oriented { offset, normal } => {
            LocalVpl::Oriented { offset: round(offset), normal: round(normal) }
        }
        LocalVpl::Omni { offset } => LocalVpl::Omni { offset: round(offset) },
        LocalVpl::Directional { towards } => LocalVpl::Directional { towards: round(towards) },
    }
}

fn accumulated(bands: usize, lights: &[(LocalVpl<f64>, Rgb)]) -> Radiance {
    let mut accumulator = Accumulator::new(bands);
    for (source, intensity) in lights {
        if let Some(incidence) = single(source).incidence(1e-12) {
            accumulator.add(&incidence, *intensity);
        }
    }
    accumulator.finish()
}

/// Computes the coefficients by definition, at the record moved by `motion`.
fn by_definition(lights: &[(LocalVpl<f64>, Rgb)], motion: DVec3) -> [DVec3; MAX_FUNCTIONS] {
    let mut sums = [DVec3::ZERO; MAX_FUNCTIONS];
    for (source, intensity) in lights {
        let Some(incidence) = mapped(source, -motion, |v| v).incidence(1e-12) else { continue };
        if incidence.direction[2] > 0.0 {
            let values = evaluate(MAX_BANDS, incidence.direction);
            for (sum, h) in sums.iter_mut().zip(values) {
                *sum += intensity.as_dvec3() * incidence.factor * h;
            }
        }
    }
    sums
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
            if let Some(incidence) = single(source).incidence(1e-12) {
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
        let Some(incidence) = source.incidence(1e-12) else { continue };
        let irradiance = incidence.irradiance();
        value += intensity.as_dvec3() * irradiance.value[2];
        for axis in 0..2 {
            gradient[axis] += intensity.as_dvec3() * irradiance.gradient[axis][2];
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
        let there: Vec<_> = lights.iter().map(|(s, i)| (mapped(s, DVec3::ZERO, turn), *i)).collect();
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
