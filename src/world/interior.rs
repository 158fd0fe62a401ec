//! Absorption inside glass, by Beer's law: light that goes the way d inside keeps the share exp(-σ d).
//!
//! The inside of glass that absorbs is behind its surface. Nothing stores in which bodies a point lies. An edge of a
//! path
//! is inside if it starts on the inside of such a surface, or else if it ends there. Sheets on the way divide the edge,
//! and leave the interior as it is unless they absorb themselves.
//!
//! Deviations:
//! - Light between two other surfaces inside a body of glass is not absorbed, nor is their emission on the way to it.
//!   Light between them and the glass is.
//! - Where bodies overlap, the one whose surface starts the edge counts.
//! - Edges that end on no surface are not absorbed. So a mesh with a hole lets light out there.

use super::{Surface, World};
use base::math::Rgb;
use embree::{Hit, Ray};
use glam::Vec3;

/// Body of glass that absorbs, or none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Interior(u32);

impl Interior {
    /// No such body.
    pub const NONE: Interior = Interior(0);
}

impl World {
    /// Returns true if there is glass that absorbs.
    #[inline]
    pub fn absorbs(&self) -> bool {
        !self.absorption.is_empty()
    }

    /// Returns the interior on the side of a surface to which the vector `towards` points. `normal` is the geometric
    /// normal of the mesh there.
    #[inline]
    pub fn interior(&self, mesh: u32, normal: Vec3, towards: Vec3) -> Interior {
        let is_inside = self.is_boundary(mesh) && normal.dot(towards) < 0.0;
        if is_inside { Interior(mesh + 1) } else { Interior::NONE }
    }

    /// Returns the interior in which a path goes on along `towards` from a surface that it met in the interior
    /// `before`. `straight` is true if it passes the surface in its direction.
    #[inline]
    pub fn interior_after(&self, before: Interior, met: &Surface, towards: Vec3, straight: bool) -> Interior {
        match straight && !self.is_boundary(met.mesh) {
            true => before,
            false => self.interior(met.mesh, met.normal, towards),
        }
    }

    /// Returns the share of the light that an edge inside of the given length leaves.
    #[inline]
    pub fn through(&self, interior: Interior, length: f32) -> Rgb {
        match interior.0.checked_sub(1).and_then(|mesh| self.absorption.coefficient(mesh)) {
            Some(absorption) => (absorption * -length).exp(),
            None => Rgb::ONE,
        }
    }

    /// Returns the shares of the light that pass an edge: for light that the surface at its end emits, and for light
    /// that it scatters.
    ///
    /// The edge goes along the unit vector `direction` from the ray parameter `from` on, starts in the interior
    /// `start`, and ends at `met`. Samples of emitters know only where an edge starts, so that its end does not count
    /// for emission.
    #[inline]
    pub fn edge_shares(&self, start: Interior, met: &Surface, direction: Vec3, from: f32) -> [Rgb; 2] {
        let length = (met.t - from).max(0.0);
        if start != Interior::NONE {
            return [self.through(start, length); 2];
        }
        [Rgb::ONE, self.through(self.interior(met.mesh, met.normal, -direction), length)]
    }

    /// Returns the share of the light from `distance` away that arrives along `direction` at a surface point, if
    /// nothing but absorption at the start of the segment counts.
    #[inline]
    pub fn share_from(&self, at: &Surface, direction: Vec3, distance: f32) -> Rgb {
        match self.absorbs() && distance < f32::INFINITY {
            true => self.through(self.interior(at.mesh, at.normal, direction), distance),
            false => Rgb::ONE,
        }
    }

