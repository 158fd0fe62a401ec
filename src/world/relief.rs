//! Shading frames on surfaces with a relief or with an anisotropic material.
//!
//! Paper: J. F. Blinn, *Simulation of Wrinkled Surfaces*, 1978, for heights; definitions are those of Mitsuba 3's
//! `bumpmap` and `normalmap`. Shadows of bumps are in [`crate::material`].
//! Deviations: the relief changes shading alone, neither outlines nor shadows. A two-sided surface is shaded as seen
//! from behind if its turned normal faces away from the eye.

use super::Surface;
use super::instances::SeenAt;
use super::triangle::Triangle;
use base::math::{Frame, Rgb};
use glam::{Vec2, Vec3};
use scene::{Mesh, Relief, Scene, TextureId, Textures};

/// Reliefs of a scene.
pub(super) struct Reliefs {
    /// Turns of the shading frames, by seen mesh.
    turns: Vec<Turn>,
    textures: Textures,
}

/// Difference between the shading frames of a mesh and those of the interpolated normals.
#[derive(Clone, Copy, Default, PartialEq)]
struct Turn {
    relief: Option<Relief>,
    /// True if normals that lean away from the viewer are mirrored.
    mirrors: bool,
    /// Angle from u to the x axis, in radians, if the material is anisotropic.
    from_u: Option<f32>,
    /// Texture of directions that replace u.
    direction: Option<TextureId>,
}

impl Reliefs {
    /// Collects the reliefs and directions of a scene; `None` if there are none.
    pub fn new(scene: &Scene) -> Option<Reliefs> {
        let of = |mesh: &Mesh| {
            let material = scene.materials.get(mesh.material.0 as usize);
            material.map_or(Turn::default(), |material| {
                let has_direction = !(mesh.uvs.is_empty() && mesh.tangents.is_empty());
                let from_u = material.anisotropy_axis().filter(|_| has_direction);
                let direction = from_u.and_then(|(_, direction)| direction);
                let (relief, mirrors) = (material.relief, material.relief_rules.mirrors);
                Turn { relief, mirrors, from_u: from_u.map(|(angle, _)| angle), direction }
            })
        };
        let turns: Vec<Turn> = scene.meshes.iter().map(of).collect();
        let turns: Vec<Turn> = scene.seen().map(|(mesh, _)| turns[mesh]).collect();
        let any = turns.iter().any(|turn| *turn != Turn::default());
        any.then(|| Reliefs { turns, textures: scene.textures.clone() })
    }

    /// Turns the shading frame of a surface by the relief of its mesh, as seen from the vector `out`, or from nowhere
    /// if that is 0. Turns x to the direction that its material asks for. `triangle` is in the scene's coordinates.
    #[inline]
    pub fn turn(&self, s: &mut Surface, seen: SeenAt, triangle: &Triangle, out: Vec3) {
        let (frame, b) = (&mut s.frame, s.barycentric);
        let Turn { relief, mirrors, from_u, direction } = &self.turns[s.mesh as usize];
        if let Some(relief) = relief {
            let normal = frame.normal;
            let turned = self.normal(relief, seen, triangle, b, normal).and_then(Vec3::try_normalize);
            let turned = turned.unwrap_or(normal);
            let leans_away = *mirrors && normal.dot(out) * turned.dot(out) < 0.0;
            let mirrored = || normal * (2.0 * normal.dot(turned)) - turned;
            *frame = Frame::from_normal(if leans_away { mirrored() } else { turned });
        }
        if let Some(angle) = from_u {
            let [along_u, along_v] = axes(seen, triangle, b, frame.normal);
            *frame = Frame::from_normal_and_tangent(frame.normal, along_u);
            let angle = match direction {
                Some(texture) => angle + self.angle(*texture, seen.mesh.uv(&triangle.vertices, b)),
                None => *angle,
            };
            if angle != 0.0 {
                let (sin, cos) = angle.sin_cos();
                let sin = if frame.bitangent.dot(along_v) < 0.0 { -sin } else { sin };
                let turned = frame.tangent * cos + frame.bitangent * sin;
                *frame = Frame::from_normal_and_tangent(frame.normal, turned);
            }
        }
    }

