//! Groups at several places against the same scene with copies of their meshes.

use crate::shadow::{Engine, ray_from, segment};
use crate::testkit::*;
use base::math::{Cone, Placement, Rgb, lanes_in};
use base::sampling::{owen_sobol_2d, uniform_sphere};
use embree::{Hits16, Ray, Rays16};
use glam::{Affine3, Quat, Vec2, Vec3, Vec4};
use scene::{Camera, Filter, Group, Material, MaterialId, Mesh, Parameter, Relief, Texture, Wrap};

/// Returns places that turn, stretch, shear and mirror. The first changes nothing.
fn places() -> Vec<Placement> {
    let turn = |x: f32, y: f32, angle: f32| Quat::from_axis_angle(Vec3::new(x, y, 0.6).normalize(), angle);
    let of = |scale: Vec3, turned: Quat, at: Vec3| {
        Placement(Affine3::from_scale_rotation_translation(scale, turned, at))
    };
    let sheared = of(Vec3::new(1.0, 1.3, 0.8), turn(0.1, 0.9, 0.7), Vec3::new(-4.0, 0.5, 3.0));
    vec![
        Placement::IDENTITY,
        of(Vec3::ONE, turn(0.3, 0.5, 2.0), Vec3::new(4.0, 1.0, 0.0)),
        of(Vec3::new(0.3, 1.2, 0.7), turn(1.0, -0.4, 1.0), Vec3::new(-3.0, -1.0, -2.0)),
        of(Vec3::new(-0.8, 0.8, 0.8), turn(0.3, 0.1, 0.5), Vec3::new(0.5, 3.5, -1.0)),
        Placement(sheared.0 * Affine3::from_quat(turn(0.7, 0.2, 1.1))),
        of(Vec3::new(0.9, 0.5, -1.1), turn(-0.2, 0.6, 2.5), Vec3::new(2.0, -4.0, 3.0)),
    ]
}

/// Returns materials of all kinds that need something of the surface: textures, reliefs with and without tangents,
/// gaps and absorption.
fn materials(scene: &mut SceneAndView) -> Vec<MaterialId> {
    let texels: Vec<Rgb> = (0..16).map(|i| Rgb::new(0.06 * i as f32, 0.5, 1.0 - 0.06 * i as f32)).collect();
    let image = texture(4, &texels);
    let image = add_texture(scene, Texture { filter: Filter::Bilinear, wrap: Wrap::Repeat, ..image });
    let textured =
        Material { diffuse: Parameter::Textured { texture: image, scale: Rgb::ONE }, ..diffuse(Rgb::ONE) };
    let kinds = [
        textured.clone(),
        Material {
            relief: Some(Relief::Normals { texture: image, strength: 1.0, y_along_v: true }),
            ..textured.clone()
        },
        Material { relief: Some(Relief::Heights { texture: image, scale: 0.1 }), ..textured.clone() },
        Material { opacity: Some(Parameter::Textured { texture: image, scale: 1.0 }), ..textured },
        Material { absorption: Some(Rgb::new(0.3, 0.6, 0.9)), ..glass(1.0) },
        diffuse(Rgb::splat(0.4)),
    ];
    kinds.into_iter().map(|kind| add_material(scene, kind)).collect()
}

