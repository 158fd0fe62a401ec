//! Random cameras on a shell around a scene, which look at its middle.

use base::math::right_of;
use glam::{DVec3, Vec2, Vec3};
use readers::UpAxis;
use scene::Scene;

/// Full turn in degrees.
const TURN: f64 = 360.0;

/// The smallest sphere around the middle of a scene's box that holds the scene, in units of its file.
pub struct Shell {
    middle: DVec3,
    radius: f64,
    up: UpAxis,
}

impl Shell {
    /// Returns the shell of a scene; `None` without triangles.
    pub fn around(scene: &Scene, up: UpAxis) -> Option<Shell> {
        let boxes = scene.seen_bounds(|_| true);
        let [low, high] = boxes.into_iter().reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])?;
        let middle = 0.5 * (low + high);
        let farthest = |(stored, placement): (usize, Option<&base::math::Placement>)| {
            let place = |p: &Vec3| placement.map_or(*p, |placement| placement.point(*p));
            let positions = scene.meshes.get(stored).map_or(&[][..], |mesh| &mesh.positions);
            positions.iter().map(|p| place(p).distance(middle)).fold(0.0, f32::max)
        };
        let radius = scene.seen().map(farthest).fold(0.0, f32::max);
        let middle = scene.centre + middle.as_dvec3() * scene.unit();
        Some(Shell { middle, radius: f64::from(radius) * scene.unit(), up })
    }

    /// Returns the rows of the matrix from camera to world coordinates. The camera looks along -z with y up.
    ///
    /// `around` and `along` in the unit cube choose the camera in ranges of elevation in degrees and of distance. At
    /// distance 1, an image with the tangent `narrow` of half its narrower field of view just holds the sphere.
    pub fn pose(&self, around: Vec2, along: f32, ranges: [[f64; 2]; 2], narrow: f64) -> [[f64; 4]; 4] {
        let [elevations, distances] = ranges;
        let between = |[low, high]: [f64; 2], at: f32| low + (high - low) * f64::from(at);
        // Cameras are spread evenly over the area of the shell.
        let sine = between(elevations.map(|angle| angle.to_radians().sin()), around.y);
        let angles = [TURN * f64::from(around.x), sine.clamp(-1.0, 1.0).asin().to_degrees()];
        let back = self.up.direction(angles);
        let distance = between(distances, along) * self.radius * (1.0 + 1.0 / (narrow * narrow)).sqrt();
        let origin = self.middle + back * distance;
        let right = right_of(-back, self.up.vector()).unwrap_or(DVec3::X);
        let up = right.cross(-back);
        let row = |i: usize| [right[i], up[i], back[i], origin[i]];
        [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]
    }
}

#[cfg(test)]
mod tests {
    use super::super::info_lists::tests::triangle;
    use super::*;

    #[test]
    fn the_whole_sphere_is_in_view_at_distance_one() {
        let positions = vec![Vec3::new(-1.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 0.5, 0.5)];
        let mesh = triangle(positions);
        let scene = Scene { meshes: vec![mesh], centre: DVec3::new(5.0, 0.0, 0.0), ..Scene::default() };
        let shell = Shell::around(&scene, UpAxis::Z).unwrap();
        assert!((shell.middle - DVec3::new(5.0, 0.25, 0.25)).length() < 1e-6);
        let narrow = 0.4;
        for i in 0..64 {
            let around = Vec2::new(i as f32 / 64.0, (i * 7 % 64) as f32 / 64.0);
            let pose = shell.pose(around, 0.0, [[-20.0, 70.0], [1.0, 2.0]], narrow);
            let column = |k: usize| DVec3::new(pose[0][k], pose[1][k], pose[2][k]);
            let (back, to) = (column(2), column(3) - shell.middle);
            // The angle of the sphere's outline is the angle of the edge.
            assert!((shell.radius / to.length() - narrow.atan().sin()).abs() < 1e-9);
            assert!((back * to.length() - to).length() < 1e-9 && back.z > -0.343 && back.z < 0.94);
            assert!(column(1).z > 0.0 && (column(0).cross(column(1)) - back).length() < 1e-9);
        }
    }
}