    /// Returns the angle from u of the direction that a texture gives at `uv`; 0 if it gives none.
    fn angle(&self, texture: TextureId, uv: Vec2) -> f32 {
        let texel = self.textures.by_id(texture).map_or(Rgb::splat(0.5), |texture| texture.lookup(uv));
        let (x, y) = (2.0 * texel.x - 1.0, 2.0 * texel.y - 1.0);
        y.atan2(x)
    }

    /// Returns the normal of a relief on a surface of shading normal `normal`, not of unit length; `None` if its
    /// texture is missing.
    #[inline(never)]
    fn normal(
        &self,
        relief: &Relief,
        seen: SeenAt,
        triangle: &Triangle,
        b: Vec2,
        normal: Vec3,
    ) -> Option<Vec3> {
        let uv = seen.mesh.uv(&triangle.vertices, b);
        let level = |v: Vec3| v - normal * normal.dot(v);
        match *relief {
            Relief::Normals { texture, strength, y_along_v } => self.textures.by_id(texture).map(|texture| {
                let [along_u, along_v] = axes(seen, triangle, b, normal);
                let local = texture.lookup(uv) * 2.0 - 1.0;
                let x = level(along_u).normalize_or_zero();
                let y = normal.cross(x);
                let y = if y_along_v && y.dot(along_v) < 0.0 { -y } else { y };
                x * (local.x * strength) + y * (local.y * strength) + normal * local.z
            }),
            Relief::Heights { texture, scale } => self.textures.by_id(texture).map(|texture| {
                let [along_u, along_v] = derivatives(seen.mesh, triangle);
                let slope = texture.luminance_gradient(uv) * scale;
                let turned = (level(along_u) + normal * slope.x).cross(level(along_v) + normal * slope.y);
                if turned.dot(triangle.normal) < 0.0 { -turned } else { turned }
            }),
        }
    }
}

/// Returns the directions of x and y of a texture's frame: those of the mesh's tangents, else the derivatives by u
/// and v.
fn axes(seen: SeenAt, triangle: &Triangle, b: Vec2, normal: Vec3) -> [Vec3; 2] {
    match seen.tangent(&triangle.vertices, b).map(|tangent| (tangent.truncate(), tangent.w)) {
        Some((x, w)) if x != Vec3::ZERO => [x, normal.cross(x) * w],
        _ => derivatives(seen.mesh, triangle),
    }
}

/// Returns the derivatives of the position by u and v, on the plane of a triangle.
fn derivatives(mesh: &Mesh, triangle: &Triangle) -> [Vec3; 2] {
    let (edges, corner) = (triangle.edges, |b: Vec2| mesh.uv(&triangle.vertices, b));
    let origin = corner(Vec2::ZERO);
    let (d1, d2) = (corner(Vec2::X) - origin, corner(Vec2::Y) - origin);
    let determinant = d1.perp_dot(d2);
    if determinant == 0.0 {
        return edges;
    }
    let along_u = (edges[0] * d2.y - edges[1] * d1.y) / determinant;
    let along_v = (edges[1] * d1.x - edges[0] * d2.x) / determinant;
    [along_u, along_v]
}

#[cfg(test)]
mod tests {
    use crate::testkit::*;
    use base::math::{Rgb, Vec3x16};
    use embree::{Hits16, Ray};
    use glam::{Vec2, Vec3, Vec4};
    use scene::{
        Camera, Distribution, Filter, Fresnel, Lobe, Material, Principled, Relief, Texture, TextureId, Wrap,
    };

    /// Builds a square with a relief, from 0 to 2 in the plane z = 0. The coordinate u is along x, v along y.
    fn square(relief: Relief, width: usize, texels: Vec<Rgb>) -> WorldAndView {
        let mut scene = scene(Camera::default(), [1, 1]);
        let texture = texture(width, &texels);
        add_texture(&mut scene, Texture { filter: Filter::Bilinear, wrap: Wrap::Clamp, ..texture });
        let relieved = Material { relief: Some(relief), ..diffuse(Rgb::ONE) };
        let material = add_material(&mut scene, relieved);
        scene.meshes.push(textured(quad(Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 2.0, material), Vec2::ONE));
        world(scene)
    }

    /// Returns sixteen hits of a ray.
    fn repeated(world: &WorldAndView, ray: &Ray) -> Hits16 {
        let hit = world.accel.closest_hit(ray).expect("the square");
        Hits16 {
            t: [hit.t; 16],
            u: [hit.u; 16],
            v: [hit.v; 16],
            geometry: [hit.geometry; 16],
            primitive: [hit.primitive; 16],
        }
    }

