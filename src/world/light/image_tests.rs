//! Projected images against closed forms and against integrals over the sphere.

use super::DeltaEmitter;
use base::math::{Rgb, luminance};
use base::sampling::{owen_sobol_2d, uniform_sphere};
use glam::{Mat3, Vec3};
use scene::{DeltaLight, Filter, FovAxis, Projector, SpotImage, Texels, Texture, TextureId, Textures, Wrap};
use std::f32::consts::PI;

/// A picture in colour that is twice as wide as high, with a dark part and a bright texel.
fn textures() -> Textures {
    let texel = |i: usize| match i {
        9 => Rgb::new(6.0, 2.0, 0.5),
        i if i % 8 < 3 => Rgb::ZERO,
        i => Rgb::new(0.1 * (i % 8) as f32, 0.4, 0.05 * (i / 8) as f32),
    };
    let texels: Vec<Rgb> = (0..32).map(texel).collect();
    let picture = Texture {
        name: "picture".into(),
        width: 8,
        height: 4,
        texels: Texels::new(8, &texels),
        filter: Filter::Bilinear,
        wrap: Wrap::Repeat,
        to_uv: Mat3::IDENTITY,
    };
    Textures::from(vec![picture])
}

/// A frame that is turned away from the axes.
fn turned() -> Mat3 {
    Mat3::from_axis_angle(Vec3::new(1.0, 2.0, 3.0).normalize(), 0.8)
}

const COLOUR: Rgb = Rgb::new(3.0, 2.0, 1.0);

fn projector(texture: Option<TextureId>, degrees: f32, axis: FovAxis) -> DeltaEmitter {
    let tan_half = (0.5 * degrees.to_radians()).tan();
    let projector = Projector { intensity: COLOUR, texture, to_local: turned(), tan_half, axis };
    DeltaEmitter::new(DeltaLight::Projector { position: Vec3::new(1.0, -2.0, 0.5), projector }, &textures())
}

fn spot(outer_angle: f32, with_image: bool) -> DeltaEmitter {
    let image = with_image.then(|| SpotImage { texture: TextureId(0), to_local: turned() });
    let light = DeltaLight::Spot {
        position: Vec3::new(1.0, -2.0, 0.5),
        direction: turned().transpose() * Vec3::Z,
        intensity: COLOUR,
        inner_angle: 0.6 * outer_angle,
        outer_angle,
        image,
    };
    DeltaEmitter::new(light, &textures())
}

fn all() -> Vec<DeltaEmitter> {
    let picture = Some(TextureId(0));
    vec![
        projector(None, 50.0, FovAxis::X),
        projector(picture, 50.0, FovAxis::X),
        projector(picture, 120.0, FovAxis::Y),
        spot(0.3, true),
        spot(1.2, true),
    ]
}

#[test]
fn a_projector_lights_a_plane_across_its_axis_evenly() {
    let emitter = projector(None, 60.0, FovAxis::X);
    let frame = turned().transpose();
    for distance in [0.5, 4.0] {
        let edge = distance * 30f32.to_radians().tan();
        for (x, y) in [(0.0, 0.0), (0.3, -0.9), (0.99, 0.99), (-0.99, 0.5), (1.01, 0.0), (0.0, -1.01)] {
            let on_plane = frame * Vec3::new(x * edge, y * edge, distance);
            let (towards, _, irradiance) = emitter.irradiance(Vec3::new(1.0, -2.0, 0.5) + on_plane);
            let on_surface = irradiance * towards.dot(-(frame * Vec3::Z));
            let is_inside = f32::max(x.abs(), y.abs()) < 1.0;
            let expected = if is_inside { COLOUR / (distance * distance) } else { Rgb::ZERO };
            assert!(
                (on_surface - expected).abs().max_element() < 1e-4 * expected.max_element().max(0.01),
                "{x} {y}"
            );
        }
        let behind = emitter.irradiance(Vec3::new(1.0, -2.0, 0.5) - frame * Vec3::Z);
        assert_eq!(behind.2, Rgb::ZERO);
    }
}

