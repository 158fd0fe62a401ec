//! Camera and camera path of the native format.

use super::builder::SceneBuilder;
use super::path::{Key, KeyedPath};
use super::source::SourceText;
use super::text::{CameraText, FixedArray, KeyText, Number, NumberArray, PathText, SceneText};
use crate::draft::{DEFAULT_RESOLUTION, DraftCamera, Shot};
use crate::error::{Location, SceneError};
use crate::finish::framing;
use base::math::{right_of, unit};
use glam::DVec3;
use scene::{MAX_FRAMES, MAX_SIDE, PixelFilter, Projection};
use toml::Spanned;

/// Default field of view, in degrees.
const DEFAULT_FOV: f64 = 45.0;

impl SceneBuilder<'_> {
    pub(super) fn shot(&self, scene: &SceneText) -> Result<Shot, SceneError> {
        if let (None, Some(shot)) = (&scene.camera, &self.model_shot) {
            let resolution = self.resolution(scene, shot.resolution)?;
            return Ok(Shot { resolution, ..shot.clone() });
        }
        let resolution = self.resolution(scene, DEFAULT_RESOLUTION)?;
        let unspecified = CameraText::default();
        let (place, text) = match &scene.camera {
            Some(text) => (self.file.place(text.span()), text.get_ref()),
            None => (Location::file(self.file.path), &unspecified),
        };
        check_names(self.file, text)?;
        let path = text.path.as_ref().map(|walk| self.path(text, walk, resolution)).transpose()?;
        let path = path.unwrap_or_default();
        let shot = |camera, fits, path| {
            let names = if fits { Vec::new() } else { vec![String::new()] };
            Ok(Shot { camera, names, fits, path, resolution, crop: None })
        };
        match (text.origin, text.target, path.first()) {
            (Some(origin), Some(target), _) => {
                shot(still(text, [origin, target], resolution, &place)?, false, path)
            }
            (None, None, Some(first)) => shot(*first, false, path),
            (None, None, None) => {
                if text.film_width.is_some() || text.aperture_radius.is_some() {
                    let what = "a camera with a film_width or an aperture_radius has no position";
                    return Err(place.wrong(what, "give its origin and target"));
                }
                let up = text.up.map_or(DVec3::Y, DVec3::from);
                let fov = fov(text, None, &place)?;
                let outlook = Key { origin: framing::outlook(up), target: DVec3::ZERO, up, fov };
                shot(camera(text, &outlook, resolution, &place)?, true, path)
            }
            _ => {
                let what = "the camera has only one of origin and target";
                Err(place.wrong(what, "give both, or none for a view of everything"))
            }
        }
    }

    fn resolution(&self, scene: &SceneText, default: [u32; 2]) -> Result<[u32; 2], SceneError> {
        Ok(film(self.file, scene.resolution.as_ref())?.unwrap_or(default))
    }

    /// Returns one camera per frame.
    fn path(
        &self,
        text: &CameraText,
        walk: &Spanned<PathText>,
        resolution: [u32; 2],
    ) -> Result<Vec<DraftCamera>, SceneError> {
        let place = self.file.place(walk.span());
        let PathText { frames, keys: texts } = walk.get_ref();
        let mut keys = Vec::new();
        for key_text in texts {
            let place = self.file.place(key_text.span());
            let key = key(text, key_text.get_ref(), &place)?;
            camera(text, &key, resolution, &place)?;
            keys.push(key);
        }
        let at = self.key_frames(texts)?;
        let frames = match (frames, at.last()) {
            (Some(frames), Some(last)) if last > frames => {
                let what = format!("the path has {frames} frames, and a key at frame {last}");
                return Err(place.wrong(what, "give more frames, or leave `frames` out"));
            }
            (Some(frames), _) | (None, Some(frames)) => *frames,
            (None, None) => {
                let what = "the path has no number of frames";
                return Err(place.wrong(what, "give `frames`, or every key its `frame`"));
            }
        };
        if frames == 0 || frames > MAX_FRAMES || keys.is_empty() {
            let what = format!("a path of {frames} frames through {} keys", keys.len());
            return Err(place.wrong(what, "give at least one of each, and at most 1048576 frames"));
        }
        let path = KeyedPath::new(keys, at, frames);
        (1..=frames).map(|frame| camera(text, &path.at(frame), resolution, &place)).collect()
    }

    /// Returns the frames of the keys in ascending order; empty if no key has a frame.
    fn key_frames(&self, keys: &[Spanned<KeyText>]) -> Result<Vec<usize>, SceneError> {
        let mut frames = Vec::new();
        if keys.iter().all(|key| key.get_ref().frame.is_none()) {
            return Ok(frames);
        }
        for key in keys {
            let place = self.file.place(key.span());
            let Some(frame) = key.get_ref().frame else {
                return Err(
                    place.wrong("this key has no frame, though others have", "give all a frame, or none")
                );
            };
            match frames.last() {
                _ if frame == 0 => return Err(place.wrong("a key is at frame 0", "frames count from 1")),
                Some(last) if frame <= *last => {
                    let what = format!("a key at frame {frame} follows a key at frame {last}");
                    return Err(place.wrong(what, "write keys in the order of their frames, one per frame"));
                }
                _ => frames.push(frame),
            }
        }
        Ok(frames)
    }
}