    /// Returns the shading normal at (x, y), and checks that a packet of hits has the same.
    fn normal(world: &WorldAndView, x: f32, y: f32) -> Vec3 {
        let ray = Ray::new(Vec3::new(x, y, 1.0), -Vec3::Z);
        let surface = world.intersect(&ray).expect("the square");
        assert_eq!(world.surfaces(&repeated(world, &ray)).frame(3), surface.frame);
        assert_eq!(surface.normal, Vec3::Z);
        surface.frame.normal
    }

    #[test]
    fn heights_slope_as_the_texels_do() {
        // A ramp from 0 to 1 between the centres of two texels, half the square apart: one unit of length.
        let relief = Relief::Heights { texture: TextureId(0), scale: 0.5 };
        let ramp = square(relief, 2, vec![Rgb::ZERO, Rgb::ONE]);
        let expected = Vec3::new(-0.5, 0.0, 1.0).normalize();
        for (x, y) in [(0.8, 0.3), (1.2, 1.7)] {
            assert!((normal(&ramp, x, y) - expected).length() < 1e-5, "{}", normal(&ramp, x, y));
        }
        // Beyond the centres it is level.
        assert!((normal(&ramp, 0.2, 1.0) - Vec3::Z).length() < 1e-5);
        // The top row is the higher one: the surface rises along y.
        let up = square(relief, 1, vec![Rgb::ONE, Rgb::ZERO]);
        let expected = Vec3::new(0.0, -0.5, 1.0).normalize();
        assert!((normal(&up, 1.0, 1.0) - expected).length() < 1e-5, "{}", normal(&up, 1.0, 1.0));
    }

    #[test]
    fn normals_are_those_of_the_texels_in_the_frame_of_the_texture() {
        let local = Vec3::new(0.6, 0.0, 0.8);
        for (local, strength, y_along_v, expected) in [
            (local, 1.0, false, local),
            (Vec3::new(0.0, 0.6, 0.8), 1.0, true, Vec3::new(0.0, 0.6, 0.8)),
            (local, 0.5, false, Vec3::new(0.3, 0.0, 0.8).normalize()),
            (Vec3::Z, 1.0, true, Vec3::Z),
        ] {
            let relief = Relief::Normals { texture: TextureId(0), strength, y_along_v };
            let flat = square(relief, 1, vec![0.5 * local + 0.5]);
            assert!(
                (normal(&flat, 1.1, 0.4) - expected).length() < 1e-5,
                "{local} {}",
                normal(&flat, 1.1, 0.4)
            );
        }
    }

    #[test]
    fn normals_that_lean_away_from_the_viewer_are_mirrored_by_rule() {
        let relief = Relief::Normals { texture: TextureId(0), strength: 1.0, y_along_v: false };
        let local = Vec3::new(0.6, 0.0, 0.8);
        for mirrors in [false, true] {
            let mut staged = staged(square(relief, 1, vec![0.5 * local + 0.5]));
            staged.materials[0].relief_rules.mirrors = mirrors;
            let world = world(staged);
            for (out, leans_away) in [
                (Vec3::new(-0.9, 0.1, 0.3), true),
                (Vec3::new(-0.3, 0.1, 0.9), false),
                (Vec3::new(0.9, 0.1, -0.3), true),
                (Vec3::new(0.3, 0.1, -0.9), false),
            ] {
                let ray = Ray::new(Vec3::new(1.1, 0.4, 0.0) + out, -out);
                let surface = world.intersect(&ray).expect("the square");
                let x = if mirrors && leans_away { -local.x } else { local.x };
                let expected = Vec3::new(x, local.y, local.z);
                assert!((surface.frame.normal - expected).length() < 1e-5, "{out} {surface:?}");
                let hits = repeated(&world, &ray);
                let along = world.surfaces_along(&hits, &Vec3x16::splat(-out));
                assert_eq!(along.frame(5), surface.frame);
                assert!((world.surfaces(&hits).frame(5).normal - local).length() < 1e-5);
            }
        }
    }

