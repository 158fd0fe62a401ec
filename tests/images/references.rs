//! The path tracer against converged images of an independent renderer (Mitsuba 3).
//!
//! The scenes are public and no part of this repository. They are looked for in `$LIGHTSPLAT_SHARED` and beside the
//! checkout. Without them the tests are skipped with a message.

use lightsplat::film::Window;
use lightsplat::film::metrics::{Variances, compare};
use lightsplat::film::{Image, read_exr};
use lightsplat::method::path::Settings;
use lightsplat::method::render;
use lightsplat::progress::Control;
use lightsplat::readers::{LoadOptions, load};
use lightsplat::view::View;
use lightsplat::world::World;
use std::path::PathBuf;

/// Returns the folder of the public scenes; `None`, with a message, if there is none.
fn shared_scenes() -> Option<PathBuf> {
    let beside = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared"));
    let folder = std::env::var_os("LIGHTSPLAT_SHARED").map_or(beside, PathBuf::from).join("scenes");
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: no shared scenes at {}", folder.display());
    None
}

/// Crops an image of the whole film to the window.
fn crop(image: &Image, window: &Window) -> Image {
    let mut part = Image::new(window.width, window.height);
    for y in 0..window.height {
        for x in 0..window.width {
            let [fx, fy] = window.film_pixel([x, y]);
            part.pixels[(y * window.width + x) as usize] = image.pixels[(fy * image.width + fx) as usize];
        }
    }
    part
}

/// Renders `size` pixels at `offset` with `spp` samples; asserts that the z-test passes and that means agree
/// within 0.5 % or the two standard errors, whichever is wider.
fn agrees(name: &str, offset: [u32; 2], size: [u32; 2], spp: u32) {
    let Some(directory) = shared_scenes().map(|folder| folder.join(name)) else { return };
    let loaded = load(&directory.join("scene.xml"), &LoadOptions::default()).expect("the scene loads");
    let film = loaded.cameras.resolution;
    let world = World::new(loaded.scene, 2).expect("the scene builds");
    let window = Window { offset, width: size[0], height: size[1], ..Window::whole(film) };
    assert!(window.is_valid());
    let output = render(
        &world,
        &View { camera: loaded.cameras.still, window },
        &Settings { spp, ..Settings::default() },
        &Control::new(),
    );
    assert_eq!(output.nonfinite, 0);
    let read = |file: &str| crop(&read_exr(&directory.join(file)).expect("the reference reads"), &window);
    let (reference, variance) = (read("reference.exr"), read("reference_variance.exr"));
    let variances = Variances { test: output.variance.as_ref(), reference: Some(&variance) };
    let result = compare(&output.color, &reference, variances).expect("the pictures compare");
    let z = result.z_test.expect("both variances are known");
    eprintln!(
        "{name}: passed {:.5}, z² {:.2}, ratio {:?}",
        z.share_passed, z.mean_z_squared, result.mean_ratio
    );
    assert!(z.passed, "{name}: only {:.4} of the pixels agree", z.share_passed);
    let errors = result.mean_ratio_std_error.expect("both variances are known");
    for (ratio, error) in result.mean_ratio.into_iter().zip(errors) {
        let (ratio, error) = (ratio.expect("a lit picture"), error.expect("a lit picture"));
        assert!((ratio - 1.0).abs() < (4.0 * error).max(0.005), "{name}: mean off: {ratio} ± {error}");
    }
}

/// A scene, the part of its film to compare (offset and size), and the samples per pixel.
///
/// Fewer samples would leave the variances of pixels uncertain, and correct images would fail.
type Part = (&'static str, [u32; 2], [u32; 2], u32);

const PARTS: [Part; 6] = [
    ("cbox", [150, 230], [200, 160], 128),
    ("knot", [150, 200], [200, 160], 128),
    ("sibenik", [180, 220], [160, 120], 128),
    ("living-room", [200, 140], [128, 96], 512),
    ("staircase", [200, 380], [160, 160], 128),
    ("kitchenette", [200, 160], [96, 96], 512),
];

/// The middle third of each part: a ninth of the pixels, whose mean is still known to better than 0.5 %.
#[test]
fn paths_agree_with_the_references() {
    for (name, offset, size, spp) in PARTS {
        let shift = size.map(|side| side / 3);
        agrees(name, [offset[0] + shift[0], offset[1] + shift[1]], shift, spp);
    }
}

#[test]
#[ignore = "a study: minutes of path tracing"]
fn paths_agree_with_the_references_over_large_parts() {
    for (name, offset, size, spp) in PARTS {
        agrees(name, offset, size, spp);
    }
}
