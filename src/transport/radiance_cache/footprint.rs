//! Footprint of a record: its size, aspect and orientation.
//!
//! Paper: Herzog et al. 2009, section 5.1, Eqs. 11 and 12 (circles, and ellipses from gradients); Schwarzhaupt et
//! al. 2012 (ellipses from second derivatives that include occlusion); Krivanek et al., *Making Radiance and Irradiance
//! Caching Practical*, 2006 (footprints end before geometry that the rays of a record may miss).
//!
//! Units: metres.
//!
//! Deviations: footprints from second derivatives are at most twice as long as wide, footprints from gradients about
//! eleven times (1/0.3²). Geometry near a record is found at the frame's shading points, not by the rays of
//! neighbouring records.

use super::cells::Candidate;
use super::settings::{CacheSettings, Footprints};
use crate::lights::Origin;
use base::math::Frame;
use glam::{Mat3, Vec3};
use serde::{Deserialize, Serialize};

/// Factor by which a footprint is shorter along the normal than along its shorter axis.
const NORMAL_SCALE: f32 = 5.0;

/// Minimum ratio of the radius along the gradient to that of the circle of equal area.
const MIN_SQUEEZE: f32 = 0.3;

/// Maximum ratio of the radius to the distance of the nearest point that rises from the surface. Low, near geometry
/// casts shadows that the rays of a record miss.
const CLEARANCE: f32 = 0.7;

/// Maximum ratio of the axes of footprints from second derivatives.
const MAX_ASPECT: f32 = 2.0;

/// Ellipse within which a record is used.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Footprint {
    /// Unit tangent axes.
    pub axes: [Vec3; 2],
    /// Radius along each axis.
    pub radii: [f32; 2],
    /// Radius along each axis without the minimum set by the spacing of eye samples.
    pub unraised: [f32; 2],
}

/// Derivatives of the irradiance over the surface.
#[derive(Clone, Copy, Debug)]
pub struct Derivatives {
    /// Gradient per channel (columns) due to moving edges, in world space.
    pub edge_gradient: Mat3,
    /// Unit tangent axes: along the largest second derivative, and across it.
    pub axes: [Vec3; 2],
    /// Absolute second derivatives of the luminance along them.
    pub curvature: [f32; 2],
}

/// Bounds of a footprint, from the settings of its layer and its surroundings.
#[derive(Clone, Copy, Debug)]
pub struct FootprintLimits<'a> {
    /// Settings of the cache.
    pub settings: &'a CacheSettings,
    /// Radius relative to `distance`: the paper's a.
    pub accuracy: f32,
    /// Distance of the geometry that sends or blocks light.
    pub distance: f32,
    /// Minimum and maximum radius.
    pub radii: [f32; 2],
}

impl<'a> FootprintLimits<'a> {
    /// Returns the bounds for a record of light of `origin` at `candidate`. Geometry at `distance` sends or blocks the
    /// light.
    pub fn new(settings: &'a CacheSettings, origin: Origin, candidate: &Candidate, distance: f32) -> Self {
        let [min, max] = settings.reach[origin as usize].map(|r| r * candidate.spacing);
        let radii = [min, max.min(CLEARANCE * candidate.clearance).max(min)];
        FootprintLimits { settings, accuracy: settings.accuracy[origin as usize], distance, radii }
    }
}

impl Footprint {
    /// Returns the ellipse from second derivatives. At its edge they change the luminance by half the square of the
    /// accuracy, relative to it. Radii do not exceed the accuracy times the distance, nor the longer one `MAX_ASPECT`
    /// times the shorter.
    pub fn from_hessian(light: &Derivatives, luminance: f32, limits: &FootprintLimits) -> Footprint {
        let FootprintLimits { accuracy, distance, radii: [min, max], .. } = *limits;
        let furthest = accuracy * distance;
        let radius = |curvature: f32| {
            let inverse_sq = curvature / (luminance.max(f32::MIN_POSITIVE) * accuracy * accuracy);
            1.0 / (inverse_sq + 1.0 / (furthest * furthest)).sqrt()
        };
        let [short, long] = light.curvature.map(radius);
        let unraised = [short, long.min(MAX_ASPECT * short)];
        let short = within(short, [min, max]);
        let long = within(long.min(MAX_ASPECT * short), [short, max]);
        Footprint { axes: light.axes, radii: [short, long], unraised }
    }

