//! Footprints of ray cones on surfaces, over which textures are averaged.

use super::{Surfaces16, World};
use base::math::{Cone, Vec3x16, lanes_in};
use glam::Vec3;

impl World {
    /// Returns true if some textures are averaged over footprints.
    #[inline]
    pub fn filters_textures(&self) -> bool {
        self.materials.filter_textures()
    }

    /// Returns the side, in texture coordinates, of a square as large as the area that a cone with the given footprint
    /// (see [`super::Surface`]) covers of a triangle's plane.
    #[inline]
    pub(super) fn covered(&self, mesh: u32, primitive: u32, footprint: Vec3) -> f32 {
        let triangle = self.triangles.get(mesh, primitive);
        scene::texture::covered(triangle.uv_scale, triangle.normal, footprint)
    }

    /// Sets the footprints of rays along `direction` that hit `surfaces`, in the lanes of `hit`. `cone` returns the cone
    /// around a lane's ray.
    #[inline]
    pub fn cover(
        &self,
        surfaces: &mut Surfaces16,
        direction: &Vec3x16,
        hit: u16,
        cone: impl Fn(usize) -> Cone,
    ) {
        if self.filters_textures() {
            for lane in lanes_in(hit) {
                let width = cone(lane).width_at(surfaces.t[lane]);
                surfaces.footprint.set(lane, direction.get(lane) * width);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::testkit::*;
    use base::math::Rgb;
    use embree::Ray;
    use glam::{Vec2, Vec3};

    #[test]
    fn a_cone_covers_more_at_grazing_angles_up_to_a_limit() {
        let mut scene = scene(Default::default(), [1, 1]);
        let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
        // Four texture coordinates by two over a square of edge 2: u along x counts 2 a unit, v along y 1.
        let square = quad(Vec3::new(-1.0, -1.0, 0.0), Vec3::X * 2.0, Vec3::Y * 2.0, grey);
        scene.meshes.push(textured(square, Vec2::new(4.0, 2.0)));
        let world = world(scene);
        let covered = |direction: Vec3| {
            let ray = Ray::new(Vec3::new(0.1, 0.2, 0.0) - direction, direction);
            let surface = world.intersect(&ray).expect("the square");
            assert_eq!(world.covered(0, surface.triangle, Vec3::ZERO), 0.0);
            world.covered(0, surface.triangle, direction * 0.1)
        };
        // An area of .1 by .1, and one of .1 by .1 / .6 at a cosine of .6.
        assert!((covered(-Vec3::Z).powi(2) - 0.02).abs() < 1e-6);
        assert!((covered(Vec3::new(0.8, 0.0, -0.6)).powi(2) - 0.02 / 0.6).abs() < 1e-6);
        let grazing = covered(Vec3::new(1.0, 0.0, -1e-4).normalize());
        assert!((grazing.powi(2) - 0.02 / 0.01).abs() < 1e-4, "{grazing}");
    }

    #[test]
    fn what_has_no_texture_coordinates_covers_none() {
        let mut scene = scene(Default::default(), [1, 1]);
        let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
        scene.meshes.push(quad(Vec3::new(-1.0, -1.0, 0.0), Vec3::X * 2.0, Vec3::Y * 2.0, grey));
        assert_eq!(world(scene).covered(0, 0, -Vec3::Z), 0.0);
    }
}
