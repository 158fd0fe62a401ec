//! Cameras of a model that moves, whose frames are scenes of their own.
//!
//! Each frame of the model is recentred by itself. A model without a camera gets one that shows all of it, and the
//! camera would follow the model. So the cameras of one frame see all frames.

use scene::{Camera, Cameras, Projection, Scene};

/// Returns `cameras` of the scene `of` in the coordinates of another frame's scene.
pub fn cameras_in(scene: &Scene, cameras: &Cameras, of: &Scene) -> Cameras {
    let scale = of.unit() / scene.unit();
    let length = |length: f32| (f64::from(length) * scale) as f32;
    let moved = |camera: &Camera| {
        let world = of.centre + camera.origin.as_dvec3() * of.unit();
        let projection = match camera.projection {
            Projection::Pinhole | Projection::Parallel => camera.projection,
            Projection::Lens { radius, distance } => {
                Projection::Lens { radius: length(radius), distance: length(distance) }
            }
        };
        let is_parallel = matches!(camera.projection, Projection::Parallel);
        Camera {
            origin: ((world - scene.centre) / scene.unit()).as_vec3(),
            tan_half_x: if is_parallel { length(camera.tan_half_x) } else { camera.tan_half_x },
            shift: if is_parallel { camera.shift.map(length) } else { camera.shift },
            near: length(camera.near),
            far: length(camera.far),
            projection,
            ..*camera
        }
    };
    Cameras {
        still: moved(&cameras.still),
        path: cameras.path.iter().map(moved).collect(),
        resolution: cameras.resolution,
        crop: cameras.crop,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};

    #[test]
    fn cameras_keep_their_place_in_the_world() {
        let of = Scene { centre: DVec3::new(1.0, 2.0, 3.0), exponent: 2, ..Scene::default() };
        let scene = Scene { centre: DVec3::new(-1.0, 0.0, 5.0), exponent: 1, ..Scene::default() };
        let projection = Projection::Lens { radius: 0.25, distance: 3.0 };
        let camera = Camera { origin: Vec3::X, near: 0.5, tan_half_x: 0.7, projection, ..Camera::default() };
        let parallel = Camera { projection: Projection::Parallel, ..camera };
        let cameras = Cameras { still: camera, path: vec![parallel], resolution: [4, 3], crop: None };
        let found = cameras_in(&scene, &cameras, &of);
        // The world position is (5, 2, 3), and a unit becomes two.
        assert_eq!(found.still.origin, Vec3::new(3.0, 1.0, -1.0));
        assert_eq!((found.still.near, found.still.far, found.still.tan_half_x), (1.0, f32::INFINITY, 0.7));
        assert_eq!(found.still.projection, Projection::Lens { radius: 0.5, distance: 6.0 });
        assert_eq!((found.path[0].tan_half_x, found.resolution), (1.4, [4, 3]));
        assert_eq!(cameras_in(&of, &cameras, &of).still.origin, camera.origin);
    }
}
