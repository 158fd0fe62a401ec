//! Derivatives against finite differences and against the paper's formula.

use super::*;
use crate::lights::{Family, LightTrees, LobeProfile, Profiles, SpotProfile, Vpl, VplKind};
use base::math::{Frame, Real};
use base::progress::Control;
use glam::{DVec3, Vec3};
use std::f64::consts::TAU;

/// Irradiance as a vector: its scalar product with a normal is the irradiance of that surface, as long as all the
/// light is above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IrradianceVector<T> {
    /// In the record's frame; z is the irradiance of the surface itself.
    pub value: [T; 3],
    /// Derivatives of `value` along u and v.
    pub gradient: [[T; 3]; 2],
}

impl<T: Real + PartialOrd> Incidence<T> {
    /// The irradiance vector; zero if the light comes from below.
    #[inline]
    pub fn irradiance(&self) -> IrradianceVector<T> {
        let zero = T::of(0.0);
        if !(self.direction[2] > zero) {
            return IrradianceVector { value: [zero; 3], gradient: [[zero; 3]; 2] };
        }
        let along = |axis: usize| {
            let turning = self.turning(axis);
            std::array::from_fn(|i| self.gradient[axis] * self.direction[i] + self.factor * turning[i])
        };
        IrradianceVector { value: self.direction.map(|c| c * self.factor), gradient: [along(0), along(1)] }
    }
}

const NEVER: f64 = 1e-30;

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

/// Lights at every offset; oriented ones turned away from the receiver by several angles, up to grazing.
fn sources() -> Vec<LocalVpl<f64>> {
    let mut all = Vec::new();
    for offset in offsets() {
        all.push(LocalVpl::Omni { offset: offset.to_array() });
        let (facing, side) = (-offset.normalize(), offset.normalize().any_orthonormal_vector());
        for angle in [0.0, 0.4, 1.0, 1.5, 1.57] {
            for sign in [-1.0, 1.0] {
                let normal = facing * f64::cos(angle) + side * (sign * f64::sin(angle));
                all.push(LocalVpl::Oriented { offset: offset.to_array(), normal: normal.to_array() });
            }
        }
    }
    all
}

fn distance(source: &LocalVpl<f64>) -> f64 {
    match *source {
        LocalVpl::Oriented { offset, .. } | LocalVpl::Omni { offset } => DVec3::from(offset).length(),
        LocalVpl::Directional { .. } => 1.0,
    }
}

/// Returns the light relative to the moved receiver.
fn moved(source: &LocalVpl<f64>, axis: usize, by: f64) -> LocalVpl<f64> {
    let mut source = *source;
    match &mut source {
        LocalVpl::Oriented { offset, .. } | LocalVpl::Omni { offset } => offset[axis] -= by,
        LocalVpl::Directional { .. } => {}
    }
    source
}

/// Derivative of `f` of the light along `axis`, by finite differences of fourth order.
fn difference<const N: usize>(
    source: &LocalVpl<f64>,
    axis: usize,
    f: impl Fn(&LocalVpl<f64>) -> [f64; N],
) -> [f64; N] {
    let step = 3e-4 * distance(source);
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|by| f(&moved(source, axis, by * step)));
    std::array::from_fn(|i| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * step))
}

/// Asserts that `value` is within 1e-6 of `expected`, relative to it or to `scale`, its typical magnitude.
fn assert_close(value: f64, expected: f64, scale: f64, what: &str, source: &LocalVpl<f64>) {
    let error = (value - expected).abs() / expected.abs().max(1e-3 * scale);
    assert!(error < 1e-6, "{what} {source:?}: {value} {expected} {error:e}");
}

/// True if all steps stay on the lit side of the light.
fn lit_around(source: &LocalVpl<f64>) -> bool {
    let reach = 1e-3 * distance(source);
    (0..2).all(|axis| [-reach, reach].iter().all(|by| moved(source, axis, *by).incidence(NEVER).is_some()))
}

