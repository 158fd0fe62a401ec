//! Conversion of sensors and their film.

use super::converter::Converter;
use super::statements::fate_of_plugin;
use super::tree::Object;
use crate::draft::{DraftCamera, DraftView, Shot};
use crate::error::{Location, SceneError};
use crate::statements::Fate;
use base::math::{right_of, unit};
use glam::{DMat4, DVec3};
use scene::{FovAxis, MAX_SIDE, PixelFilter, Projection};
use std::rc::Rc;

/// Film of a sensor.
struct SensorFilm {
    /// Width and height in pixels.
    resolution: [u32; 2],
    /// Offset and size of the part to render, if not all of it.
    crop: Option<[[u32; 2]; 2]>,
    filter: PixelFilter,
}

impl Converter<'_> {
    /// Returns the shot of the sensor `wanted` (a number from 1, or an id; else the first).
    pub(super) fn shot(&mut self, wanted: Option<&str>) -> Result<Shot, SceneError> {
        let root = &self.document.root;
        let sensors = self.tagged(root, "sensor")?;
        let sensor = chosen(&sensors, wanted, &root.place)?;
        if let (None, [_, second, ..]) = (wanted, &sensors[..]) {
            let what = format!("there are {} sensors: {}", sensors.len(), names(&sensors));
            self.log.note(&second.place, what, "the first is used; choose another with --camera");
        }
        let names = sensors.iter().map(|sensor| sensor.id.clone().unwrap_or_default()).collect();
        Ok(Shot { names, ..self.shot_of(sensor)? })
    }

    /// Returns all sensors as a list of views.
    pub(super) fn views(&mut self) -> Result<Vec<Result<DraftView, SceneError>>, SceneError> {
        let sensors = self.tagged(&self.document.root, "sensor")?;
        let view = |sensor: &Rc<Object>| {
            let Shot { camera, resolution, crop, .. } = self.shot_of(sensor)?;
            if crop.is_some() {
                self.log.note(&sensor.place, "the film has a crop", "views are whole films");
            }
            let name = sensor.id.clone().unwrap_or_default();
            Ok(DraftView { name, is_path: false, camera, resolution: Some(resolution) })
        };
        Ok(sensors.iter().map(view).collect())
    }

    /// Returns the shot of a sensor, without the names of sensors.
    fn shot_of(&mut self, sensor: &Object) -> Result<Shot, SceneError> {
        match sensor.plugin.as_str() {
            "perspective" | "thinlens" | "orthographic" => {}
            other => {
                let what = format!("the sensor \"{other}\" is not supported");
                return Err(sensor.place.wrong(what, "use type=\"perspective\""));
            }
        }
        let SensorFilm { resolution, crop, filter } = self.film(sensor)?;
        let to_world = self.axes(sensor)?.unwrap_or(DMat4::IDENTITY);
        let aspect = f64::from(resolution[0]) / f64::from(resolution[1]);
        let near = sensor.positive("near_clip", 1e-2)?;
        let far = sensor.positive("far_clip", 1e4)?;
        if near >= far {
            let what = format!("near_clip {near} is not below far_clip {far}");
            return Err(sensor.place.wrong(what, "swap them"));
        }
        for offset in ["principal_point_offset_x", "principal_point_offset_y"] {
            if sensor.float(offset)?.is_some_and(|v| v != 0.0) {
                self.log.warn(
                    &sensor.place,
                    "a shifted principal point is not supported",
                    "it is centred",
                )?;
            }
        }
        let (projection, tan_half_x) = match sensor.plugin.as_str() {
            // The film covers -1 to 1, scaled by to_world.
            "orthographic" => (Projection::Parallel, to_world.transform_vector3(DVec3::X).length()),
            "thinlens" => {
                let focus_distance = sensor.positive("focus_distance", far)?;
                let radius = sensor.positive("aperture_radius", 0.0)?;
                let lens = Projection::Lens { radius: radius as f32, distance: focus_distance as f32 };
                (lens, (0.5 * horizontal_fov(sensor, aspect)?).tan())
            }
            _ => (Projection::Pinhole, (0.5 * horizontal_fov(sensor, aspect)?).tan()),
        };
        self.sampler(sensor)?;
        let camera = self.camera(&sensor.place, &to_world, projection)?;
        let camera = DraftCamera { tan_half_x, near, far, filter, ..camera };
        sensor.report_unused(self.log)?;
        Ok(Shot { camera, names: Vec::new(), fits: false, path: Vec::new(), resolution, crop })
    }

    /// Names what a sampler says besides noise. `--spp` gives the number of samples.
    fn sampler(&mut self, sensor: &Object) -> Result<(), SceneError> {
        let Some(sampler) = self.first(sensor, "sampler")? else { return Ok(()) };
        if fate_of_plugin("sampler", &sampler.plugin) != Fate::NoEffect {
            let what = format!("the sampler \"{}\" is not known", sampler.plugin);
            return self.log.warn(&sampler.place, what, "it is left out");
        }
        sampler.report_unused(self.log)
    }

    /// Returns a camera with its position and axes. Mitsuba's cameras look along +z with +x to the left.
    fn camera(
        &mut self,
        place: &Location,
        to_world: &DMat4,
        projection: Projection,
    ) -> Result<DraftCamera, SceneError> {
        let axes = [DVec3::NEG_X, DVec3::Y, DVec3::Z].map(|a| to_world.transform_vector3(a));
        let singular = || place.wrong("the sensor's to_world is singular", "use a rotation");
        let [right, up, forward] = axes.map(unit);
        let (right, up, forward) =
            (right.ok_or_else(singular)?, up.ok_or_else(singular)?, forward.ok_or_else(singular)?);
        let scales = match projection {
            Projection::Parallel => (axes[0].length() / axes[1].length() - 1.0).abs() > 1e-3,
            _ => axes.iter().any(|a| (a.length_squared() - 1.0).abs() > 1e-3),
        };
        if scales {
            let fallback = "only the scale of the width of a parallel projection is used";
            self.log.warn(place, "the sensor's to_world scales", fallback)?;
        }
        let (mut right, mut up) = (right, up);
        if right.dot(up).abs().max(up.dot(forward).abs()).max(forward.dot(right).abs()) > 1e-3 {
            self.log.warn(place, "the sensor's to_world shears", "it looks the same way, not sheared")?;
            let across = right_of(forward, up).ok_or_else(singular)?;
            up = across.cross(forward);
            right = match right.dot(across) {
                0.0 => return Err(singular()),
                side => across * side.signum(),
            };
        }
        let origin = to_world.transform_point3(DVec3::ZERO);
        Ok(DraftCamera { origin, forward, right, up, projection, ..DraftCamera::default() })
    }

    fn film(&mut self, sensor: &Object) -> Result<SensorFilm, SceneError> {
        let Some(film) = self.first(sensor, "film")? else {
            return Ok(SensorFilm { resolution: [768, 576], crop: None, filter: PixelFilter::GAUSSIAN });
        };
        if fate_of_plugin("film", &film.plugin) != Fate::Read {
            let what = format!("the film \"{}\" is not supported", film.plugin);
            self.log.warn(&film.place, what, "hdrfilm is used instead")?;
        }
        if let Some(format) = film.string("pixel_format")?
            && !matches!(format.to_lowercase().as_str(), "rgb" | "rgba")
        {
            let what = format!("the pixel format \"{format}\" is not supported");
            self.log.warn(&film.place, what, "red, green and blue are written")?;
        }
        let size = |name: &str, default: i64| {
            let value = film.integer(name)?.unwrap_or(default);
            let fits = u32::try_from(value).ok().filter(|v| (1..=MAX_SIDE).contains(v));
            let what = format!("the film's {name} is {value}");
            fits.ok_or_else(|| film.place.wrong(what, format!("give 1 to {MAX_SIDE}")))
        };
        let resolution = [size("width", 768)?, size("height", 576)?];
        let names = ["crop_offset_x", "crop_offset_y", "crop_width", "crop_height"];
        let all = [0, 0, resolution[0], resolution[1]];
        let mut crop = all;
        for ((name, default), value) in names.into_iter().zip(all).zip(&mut crop) {
            let number = film.integer(name)?.unwrap_or(default.into());
            let what =
                || film.place.wrong(format!("the film's {name} is {number}"), "give pixels of the film");
            *value = u32::try_from(number).map_err(|_| what())?;
        }
        let [x, y, width, height] = crop;
        let fits = |offset: u32, size: u32, film: u32| {
            size > 0 && offset.checked_add(size).is_some_and(|end| end <= film)
        };
        if !(fits(x, width, resolution[0]) && fits(y, height, resolution[1])) {
            let what = "the film's crop is empty or not on the film";
            return Err(film.place.wrong(what, "keep crop_offset + crop size within the film's size"));
        }
        let crop = (crop != all).then_some([[x, y], [width, height]]);
        let filter = match self.first(&film, "rfilter")? {
            Some(filter) => self.filter(&filter)?,
            None => PixelFilter::GAUSSIAN,
        };
        film.report_unused(self.log)?;
        Ok(SensorFilm { resolution, crop, filter })
    }

    fn filter(&mut self, object: &Object) -> Result<PixelFilter, SceneError> {
        let filter = match object.plugin.as_str() {
            "box" => match object.positive("radius", 0.5)? {
                0.5 => PixelFilter::Box,
                radius => {
                    let what = format!("a box filter of radius {radius} is not supported");
                    self.log.note(&object.place, what, "it is .5");
                    PixelFilter::Box
                }
            },
            "tent" => PixelFilter::Tent { radius: object.positive("radius", 1.0)? as f32 },
            "gaussian" => PixelFilter::Gaussian { deviation: object.positive("stddev", 0.5)? as f32 },
            "mitchell" => {
                // Version 3 names A and B what version 0.6 and the paper name B and C.
                for name in ["A", "B", "C"] {
                    self.usual(object, name, 1.0 / 3.0)?;
                }
                PixelFilter::Mitchell
            }
            "catmullrom" => PixelFilter::CatmullRom,
            "lanczos" => {
                self.usual(object, "lobes", 3.0)?;
                PixelFilter::Lanczos
            }
            other => {
                let what = format!("the film's reconstruction filter \"{other}\" is not supported");
                self.log.warn(&object.place, what, "a Gaussian with deviation 0.5 is used instead")?;
                object.properties.iter().for_each(|property| property.used.set(true));
                PixelFilter::GAUSSIAN
            }
        };
        object.report_unused(self.log)?;
        Ok(filter)
    }

    /// Notes that a filter's parameter differs from `usual`, which replaces it.
    fn usual(&mut self, object: &Object, name: &str, usual: f64) -> Result<(), SceneError> {
        let given = object.float(name)?.unwrap_or(usual);
        if (given - usual).abs() > 1e-3 {
            let what = format!("a {} filter with {name} = {given} is not supported", object.plugin);
            self.log.note(&object.place, what, format!("it is {usual:.3}"));
        }
        Ok(())
    }
}