/// Builds two groups at their places in a lit room.
fn grouped() -> SceneAndView {
    let camera = camera(Vec3::new(0.0, 0.0, 9.0), Vec3::ZERO, 0.9);
    let mut scene = scene(camera, [24, 24]);
    let kinds = materials(&mut scene);
    scene.meshes.extend(room(Vec3::splat(-10.0), Vec3::splat(10.0), kinds[5]));
    let lamp = quad(Vec3::new(-3.0, 9.9, -3.0), Vec3::X * 6.0, Vec3::Z * 6.0, kinds[5]);
    scene.meshes.push(emitting(lamp, Rgb::splat(5.0)));
    let start = scene.meshes.len();
    let ball = |centre: Vec3, radius: f32, kind: usize| {
        let mut ball = sphere(centre, radius, 16, kinds[kind]);
        ball.uvs = ball.normals.iter().map(|n| Vec2::new(n.x * 2.0, n.y + n.z)).collect();
        ball.tangents = ball.normals.iter().map(|n| n.any_orthonormal_vector().extend(1.0)).collect();
        ball
    };
    let tile = |x: f32, kind: usize| {
        textured(
            quad(Vec3::new(x, -1.0, 0.3 + 0.1 * x), Vec3::X, Vec3::new(0.1, 1.0, 0.2), kinds[kind]),
            Vec2::new(2.0, 3.0),
        )
    };
    let tilted = Mesh { tangents: vec![Vec4::new(1.0, 0.2, 0.0, -1.0); 4], ..tile(0.2, 1) };
    scene.meshes.extend([
        ball(Vec3::ZERO, 0.7, 1),
        tile(-1.0, 2),
        tilted,
        tile(-0.2, 3),
        ball(Vec3::Y, 0.4, 4),
    ]);
    let middle = scene.meshes.len();
    scene.meshes.extend([ball(Vec3::X, 0.5, 0), tile(0.0, 5)]);
    let end = scene.meshes.len();
    let lower = places()
        .into_iter()
        .map(|place| Placement(Affine3::from_translation(Vec3::new(0.4, -1.1, 0.7)) * place.0));
    scene.scene.groups = vec![
        Group { meshes: start..middle, placements: places() },
        Group { meshes: middle..end, placements: lower.collect() },
    ];
    scene
}

