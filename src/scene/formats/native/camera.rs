//! Camera and walk-through of the native format.
//!
//! Paper: Yuksel, Schaefer and Keyser, *Parameterization and Applications of Catmull-Rom Curves*, CAD 2011:
//! the path through the keys is a centripetal Catmull-Rom curve, which neither overshoots nor loops between
//! keys. Eye and target follow it together, at constant parameter speed, end keys included.

use super::text::{CameraText, KeyText, SceneText};
use super::{Builder, finite};
use crate::scene::draft::{DraftCamera, Shot};
use crate::scene::formats::error::{Place, SceneError};
use glam::DVec3;

/// A key: eye and target.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    origin: DVec3,
    target: DVec3,
}

impl Key {
    fn blend(self, other: Key, t: f64) -> Key {
        Key { origin: self.origin.lerp(other.origin, t), target: self.target.lerp(other.target, t) }
    }

    fn distance(self, other: Key) -> f64 {
        let squared = self.origin.distance_squared(other.origin) + self.target.distance_squared(other.target);
        squared.sqrt()
    }
}

impl Builder<'_> {
    pub(super) fn shot(&self, scene: &SceneText) -> Result<Shot, SceneError> {
        let place = self.file.place(scene.resolution.span());
        let resolution = *scene.resolution.get_ref();
        if resolution.iter().any(|r| !(1..=65536).contains(r)) {
            let what = format!("the resolution is {} x {}", resolution[0], resolution[1]);
            return Err(place.wrong(what, "give 1 to 65536 each"));
        }
        let place = self.file.place(scene.camera.span());
        let text = scene.camera.get_ref();
        let tan_half_x = self.tan_half_x(text, resolution, &place)?;
        let still = key(&KeyText { origin: text.origin, target: text.target }, &place)?;
        let camera = camera(text, still, tan_half_x, &place)?;
        let mut path = Vec::new();
        if let Some(walk) = &text.path {
            let place = self.file.place(walk.span());
            let walk = walk.get_ref();
            let keys: Vec<Key> = walk.keys.iter().map(|k| key(k, &place)).collect::<Result<_, _>>()?;
            if walk.frames == 0 || walk.frames > 1 << 20 || keys.is_empty() {
                let what = format!("a path of {} frames through {} keys", walk.frames, keys.len());
                return Err(place.wrong(what, "give at least one of each"));
            }
            for frame in 0..walk.frames {
                let t = frame as f64 / (walk.frames.max(2) - 1) as f64;
                path.push(self::camera(text, along(&keys, t), tan_half_x, &place)?);
            }
        }
        Ok(Shot { camera, path, resolution })
    }

    fn tan_half_x(&self, text: &CameraText, resolution: [u32; 2], place: &Place) -> Result<f64, SceneError> {
        if !(text.fov > 0.0 && text.fov < 180.0) {
            return Err(place.wrong(format!("fov is {}", text.fov), "give 0 to 180 degrees"));
        }
        let tan = (0.5 * text.fov.to_radians()).tan();
        match text.fov_axis.as_ref().map(|a| (a.get_ref().as_str(), a.span())) {
            None | Some(("x", _)) => Ok(tan),
            Some(("y", _)) => Ok(tan * f64::from(resolution[0]) / f64::from(resolution[1])),
            Some((other, span)) => {
                let what = format!("unknown fov_axis \"{other}\"");
                Err(self.file.place(span).wrong(what, "use x or y"))
            }
        }
    }
}

fn key(text: &KeyText, place: &Place) -> Result<Key, SceneError> {
    let origin = finite(text.origin, "the camera's origin", place)?;
    Ok(Key { origin, target: finite(text.target, "the camera's target", place)? })
}