    #[test]
    fn bumps_shadow_as_microfacets_of_their_slope_do() {
        let relief = Relief::Normals { texture: TextureId(0), strength: 1.0, y_along_v: false };
        let local = Vec3::new(0.48, 0.36, 0.8);
        let [plain, shadowed] = [false, true].map(|shadows| {
            let mut staged = staged(square(relief, 1, vec![0.5 * local + 0.5]));
            staged.materials[0].relief_rules.shadows = shadows;
            staged.materials[0].two_sided = true;
            world(staged)
        });
        for side in [1.0, -1.0] {
            let ray = Ray::new(Vec3::new(1.1, 0.4, side), Vec3::NEG_Z * side);
            let surface = plain.intersect(&ray).expect("the square");
            let hits = repeated(&shadowed, &ray);
            for wi in [Vec3::new(0.1, -0.2, 0.9), Vec3::new(0.9, 0.3, 0.1), Vec3::new(0.0, 0.0, 1.0)] {
                let wi = wi.normalize() * side;
                let [wo, local_wi] = [-ray.direction, wi].map(|v| surface.frame.to_local(v));
                // One eighth of the square of the slope, 0.75.
                let (alpha_sq, tan_sq) = (0.5625 / 8.0, 1.0 / (wi.z * wi.z) - 1.0);
                let share = 2.0 / (1.0 + (1.0 + alpha_sq * tan_sq).sqrt());
                let expected = plain.bsdf(&surface).eval(wo, local_wi) * share;
                let found = shadowed.bsdf(&surface).eval(wo, local_wi);
                assert!((found - expected).length() < 1e-5, "{wi} {found} {expected}");
                let bsdfs = shadowed.bsdfs(&shadowed.surfaces(&hits), Vec3x16::splat(wo));
                let packet = bsdfs.eval_pdf(&Vec3x16::splat(local_wi), u16::MAX).0.get(3);
                assert!((packet - expected).length() < 1e-5, "{wi} {packet} {expected}");
            }
        }
    }

    #[test]
    fn frames_are_along_u_where_a_material_knows_a_direction() {
        let bumps = Relief::Heights { texture: TextureId(0), scale: 0.5 };
        for relief in [None, Some(bumps)] {
            let mut staged = staged(square(bumps, 2, vec![Rgb::ZERO, Rgb::ONE]));
            staged.materials[0].relief = relief;
            let fresnel = Fresnel::One;
            let (distribution, alpha, scale) = (Distribution::Ggx, [0.1.into(), 0.3.into()], Rgb::ONE.into());
            staged.materials[0].lobes = vec![Lobe::Anisotropic { distribution, alpha, fresnel, scale }];
            // u grows across the square, from corner to corner.
            staged.meshes[0].uvs.iter_mut().for_each(|uv| *uv = Vec2::new(uv.x + uv.y, uv.y - uv.x));
            let world = world(staged);
            let ray = Ray::new(Vec3::new(0.6, 0.5, 1.0), -Vec3::Z);
            let frame = world.intersect(&ray).expect("the square").frame;
            let across = Vec3::new(1.0, 1.0, 0.0) - frame.normal * frame.normal.dot(Vec3::new(1.0, 1.0, 0.0));
            assert!((frame.tangent - across.normalize()).length() < 1e-5, "{frame:?}");
            assert!((frame.tangent.cross(frame.bitangent) - frame.normal).length() < 1e-6);
            assert_eq!(frame.normal == Vec3::Z, relief.is_none());
            normal(&world, 0.6, 0.5);
        }
    }

    #[test]
    fn frames_are_turned_from_u_towards_v_whichever_side_that_is() {
        let flat = Relief::Heights { texture: TextureId(0), scale: 0.0 };
        for mirrored in [1.0, -1.0] {
            let mut staged = staged(square(flat, 1, vec![Rgb::ZERO]));
            staged.materials[0].relief = None;
            let brushed =
                Principled { anisotropic: 0.5.into(), anisotropic_rotation: 0.5, ..Principled::default() };
            staged.materials[0].principled = Some(Box::new(brushed));
            staged.meshes[0].uvs.iter_mut().for_each(|uv| uv.y *= mirrored);
            let world = world(staged);
            let ray = Ray::new(Vec3::new(0.6, 0.5, 1.0), -Vec3::Z);
            let frame = world.intersect(&ray).expect("the square").frame;
            let expected = Vec3::new(0.5f32.cos(), mirrored * 0.5f32.sin(), 0.0);
            assert!((frame.tangent - expected).length() < 1e-5, "{frame:?}");
        }
    }