/// Returns the scene with copies of the meshes of groups. Copies of mirrored meshes have reversed triangles.
fn copied(from: &SceneAndView) -> SceneAndView {
    let mut to = from.clone();
    let copy = |(mesh, placement): (usize, Option<&Placement>)| {
        let mut mesh = from.scene.meshes[mesh].clone();
        let Some(placement) = placement else { return mesh };
        mesh.positions
            .iter_mut()
            .for_each(|p| *p = placement.0.as_daffine3().transform_point3(p.as_dvec3()).as_vec3());
        mesh.normals.iter_mut().for_each(|n| *n = placement.normal(*n));
        mesh.tangents.iter_mut().for_each(|t| *t = placement.tangent(*t));
        if placement.mirrors() {
            mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        mesh
    };
    to.scene.meshes = from.scene.seen().map(copy).collect();
    to.scene.groups.clear();
    to
}

/// Returns packets of rays towards the places of groups.
fn packets(count: u32) -> Vec<Rays16> {
    let places = places();
    let packet = |i: u32| {
        let mut rays = Rays16::default();
        for lane in 0..16 {
            let number = 16 * i + lane;
            let [a, b, c] = [1, 2, 3].map(|dimension| owen_sobol_2d(number, dimension));
            let origin = Vec3::new(a.x, a.y, b.x) * 12.0 - 6.0;
            let target = places[number as usize % places.len()].point(Vec3::new(b.y, c.x, c.y) * 2.0 - 1.0);
            rays.set(lane as usize, &Ray::new(origin, (target - origin).normalize()));
        }
        rays
    };
    (0..count).map(packet).collect()
}

fn near(a: Vec3, b: Vec3, tolerance: f32) -> bool {
    (a - b).abs().max_element() < tolerance
}

#[test]
fn surfaces_at_places_are_those_of_copies() {
    let grouped = grouped();
    let (groups, copies) = (world(grouped.clone()), world(copied(&grouped)));
    assert_eq!(groups.accel.bounds().is_some(), copies.accel.bounds().is_some());
    let (mut met, mut different, mut mirrored) = (0, 0, 0);
    for rays in packets(2000) {
        let (mut hits, mut others) = (Hits16::default(), Hits16::default());
        let found = groups.accel.closest_hit16(&rays, u16::MAX, false, &mut hits);
        let expected = copies.accel.closest_hit16(&rays, u16::MAX, false, &mut others);
        assert_eq!((found, expected), (u16::MAX, u16::MAX), "the room is closed");
        let (mut a, mut b) = (groups.surfaces(&hits), copies.surfaces(&others));
        let cone = |_: usize| Cone { width: 0.0, spread: 0.02 };
        groups.cover(&mut a, &rays.directions(), found, cone);
        copies.cover(&mut b, &rays.directions(), found, cone);
        for lane in 0..16 {
            if (a.mesh[lane], a.triangle[lane]) != (b.mesh[lane], b.triangle[lane]) {
                different += 1;
                continue;
            }
            met += u32::from(groups.placement(a.mesh[lane]).is_some());
            mirrored += u32::from(groups.placement(a.mesh[lane]).is_some_and(|place| place.mirrors()));
            let (one, other) = (a.get(lane), b.get(lane));
            // Rays at grazing incidence turn rounding across the surface into rounding along it.
            let between = one.position - other.position;
            assert!(between.dot(one.normal).abs() < 3e-6 && between.length() < 1e-3, "{one:?} {other:?}");
            assert!(near(one.normal, other.normal, 1e-4), "{one:?} {other:?}");
            assert!(near(one.frame.normal, other.frame.normal, 3e-3), "{one:?} {other:?}");
            let single = groups.surface(&hits.get(lane));
            assert!(
                near(single.position, one.position, 1e-6)
                    && near(single.frame.tangent, one.frame.tangent, 1e-5)
            );
            assert_eq!(groups.material(one.mesh), copies.material(other.mesh));
            let albedo = |bsdf: &crate::material::Bsdf| bsdf.albedo(Vec3::new(0.6, 0.0, 0.8));
            assert!(
                near(albedo(&groups.bsdf(&one)), albedo(&copies.bsdf(&other)), 2e-3),
                "{one:?} {other:?}"
            );
        }
    }
    assert!(met > 4000 && mirrored > 1000 && different < 16, "{met} {mirrored} {different}");
}

#[test]
fn light_arrives_as_between_copies() {
    let grouped = grouped();
    let (groups, copies) = (world(grouped.clone()), world(copied(&grouped)));
    assert!(groups.has_sheets() && groups.absorbs());
    let (by_groups, by_copies) = (Engine::with(&groups, true, Default::default()), Engine::new(&copies));
    let (mut dark, mut dimmed, mut different) = (0, 0, 0);
    for (i, rays) in packets(1500).into_iter().enumerate() {
        let mut segments = Rays16::default();
        for lane in 0..16 {
            let ray = rays.get(lane);
            segments.set(lane, &Ray { t_far: 1.0 + 0.5 * lane as f32, ..ray });
        }
        let (one, other) =
            (by_groups.occluded16(&segments, u16::MAX), by_copies.occluded16(&segments, u16::MAX));
        different += (one ^ other).count_ones();
        for lane in 0..16 {
            let segment = segments.get(lane);
            // The cache holds triangles at their places.
            let is_dark = other >> lane & 1 != 0;
            different += u32::from(by_groups.occluded(&segment, i as u32 % 7) != is_dark);
            different += u32::from(by_groups.occluded(&segment, i as u32 % 7) != is_dark);
        }
        dark += one.count_ones();
        for lane in lanes_in(!(one | other)) {
            let segment = segments.get(lane);
            let (one, other) = (groups.transmittance(&segment), copies.transmittance(&segment));
            dimmed += u32::from(one != Rgb::ONE);
            different += u32::from(!near(one, other, 2e-3));
        }
    }
    assert!(by_groups.take_counts().single.saved > 1000);
    assert!(dark > 3000 && dimmed > 300 && different < 40, "{dark} {dimmed} {different}");
}

/// Returns a closed ball at several places of one kind.
fn balls(placements: Vec<Placement>) -> WorldAndView {
    let mut scene = scene(Camera::default(), [1, 1]);
    let grey = add_material(&mut scene, diffuse(Rgb::ONE));
    scene.meshes.push(sphere(Vec3::ZERO, 0.6, 48, grey));
    scene.scene.groups = vec![Group { meshes: 0..1, placements }];
    world(scene)
}

#[test]
fn surfaces_at_places_do_not_shadow_themselves() {
    // As readers choose the origin, no ball is closer to it than its own size.
    let turn = Quat::from_axis_angle(Vec3::new(1.0, 2.0, -0.5).normalize(), 1.0);
    let sheared =
        Affine3::from_quat(turn) * Affine3::from_scale(Vec3::new(0.3, 1.0, 1.5)) * Affine3::from_quat(turn);
    let shapes = [
        Affine3::from_quat(turn),
        Affine3::from_quat(turn) * Affine3::from_scale(Vec3::new(0.02, 1.0, 1.0)),
        Affine3::from_quat(turn) * Affine3::from_scale(Vec3::new(-1.0, 0.5, 1.0)),
        sheared,
    ];
    let mut leaving = 0;
    for shape in shapes {
        for (size, distance) in [(1.0, 1.7), (1.0, 30.0), (1e-4, 1.7), (1e4, 2.0), (1.0, 2000.0), (1e-3, 1e3)]
        {
            let place = |i: u32| {
                let towards = uniform_sphere(owen_sobol_2d(i, 9));
                let towards = towards / towards.abs().max_element();
                let at = Affine3::from_translation(towards * (size * distance));
                Placement(at * Affine3::from_scale(Vec3::splat(size)) * shape)
            };
            // One ball at a time: others would be in the way.
            for i in 0..6 {
                let world = balls(vec![place(i), Placement(Affine3::from_translation(Vec3::splat(1e8)))]);
                leaving += check_ball(&world, place(i), size);
            }
        }
    }
    assert!(leaving > 6000, "{leaving}");
}

/// Asserts that rays which leave a ball are free, and those that cross much of it are not.
///
/// Returns the number of rays into it.
fn check_ball(world: &WorldAndView, place: Placement, size: f32) -> u32 {
    let (mut free, mut inside, mut shadowed, mut leaked) = (0, 0, 0, 0);
    for i in 0..300 {
        let direction = uniform_sphere(owen_sobol_2d(i, 5));
        let eye = place.point(direction * 2.0);
        let Some(surface) = world.intersect(&Ray::new(eye, place.point(Vec3::ZERO) - eye)) else {
            panic!("the ball is missed")
        };
        let out = uniform_sphere(owen_sobol_2d(i, 6));
        let cos = out.dot(surface.normal);
        let ray = ray_from(surface.position, surface.normal, out);
        if cos > 0.02 {
            free += 1;
            shadowed += u32::from(world.accel.occluded(&ray));
            let far = surface.position + out * (3.0 * size);
            let to_far = segment(surface.position, surface.normal, far, Vec3::ZERO);
            shadowed += u32::from(world.accel.occluded(&to_far));
        } else if cos < -0.1
            && chord(&place, surface.position, out) > 100.0 * 1e-6 * surface.position.abs().max_element()
        {
            inside += 1;
            leaked += u32::from(!world.accel.occluded(&ray));
        }
    }
    assert!(free > 100, "{free}");
    assert_eq!((shadowed, leaked), (0, 0), "{place:?} {size}");
    inside
}

/// Returns the length of a chord of a placed ball from a point on.
fn chord(place: &Placement, from: Vec3, direction: Vec3) -> f32 {
    let back = place.0.as_daffine3().inverse();
    let (p, d) = (back.transform_point3(from.as_dvec3()), back.transform_vector3(direction.as_dvec3()));
    (-2.0 * p.dot(d) / d.length_squared()) as f32
}