#[test]
fn the_picture_stands_upright_and_keeps_its_aspect() {
    let emitter = projector(Some(TextureId(0)), 50.0, FovAxis::X);
    let image = emitter.image.expect("a picture");
    let half = 25f32.to_radians().tan();
    // Column and row of a texel, from the top left corner.
    for (column, row, texel) in
        [(7, 0, Rgb::new(0.7, 0.4, 0.0)), (4, 3, Rgb::new(0.4, 0.4, 0.15)), (1, 1, Rgb::new(6.0, 2.0, 0.5))]
    {
        let (u, v) = ((column as f32 + 0.5) / 8.0, (row as f32 + 0.5) / 4.0);
        let local = Vec3::new((2.0 * u - 1.0) * half, (2.0 * v - 1.0) * 0.5 * half, 1.0).normalize();
        let intensity = image.intensity(turned().transpose() * local) * local.z.powi(3);
        assert!((intensity - COLOUR * texel).abs().max_element() < 1e-4, "{column} {row} {intensity}");
    }
    assert!(!image.is_grey && projector(None, 50.0, FovAxis::X).image.expect("one").is_grey);
    // Texels of a file are stored as codes.
    let values = std::array::from_fn(|code| code as f32 / 255.0);
    for (codes, is_grey) in
        [([[9, 9, 9, 0], [80, 80, 80, 1]], true), ([[9, 9, 9, 0], [80, 81, 80, 0]], false)]
    {
        let coded = Texture {
            width: 2,
            height: 1,
            texels: Texels::coded(2, &codes, values),
            ..textures()[0].clone()
        };
        let light = projector(Some(TextureId(0)), 50.0, FovAxis::X).light;
        let emitter = DeltaEmitter::new(light, &Textures::from(vec![coded]));
        assert_eq!(emitter.image.expect("one").is_grey, is_grey);
    }
}

#[test]
fn an_image_of_ones_leaves_a_spot_light_as_it_is() {
    let (plain, pictured) = (spot(0.7, false), spot(0.7, true));
    let white = |light: DeltaLight| {
        let ones = Texture { texels: Texels::new(8, &[Rgb::ONE; 32]), ..textures()[0].clone() };
        DeltaEmitter::new(light, &Textures::from(vec![ones]))
    };
    let pictured = white(pictured.light);
    for i in 0..500 {
        let x = 3.0 * uniform_sphere(owen_sobol_2d(i, 1));
        let ((a, b, expected), (c, d, irradiance)) = (plain.irradiance(x), pictured.irradiance(x));
        assert!(
            a == c && b == d && (irradiance - expected).length() <= 1e-4 * expected.length() + 1e-6,
            "{x}"
        );
    }
}

#[test]
fn power_bounds_and_samples_are_those_of_the_intensity() {
    const N: u32 = 1 << 18;
    for (number, emitter) in all().iter().enumerate() {
        let image = emitter.image.as_ref().expect("an image");
        let (mut flux, mut sampled) = (Rgb::ZERO, Rgb::ZERO);
        let mut worst = 0.0f32;
        for i in 0..N {
            let away = uniform_sphere(owen_sobol_2d(i, 3));
            let intensity = image.intensity(away);
            flux += intensity * (4.0 * PI / N as f32);
            assert!(intensity.cmple(image.peak * 1.0001).all(), "{number}: {intensity} {}", image.peak);
            let angle = away.dot(image.axis()).clamp(-1.0, 1.0).acos();
            assert!(
                intensity == Rgb::ZERO || angle < image.angle + 1e-3,
                "{number}: {angle} {}",
                image.angle
            );
            let (direction, solid_angle) = image.sample(owen_sobol_2d(i, 4));
            let carried = image.intensity(direction) * solid_angle;
            sampled += carried / N as f32;
            worst = worst.max(luminance(carried) / image.power);
        }
        assert!((sampled / flux - 1.0).abs().max_element() < 0.02, "{number}: {sampled} {flux}");
        assert!((image.power / luminance(flux) - 1.0).abs() < 0.03, "{number}: {} {flux}", image.power);
        // Photons follow the image.
        assert!(worst < 2.5, "{number}: {worst}");
        assert_eq!(emitter.power(1.0), image.power);
    }
}
