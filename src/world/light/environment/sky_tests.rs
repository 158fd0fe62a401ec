//! Sun and sky, as scenes describe them, against Mitsuba 3.9.1 (variant `scalar_rgb`): values kept from a run, and
//! maps by the Python package `mitsuba` where that is there.

use super::*;
use base::sampling::owen_sobol_2d;
use glam::DVec3;
use readers::{LoadOptions, load};
use scene::Scene;
use std::process::Command;

/// Height of the sun in degrees, turbidity and albedo; radiance of the sun, and of the sky from [`DIRECTIONS`].
type Sky = (f32, f32, f32, [f32; 3], [[f32; 3]; 5]);

/// Directions in Mitsuba's frame, z up, the sun at azimuth 0.
const DIRECTIONS: [[f32; 3]; 5] =
    [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [-0.6, 0.3, 0.5], [0.1, -0.9, 0.1], [0.7, 0.7, 0.3]];

#[rustfmt::skip]
const SKIES: [Sky; 3] = [
    (10.0, 3.0, 0.3, [14494.0, 8789.2, 3141.1], [
        [0.008369, 0.017025, 0.029884],
        [0.02008, 0.031497, 0.046008],
        [0.023084, 0.038339, 0.05507],
        [0.070007, 0.088966, 0.082069],
        [0.066815, 0.084864, 0.093484],
    ]),
    (35.0, 2.2, 0.1, [21205.0, 17039.0, 11846.0], [
        [0.014904, 0.029065, 0.061618],
        [0.045976, 0.067826, 0.10841],
        [0.023714, 0.046839, 0.090636],
        [0.083007, 0.13126, 0.17897],
        [0.071381, 0.11404, 0.1742],
    ]),
    (60.0, 6.0, 0.8, [20118.0, 16696.0, 12919.0], [
        [0.08804, 0.11528, 0.17247],
        [0.46549, 0.49388, 0.48512],
        [0.062174, 0.10351, 0.17621],
        [0.22112, 0.276, 0.35187],
        [0.16539, 0.22127, 0.31271],
    ]),
];

fn read(name: &str, text: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    load(&path, &LoadOptions::default()).unwrap().scene
}

/// Returns the environment of a Mitsuba 3 emitter with the sun at a height, and other values.
fn sunsky(height: f32, more: &str) -> EnvironmentLight {
    let (sin, cos) = height.to_radians().sin_cos();
    let scene = read(
        "s.xml",
        &format!(
            "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"sunsky\">\
            <vector name=\"sun_direction\" x=\"{cos}\" y=\"0\" z=\"{sin}\"/>{more}</emitter></scene>"
        ),
    );
    EnvironmentLight::new(scene.environment.as_ref(), &scene.discs).unwrap()
}

fn float(name: &str, value: f32) -> String {
    format!("<float name=\"{name}\" value=\"{value}\"/>")
}

fn assert_near(value: Rgb, expected: Rgb, tolerance: f32, what: &str) {
    assert!(
        (value - expected).abs().max_element() <= tolerance * expected.max_element(),
        "{what}: {value} {expected}"
    );
}

#[test]
fn sun_and_sky_are_mitsubas() {
    for (height, turbidity, albedo, sun, sky) in SKIES {
        let more = float("turbidity", turbidity) + &float("albedo", albedo);
        let light = sunsky(height, &(more.clone() + &float("sun_scale", 0.0)));
        for (direction, expected) in DIRECTIONS.iter().zip(sky) {
            let direction = Vec3::from(*direction).normalize();
            assert_near(
                light.radiance(direction),
                Rgb::from(expected),
                0.01,
                &format!("{height} {direction}"),
            );
        }
        assert_eq!(light.radiance(Vec3::new(0.6, 0.0, -0.8)), Rgb::ZERO);
        let light = sunsky(height, &(more + &float("sky_scale", 0.0)));
        let (sin, cos) = height.to_radians().sin_cos();
        let rim = |degrees: f32| Vec3::new(cos, degrees.to_radians(), sin).normalize();
        assert_near(light.radiance(rim(0.0)), Rgb::from(sun), 0.02, &format!("sun at {height}"));
        assert_eq!(light.radiance(rim(0.266)), light.radiance(rim(0.0)));
        assert_eq!(light.radiance(rim(0.27)), Rgb::ZERO);
    }
}

#[test]
fn a_wider_sun_keeps_its_irradiance() {
    let sky = float("sky_scale", 0.0);
    let [narrow, wide] = ["0.5358", "4"]
        .map(|angle| sunsky(30.0, &(sky.clone() + "<float name=\"sun_aperture\" value=\"" + angle + "\"/>")));
    assert!((wide.mean_luminance() / narrow.mean_luminance() - 1.0).abs() < 1e-3);
}

