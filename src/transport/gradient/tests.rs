//! Derivatives against finite differences in double precision and against the paper's formula.

use super::*;
use crate::lights::{LightTrees, LobeProfile, Profiles, SpotProfile, Vpl, VplKind};
use base::math::Frame;
use base::progress::Control;
use glam::{DVec3, Vec3};
use std::f64::consts::TAU;

/// Irradiance as a vector: its scalar product with a normal is the irradiance of that surface, as long as all the
/// light is above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IrradianceVector {
    /// In the record's frame; z is the irradiance of the surface itself.
    pub value: Vec3,
    /// Derivatives of `value` along u and v.
    pub gradient: [Vec3; 2],
}

impl Incidence {
    /// Returns the irradiance vector; zero if the light comes from below.
    pub fn irradiance(&self) -> IrradianceVector {
        if !(self.direction[2] > 0.0) {
            return IrradianceVector { value: Vec3::ZERO, gradient: [Vec3::ZERO; 2] };
        }
        let direction = Vec3::from(self.direction);
        let along =
            |axis: usize| self.gradient[axis] * direction + self.factor * Vec3::from(self.turning(axis));
        IrradianceVector { value: direction * self.factor, gradient: [along(0), along(1)] }
    }
}

/// A light at a finite distance by its definition, in double precision.
#[derive(Clone, Copy, Debug)]
pub struct Exact {
    pub offset: DVec3,
    /// Normal of oriented lights.
    pub normal: Option<DVec3>,
}

impl Exact {
    pub fn distance(&self) -> f64 {
        self.offset.length()
    }

    pub fn direction(&self) -> DVec3 {
        self.offset / self.distance()
    }

    /// Cosine at the emitter over squared distance; negative behind the light.
    pub fn factor(&self) -> f64 {
        self.normal.map_or(1.0, |normal| -normal.dot(self.direction())) / self.offset.length_squared()
    }

    pub fn irradiance(&self) -> DVec3 {
        self.factor() * self.direction()
    }

    /// Returns the light relative to the receiver moved along `axis`.
    pub fn moved(&self, axis: usize, by: f64) -> Exact {
        Exact { offset: self.offset - DVec3::AXES[axis] * by, ..*self }
    }

    /// Returns the light in single precision.
    pub fn single(&self) -> LocalVpl {
        let offset = self.offset.as_vec3().to_array();
        match self.normal {
            Some(normal) => LocalVpl::Oriented { offset, normal: normal.as_vec3().to_array() },
            None => LocalVpl::Omni { offset },
        }
    }
}

const NEVER: f32 = 1e-30;

/// Rounding in single precision: value, first and second derivatives.
const ROUNDING: f64 = 4e-6;

/// Offsets all over the hemisphere, from the horizon to the pole, near and far.
fn offsets() -> Vec<DVec3> {
    let mut all = Vec::new();
    for z in [1e-9, 1e-6, 1e-3, 0.05, 0.3, 0.6, 0.9, 0.999, 1.0 - 1e-9, 1.0] {
        for j in 0..12 {
            let (sin, cos) = (f64::from(j) * TAU / 12.0 + 0.05).sin_cos();
            let r = f64::sqrt((1.0 - z) * (1.0 + z));
            let distance = [0.02, 1.0, 300.0][j as usize % 3];
            all.push(DVec3::new(r * cos, r * sin, z) * distance);
        }
    }
    all
}

/// Lights at every offset; oriented ones turned away from the receiver by several angles, up to grazing. They are
/// rounded to single precision, so that only the arithmetic differs.
fn sources() -> Vec<Exact> {
    let rounded = |v: DVec3| v.as_vec3().as_dvec3();
    let mut all = Vec::new();
    for offset in offsets() {
        all.push(Exact { offset: rounded(offset), normal: None });
        let (facing, side) = (-offset.normalize(), offset.normalize().any_orthonormal_vector());
        for angle in [0.0, 0.4, 1.0, 1.5, 1.57] {
            for sign in [-1.0, 1.0] {
                let normal = facing * f64::cos(angle) + side * (sign * f64::sin(angle));
                all.push(Exact { offset: rounded(offset), normal: Some(rounded(normal)) });
            }
        }
    }
    all
}

/// Derivative of `f` of the light along `axis`, by finite differences of fourth order.
fn difference(source: &Exact, axis: usize, f: impl Fn(&Exact) -> DVec3) -> DVec3 {
    let step = 3e-4 * source.distance();
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|by| f(&source.moved(axis, by * step)));
    (a - 8.0 * b + 8.0 * c - d) / (12.0 * step)
}

