//! The part of a texture that the cone around a ray covers.
//!
//! Paper: Akenine-Möller et al., *Improved Shader and Texture Level of Detail Using Ray Cones*, 2021: the cone's width
//! over the root of the cosine, times the root of the ratio of the triangle's areas, by texture coordinates and in the
//! scene.
//! Deviations: the root of the cosine, where the paper has the cosine: what is covered is as large, and not as long.

use super::{Surfaces16, World};
use base::math::{Cone, Vec3x16, lanes_in};
use glam::Vec3;

/// Minimum cosine between a ray and the normal: beyond it, what the cone covers grows no longer.
const MIN_COS: f32 = 0.01;

impl World {
    /// True if some textures are averaged over what a ray stands for.
    #[inline]
    pub fn filters_textures(&self) -> bool {
        self.materials.filter_textures()
    }

    /// Side, by texture coordinates, of a square as large as what a cone with the given footprint (see
    /// [`super::Surface`]) covers of a triangle's plane; 0 where that is a point.
    #[inline]
    pub(super) fn covered(&self, mesh: u32, primitive: u32, footprint: Vec3) -> f32 {
        let triangle = self.triangles.get(mesh, primitive);
        let width_sq = footprint.length_squared();
        let width_cos = triangle.normal.dot(footprint).abs().max(MIN_COS * width_sq.sqrt());
        match width_sq > 0.0 {
            true => triangle.uv_scale * (width_sq * width_sq.sqrt() / width_cos).sqrt(),
            false => 0.0,
        }
    }

    /// Notes the footprints of rays along `direction` that met `surfaces` in the lanes of `found` within `cone(lane)`.
    #[inline]
    pub fn cover(
        &self,
        surfaces: &mut Surfaces16,
        direction: &Vec3x16,
        found: u16,
        cone: impl Fn(usize) -> Cone,
    ) {
        if self.filters_textures() {
            for lane in lanes_in(found) {
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
