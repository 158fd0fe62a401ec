//! Sun and sky of all formats: the sky becomes an environment map, the sun a distant disc.
//!
//! Deviations: the map is bilinear between directions 0.35° apart. So the sky fades over that angle below the horizon,
//! where the map is black or shows the ground.

mod hosek_wilkie;
mod sun_position;

use super::error::{Location, Log, SceneError};
use base::math::{Rgb, luminance};
use glam::{DMat3, DVec3};
use hosek_wilkie::{ClearSky, SUN_ANGLE, TURBIDITIES, sun_radiance};
use rayon::prelude::*;
use scene::{DistantDisc, EnvironmentMap};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

pub(crate) use sun_position::{Moment, sun_position};

/// Width of the map.
const WIDTH: usize = 1024;
/// Height of the map; odd, so that one row lies on the horizon.
const HEIGHT: usize = 513;

/// Description of a clear sky with its sun.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SkyPlan {
    /// Unit world vector to the zenith.
    pub up: DVec3,
    /// Unit world vector to the sun.
    pub towards_sun: DVec3,
    pub turbidity: f64,
    /// Albedo of the ground.
    pub albedo: Rgb,
    /// Factor on the sky.
    pub sky_scale: f64,
    /// Factor on the sun.
    pub sun_scale: f64,
    /// Diameter of the sun in degrees; the irradiance does not depend on it.
    pub sun_angle: f64,
    /// True if the lower half shows level ground in this light. Else it is black.
    pub has_ground: bool,
}

impl SkyPlan {
    /// Returns a sky with the defaults of Mitsuba.
    pub fn new(up: DVec3, towards_sun: DVec3) -> SkyPlan {
        let (turbidity, albedo) = (3.0, Rgb::splat(0.3));
        SkyPlan {
            up,
            towards_sun,
            turbidity,
            albedo,
            sky_scale: 1.0,
            sun_scale: 1.0,
            sun_angle: SUN_ANGLE,
            has_ground: false,
        }
    }

    /// Returns the sky over level ground of its albedo, scaled so that the irradiance of the ground has luminance π.
    ///
    /// The brightness of the ground as seen from infinitely far is that of a diffuse surface.
    pub fn over_ground(self) -> SkyPlan {
        let unscaled = SkyPlan { sky_scale: 1.0, sun_scale: 1.0, ..self };
        let scale = PI / f64::from(luminance(unscaled.irradiance().as_vec3()));
        if scale.is_finite() {
            return SkyPlan { sky_scale: scale, sun_scale: scale, has_ground: true, ..unscaled };
        }
        SkyPlan { has_ground: true, ..unscaled }
    }

    /// Returns the irradiance of level ground by sky and sun, W/m².
    fn irradiance(&self) -> DVec3 {
        let elevation = self.elevation();
        if elevation < 0.0 {
            return DVec3::ZERO;
        }
        let sky = ClearSky::new(self.turbidity, self.albedo.as_dvec3(), elevation);
        // The midpoint rule over equal steps of azimuth and of the squared sine of the zenith angle.
        let (rings, sectors) = (64, 128);
        let of_sky = (0..rings * sectors).map(|i| {
            let sin_sq = ((i / sectors) as f64 + 0.5) / f64::from(rings);
            let (sin, cos) = (sin_sq.sqrt(), (1.0 - sin_sq).sqrt());
            let azimuth = TAU * (f64::from(i % sectors) + 0.5) / f64::from(sectors);
            let cos_gamma = cos * elevation.sin() + sin * azimuth.cos() * elevation.cos();
            sky.radiance(cos, cos_gamma.clamp(-1.0, 1.0).acos())
        });
        let of_sky = of_sky.sum::<DVec3>() * (PI / f64::from(rings * sectors) * self.sky_scale);
        let half_angle = (0.5 * SUN_ANGLE).to_radians();
        let solid_angle = TAU * (1.0 - half_angle.cos());
        of_sky + sun_radiance(self.turbidity, elevation) * (solid_angle * elevation.sin() * self.sun_scale)
    }