/// Asserts that `value` is `expected` but for rounding of numbers of the magnitude `scale`.
fn assert_close(value: f32, expected: f64, scale: f64, what: &str, source: &Exact) {
    let error = (f64::from(value) - expected).abs() / scale;
    assert!(error < ROUNDING, "{what} {source:?}: {value} {expected} {error:e}");
}

/// True if all steps stay on the lit side of the light.
fn lit_around(source: &Exact) -> bool {
    let reach = 1e-3 * source.distance();
    (0..2).all(|axis| [-reach, reach].iter().all(|by| source.moved(axis, *by).factor() > 0.0))
}

#[test]
fn gradients_agree_with_finite_differences() {
    let mut compared = 0;
    for source in sources().iter().filter(|s| lit_around(s)) {
        let incidence = source.single().incidence(NEVER).unwrap();
        let irradiance = incidence.irradiance();
        let r = source.distance();
        assert_close(incidence.factor, source.factor(), r.powi(-2), "value", source);
        for axis in 0..2 {
            let factor = difference(source, axis, |s| DVec3::splat(s.factor())).x;
            assert_close(incidence.gradient[axis], factor, r.powi(-3), "factor", source);
            let vector = difference(source, axis, Exact::irradiance);
            let direction = difference(source, axis, Exact::direction);
            for i in 0..3 {
                // The vertical component is proportional to the height.
                let scale = if i == 2 { source.direction().z } else { 1.0 } * 2.0 * r.powi(-3);
                assert_close(irradiance.gradient[axis][i], vector[i], scale, "irradiance", source);
                assert_close(incidence.turning(axis)[i], direction[i], 1.0 / r, "direction", source);
            }
        }
        compared += 1;
    }
    assert!(compared > 1000, "{compared}");
}

#[test]
fn the_hessian_agrees_with_finite_differences_of_the_gradient() {
    for source in sources().iter().filter(|s| lit_around(s)) {
        let [uu, uv, vv] = source.single().irradiance_hessian(NEVER);
        let gradient = |s: &Exact| DVec3::new(printed_gradient(s, 0), printed_gradient(s, 1), 0.0);
        let (d_u, d_v) = (difference(source, 0, gradient), difference(source, 1, gradient));
        let scale = source.direction().z * 10.0 * source.distance().powi(-4);
        for (value, expected, what) in
            [(uu, d_u.x, "uu"), (uv, d_u.y, "uv"), (uv, d_v.x, "vu"), (vv, d_v.y, "vv")]
        {
            assert_close(value, expected, scale, what, source);
        }
    }
}

/// Derivative of the irradiance by the paper's equation 9, and by that for lights without a normal.
fn printed_gradient(source: &Exact, axis: usize) -> f64 {
    let (length, offset) = (source.distance(), source.offset);
    match source.normal {
        Some(normal) => {
            let cos_y = -normal.dot(source.direction());
            offset.z * (normal[axis] * length + 4.0 * offset[axis] * cos_y) / length.powi(5)
        }
        None => 3.0 * offset.z * offset[axis] / length.powi(5),
    }
}

#[test]
fn the_gradient_of_irradiance_is_the_one_printed_in_the_paper() {
    for source in sources() {
        let Some(incidence) = source.single().incidence(NEVER) else { continue };
        for axis in 0..2 {
            let value = incidence.irradiance().gradient[axis].z;
            let scale = source.direction().z * 2.0 * source.distance().powi(-3);
            assert_close(value, printed_gradient(&source, axis), scale, "printed", &source);
        }
    }
}

#[test]
fn single_precision_holds_at_every_scale() {
    for scale in [1e-6, 1e6] {
        for source in sources() {
            let at = |scale: f64| Exact { offset: source.offset * scale, ..source }.single();
            let (Some(one), Some(a)) = (at(1.0).incidence(NEVER), at(scale).incidence(NEVER)) else {
                continue;
            };
            let r = source.distance();
            let near = |a: f32, b: f32, power: i32| {
                (f64::from(a) * scale.powi(power) - f64::from(b)).abs() < 20.0 * ROUNDING * r.powi(-power)
            };
            assert!(near(a.factor, one.factor, 2));
            let (there, here) = (at(scale).irradiance_hessian(NEVER), at(1.0).irradiance_hessian(NEVER));
            assert!((0..3).all(|i| near(there[i], here[i], 4)), "{source:?} {there:?} {here:?}");
            assert!((0..2).all(|axis| near(a.gradient[axis], one.gradient[axis], 3)));
        }
    }
}