#[test]
fn gradients_agree_with_finite_differences() {
    let mut compared = 0;
    for source in sources().iter().filter(|s| lit_around(s)) {
        let incidence = source.incidence(NEVER).unwrap();
        let irradiance = incidence.irradiance();
        let r = distance(source);
        for axis in 0..2 {
            let [factor] = difference(source, axis, |s| [s.incidence(NEVER).unwrap().factor]);
            assert_close(incidence.gradient[axis], factor, r.powi(-3), "factor", source);
            let vector = difference(source, axis, |s| s.incidence(NEVER).unwrap().irradiance().value);
            for i in 0..3 {
                // The vertical component is proportional to the height.
                let scale = if i == 2 { incidence.direction[2] } else { 1.0 } * r.powi(-3);
                assert_close(irradiance.gradient[axis][i], vector[i], scale, "irradiance", source);
            }
            let direction = difference(source, axis, |s| s.incidence(NEVER).unwrap().direction);
            for i in 0..3 {
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
        let [uu, uv, vv] = source.irradiance_hessian(NEVER);
        let gradient = |s: &LocalVpl<f64>| s.incidence(NEVER).unwrap().irradiance().gradient.map(|g| g[2]);
        let [d_uu, d_uv] = difference(source, 0, gradient);
        let [d_vu, d_vv] = difference(source, 1, gradient);
        let scale = source.incidence(NEVER).unwrap().direction[2] * distance(source).powi(-4);
        for (value, expected, what) in
            [(uu, d_uu, "uu"), (uv, d_uv, "uv"), (uv, d_vu, "vu"), (vv, d_vv, "vv")]
        {
            assert_close(value, expected, scale, what, source);
        }
    }
}

#[test]
fn the_gradient_of_irradiance_is_the_one_printed_in_the_paper() {
    for source in sources() {
        let (offset, normal) = match source {
            LocalVpl::Oriented { offset, normal } => (offset, normal),
            _ => continue,
        };
        let Some(incidence) = source.incidence(NEVER) else { continue };
        let length = DVec3::from(offset).length();
        let cos_y = -DVec3::from(normal).dot(DVec3::from(offset)) / length;
        for axis in 0..2 {
            // Equation 9
            let printed = offset[2] * (normal[axis] * length + 4.0 * offset[axis] * cos_y) / length.powi(5);
            let value = incidence.irradiance().gradient[axis][2];
            assert_close(value, printed, incidence.direction[2] * length.powi(-3), "printed", &source);
        }
    }
}

#[test]
fn single_precision_holds_at_every_scale() {
    for scale in [1e-6, 1.0, 1e6] {
        for source in sources() {
            let LocalVpl::Oriented { offset, normal } = source else { continue };
            // Rounded first, so that only the arithmetic differs.
            let (offset, normal) = (offset.map(|c| (c * scale) as f32), normal.map(|c| c as f32));
            let single = LocalVpl::Oriented { offset, normal };
            let double = LocalVpl::Oriented { offset: offset.map(f64::from), normal: normal.map(f64::from) };
            let (Some(a), Some(b)) = (single.incidence(1e-30), double.incidence(NEVER)) else { continue };
            let r = distance(&double);
            let near = |a: f32, b: f64, size: f64| (f64::from(a) - b).abs() < 4e-6 * size;
            assert!(near(a.factor, b.factor, r.powi(-2)));
            let (hessian, exact) = (single.irradiance_hessian(1e-30), double.irradiance_hessian(NEVER));
            for i in 0..3 {
                assert!(near(hessian[i], exact[i], 10.0 * r.powi(-4)), "{single:?} {hessian:?} {exact:?}");
            }
            for axis in 0..2 {
                assert!(near(a.gradient[axis], b.gradient[axis], r.powi(-3)));
                for i in 0..3 {
                    let (a, b) = (a.irradiance().gradient[axis][i], b.irradiance().gradient[axis][i]);
                    assert!(near(a, b, 2.0 * r.powi(-3)), "{a} {b}");
                }
            }
        }
    }
}

#[test]
fn what_is_clamped_does_not_change_with_the_receiver() {
    let source = LocalVpl::<f64>::Oriented { offset: [0.02, 0.0, 0.01], normal: [0.0, 0.0, -1.0] };
    let near = source.incidence(0.01).unwrap();
    assert_eq!((near.inv_dist, near.gradient), (0.0, [0.0; 2]));
    assert!((near.factor - near.direction[2] / 0.01).abs() < 1e-12);
    assert_eq!(near.irradiance().gradient, [[0.0; 3]; 2]);
    assert_eq!(source.irradiance_hessian(0.01), [0.0; 3]);
    let free = source.incidence(NEVER).unwrap();
    let held = free.held(0.25);
    assert_eq!((held.inv_dist, held.gradient, held.factor), (0.0, [0.0; 2], 0.25 * free.factor));
}

#[test]
fn lights_that_cannot_be_seen_give_nothing() {
    let dark = |s: LocalVpl<f64>| s.incidence(NEVER).is_none() && s.irradiance_hessian(NEVER) == [0.0; 3];
    assert!(dark(LocalVpl::Omni { offset: [0.0; 3] }));
    assert!(dark(LocalVpl::Omni { offset: [f64::NAN; 3] }));
    assert!(dark(LocalVpl::Oriented { offset: [0.0, 0.3, 1.0], normal: [0.0, 0.0, 1.0] }));
    let below = LocalVpl::Omni { offset: [0.4, 0.3, -1.0] };
    assert_eq!(below.incidence(NEVER).unwrap().irradiance().value, [0.0; 3]);
    assert_eq!(below.irradiance_hessian(NEVER), [0.0; 3]);
    let sun = LocalVpl::Directional { towards: [0.6, 0.0, 0.8] };
    let incidence = sun.incidence(NEVER).unwrap();
    assert_eq!(incidence.irradiance().value, [0.6, 0.0, 0.8]);
    assert_eq!(incidence.irradiance().gradient, [[0.0; 3]; 2]);
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
    let trees = LightTrees::build(&[], profiles.clone(), 1.0, Family::default(), &Control::new());
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