#[test]
fn dates_and_transforms_place_the_sun_as_mitsuba_does() {
    let sun = |version: &str, inside: &str| {
        let sensor = "<sensor type=\"perspective\"/>";
        let text = format!(
            "<scene version=\"{version}\">{sensor}<emitter type=\"sunsky\">{inside}</emitter></scene>"
        );
        read("s.xml", &text).discs[0].direction
    };
    let whole = |name: &str, value: i32| format!("<integer name=\"{name}\" value=\"{value}\"/>");
    let berlin =
        [("latitude", 52.5), ("longitude", 13.4), ("timezone", 2.0), ("hour", 17.0), ("minute", 30.0)]
            .map(|(name, value)| float(name, value))
            .concat()
            + &whole("year", 2013)
            + &whole("month", 6)
            + &whole("day", 21);
    let sydney = [("latitude", -33.9), ("longitude", 151.2), ("timezone", 10.0), ("hour", 9.0)]
        .map(|(name, value)| float(name, value))
        .concat()
        + &whole("year", 2005)
        + &whole("month", 1)
        + &whole("day", 3);
    let turned = "<transform name=\"to_world\"><rotate x=\"1\" angle=\"-90\"/></transform>";
    let eight = float("hour", 8.0);
    let cases = [
        (String::new(), Vec3::new(0.0513854, 0.691748, 0.720308)),
        (eight.clone(), Vec3::new(-0.010881, -0.772856, 0.634488)),
        (eight.clone() + turned, Vec3::new(-0.010881, 0.634488, 0.772856)),
        (berlin, Vec3::new(0.0605561, 0.834466, 0.547722)),
        (sydney, Vec3::new(-0.0420907, -0.650446, 0.758385)),
    ];
    for (inside, expected) in cases {
        let found = sun("3.0.0", &inside);
        assert!((found - expected).length() < 2e-3, "{found} {expected}");
    }
    // In 0.6, up is y, east x and north -z: the morning's sun stands in the east.
    assert!((sun("0.6.0", &eight) - Vec3::new(0.772856, 0.634488, -0.010881)).length() < 2e-3);
    let toml = "resolution = [8, 8]\n[sky]\ndate = 2013-06-21T17:30:00+02:00\nplace = [52.5, 13.4]\n";
    let found = read("s.toml", toml).discs[0].direction;
    assert!((found - Vec3::new(-0.834466, 0.547722, 0.0605561)).length() < 2e-3, "{found}");
    let found = read("s.toml", &format!("{toml}up = [0, 0, 1]\nrotate_y = 90\n")).discs[0].direction;
    assert!((found - Vec3::new(0.0605561, -0.834466, 0.547722)).length() < 2e-3, "{found}");
}

/// Prints the radiance of an emitter in the directions of a file.
const SCRIPT: &str = r"
import sys
import numpy as np
import mitsuba as mi
mi.set_variant('scalar_rgb')
height, turbidity, albedo = map(float, sys.argv[1:4])
angle = np.radians(height)
emitter = mi.load_dict({'type': 'sunsky', 'turbidity': turbidity, 'albedo': albedo, 'sun_scale': 0.0,
    'sun_direction': [float(np.cos(angle)), 0.0, float(np.sin(angle))]})
at = mi.SurfaceInteraction3f()
for row in np.loadtxt(sys.argv[4]):
    at.wi = -mi.Vector3f(*[float(x) for x in row])
    print(*emitter.eval(at))
";

#[test]
fn maps_of_the_sky_are_those_of_the_package_mitsuba() {
    if !Command::new("python3").args(["-c", "import mitsuba"]).output().is_ok_and(|o| o.status.success()) {
        eprintln!("skipped: there is no Python package mitsuba");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("directions");
    let directions: Vec<Vec3> =
        (0..2000).map(|i| uniform_sphere(owen_sobol_2d(i, 9))).filter(|d| d.z > 0.01).collect();
    let lines = directions.iter().map(|d| format!("{} {} {}\n", d.x, d.y, d.z));
    std::fs::write(&file, lines.collect::<String>()).unwrap();
    for (height, turbidity, albedo) in [(8.0, 2.0, 0.2), (35.0, 3.5, 0.3), (75.0, 9.0, 0.6)] {
        let arguments = [height, turbidity, albedo].map(|value: f32| value.to_string());
        let output =
            Command::new("python3").args(["-c", SCRIPT]).args(arguments).arg(&file).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = String::from_utf8(output.stdout).unwrap();
        let values: Vec<f32> = text.split_whitespace().map(|v| v.parse().unwrap()).collect();
        assert_eq!(values.len(), 3 * directions.len());
        let more = float("turbidity", turbidity) + &float("albedo", albedo) + &float("sun_scale", 0.0);
        let light = sunsky(height, &more);
        let (mut worst, mut sums) = (0.0f32, [DVec3::ZERO; 2]);
        for (direction, expected) in directions.iter().zip(values.chunks(3)) {
            let (found, expected) = (light.radiance(*direction), Rgb::from_slice(expected));
            worst = worst.max((found - expected).abs().max_element() / expected.max_element());
            sums[0] += found.as_dvec3();
            sums[1] += expected.as_dvec3();
        }
        let means = sums[0] / sums[1];
        eprintln!("sun at {height}: radiance within {:.2} %, means {means:.4}", 100.0 * worst);
        assert!(worst < 0.02 && (means - 1.0).abs().max_element() < 2e-3, "{worst} {means}");
    }
}