fn camera(text: &CameraText, key: Key, tan_half_x: f64, place: &Place) -> Result<DraftCamera, SceneError> {
    let up = finite(text.up.unwrap_or([0.0, 1.0, 0.0]), "the camera's up", place)?;
    let forward = (key.target - key.origin).try_normalize();
    let right = forward.and_then(|f| f.cross(up).try_normalize());
    let (Some(forward), Some(right)) = (forward, right) else {
        let what = "the camera looks nowhere, or along its up vector";
        return Err(place.wrong(what, "move target away from origin, or turn up"));
    };
    let (near, far) = (text.near.unwrap_or(0.0), text.far.unwrap_or(f64::INFINITY));
    if !(near >= 0.0 && near < far) {
        return Err(place.wrong(format!("near is {near}, far {far}"), "keep 0 <= near < far"));
    }
    Ok(DraftCamera { origin: key.origin, forward, right, up: right.cross(forward), tan_half_x, near, far })
}

/// Returns the key at `t` in [0, 1] along the curve through `keys`.
fn along(keys: &[Key], t: f64) -> Key {
    let [first, .., last] = keys else { return keys[0] };
    // Ends are extrapolated linearly.
    let before = first.blend(keys[1], -1.0);
    let after = last.blend(keys[keys.len() - 2], -1.0);
    let points: Vec<Key> = [before].into_iter().chain(keys.iter().copied()).chain([after]).collect();
    // Centripetal knots; coincident keys are separated by a tiny distance.
    let mut knots = vec![0.0];
    for pair in points.windows(2) {
        knots.push(knots[knots.len() - 1] + pair[0].distance(pair[1]).sqrt().max(1e-9));
    }
    let (start, end) = (knots[1], knots[knots.len() - 2]);
    let u = start + (end - start) * t.clamp(0.0, 1.0);
    let segment = (1..points.len() - 2).rev().find(|&i| knots[i] <= u).unwrap_or(1);
    barry_goldman(&points[segment - 1..segment + 3], &knots[segment - 1..segment + 3], u)
}

/// Evaluates the segment between the middle two of four points by repeated interpolation.
fn barry_goldman(p: &[Key], k: &[f64], u: f64) -> Key {
    let mix = |a: Key, b: Key, from: f64, to: f64| a.blend(b, (u - from) / (to - from));
    let a = [0, 1, 2].map(|i| mix(p[i], p[i + 1], k[i], k[i + 1]));
    let b = [0, 1].map(|i| mix(a[i], a[i + 1], k[i], k[i + 2]));
    mix(b[0], b[1], k[1], k[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> Key {
        Key { origin: DVec3::new(x, y, 0.0), target: DVec3::new(x, y, -1.0) }
    }

    #[test]
    fn the_path_goes_through_its_keys_from_end_to_end() {
        let keys = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 2.0), at(5.0, 2.0)];
        assert!(along(&keys, 0.0).distance(keys[0]) < 1e-9);
        assert!(along(&keys, 1.0).distance(keys[3]) < 1e-9);
        for key in keys {
            let nearest =
                (0..=4000).map(|i| along(&keys, i as f64 / 4000.0).distance(key)).fold(f64::MAX, f64::min);
            assert!(nearest < 5e-3, "{nearest}");
        }
    }

    #[test]
    fn the_path_is_smooth() {
        let keys = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 2.0), at(5.0, 2.0)];
        let step = 1e-4;
        let velocity = |i: i32| {
            let [a, b] = [0, 1].map(|k| along(&keys, (i + k) as f64 * step).origin);
            (b - a) / step
        };
        for i in 0..9998 {
            let turn = (velocity(i + 1) - velocity(i)).length();
            assert!(turn < 0.02, "{i} {turn}");
        }
    }

    #[test]
    fn one_key_and_keys_that_coincide_are_no_trouble() {
        assert_eq!(along(&[at(1.0, 1.0)], 0.5), at(1.0, 1.0));
        let still = along(&[at(1.0, 1.0), at(1.0, 1.0), at(1.0, 1.0)], 0.3);
        assert!(still.distance(at(1.0, 1.0)) < 1e-6);
        let turn = along(&[at(1.0, 1.0), Key { target: DVec3::X, ..at(1.0, 1.0) }], 0.5);
        assert!(turn.origin.distance(DVec3::new(1.0, 1.0, 0.0)) < 1e-12);
    }
}