    /// Returns the ellipse from gradients, short along the gradient of the luminance. Its area is that of a circle
    /// whose radius is the accuracy times the distance. It is a circle unless footprints are anisotropic.
    pub fn from_gradient(
        normal: Vec3,
        gradient: Vec3,
        luminance: f32,
        limits: &FootprintLimits,
    ) -> Footprint {
        let FootprintLimits { settings, accuracy, distance, radii: [min, max] } = *limits;
        let unraised = accuracy * distance;
        let radius = within(unraised, [min, max]);
        let change = radius * gradient.length() / luminance.max(f32::MIN_POSITIVE);
        let (axis, squeeze) = match gradient.try_normalize() {
            Some(axis) if settings.footprints == Footprints::Anisotropic => {
                let relative = change / settings.mu;
                (axis, (1.0 / (1.0 + relative * relative)).max(MIN_SQUEEZE))
            }
            _ => (Frame::from_normal(normal).tangent, 1.0),
        };
        Footprint {
            axes: [axis, normal.cross(axis)],
            radii: [radius * squeeze, radius / squeeze],
            unraised: [unraised * squeeze, unraised / squeeze],
        }
    }

    /// Shrinks radii that were raised to a minimum if a smaller minimum `min` applies now.
    pub fn lower(&mut self, min: f32) {
        for (radius, unraised) in self.radii.iter_mut().zip(self.unraised) {
            *radius = radius.min(unraised.max(min));
        }
    }

    /// Returns the larger radius.
    pub fn max_radius(&self) -> f32 {
        self.radii[0].max(self.radii[1])
    }

    /// Returns an offset in units of the footprint's radii.
    pub fn scaled(&self, offset: Vec3, normal: Vec3) -> Vec3 {
        let [r0, r1] = self.radii;
        Vec3::new(
            offset.dot(self.axes[0]) / r0,
            offset.dot(self.axes[1]) / r1,
            offset.dot(normal) * NORMAL_SCALE / r0.min(r1),
        )
    }
}

