//! Camera that the caller places in a scene, instead of the scene's own.

use crate::draft::{Draft, DraftCamera};
use crate::error::{Location, SceneError};
use crate::finish::framing;
use crate::lighting::UpAxis;
use base::math::{right_of, unit};
use glam::{DQuat, DVec3};
use scene::Projection;
use std::f64::consts::TAU;

/// Range of fields of view in degrees, exclusive.
const FOV: [f64; 2] = [0.0, 180.0];

/// Changes of a scene's camera. The default changes nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Viewpoint {
    /// Position of the camera in the units of the scene's file.
    pub from: Option<DVec3>,
    /// Point that the camera looks at; the middle of the scene if only `from` is given.
    pub at: Option<DVec3>,
    /// Horizontal field of view in degrees.
    pub fov: Option<f64>,
    /// Azimuth and elevation in degrees of a camera that sees the whole scene. The azimuth counts from the front
    /// towards the viewer's right.
    pub around: Option<[f64; 2]>,
    /// Number of frames in which the camera goes once around the middle of the scene, counter-clockwise seen from
    /// above.
    pub turntable: Option<usize>,
    /// Lens of all cameras.
    pub lens: Option<Lens>,
}

/// A lens in place of a pinhole, in units of the scene's file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Radius.
    pub radius: f64,
    /// Distance of the plane in focus along the axis; `None` for the surface in the middle of the image.
    pub focus: Option<f64>,
}

impl Viewpoint {
    /// Changes the cameras of a draft. A camera that is to see everything stands upright by `up` if that is given.
    ///
    /// # Errors
    /// If the camera would look nowhere.
    pub(crate) fn apply(
        &self,
        draft: &mut Draft,
        up: Option<UpAxis>,
        place: &Location,
    ) -> Result<(), SceneError> {
        self.place(draft, up, place)?;
        if let Some(frames) = self.turntable {
            let (axis, middle) = (up.unwrap_or(UpAxis::Y).vector(), framing::middle(draft));
            let turned = |frame: usize| {
                let turn = DQuat::from_axis_angle(axis, TAU * frame as f64 / frames as f64);
                let DraftCamera { origin, forward, right, up, .. } = draft.shot.camera;
                let origin = middle + turn * (origin - middle);
                let [forward, right, up] = [forward, right, up].map(|direction| turn * direction);
                DraftCamera { origin, forward, right, up, ..draft.shot.camera }
            };
            draft.shot.path = (0..frames).map(turned).collect();
        }
        Ok(())
    }

    /// Places the camera of a still.
    fn place(&self, draft: &mut Draft, up: Option<UpAxis>, place: &Location) -> Result<(), SceneError> {
        if let Some(fov) = self.fov {
            if !(fov > FOV[0] && fov < FOV[1]) {
                return Err(
                    place.wrong(format!("--fov is {fov}"), "give more than 0 and less than 180 degrees")
                );
            }
            let still = [&mut draft.shot.camera];
            for camera in still.into_iter().chain(&mut draft.shot.path) {
                camera.tan_half_x = (0.5 * fov).to_radians().tan();
                if camera.projection == Projection::Parallel {
                    camera.projection = Projection::Pinhole;
                }
            }
        }
        let stated = up.map(UpAxis::vector);
        let up = up.unwrap_or(UpAxis::Y);
        let (forward, origin) = match (self.from, self.at, self.around) {
            (_, _, Some(angles)) => (-up.direction(angles), None),
            (Some(from), at, None) => {
                let at = at.unwrap_or_else(|| framing::middle(draft));
                let nowhere = || place.wrong("--look-from and --look-at are one point", "move one of them");
                (unit(at - from).ok_or_else(nowhere)?, Some(from))
            }
            (None, Some(at), None) => {
                let from = draft.shot.camera.origin;
                let nowhere = || place.wrong("--look-at is where the camera stands", "add --look-from");
                let forward = unit(at - from).filter(|_| !draft.shot.fits);
                (forward.ok_or_else(nowhere)?, Some(from))
            }
            (None, None, None) => match stated.filter(|_| draft.shot.fits) {
                Some(up) => (-framing::outlook(up), None),
                None => return Ok(()),
            },
        };
        // A camera that looks straight up or down has the front at the top or the bottom of the film.
        let right = right_of(forward, up.vector()).unwrap_or(DVec3::X);
        let camera = &mut draft.shot.camera;
        let origin_or_own = origin.unwrap_or(camera.origin);
        let (near, far) = (0.0, f64::INFINITY);
        *camera = DraftCamera {
            origin: origin_or_own,
            forward,
            right,
            up: right.cross(forward),
            near,
            far,
            ..*camera
        };
        draft.shot.fits = origin.is_none();
        draft.shot.path.clear();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LoadOptions, Loaded, load};
    use glam::Vec3;

