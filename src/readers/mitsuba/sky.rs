//! Conversion of the emitters `sunsky` (Mitsuba 3 and 0.6), `sky` and `sun` (0.6).
//!
//! Up is z in 3.x and y in 0.6, before `to_world`. `sun_direction` is in world space in both. Dates are local times of
//! a place, by default 10 July 2010, 15:00, in Tokyo.
//!
//! Deviations: sky and sun of 0.6 use the model of Mitsuba 3, whose sun has another colour.

use super::converter::Converter;
use super::tree::Object;
use crate::error::SceneError;
use crate::plan::EnvironmentPlan;
use crate::sky::{Moment, SkyPlan, sun_position};
use base::math::unit;
use glam::{DMat4, DVec3};
use std::f64::consts::PI;

/// Minimum factor on the sun's radius. In 0.6, a factor of 0 makes the sun a point.
const MIN_RADIUS_SCALE: f64 = 0.01;

impl Converter<'_> {
    pub(super) fn sky(&mut self, emitter: &Object, to_world: DMat4) -> Result<(), SceneError> {
        let to_world = self.rotation(emitter, to_world)?;
        let up = if self.document.is_old { DVec3::Y } else { DVec3::Z };
        let towards_sun = match emitter.vector("sun_direction")? {
            Some(direction) => unit(direction).ok_or_else(|| {
                emitter.place.wrong("the sun has no direction", "give one that is not zero, or a date")
            })?,
            None => to_world.transform_vector3(self.sun_of_date(emitter)?),
        };
        let mut sky = SkyPlan::new(to_world.transform_vector3(up), towards_sun);
        let float = |name: &str, default: f64| Ok(emitter.float(name)?.unwrap_or(default));
        sky.turbidity = float("turbidity", sky.turbidity)?;
        if let Some(albedo) = self.colour(emitter, "albedo")? {
            sky.albedo = albedo;
        }
        let scale = float("scale", 1.0)?;
        sky.sky_scale = float("sky_scale", scale)?;
        sky.sun_scale = float("sun_scale", scale)?;
        match emitter.plugin.as_str() {
            "sky" => sky.sun_scale = 0.0,
            "sun" => sky.sky_scale = 0.0,
            _ => {}
        }
        sky.sun_angle =
            float("sun_aperture", sky.sun_angle)? * float("sun_radius_scale", 1.0)?.max(MIN_RADIUS_SCALE);
        if emitter.boolean("complex_sun", false)? {
            let what = "limb darkening of the sun is not supported";
            self.log.warn(&emitter.place, what, "the disc is uniform, with the same irradiance")?;
        }
        sky.check(&emitter.place, self.log)?;
        self.contents.discs.extend(sky.sun());
        if sky.sky_scale > 0.0 {
            self.environment(emitter, EnvironmentPlan::Sky(sky))?;
        }
        Ok(())
    }

    /// Returns the unit vector to the sun, before `to_world`.
    fn sun_of_date(&self, emitter: &Object) -> Result<DVec3, SceneError> {
        let default = Moment::default();
        let number = |name: &str, default: f64| Ok(emitter.float(name)?.unwrap_or(default));
        let integer = |name: &str, default: i64| {
            let value = emitter.integer(name)?.unwrap_or(default);
            let wrong = || emitter.place.wrong(format!("{name} is {value}"), "give one between 0 and 9999");
            if (0..=9999).contains(&value) { Ok(value) } else { Err(wrong()) }
        };
        let minutes = number("minute", 0.0)? + number("second", 0.0)? / 60.0;
        let moment = Moment {
            year: integer("year", default.year)?,
            month: integer("month", default.month)?,
            day: integer("day", default.day)?,
            hours: number("hour", default.hours)? + minutes / 60.0,
            timezone: number("timezone", default.timezone)?,
        };
        let place = [number("latitude", 35.6894)?, number("longitude", 139.6917)?];
        let [zenith, azimuth] = sun_position(&moment, place);
        let (sin, cos) = zenith.sin_cos();
        Ok(match self.document.is_old {
            true => DVec3::new(sin * azimuth.sin(), cos, -sin * azimuth.cos()),
            false => DVec3::new(sin * (azimuth - PI).cos(), sin * (azimuth - PI).sin(), cos),
        })
    }
}