/// Returns the radius clamped between a minimum and a maximum; the minimum if it is NaN, as when derivatives overflow.
fn within(radius: f32, [min, max]: [f32; 2]) -> f32 {
    radius.max(min).min(max)
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::candidate;
    use super::*;

    fn limits(settings: &CacheSettings, radii: [f32; 2]) -> FootprintLimits<'_> {
        FootprintLimits { settings, accuracy: 0.2, distance: 4.0, radii }
    }

    fn assert_near(a: f32, b: f32) {
        assert!((a - b).abs() <= 1e-5 * b.abs(), "{a} against {b}");
    }

    #[test]
    fn limits_are_those_of_the_layer_in_spacings() {
        let settings = CacheSettings::default();
        for origin in Origin::ALL {
            let mut at = Candidate { spacing: 0.5, ..candidate(Vec3::ZERO, Vec3::Z) };
            let [least, largest] = settings.reach[origin as usize].map(|r| 0.5 * r);
            let limits = FootprintLimits::new(&settings, origin, &at, 7.0);
            assert_eq!((limits.accuracy, limits.distance), (settings.accuracy[origin as usize], 7.0));
            assert_eq!(limits.radii, [least, largest]);
            // Nearby geometry lowers the largest radius, though not below the least.
            for (clearance, radius) in [(0.5 * largest / CLEARANCE, 0.5 * largest), (0.0, least)] {
                at.clearance = clearance;
                let limits = FootprintLimits::new(&settings, origin, &at, 7.0);
                assert_eq!(limits.radii[0], least);
                assert_near(limits.radii[1], radius);
            }
        }
    }

    #[test]
    fn gradients_squeeze_circles_as_in_equation_12() {
        let isotropic = CacheSettings { footprints: Footprints::Isotropic, ..CacheSettings::default() };
        let anisotropic =
            CacheSettings { footprints: Footprints::Anisotropic, mu: 0.5, ..CacheSettings::default() };
        // The radius is 0.2 · 4; by so much does light of luminance 2 change across it, relatively.
        for change in [0.0, 0.1, 0.5, 0.7] {
            let gradient = Vec3::new(0.6, 0.8, 0.0) * (change * 2.0 / 0.8);
            let circle = Footprint::from_gradient(Vec3::Z, gradient, 2.0, &limits(&isotropic, [0.1, 9.0]));
            assert_near(circle.radii[0], 0.8);
            assert_near(circle.radii[1], 0.8);
            let ellipse = Footprint::from_gradient(Vec3::Z, gradient, 2.0, &limits(&anisotropic, [0.1, 9.0]));
            let squeeze = 1.0 / (1.0 + (change / 0.5).powi(2));
            assert_near(ellipse.radii[0], 0.8 * squeeze.max(0.3));
            assert_near(ellipse.radii[0] * ellipse.radii[1], 0.64);
            let [along, across] = ellipse.axes;
            assert!(change == 0.0 || along.dot(Vec3::new(0.6, 0.8, 0.0)) > 0.999_99);
            assert!(along.dot(across).abs() < 1e-6 && across.dot(Vec3::Z).abs() < 1e-6);
            assert_near(across.length(), 1.0);
        }
        let steep = Footprint::from_gradient(Vec3::Z, Vec3::X * 1e9, 2.0, &limits(&anisotropic, [0.1, 9.0]));
        assert_near(steep.radii[1] / steep.radii[0], 1.0 / 0.09);
        for (radii, radius) in [([1.0, 9.0], 1.0), ([0.1, 0.5], 0.5)] {
            let clamped = Footprint::from_gradient(Vec3::Z, Vec3::ZERO, 2.0, &limits(&isotropic, radii));
            assert_near(clamped.radii[0], radius);
        }
    }

    #[test]
    fn second_derivatives_change_light_by_half_the_square_of_the_accuracy_at_the_edge() {
        let settings = CacheSettings::default();
        let of = |curvature, distance, radii| {
            let light = Derivatives { edge_gradient: Mat3::ZERO, axes: [Vec3::Y, Vec3::X], curvature };
            Footprint::from_hessian(&light, 2.0, &FootprintLimits { distance, ..limits(&settings, radii) })
        };
        let free = of([3.0, 1.5], 1e6, [1e-3, 1e3]);
        assert_eq!(free.axes, [Vec3::Y, Vec3::X]);
        for (radius, curvature) in free.radii.into_iter().zip([3.0, 1.5]) {
            assert_near(0.5 * curvature * radius * radius, 0.5 * 0.2 * 0.2 * 2.0);
        }
        // Without curvature the distance alone sets the radius; with both, inverse squares add up.
        assert_near(of([0.0, 0.0], 4.0, [1e-3, 1e3]).radii[1], 0.2 * 4.0);
        let both = of([3.0, 3.0], 1.0, [1e-3, 1e3]).radii[0];
        assert_near(1.0 / (both * both), 1.0 / (0.2 * 0.2) + 3.0 / (2.0 * 0.2 * 0.2));
        let long = of([300.0, 0.0], 4.0, [1e-3, 1e3]);
        assert_near(long.radii[1], 2.0 * long.radii[0]);
        assert_eq!(of([300.0, 0.0], 4.0, [0.1, 0.15]).radii, [0.1, 0.15]);
        assert_eq!(of([0.0, 0.0], 4.0, [0.1, 0.15]).radii, [0.15, 0.15]);
    }

    #[test]
    fn where_derivatives_overflow_footprints_have_their_least_radii() {
        let settings = CacheSettings::default();
        for curvature in [[f32::NAN; 2], [f32::INFINITY; 2], [f32::INFINITY, f32::NAN]] {
            let light = Derivatives { edge_gradient: Mat3::ZERO, axes: [Vec3::X, Vec3::Y], curvature };
            for luminance in [0.0, 1.0, f32::MAX] {
                let found = Footprint::from_hessian(&light, luminance, &limits(&settings, [0.1, 9.0]));
                assert!(found.radii[0] == 0.1 && (0.1..=0.2).contains(&found.radii[1]), "{:?}", found.radii);
            }
            let gradient = Vec3::splat(curvature[1]);
            let found = Footprint::from_gradient(Vec3::Z, gradient, 1.0, &limits(&settings, [0.1, 9.0]));
            assert!(found.radii.iter().all(|radius| radius.is_finite() && *radius > 0.0));
        }
    }

    #[test]
    fn radii_raised_to_a_minimum_follow_it_down_to_those_that_accuracy_asks_for() {
        let settings = CacheSettings::default();
        let light =
            Derivatives { edge_gradient: Mat3::ZERO, axes: [Vec3::X, Vec3::Y], curvature: [300.0, 3.0] };
        let of = |min| Footprint::from_hessian(&light, 2.0, &limits(&settings, [min, 1e3]));
        let exact = of(1e-6);
        let mut kept = of(0.5);
        assert!(exact.radii[1] < 0.1 && kept.radii == [0.5, 0.5]);
        // A larger minimum, of a view from farther away, changes nothing.
        kept.lower(0.7);
        assert_eq!(kept.radii, [0.5, 0.5]);
        for min in [0.4, 0.2, 0.5 * (exact.radii[0] + exact.radii[1])] {
            kept.lower(min);
            let alone = of(min).radii;
            assert!(kept.radii[0] == alone[0] && (min..=alone[1]).contains(&kept.radii[1]));
        }
        kept.lower(1e-6);
        assert_eq!(kept.radii, exact.radii);
    }

    #[test]
    fn offsets_are_scaled_by_the_radii_and_five_times_as_much_along_the_normal() {
        let radii = [2.0, 0.5];
        let footprint = Footprint { axes: [Vec3::X, Vec3::Y], radii, unraised: radii };
        assert_eq!(footprint.scaled(Vec3::new(3.0, 3.0, 3.0), Vec3::Z), Vec3::new(1.5, 6.0, 30.0));
        assert_eq!(footprint.max_radius(), 2.0);
    }
}