fn chosen<'a>(
    sensors: &'a [Rc<Object>],
    wanted: Option<&str>,
    place: &Location,
) -> Result<&'a Rc<Object>, SceneError> {
    if sensors.is_empty() {
        let remedy = "add <sensor type=\"perspective\"> with a to_world transform";
        return Err(place.wrong("the scene has no sensor", remedy));
    }
    let wanted = wanted.unwrap_or("1");
    let number = wanted.parse().ok().and_then(|number: usize| sensors.get(number.checked_sub(1)?));
    let named = || sensors.iter().find(|sensor| sensor.id.as_deref() == Some(wanted));
    let missing = || place.no_camera(wanted, format!("--camera chooses among {}", names(sensors)));
    number.or_else(named).ok_or_else(missing)
}

/// Lists numbers and ids of sensors.
fn names(sensors: &[Rc<Object>]) -> String {
    let name = |(i, sensor): (usize, &Rc<Object>)| match &sensor.id {
        Some(id) => format!("{} ({id})", i + 1),
        None => (i + 1).to_string(),
    };
    sensors.iter().enumerate().map(name).collect::<Vec<_>>().join(", ")
}

/// Returns the horizontal field of view in radians.
fn horizontal_fov(sensor: &Object, aspect: f64) -> Result<f64, SceneError> {
    let (tan, axis) = field_of_view(sensor)?;
    let tan_x = axis.tan_half_x(tan, aspect);
    if !(tan_x > 0.0 && (tan_x as f32).is_finite()) {
        return Err(fov_out_of_range(sensor));
    }
    Ok(2.0 * tan_x.atan())
}