#[test]
fn what_is_clamped_does_not_change_with_the_receiver() {
    let source = LocalVpl::Oriented { offset: [0.02, 0.0, 0.01], normal: [0.0, 0.0, -1.0] };
    let near = source.incidence(0.01).unwrap();
    assert_eq!((near.inv_dist, near.gradient), (0.0, [0.0; 2]));
    assert!((near.factor - near.direction[2] / 0.01).abs() < 1e-4);
    assert_eq!(near.irradiance().gradient, [Vec3::ZERO; 2]);
    assert_eq!(source.irradiance_hessian(0.01), [0.0; 3]);
    let free = source.incidence(NEVER).unwrap();
    let held = free.held(0.25);
    assert_eq!((held.inv_dist, held.gradient, held.factor), (0.0, [0.0; 2], 0.25 * free.factor));
}

#[test]
fn lights_that_cannot_be_seen_give_nothing() {
    let dark = |s: LocalVpl| s.incidence(NEVER).is_none() && s.irradiance_hessian(NEVER) == [0.0; 3];
    assert!(dark(LocalVpl::Omni { offset: [0.0; 3] }));
    assert!(dark(LocalVpl::Omni { offset: [f32::NAN; 3] }));
    assert!(dark(LocalVpl::Oriented { offset: [0.0, 0.3, 1.0], normal: [0.0, 0.0, 1.0] }));
    let below = LocalVpl::Omni { offset: [0.4, 0.3, -1.0] };
    assert_eq!(below.incidence(NEVER).unwrap().irradiance().value, Vec3::ZERO);
    assert_eq!(below.irradiance_hessian(NEVER), [0.0; 3]);
    let sun = LocalVpl::Directional { towards: [0.6, 0.0, 0.8] };
    let incidence = sun.incidence(NEVER).unwrap();
    assert_eq!(incidence.irradiance().value, Vec3::new(0.6, 0.0, 0.8));
    assert_eq!(incidence.irradiance().gradient, [Vec3::ZERO; 2]);
    assert_eq!(sun.irradiance_hessian(NEVER), [0.0; 3]);
}

#[test]
fn virtual_lights_arrive_as_the_lightcut_counts_them() {
    let frame = Frame::from_normal(Vec3::new(0.3, -0.5, 0.8).normalize());
    let position = Vec3::new(1.0, 2.0, 3.0);
    let spot = SpotProfile::Cone {
        direction: Vec3::new(-0.2, 0.1, -1.0).normalize(),
        inner_angle: 0.3,
        outer_angle: 0.8,
    };
    let light = position + Vec3::new(0.4, 0.3, 1.5);
    let lobe = LobeProfile {
        normal: Vec3::new(0.3, 0.2, -1.0).normalize(),
        towards_light: Vec3::new(0.2, 0.7, -0.6).normalize(),
        ..crate::lightcut::fixtures::profiles().lobes[0]
    };
    let profiles = Profiles { spots: vec![spot], lobes: vec![lobe] };
    let at = |vpl: &Vpl, kind, x| Incidence::of_vpl(&frame, x, vpl, kind, &profiles, 1e-12);
    let trees = LightTrees::build(&[], profiles.clone(), 1.0, &Control::new());
    let transfer =
        crate::lightcut::Transfer { min_dist_sq: 1e-12, ..crate::lightcut::Transfer::new(&trees, 1.0) };
    for (vpl, kind) in [
        (Vpl::oriented(light, Vec3::new(0.1, 0.2, -1.0).normalize()), VplKind::Oriented),
        (Vpl::omni(light), VplKind::Omni),
        (Vpl::spot(light, 0), VplKind::Omni),
        (Vpl::directional(Vec3::new(0.5, 0.0, 1.0).normalize()), VplKind::Directional),
        (Vpl::lobed(light, 0), VplKind::Lobed),
    ] {
        let receiver = crate::lightcut::Receiver::irradiance(position, frame.normal, &frame);
        let incidence = at(&vpl, kind, position).unwrap();
        let irradiance = incidence.irradiance();
        let expected = transfer.unshadowed(&receiver, &vpl, kind).x;
        assert!((irradiance.value[2] / expected - 1.0).abs() < 1e-5, "{kind:?}");
        for (axis, tangent) in [frame.tangent, frame.bitangent].into_iter().enumerate() {
            let step = 0.01;
            let there = |by: f32| at(&vpl, kind, position + by * tangent).unwrap().factor;
            let difference = (there(step) - there(-step)) / (2.0 * step);
            let error = (incidence.gradient[axis] - difference).abs();
            assert!(error < 2e-3 * incidence.factor, "{kind:?} {axis}: {incidence:?} {difference}");
        }
    }
    // Outside the cone.
    let outside =
        Incidence::of_vpl(&frame, light + Vec3::Z, &Vpl::spot(light, 0), VplKind::Omni, &profiles, 0.0);
    assert!(outside.is_none());
}