    /// Returns the share of the light that the interiors between the sheets on a segment leave. `sheets` are in order.
    pub(super) fn share_between(&self, segment: &Ray, sheets: impl Iterator<Item = Hit>) -> Rgb {
        let length = segment.direction.length();
        let (mut inside, mut from, mut share) = (Interior::NONE, segment.t_near, Rgb::ONE);
        for hit in sheets {
            let normal = self.geometric_normal(hit.geometry, hit.primitive);
            let here = match inside {
                Interior::NONE => self.interior(hit.geometry, normal, -segment.direction),
                inside => inside,
            };
            share *= self.through(here, (hit.t - from).max(0.0) * length);
            if self.is_boundary(hit.geometry) {
                inside = self.interior(hit.geometry, normal, segment.direction);
            }
            from = hit.t;
        }
        match segment.t_far < f32::INFINITY {
            true => share * self.through(inside, (segment.t_far - from).max(0.0) * length),
            false => share,
        }
    }

    /// Returns true if a mesh is the surface of glass that absorbs.
    #[inline]
    fn is_boundary(&self, mesh: u32) -> bool {
        self.absorption.coefficient(mesh).is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beyond;
    use crate::testkit::*;
    use scene::{Camera, Material, Mesh};

    const FIRST: Rgb = Rgb::new(0.2, 0.7, 1.5);
    const SECOND: Rgb = Rgb::new(0.9, 0.0, 0.3);

    /// Returns a closed box with fronts outwards.
    fn block(low: Vec3, high: Vec3, scene: &mut SceneAndView, material: Material) -> Vec<Mesh> {
        let material = add_material(scene, material);
        let mut faces = room(low, high, material);
        faces.iter_mut().flat_map(|mesh| &mut mesh.triangles).for_each(|t| t.swap(1, 2));
        faces
    }

    /// Blocks of two kinds of glass, from x = 0 to 1 and from 2 to 3, with a veil in the first and between them.
    fn blocks(eta: f32) -> WorldAndView {
        let mut scene = scene(Camera::default(), [1, 1]);
        for (x, absorption) in [(0.0, FIRST), (2.0, SECOND)] {
            let material = Material { absorption: Some(absorption), ..glass(eta) };
            let (low, high) = (Vec3::new(x, -9.0, -9.0), Vec3::new(x + 1.0, 9.0, 9.0));
            let faces = block(low, high, &mut scene, material);
            scene.meshes.extend(faces);
        }
        let veil = Material { opacity: Some(0.5.into()), ..diffuse(Rgb::ONE) };
        let veil = add_material(&mut scene, veil);
        for x in [0.6, 1.5] {
            scene.meshes.push(quad(Vec3::new(x, -9.0, -9.0), Vec3::Y * 18.0, Vec3::Z * 18.0, veil));
        }
        world(scene)
    }

    fn assert_near(found: Rgb, expected: Rgb) {
        assert!((found - expected).abs().max_element() < 1e-5, "{found} for {expected}");
    }

    #[test]
    fn shadow_rays_lose_light_by_their_length_inside() {
        let world = blocks(1.0);
        for slant in [Vec3::ZERO, Vec3::new(0.0, 0.3, -0.4)] {
            let at = |x: f32| Vec3::new(x, 0.1, 0.2) + slant * x;
            let stretch = (1.0 + slant.length_squared()).sqrt();
            for (from, to, first, second, veils) in [
                (-1.0, 4.0, 1.0, 1.0, 2),
                (4.0, -1.0, 1.0, 1.0, 2),
                // Between 0.25 and the veil at 0.6, the segment neither starts nor ends on glass.
                (0.25, 4.0, 0.4, 1.0, 2),
                (0.7, 4.0, 0.3, 1.0, 1),
                (-1.0, 0.8, 0.8, 0.0, 1),
                (-1.0, 0.5, 0.5, 0.0, 0),
                (1.2, 1.8, 0.0, 0.0, 1),
            ] {
                let share = world.transmittance(&Ray::between(at(from), at(to)));
                let expected = (-(FIRST * first + SECOND * second) * stretch).exp() * 0.5f32.powi(veils);
                assert_near(share, expected);
            }
            let out = Ray { t_far: f32::INFINITY, ..Ray::between(at(0.7), at(1.7)) };
            assert_near(world.transmittance(&out), (-(FIRST * 0.3 + SECOND) * stretch).exp() * 0.5);
        }
    }

    #[test]
    fn paths_lose_what_shadow_rays_lose() {
        let world = blocks(1.0);
        let mut absorbing = 0;
        for i in 0..500 {
            let at = |k: f32| (i as f32 * k).fract();
            let from = Vec3::new(4.0 * at(0.618) - 0.5, at(0.414), at(0.732));
            let to = Vec3::new(4.0 * at(0.236) - 0.5, 3.0 * at(0.317), -at(0.645));
            let segment = Ray::between(from, to);
            let (length, direction) = (segment.direction.length(), segment.direction.normalize());
            let mut ray = Ray { direction, t_far: length, ..segment };
            let (mut share, mut interior) = (Rgb::ONE, Interior::NONE);
            while let Some(surface) = world.intersect(&ray) {
                share *= world.edge_shares(interior, &surface, direction, ray.t_near)[1];
                let cos = surface.frame.to_local(-direction).z;
                share *= world.bsdf(&surface).straight_transmittance(cos);
                interior = world.interior_after(interior, &surface, direction, true);
                ray = beyond(&ray, surface.position, surface.normal, surface.t);
            }
            share *= world.through(interior, length - ray.t_near);
            // Offsets behind sheets are not inside.
            assert!((world.transmittance(&segment) - share).abs().max_element() < 1e-4, "{segment:?}");
            absorbing += usize::from(share.x != share.z);
        }
        assert!(absorbing > 200, "{absorbing}");
    }

    #[test]
    fn an_edge_is_inside_if_it_starts_or_ends_on_the_inside() {
        let world = blocks(1.5);
        let at = |x: f32, direction: Vec3| {
            world.intersect(&Ray::new(Vec3::new(x, 0.1, 0.2), direction)).expect("a surface")
        };
        let (enter, leave) = (at(-1.0, Vec3::X), at(0.7, Vec3::X));
        assert_eq!(world.edge_shares(Interior::NONE, &enter, Vec3::X, 0.0), [Rgb::ONE; 2]);
        // Emission is absorbed on edges that start on glass alone, as samples of emitters are.
        let [emitted, scattered] = world.edge_shares(Interior::NONE, &leave, Vec3::X, 0.0);
        assert_eq!(emitted, Rgb::ONE);
        assert_near(scattered, (-FIRST * 0.3).exp());
        let inside = world.interior_after(Interior::NONE, &enter, Vec3::X, false);
        assert!(inside != Interior::NONE);
        assert_eq!(world.interior_after(Interior::NONE, &enter, -Vec3::X, false), Interior::NONE);
        assert_eq!(world.interior_after(inside, &leave, Vec3::X, false), Interior::NONE);
        assert!(world.interior_after(inside, &leave, -Vec3::X, false) != Interior::NONE);
        for share in world.edge_shares(inside, &leave, Vec3::X, 0.1) {
            assert_near(share, (-FIRST * 0.2).exp());
        }
        // A veil is no boundary for light that passes it, and one for light that it scatters.
        let veil = at(0.2, Vec3::X);
        assert_eq!(world.interior_after(inside, &veil, Vec3::X, true), inside);
        assert_eq!(world.interior_after(inside, &veil, -Vec3::X, false), Interior::NONE);
    }

    #[test]
    fn only_solid_glass_has_an_inside() {
        let absorbing = |material: Material| Material { absorption: Some(FIRST), ..material };
        for (material, absorbs) in [
            (absorbing(glass(1.5)), true),
            (absorbing(pane(1.5, Rgb::ONE)), false),
            (absorbing(diffuse(Rgb::ONE)), false),
            (glass(1.5), false),
            (Material { absorption: Some(Rgb::ZERO), ..glass(1.5) }, false),
        ] {
            let mut scene = scene(Camera::default(), [1, 1]);
            let faces = block(Vec3::ZERO, Vec3::ONE, &mut scene, material);
            scene.meshes.extend(faces);
            assert_eq!(world(scene).absorbs(), absorbs);
        }
    }
}
