//! Sun and sky of the native format.
//!
//! If y is up, north is -z and east is x. If z is up, north is y.

use super::builder::SceneBuilder;
use super::text::SkyText;
use crate::error::{Location, SceneError};
use crate::plan::EnvironmentPlan;
use crate::sky::{Moment, SkyPlan, sun_position};
use base::math::unit;
use glam::{DQuat, DVec3};
use toml::Spanned;
use toml::value::{Datetime, Offset};

impl SceneBuilder<'_> {
    pub(super) fn sky(&mut self, text: &Spanned<SkyText>) -> Result<(), SceneError> {
        let place = self.file.place(text.span());
        let text = text.get_ref();
        let up = unit(text.up.map_or(DVec3::Y, DVec3::from));
        let up = up.ok_or_else(|| place.wrong("the sky's up is zero", "give a direction"))?;
        let towards_sun = match (text.sun_direction, &text.date, text.place) {
            (Some(direction), None, None) if text.rotate_y.is_none() => unit(DVec3::from(direction))
                .ok_or_else(|| place.wrong("the sun has no direction", "give one that is not zero"))?,
            (None, Some(date), Some(at)) => {
                let [zenith, azimuth] = sun_position(&moment(date, &place)?, at.into());
                let (sin, cos) = zenith.sin_cos();
                let azimuth = azimuth - text.rotate_y.map_or(0.0, f64::from).to_radians();
                let towards_sun = DVec3::new(sin * azimuth.sin(), cos, -sin * azimuth.cos());
                DQuat::from_rotation_arc(DVec3::Y, up) * towards_sun
            }
            _ => {
                let remedy = "give sun_direction, or date and place = [latitude, longitude]";
                return Err(place.wrong("the sun has no single position", remedy));
            }
        };
        let mut sky = SkyPlan::new(up, towards_sun);
        sky.turbidity = text.turbidity.map_or(sky.turbidity, f64::from);
        if let Some(albedo) = &text.albedo {
            sky.albedo = albedo.rgb("the ground's albedo", &place)?;
        }
        sky.sky_scale = text.scale.map_or(1.0, f64::from);
        sky.sun_scale = text.sun_scale.map_or(sky.sky_scale, f64::from);
        sky.sun_angle = text.sun_angle.map_or(sky.sun_angle, f64::from);
        sky.check(&place, self.log)?;
        self.contents.discs.extend(sky.sun());
        if self.contents.environment.is_some() {
            return Err(place.wrong("the scene has a sky and an environment", "leave one"));
        }
        self.contents.environment = Some(EnvironmentPlan::Sky(sky));
        Ok(())
    }
}

fn moment(date: &Datetime, place: &Location) -> Result<Moment, SceneError> {
    let (Some(day), Some(time), Some(offset)) = (date.date, date.time, date.offset) else {
        let remedy = "write day, time and time zone, as 2024-06-21T12:30:00+02:00";
        return Err(place.wrong(format!("the date {date} is invalid"), remedy));
    };
    let timezone = match offset {
        Offset::Z => 0.0,
        Offset::Custom { minutes } => f64::from(minutes) / 60.0,
    };
    let hours =
        f64::from(time.hour) + f64::from(time.minute) / 60.0 + f64::from(time.second.unwrap_or(0)) / 3600.0;
    Ok(Moment { year: day.year.into(), month: day.month.into(), day: day.day.into(), hours, timezone })
}