    #[test]
    fn textures_of_directions_turn_frames_before_the_angle_does() {
        let flat = Relief::Heights { texture: TextureId(0), scale: 0.0 };
        // The direction (0.6, 0.8), as texels from 0 to 1; blue is the strength.
        let mut staged = staged(square(flat, 1, vec![Rgb::new(0.8, 0.9, 0.1)]));
        staged.materials[0].relief = None;
        let brushed = Principled {
            anisotropic: 0.5.into(),
            anisotropic_rotation: 0.5,
            anisotropic_direction: Some(TextureId(0)),
            ..Principled::default()
        };
        staged.materials[0].principled = Some(Box::new(brushed));
        let world = world(staged);
        let ray = Ray::new(Vec3::new(0.6, 0.5, 1.0), -Vec3::Z);
        let frame = world.intersect(&ray).expect("the square").frame;
        let angle = 0.5 + 0.8f32.atan2(0.6);
        assert!((frame.tangent - Vec3::new(angle.cos(), angle.sin(), 0.0)).length() < 1e-5, "{frame:?}");
        normal(&world, 0.6, 0.5);
    }

    #[test]
    fn tangents_of_a_mesh_come_before_the_directions_of_its_texture() {
        // The x axis is along y; the y axis is along -x, or along x if the tangents are left-handed.
        for (w, y) in [(1.0, Vec3::NEG_X), (-1.0, Vec3::X)] {
            let tangents = vec![Vec4::new(0.0, 1.0, 0.0, w); 4];
            let local = Vec3::new(0.48, 0.6, 0.64);
            let relief = Relief::Normals { texture: TextureId(0), strength: 1.0, y_along_v: true };
            let mut mapped = staged(square(relief, 1, vec![0.5 * local + 0.5]));
            mapped.meshes[0].tangents = tangents.clone();
            let expected = Vec3::Y * local.x + y * local.y + Vec3::Z * local.z;
            let found = normal(&world(mapped), 0.6, 0.5);
            assert!((found - expected).length() < 1e-5, "{found} {expected}");
            // Anisotropy turns from x to y, with texture coordinates or without.
            let mut brushed =
                staged(square(Relief::Heights { texture: TextureId(0), scale: 0.0 }, 1, vec![Rgb::ZERO]));
            let lobe =
                Principled { anisotropic: 0.5.into(), anisotropic_rotation: 0.5, ..Principled::default() };
            brushed.materials[0].relief = None;
            brushed.materials[0].principled = Some(Box::new(lobe));
            brushed.meshes[0].tangents = tangents;
            brushed.meshes[0].uvs.clear();
            let world = world(brushed);
            let frame =
                world.intersect(&Ray::new(Vec3::new(0.6, 0.5, 1.0), -Vec3::Z)).expect("the square").frame;
            let expected = Vec3::Y * 0.5f32.cos() + y * 0.5f32.sin();
            assert!((frame.tangent - expected).length() < 1e-5, "{frame:?}");
        }
    }

    #[test]
    fn tangents_of_zeros_leave_the_directions_of_the_texture() {
        let local = Vec3::new(0.6, 0.0, 0.8);
        let relief = Relief::Normals { texture: TextureId(0), strength: 1.0, y_along_v: true };
        let mut flat = staged(square(relief, 1, vec![0.5 * local + 0.5]));
        flat.meshes[0].tangents = vec![Vec4::ZERO; 4];
        assert!((normal(&world(flat), 1.1, 0.4) - local).length() < 1e-5);
    }

    #[test]
    fn a_mirrored_texture_turns_y_only_where_it_follows_v() {
        for (y_along_v, y) in [(false, 0.6), (true, -0.6)] {
            let relief = Relief::Normals { texture: TextureId(0), strength: 1.0, y_along_v };
            let local = Vec3::new(0.0, 0.6, 0.8);
            let mut staged = staged(square(relief, 1, vec![0.5 * local + 0.5]));
            staged.meshes[0].uvs.iter_mut().for_each(|uv| uv.y = -uv.y);
            let found = normal(&world(staged), 1.0, 1.0);
            assert!((found - Vec3::new(0.0, y, 0.8)).length() < 1e-5, "{found}");
        }
    }
}
