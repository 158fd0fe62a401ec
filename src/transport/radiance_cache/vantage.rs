//! Camera of a frame, from which the spacing of eye samples at a record follows.

use super::record::Record;
use glam::Vec3;
use scene::Projection;
use world::view::View;

/// Minimum cosine, between the normal and the direction to the eye, that foreshortens; the same as for eye samples.
const MIN_COS: f32 = 0.05;

/// Camera of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Vantage {
    eye: Vec3,
    /// Direction of a parallel projection.
    axis: Option<Vec3>,
    /// Distance between pixels at distance 1, or a common factor of all frames.
    pixel: f32,
}

impl Vantage {
    /// Returns the vantage of a frame of a film, whose frames all have one lens and one size.
    pub fn in_film(view: &View) -> Vantage {
        Vantage::at(view.camera.origin)
    }

    /// Returns the vantage of a view that shares records with views of other lenses and sizes.
    pub fn of(view: &View) -> Vantage {
        let axis = (view.camera.projection == Projection::Parallel).then_some(view.camera.forward);
        let pixel = 2.0 * view.camera.tan_half_x / view.window.film[0] as f32;
        Vantage { eye: view.camera.origin, axis, pixel: pixel.max(f32::MIN_POSITIVE) }
    }

    /// Returns the vantage of an eye, whose pixels are 1 apart at distance 1.
    pub fn at(eye: Vec3) -> Vantage {
        Vantage { eye, axis: None, pixel: 1.0 }
    }

    /// Returns a length to which the spacing of eye samples at a record is proportional: the distance between pixels
    /// there, foreshortened. Chains through mirrors are longer, so that spacings are never overestimated as the camera
    /// moves.
    pub fn spacing(&self, record: &Record) -> f32 {
        if let Some(axis) = self.axis {
            return self.pixel / record.normal.dot(axis).abs().max(MIN_COS).sqrt();
        }
        let to_eye = self.eye - record.position;
        let distance = to_eye.length();
        let cos = record.normal.dot(to_eye).abs() / distance.max(f32::MIN_POSITIVE);
        (distance / cos.max(MIN_COS).sqrt()).max(f32::MIN_POSITIVE) * self.pixel
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::record;
    use super::*;
    use base::math::Rgb;
    use scene::Camera;

    #[test]
    fn spacings_follow_distance_lens_size_and_projection() {
        let record = record(Vec3::ZERO, [1.0; 2], Rgb::ONE);
        let seen = |distance: f32, tan_half_x: f32, width: u32, projection| {
            let origin = record.normal * distance;
            let camera =
                Camera { origin, forward: -record.normal, tan_half_x, projection, ..Camera::default() };
            Vantage::of(&View::whole(camera, [width, 10])).spacing(&record)
        };
        let near = seen(2.0, 1.0, 100, Projection::Pinhole);
        assert!((near - 0.04).abs() < 1e-6);
        assert!((seen(4.0, 1.0, 100, Projection::Pinhole) - 2.0 * near).abs() < 1e-6);
        assert!((seen(2.0, 0.5, 200, Projection::Pinhole) - near / 4.0).abs() < 1e-6);
        for distance in [2.0, 4.0] {
            assert!((seen(distance, 2.0, 100, Projection::Parallel) - 0.04).abs() < 1e-6);
        }
        let view = View::whole(Camera { origin: Vec3::ONE, ..Camera::default() }, [16, 16]);
        assert_eq!(Vantage::in_film(&view).spacing(&record), Vantage::at(Vec3::ONE).spacing(&record));
    }
}