/// Rejects unknown names of axes and filters.
pub(super) fn check_names(file: SourceText, text: &CameraText) -> Result<(), SceneError> {
    if let Some(axis) = text.fov_axis.as_ref().filter(|axis| !["x", "y"].contains(&axis.get_ref().as_str())) {
        let what = format!("unknown fov_axis \"{}\"", axis.get_ref());
        return Err(file.place(axis.span()).wrong(what, "use x or y"));
    }
    match text.filter.as_ref().filter(|name| filter(name.get_ref()).is_none()) {
        Some(name) => {
            let remedy = "use box, tent, gaussian, blackman-harris, mitchell, catmull-rom or lanczos";
            Err(file.place(name.span()).wrong("the film's filter is not known", remedy))
        }
        None => Ok(()),
    }
}

/// Returns the size of a film in pixels, if it is given.
pub(super) fn film(
    file: SourceText,
    text: Option<&Spanned<FixedArray<u32, 2>>>,
) -> Result<Option<[u32; 2]>, SceneError> {
    let Some(text) = text else { return Ok(None) };
    let resolution = text.get_ref().0;
    if resolution.iter().any(|side| !(1..=MAX_SIDE).contains(side)) {
        let what = format!("the resolution is {} x {}", resolution[0], resolution[1]);
        return Err(file.place(text.span()).wrong(what, format!("give 1 to {MAX_SIDE} each")));
    }
    Ok(Some(resolution))
}

/// Returns a camera that stands at the first point and looks at the second.
pub(super) fn still(
    text: &CameraText,
    [origin, target]: [NumberArray<3>; 2],
    resolution: [u32; 2],
    place: &Location,
) -> Result<DraftCamera, SceneError> {
    let still = KeyText { frame: None, origin, target, up: None, fov: None };
    camera(text, &key(text, &still, place)?, resolution, place)
}

fn filter(name: &str) -> Option<PixelFilter> {
    match name {
        "box" => Some(PixelFilter::Box),
        "tent" => Some(PixelFilter::TENT),
        "gaussian" => Some(PixelFilter::GAUSSIAN),
        "blackman-harris" => Some(PixelFilter::BlackmanHarris),
        "mitchell" => Some(PixelFilter::Mitchell),
        "catmull-rom" => Some(PixelFilter::CatmullRom),
        "lanczos" => Some(PixelFilter::Lanczos),
        _ => None,
    }
}

/// Returns a key. The camera's up vector and field of view are its defaults.
fn key(camera: &CameraText, text: &KeyText, place: &Location) -> Result<Key, SceneError> {
    let up = text.up.or(camera.up).map_or(DVec3::Y, DVec3::from);
    let fov = fov(camera, text.fov, place)?;
    Ok(Key { origin: text.origin.into(), target: text.target.into(), up, fov })
}

/// Returns the field of view of a key in degrees: its own or the camera's.
fn fov(camera: &CameraText, own: Option<Number>, place: &Location) -> Result<f64, SceneError> {
    let fov = own.or(camera.fov).map_or(DEFAULT_FOV, f64::from);
    match fov > 0.0 && fov < 180.0 {
        true => Ok(fov),
        false => Err(place.wrong(format!("fov is {fov}"), "give 0 to 180 degrees")),
    }
}

fn camera(
    text: &CameraText,
    key: &Key,
    resolution: [u32; 2],
    place: &Location,
) -> Result<DraftCamera, SceneError> {
    let Key { origin, target, up, fov } = *key;
    let forward = unit(target - origin);
    let right = forward.and_then(|forward| right_of(forward, up));
    let (Some(forward), Some(right)) = (forward, right) else {
        let what = "the camera looks nowhere, or along its up vector";
        return Err(place.wrong(what, "move target away from origin, or turn up"));
    };
    let tan = (0.5 * fov.to_radians()).tan();
    let tan_half_x = match text.fov_axis.as_ref().map(|axis| axis.get_ref().as_str()) {
        Some("y") => tan * f64::from(resolution[0]) / f64::from(resolution[1]),
        _ => tan,
    };
    let (near, far) = (text.near.unwrap_or(0.0), text.far.unwrap_or(f64::INFINITY));
    if !(near >= 0.0 && near < far) {
        return Err(place.wrong(format!("near is {near}, far {far}"), "keep 0 <= near < far"));
    }
    let positive = |value: f64, name: &str| match value > 0.0 && value.is_finite() {
        true => Ok(value),
        false => Err(place.wrong(format!("{name} is {value}"), "give a number above 0")),
    };
    let mut half_width = tan_half_x;
    let projection = match (text.film_width, text.aperture_radius) {
        (Some(_), Some(_)) => {
            return Err(
                place.wrong("a parallel projection has no lens", "leave out aperture_radius or film_width")
            );
        }
        (Some(width), None) => {
            half_width = 0.5 * positive(width.into(), "film_width")?;
            Projection::Parallel
        }
        (None, Some(radius)) => {
            let distance = text.focus_distance.map_or_else(|| origin.distance(target), f64::from);
            let distance = positive(distance, "focus_distance")? as f32;
            Projection::Lens { radius: positive(radius.into(), "aperture_radius")? as f32, distance }
        }
        (None, None) => Projection::Pinhole,
    };
    let filter = text.filter.as_ref().and_then(|name| filter(name.get_ref())).unwrap_or_default();
    let placed = DraftCamera { origin, forward, right, up: right.cross(forward), ..DraftCamera::default() };
    Ok(DraftCamera { tan_half_x: half_width, near, far, projection, filter, ..placed })
}