fn fov_out_of_range(object: &Object) -> SceneError {
    object.place.wrong("the field of view is not between 0 and 180 degrees", "correct fov")
}

/// Returns the tangent of half the field of view of a sensor or projector, and the axis to which it refers.
pub(super) fn field_of_view(sensor: &Object) -> Result<(f64, FovAxis), SceneError> {
    let wrong = |what: String, remedy: &str| sensor.place.wrong(what, remedy);
    let (fov, axis) = match (sensor.float("fov")?, sensor.property("focal_length")) {
        (Some(_), Some(_)) => {
            return Err(wrong("both fov and focal_length are given".into(), "leave one out"));
        }
        (Some(fov), None) => {
            let axis = sensor.string("fov_axis")?.unwrap_or("x".into()).to_lowercase();
            (fov.to_radians(), axis)
        }
        (None, _) => {
            let text = sensor.string("focal_length")?.unwrap_or("50mm".into());
            let millimetres = text.trim_end_matches("mm").trim().parse::<f64>().ok().filter(|v| *v > 0.0);
            let millimetres = millimetres
                .ok_or_else(|| wrong(format!("cannot read focal_length \"{text}\""), "write e.g. 50mm"))?;
            // 35 mm film is 36 mm by 24 mm; the focal length refers to its diagonal.
            (2.0 * (36f64.hypot(24.0) / (2.0 * millimetres)).atan(), "diagonal".into())
        }
    };
    let axis = match axis.as_str() {
        "x" => FovAxis::X,
        "y" => FovAxis::Y,
        "diagonal" => FovAxis::Diagonal,
        "smaller" => FovAxis::Smaller,
        "larger" => FovAxis::Larger,
        other => {
            let remedy = "use x, y, smaller, larger or diagonal";
            return Err(wrong(format!("unknown fov_axis \"{other}\""), remedy));
        }
    };
    let tan = (0.5 * fov).tan();
    let is_in_range = fov > 0.0 && fov < std::f64::consts::PI && (tan as f32).is_finite();
    if is_in_range { Ok((tan, axis)) } else { Err(fov_out_of_range(sensor)) }
}
