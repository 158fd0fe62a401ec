//! Position of the sun by date and place.
//!
//! Paper: M. Blanco-Muriel et al., *Computing the Solar Vector*, Solar Energy 70(5), 2001. Its precision is 0.5 arc
//! minutes from 1999 to 2015.

use std::f64::consts::TAU;

/// Radius of the Earth over its distance from the sun, for the parallax.
const PARALLAX: f64 = 6371.01 / 149_597_890.0;

/// A local time, `timezone` hours ahead of Universal Time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moment {
    pub year: i64,
    pub month: i64,
    pub day: i64,
    /// Hours since midnight.
    pub hours: f64,
    pub timezone: f64,
}

/// The default date of Mitsuba.
impl Default for Moment {
    fn default() -> Moment {
        Moment { year: 2010, month: 7, day: 10, hours: 15.0, timezone: 9.0 }
    }
}

/// Returns the angle from the zenith, and the azimuth from north towards east, in radians.
///
/// The place is given by latitude (north) and longitude (east), in degrees.
pub(crate) fn sun_position(moment: &Moment, [latitude, longitude]: [f64; 2]) -> [f64; 2] {
    let hours = moment.hours - moment.timezone;
    let days = julian_day(moment) as f64 - 0.5 + hours / 24.0 - 2_451_545.0;
    let omega = 2.1429 - 0.001_039_459_4 * days;
    let mean_longitude = 4.895_063_0 + 0.017_202_791_698 * days;
    let anomaly = 6.240_060_0 + 0.017_201_969_9 * days;
    let ecliptic_longitude =
        mean_longitude + 0.033_416_07 * anomaly.sin() + 0.000_348_94 * (2.0 * anomaly).sin()
            - 0.000_113_4
            - 0.000_020_3 * omega.sin();
    let obliquity = 0.409_092_8 - 6.2140e-9 * days + 0.000_039_6 * omega.cos();
    let right_ascension =
        (obliquity.cos() * ecliptic_longitude.sin()).atan2(ecliptic_longitude.cos()).rem_euclid(TAU);
    let declination = (obliquity.sin() * ecliptic_longitude.sin()).asin();
    let sidereal_hours = 6.697_424_324_2 + 0.065_709_828_3 * days + hours;
    let hour_angle = (sidereal_hours * 15.0 + longitude).to_radians() - right_ascension;
    let (sin_latitude, cos_latitude) = latitude.to_radians().sin_cos();
    let cos_zenith = cos_latitude * hour_angle.cos() * declination.cos() + declination.sin() * sin_latitude;
    let zenith = cos_zenith.clamp(-1.0, 1.0).acos();
    let north = declination.tan() * cos_latitude - sin_latitude * hour_angle.cos();
    let azimuth = (-hour_angle.sin()).atan2(north);
    [zenith + PARALLAX * zenith.sin(), azimuth]
}

/// Returns the Julian day that begins at noon of the date.
fn julian_day(Moment { year, month, day, .. }: &Moment) -> i64 {
    let before_march = (month - 14) / 12;
    (1461 * (year + 4800 + before_march)) / 4 + (367 * (month - 2 - 12 * before_march)) / 12
        - (3 * ((year + 4900 + before_march) / 100)) / 4
        + day
        - 32075
}