    /// Returns a cube of side 2 around (10, 0, 0), seen as the options say.
    fn seen(camera: &str, viewpoint: Viewpoint, up: Option<UpAxis>) -> Result<Loaded, SceneError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.toml");
        let text = format!(
            "{camera}\n[[material]]\nname = \"m\"\nkind = \"diffuse\"\nreflectance = 0.5\n\
             [[mesh]]\nshape = \"cube\"\nmaterial = \"m\"\ntransform = [{{ translate = [10, 0, 0] }}]\n"
        );
        std::fs::write(&path, text).unwrap();
        load(&path, &LoadOptions { viewpoint, up, ..LoadOptions::default() })
    }

    #[test]
    fn cameras_stand_and_look_where_they_are_told() {
        let from = Some(DVec3::new(10.0, 0.0, 8.0));
        let camera = seen("", Viewpoint { from, ..Viewpoint::default() }, None).unwrap().cameras.still;
        // The scene's centre is the origin of local coordinates.
        assert!((camera.origin - Vec3::new(0.0, 0.0, 8.0)).length() < 1e-5);
        assert!((camera.forward - Vec3::NEG_Z).length() < 1e-6 && (camera.up - Vec3::Y).length() < 1e-6);
        let at = Some(DVec3::new(18.0, 0.0, 8.0));
        let wide = Viewpoint { from, at, fov: Some(90.0), ..Viewpoint::default() };
        let camera = seen("", wide, None).unwrap().cameras.still;
        assert!((camera.forward - Vec3::X).length() < 1e-6 && (camera.tan_half_x - 1.0).abs() < 1e-6);
        let own = "camera = { origin = [10, 0, 5], target = [10, 0, 0] }";
        let turned =
            seen(own, Viewpoint { at: Some(DVec3::new(10.0, 5.0, 5.0)), ..Viewpoint::default() }, None);
        let camera = turned.unwrap().cameras.still;
        assert!((camera.forward - Vec3::Y).length() < 1e-6 && camera.right.is_finite());
    }

    #[test]
    fn cameras_around_a_scene_see_all_of_it_upright() {
        for (up, vector, front) in [(UpAxis::Y, Vec3::Y, Vec3::Z), (UpAxis::Z, Vec3::Z, Vec3::NEG_Y)] {
            let around = Viewpoint { around: Some([0.0, 0.0]), ..Viewpoint::default() };
            let camera = seen("", around, Some(up)).unwrap().cameras.still;
            assert!((camera.forward + front).length() < 1e-6 && (camera.up - vector).length() < 1e-6);
            assert!(camera.origin.dot(front) > 2.0 && (camera.origin.reject_from(front)).length() < 1e-4);
            let default = seen("", Viewpoint::default(), Some(up)).unwrap().cameras.still;
            assert!(default.forward.dot(vector) < 0.0 && default.up.dot(vector) > 0.9);
        }
    }

    #[test]
    fn turntables_are_circles_on_which_everything_is_in_view() {
        let turned = |camera: &str, viewpoint: Viewpoint| {
            let viewpoint = Viewpoint { turntable: Some(8), ..viewpoint };
            seen(camera, viewpoint, None).unwrap().cameras.path
        };
        let own = turned("camera = { origin = [10, 1, 5], target = [10, 0, 0] }", Viewpoint::default());
        let around = turned("", Viewpoint { around: Some([0.0, 20.0]), ..Viewpoint::default() });
        for path in [own, around] {
            assert_eq!(path.len(), 8);
            for (frame, camera) in path.iter().enumerate() {
                let (sin, cos) = (frame as f32 * std::f32::consts::FRAC_PI_4).sin_cos();
                let level = path[0].origin.with_y(0.0).length();
                let expected = Vec3::new(level * sin, path[0].origin.y, level * cos);
                assert!((camera.origin - expected).length() < 1e-4, "{frame} {camera:?}");
                assert!(camera.origin.normalize().dot(camera.forward) < -0.99);
            }
        }
        // The corners of the cube are farther apart than its sides.
        let still = seen("", Viewpoint { around: Some([0.0, 20.0]), ..Viewpoint::default() }, None);
        let around = turned("", Viewpoint { around: Some([0.0, 20.0]), ..Viewpoint::default() });
        assert!(around[0].origin.length() > still.unwrap().cameras.still.origin.length());
    }

    #[test]
    fn cameras_that_would_look_nowhere_are_errors() {
        let here = Some(DVec3::ONE);
        let refuse = |viewpoint| seen("", viewpoint, None).unwrap_err().to_string();
        assert!(refuse(Viewpoint { from: here, at: here, ..Viewpoint::default() }).contains("one point"));
        assert!(refuse(Viewpoint { at: here, ..Viewpoint::default() }).contains("add --look-from"));
        assert!(refuse(Viewpoint { fov: Some(180.0), ..Viewpoint::default() }).contains("--fov is 180"));
    }
}
