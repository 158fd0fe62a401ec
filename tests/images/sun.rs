//! The sun, a distant disc: light through a window by all methods, soft shadows, and a lit room against Mitsuba.

use crate::glass::mean_by;
use crate::kit::*;
use crate::oracle::assert_means_within;
use glam::Vec3;
use lightsplat::film::Image;
use lightsplat::math::{Rgb, luminance};
use lightsplat::method::{path, vpl};
use lightsplat::scene::{DistantDisc, Environment};

/// A sun over +x, of the true one's size, and its direction.
fn sun(scene: &mut SceneAndView, half_angle: f32) -> Vec3 {
    let direction = Vec3::new(0.8, 0.55, 0.2).normalize();
    let solid_angle = std::f32::consts::PI * half_angle * half_angle;
    let radiance = Rgb::new(1.5, 1.3, 1.0) / solid_angle;
    scene.discs.push(DistantDisc { direction, half_angle, radiance });
    direction
}

/// A room that is open towards +x, under a sun and a faint sky, with a thin sheet of glass before the opening.
fn sunny_room() -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.9, 0.1, 0.9), Vec3::new(-0.4, -0.3, -0.6), 0.9), [16, 16]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.6, 0.5)));
    let walls = room(Vec3::splat(-1.0), Vec3::ONE, wall);
    scene.meshes.extend(walls.into_iter().filter(|mesh| mesh.positions.iter().any(|p| p.x != 1.0)));
    let glass = add_material(&mut scene, pane(1.5, Rgb::new(0.9, 0.8, 0.7)));
    scene.meshes.push(quad(Vec3::new(1.05, -1.1, -1.1), Vec3::Y * 2.2, Vec3::Z * 2.2, glass));
    scene.environment = Some(Environment::Constant(Rgb::new(0.05, 0.08, 0.12)));
    sun(&mut scene, 0.2679f32.to_radians());
    world(scene)
}

#[test]
fn all_methods_find_the_sun_through_a_pane() {
    let world = sunny_room();
    let exact = mean_by(&world, &path::Settings { spp: 2048, ..Default::default() });
    let found = [
        ("cache", mean_by(&world, &vpl::Settings { spp: 256, ..vpl::Settings::cache() })),
        ("lightcuts", mean_by(&world, &vpl::Settings { spp: 16, ..vpl::Settings::lightcuts() })),
        ("reconstruction", mean_by(&world, &vpl::Settings { spp: 16, ..vpl::Settings::reconstruction() })),
        ("photon-cache", mean_by(&world, &vpl::Settings { spp: 16, ..vpl::Settings::photon_cache() })),
    ];
    for (name, found) in found {
        assert_means_within(0.02, found, exact, name);
    }
}

/// A wide sun's shadow of an edge on a floor falls off over the width that its angle gives.
#[test]
fn shadows_of_a_wide_sun_are_soft() {
    let half_angle = 4f32.to_radians();
    let mut scene = scene(camera(Vec3::new(0.0, 6.0, 0.0), Vec3::ZERO, 0.25), [64, 1]);
    let white = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    scene.meshes.push(quad(Vec3::new(-9.0, 0.0, 9.0), Vec3::X * 18.0, Vec3::NEG_Z * 18.0, white));
    let direction = sun(&mut scene, half_angle);
    // The edge lies at height 4, in the plane through the origin that holds the sun's centre and the z axis.
    let edge = direction * (4.0 / direction.y);
    scene.meshes.push(quad(Vec3::new(edge.x, 4.0, -30.0), Vec3::Z * 60.0, Vec3::X * 40.0, white));
    let scene = world(scene);
    let luminances = |image: Image| image.pixels.iter().map(|p| luminance(*p)).collect::<Vec<f32>>();
    let settings = path::Settings { spp: 4096, max_depth: Some(2), ..Default::default() };
    let by_paths = luminances(image(&scene, &settings));
    let mut settings = vpl::Settings { spp: 64, ..vpl::Settings::lightcuts() };
    settings.light.indirect = 0;
    let by_cuts = luminances(image(&scene, &settings));
    let (bright, dark) = (by_paths[0].max(by_paths[63]), by_paths[0].min(by_paths[63]));
    assert!(dark < 1e-3 * bright && bright > 0.1, "{bright} {dark}");
    // Chord of the disc that the edge leaves free, by distance from the middle of the penumbra.
    let penumbra = by_paths.iter().filter(|l| **l > 0.02 * bright && **l < 0.98 * bright).count();
    // Along x, at the slant of the light: distance times angle, over the cosine twice.
    let (distance, sin) = (4.0 / direction.y, direction.y / direction.truncate().length());
    let width = 2.0 * half_angle * distance * direction.truncate().length() / sin;
    let pixels = width / (2.0 * 0.25 * 6.0 / 64.0);
    assert!((penumbra as f32 / pixels - 1.0).abs() < 0.25, "{penumbra} {pixels}");
    for (a, b) in by_paths.iter().zip(&by_cuts) {
        assert!((a - b).abs() < 0.03 * bright, "{a} {b}");
    }
}

/// A room with an open side under sun and sky, seen by a lens.
const ROOM: &str = r#"<scene version="3.0.0">
    <integrator type="path"><integer name="max_depth" value="8"/></integrator>
    <sensor type="thinlens">
        <float name="fov" value="60"/>
        <float name="aperture_radius" value="0.1"/><float name="focus_distance" value="4"/>
        <transform name="to_world"><lookat origin="1.8, 1.8, -3.5" target="-0.6, 1, 1" up="0, 1, 0"/></transform>
        <sampler type="independent"/>
        <film type="hdrfilm">
            <integer name="width" value="24"/><integer name="height" value="24"/>
            <rfilter type="box"/>
        </film>
    </sensor>
    <emitter type="sunsky">
        <vector name="sun_direction" x="0.75" y="0.55" z="-0.1"/>
        <float name="turbidity" value="4"/>
        <transform name="to_world"><rotate x="1" angle="-90"/></transform>
    </emitter>
    <bsdf type="twosided" id="white"><bsdf type="diffuse"><rgb name="reflectance" value=".7 .68 .65"/></bsdf></bsdf>
    <bsdf type="twosided" id="red"><bsdf type="diffuse"><rgb name="reflectance" value=".6 .2 .15"/></bsdf></bsdf>
    <shape type="rectangle">
        <transform name="to_world"><scale x="2" y="2.5"/><rotate x="1" angle="-90"/></transform><ref id="white"/>
    </shape>
    <shape type="rectangle">
        <transform name="to_world"><scale x="2" y="2.5"/><rotate x="1" angle="90"/><translate y="3"/></transform>
        <ref id="white"/>
    </shape>
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="2" y="1.5"/><rotate y="1" angle="180"/><translate y="1.5" z="2.5"/>
        </transform>
        <ref id="white"/>
    </shape>
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="2.5" y="1.5"/><rotate y="1" angle="90"/><translate x="-2" y="1.5"/>
        </transform>
        <ref id="red"/>
    </shape>
    <shape type="cube">
        <transform name="to_world">
            <scale value=".4"/><rotate y="1" angle="30"/><translate x="-.6" y=".4" z=".8"/>
        </transform>
        <ref id="white"/>
    </shape>
</scene>"#;

mod slow_mitsuba {
    use super::ROOM;
    use crate::mitsuba::scene_agrees;

    #[test]
    fn a_room_under_sun_and_sky_is_as_by_the_package_mitsuba() {
        let folder = tempfile::tempdir().expect("a folder");
        scene_agrees("sun and sky", folder.path(), ROOM);
    }
}