    /// Checks the ranges of the values, and warns of a sun below the horizon.
    pub fn check(&self, place: &Location, log: &mut Log) -> Result<(), SceneError> {
        let [low, high] = TURBIDITIES;
        if !(low..=high).contains(&self.turbidity) {
            return Err(place.wrong(format!("the turbidity is {}", self.turbidity), "give 1 to 10"));
        }
        if self.albedo.to_array().iter().any(|albedo| !(0.0..=1.0).contains(albedo)) {
            return Err(place.wrong(format!("the ground's albedo is {}", self.albedo), "give 0 to 1"));
        }
        if !(self.sun_angle > 0.0 && self.sun_angle < 90.0) {
            return Err(place.wrong(format!("the sun is {} degrees wide", self.sun_angle), "give 0 to 90"));
        }
        if [self.sky_scale, self.sun_scale].iter().any(|scale| !(*scale >= 0.0 && scale.is_finite())) {
            return Err(place.wrong("the scale of sun or sky is negative or not a number", "give 0 or more"));
        }
        if self.elevation() < 0.0 {
            let fallback = "there is no light from it; choose another hour or direction";
            log.warn(place, "the sun is below the horizon", fallback)?;
        }
        Ok(())
    }

    fn elevation(&self) -> f64 {
        FRAC_PI_2 - angle_between(self.up, self.towards_sun)
    }

    /// Returns the sky as a map; `None` if black.
    pub fn map(&self) -> Option<EnvironmentMap> {
        if self.sky_scale == 0.0 || self.elevation() < 0.0 {
            return None;
        }
        let sky = ClearSky::new(self.turbidity, self.albedo.as_dvec3(), self.elevation());
        let right = self.up.any_orthonormal_vector();
        let to_world = DMat3::from_cols(right, self.up, right.cross(self.up));
        let ground = match self.has_ground {
            true => (self.irradiance() * self.albedo.as_dvec3() / PI).as_vec3(),
            false => Rgb::ZERO,
        };
        let texel = |i: usize| {
            let (x, y) = (i % WIDTH, i / WIDTH);
            if 2 * y >= HEIGHT {
                return ground;
            }
            let (sin_theta, cos_theta) = (PI * y as f64 / (HEIGHT - 1) as f64).sin_cos();
            let (sin_phi, cos_phi) = (TAU * (x as f64 + 0.5) / WIDTH as f64).sin_cos();
            let direction = to_world * DVec3::new(sin_phi * sin_theta, cos_theta, -cos_phi * sin_theta);
            let gamma = angle_between(direction, self.towards_sun);
            (sky.radiance(cos_theta, gamma) * self.sky_scale).as_vec3()
        };
        let radiance = (0..WIDTH * HEIGHT).into_par_iter().map(texel).collect();
        let to_local = to_world.transpose().as_mat3();
        Some(EnvironmentMap { width: WIDTH, height: HEIGHT, radiance, to_local })
    }

    /// Returns the sun; `None` if black.
    pub fn sun(&self) -> Option<DistantDisc> {
        if self.sun_scale == 0.0 || self.elevation() < 0.0 {
            return None;
        }
        let versine = |angle: f64| 1.0 - (0.5 * angle.to_radians()).cos();
        let scale = self.sun_scale * versine(SUN_ANGLE) / versine(self.sun_angle);
        Some(DistantDisc {
            direction: self.towards_sun.as_vec3(),
            half_angle: (0.5 * self.sun_angle).to_radians() as f32,
            radiance: (sun_radiance(self.turbidity, self.elevation()) * scale).as_vec3(),
        })
    }
}

/// Returns the angle between unit vectors, precise for small angles too.
fn angle_between(a: DVec3, b: DVec3) -> f64 {
    2.0 * (a - b).length().atan2((a + b).length())
}
