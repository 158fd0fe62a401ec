//! Materials against an independent renderer, the Python package `mitsuba` (version 3): a small scene for each, the
//! same XML file for both, pictures by paths. Where the package is not there, nothing is tested, with a line that says
//! so.

use lightsplat::film::metrics::{Variances, compare};
use lightsplat::film::{Image, Window};
use lightsplat::math::Rgb;
use lightsplat::method::{path, render};
use lightsplat::progress::Control;
use lightsplat::readers::{LoadOptions, Severity, load};
use lightsplat::view::View;
use lightsplat::world::World;
use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;

/// Edge of the pictures in pixels.
const SIZE: u32 = 24;

/// Samples a pixel of either renderer.
const SPP: u32 = 1024;

/// A block, a leaning board and a floor under a lamp and a faint sky; the first two are of the material.
const SCENE: &str = r#"<scene version="3.0.0">
    <integrator type="path"><integer name="max_depth" value="8"/></integrator>
    <sensor type="perspective">
        <float name="fov" value="34"/>
        <transform name="to_world"><lookat origin="0.3, 2.2, 4.5" target="0, 0.6, 0" up="0, 1, 0"/></transform>
        <sampler type="independent"><integer name="sample_count" value="64"/></sampler>
        <film type="hdrfilm">
            <integer name="width" value="24"/><integer name="height" value="24"/>
            <rfilter type="box"/>
        </film>
    </sensor>
    <emitter type="constant"><rgb name="radiance" value="0.2, 0.25, 0.3"/></emitter>
    <shape type="rectangle">
        <transform name="to_world">
            <rotate x="1" angle="90"/><translate x="-0.6" y="3.5" z="0.8"/>
        </transform>
        <emitter type="area"><rgb name="radiance" value="6, 5, 4"/></emitter>
    </shape>
    <shape type="rectangle">
        <transform name="to_world"><scale value="60"/><rotate x="1" angle="-90"/></transform>
        <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf></bsdf>
    </shape>
    <texture type="bitmap" id="checker">
        <string name="filename" value="checker.png"/><boolean name="raw" value="true"/>
        <string name="filter_type" value="nearest"/>
        <transform name="to_uv"><scale x="3" y="3"/></transform>
    </texture>
    BSDF
    <shape type="cube">
        <transform name="to_world">
            <scale value="0.45"/><rotate y="1" angle="25"/><translate x="0.8" y="0.5" z="0.4"/>
        </transform>
        <ref id="material"/>
    </shape>
    <shape type="rectangle">
        <transform name="to_world">
            <scale value="0.7"/><rotate x="1" angle="-35"/><rotate y="1" angle="15"/>
            <translate x="-0.7" y="0.7" z="0.2"/>
        </transform>
        <ref id="material"/>
    </shape>
</scene>"#;

/// Renders with other seeds over and over: means and their variances.
const SCRIPT: &str = r"
import sys
import numpy as np
import mitsuba as mi
mi.set_variant('scalar_rgb')
scene, runs = mi.load_file(sys.argv[1]), 16
pictures = [np.array(mi.render(scene, spp=int(sys.argv[3]) // runs, seed=seed)) for seed in range(runs)]
mean, variance = np.mean(pictures, 0), np.var(pictures, 0, ddof=1) / runs
np.concatenate([mean.ravel(), variance.ravel()]).astype('<f4').tofile(sys.argv[2])
";

/// True if the other renderer is there, which is tried once.
fn is_there() -> bool {
    static IS_THERE: OnceLock<bool> = OnceLock::new();
    *IS_THERE.get_or_init(|| {
        let output = Command::new("python3").args(["-c", "import mitsuba"]).output();
        output.is_ok_and(|output| output.status.success())
    })
}

/// Mean and variance by the other renderer; `None`, with a line, where it is not there.
fn by_mitsuba(scene: &Path, folder: &Path) -> Option<[Image; 2]> {
    if !is_there() {
        eprintln!("skipped: there is no Python package mitsuba");
        return None;
    }
    let values = folder.join("values");
    let arguments = [scene.as_os_str(), values.as_os_str(), SPP.to_string().as_ref()].map(|a| a.to_owned());
    let output = Command::new("python3").args(["-c", SCRIPT]).args(arguments).output().expect("a process");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let bytes = std::fs::read(values).expect("values");
    let numbers: Vec<f32> =
        bytes.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().expect("four bytes"))).collect();
    let image = |numbers: &[f32]| {
        let mut image = Image::new(SIZE, SIZE);
        let colours = numbers.chunks_exact(3).map(|c| Rgb::new(c[0], c[1], c[2]));
        image.pixels.iter_mut().zip(colours).for_each(|(pixel, colour)| *pixel = colour);
        image
    };
    let (mean, variance) = numbers.split_at(numbers.len() / 2);
    Some([image(mean), image(variance)])
}

/// Writes a picture of two by two texels.
fn picture(path: &Path, texels: [[u8; 3]; 4]) {
    image::RgbImage::from_raw(2, 2, texels.concat()).expect("four texels").save(path).expect("a file");
}

/// Renders the scene with a material in both.
fn agrees(name: &str, bsdf: &str) {
    agrees_in(name, &SCENE.replace("BSDF", bsdf));
}

/// Renders a scene that may have the checkered texture in both.
fn agrees_in(name: &str, scene: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let texels = [[230, 180, 130], [25, 50, 75], [25, 50, 75], [230, 180, 130]];
    picture(&folder.path().join("checker.png"), texels);
    scene_agrees(name, folder.path(), scene);
}

/// Renders a scene of a film of 24 by 24 pixels, whose files are in a folder, in both; asserts that the pictures pass
/// the z-test and that their means agree within half a per cent or their noise.
pub fn scene_agrees(name: &str, folder: &Path, scene: &str) {
    let file = folder.join("scene.xml");
    std::fs::write(&file, scene).expect("a file");
    let loaded = load(&file, &LoadOptions::default()).expect("the scene loads");
    let are_notes = loaded.warnings.iter().all(|warning| warning.severity == Severity::Note);
    assert!(are_notes, "{name}: {:?}", loaded.warnings);
    let Some([reference, variance]) = by_mitsuba(&file, folder) else { return };
    let world = World::new(loaded.scene, 2).expect("the scene builds");
    let view = View { camera: loaded.cameras.still, window: Window::whole([SIZE, SIZE]) };
    let settings = path::Settings { spp: SPP, ..Default::default() };
    let output = render(&world, &view, &settings, &Control::new());
    let variances = Variances { test: output.variance.as_ref(), reference: Some(&variance) };
    let result = compare(&output.color, &reference, variances).expect("the pictures compare");
    let z = result.z_test.expect("both variances are known");
    let ratios = (result.mean_ratio, result.mean_ratio_std_error);
    eprintln!("{name}: passed {:.5}, z² {:.2}, ratio {ratios:?}", z.share_passed, z.mean_z_squared);
    assert!(z.passed, "{name}: only {:.4} of the pixels agree", z.share_passed);
    let errors = ratios.1.expect("both variances are known");
    for (ratio, error) in ratios.0.into_iter().zip(errors) {
        let (ratio, error) = (ratio.expect("a lit picture"), error.expect("a lit picture"));
        assert!((ratio - 1.0).abs() < (4.0 * error).max(0.005), "{name}: mean off: {ratio} ± {error}");
    }
}

#[test]
fn hidden_emitters_shine_and_are_not_seen() {
    let integrator = "<integrator type=\"path\"><boolean name=\"hide_emitters\" value=\"true\"/>";
    let scene = SCENE.replace("<integrator type=\"path\">", integrator);
    // The lamp hangs in front of the blocks, and above the floor the sky is seen.
    let scene = scene.replace("x=\"-0.6\" y=\"3.5\" z=\"0.8\"", "x=\"0.3\" y=\"1.8\" z=\"0.9\"");
    let scene = scene.replace("target=\"0, 0.6, 0\"", "target=\"0, 1.5, 0\"");
    let material = r#"<bsdf type="twosided" id="material"><bsdf type="diffuse"/></bsdf>"#;
    agrees_in("hidden emitters", &scene.replace("BSDF", material));
}

mod slow_materials {
    use super::agrees;

    #[test]
    fn plain_ones() {
        for (name, bsdf) in [
            ("glass", r#"<bsdf type="dielectric" id="material"/>"#),
            (
                "pane",
                r#"<bsdf type="thindielectric" id="material"><float name="int_ior" value="1.7"/></bsdf>"#,
            ),
        ] {
            agrees(name, bsdf);
        }
        for (name, bsdf) in [
            (
                "rough gold",
                r#"<bsdf type="roughconductor"><string name="material" value="Au"/>
                <string name="distribution" value="ggx"/><float name="alpha" value="0.2"/></bsdf>"#,
            ),
            (
                "brushed gold",
                r#"<bsdf type="roughconductor"><string name="material" value="Au"/>
                <string name="distribution" value="ggx"/><float name="alpha_u" value="0.08"/>
                <float name="alpha_v" value="0.4"/></bsdf>"#,
            ),
            (
                "smooth plastic",
                r#"<bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.6, 0.2, 0.1"/>
                <boolean name="nonlinear" value="true"/></bsdf>"#,
            ),
            (
                "rough plastic",
                r#"<bsdf type="roughplastic"><ref name="diffuse_reflectance" id="checker"/>
                <float name="alpha" value="0.15"/></bsdf>"#,
            ),
        ] {
            agrees(name, &format!("<bsdf type=\"twosided\" id=\"material\">{bsdf}</bsdf>"));
        }
    }

    #[test]
    fn masks() {
        let inner = r#"<bsdf type="twosided"><bsdf type="diffuse">
            <rgb name="reflectance" value="0.2, 0.6, 0.3"/></bsdf></bsdf>"#;
        let mask = |opacity: &str| format!(r#"<bsdf type="mask" id="material">{opacity}{inner}</bsdf>"#);
        agrees("constant mask", &mask(r#"<float name="opacity" value="0.6"/>"#));
        agrees("textured mask", &mask(r#"<ref name="opacity" id="checker"/>"#));
    }

    #[test]
    fn reliefs() {
        // Rows of bumps, and a normal map of four inclinations.
        let file = |name: &str, texels: [[u8; 3]; 4]| {
            let path = std::env::temp_dir().join(format!("lightsplat-{}-{name}.png", std::process::id()));
            super::picture(&path, texels);
            path
        };
        let map = |name: &str, path: &std::path::Path| {
            let path = path.display();
            format!(
                r#"<texture type="bitmap" name="{name}"><string name="filename" value="{path}"/>
                <boolean name="raw" value="true"/>
                <transform name="to_uv"><scale x="3" y="2"/></transform></texture>"#
            )
        };
        let inner = r#"<bsdf type="roughplastic"><float name="alpha" value="0.3"/></bsdf>"#;
        let relieved = |plugin: &str, parameters: &str| {
            let bsdf = format!(r#"<bsdf type="{plugin}">{parameters}{inner}</bsdf>"#);
            format!(r#"<bsdf type="twosided" id="material">{bsdf}</bsdf>"#)
        };
        let heights = file("heights", [[255; 3], [0; 3], [60; 3], [200; 3]]);
        let scale = r#"<float name="scale" value="0.05"/>"#;
        agrees("bump map", &relieved("bumpmap", &format!("{}{scale}", map("bump", &heights))));
        let normals = file("normals", [[160, 128, 250], [100, 140, 250], [128, 90, 245], [128, 128, 255]]);
        agrees("normal map", &relieved("normalmap", &map("normalmap", &normals)));
        [heights, normals].iter().for_each(|path| std::fs::remove_file(path).expect("a file"));
    }

    #[test]
    fn thin_sheets() {
        let sheet = |parameters: &[(&str, f32)]| {
            let float = |(name, value): &(&str, f32)| format!(r#"<float name="{name}" value="{value}"/>"#);
            let parameters: String = parameters.iter().map(float).collect();
            format!(
                r#"<bsdf type="principledthin" id="material">{parameters}
                <rgb name="base_color" value="0.5, 0.8, 0.3"/></bsdf>"#
            )
        };
        agrees("matte sheet", &sheet(&[("diff_trans", 1.2), ("roughness", 0.4), ("sheen", 0.5)]));
        let mixed = [("diff_trans", 0.8), ("spec_trans", 0.6), ("spec_tint", 0.4), ("eta", 1.4)];
        agrees("mixed sheet", &sheet(&mixed));
        agrees("brushed clear sheet", &sheet(&[("spec_trans", 1.0), ("anisotropic", 0.5), ("eta", 1.6)]));
        let textured = r#"<bsdf type="principledthin" id="material"><ref name="diff_trans" id="checker"/>
            <ref name="spec_trans" id="checker"/></bsdf>"#;
        agrees("textured sheet", textured);
    }

    #[test]
    fn projected_images() {
        let light = |plugin: &str, inside: &str| {
            format!(
                r#"<bsdf type="diffuse" id="material"/><emitter type="{plugin}">{inside}
                <transform name="to_world"><lookat origin="0.5, 3, 2.5" target="0, 0.3, 0" up="0, 1, 0"/></transform>
                </emitter>"#
            )
        };
        let float = |name: &str, value: f32| format!(r#"<float name="{name}" value="{value}"/>"#);
        let image = |name: &str| format!(r#"<ref name="{name}" id="checker"/>"#);
        agrees(
            "projector",
            &light("projector", &(image("irradiance") + &float("scale", 8.0) + &float("fov", 35.0))),
        );
        let spot =
            image("texture") + &float("cutoff_angle", 25.0) + r#"<rgb name="intensity" value="40, 30, 20"/>"#;
        agrees("spot light with a texture", &light("spot", &spot));
    }

    #[test]
    fn rough_glass() {
        for (distribution, alpha) in [("ggx", 0.3), ("beckmann", 0.15)] {
            let bsdf = format!(
                r#"<bsdf type="roughdielectric" id="material"><float name="alpha" value="{alpha}"/>
                <string name="distribution" value="{distribution}"/></bsdf>"#
            );
            agrees(&format!("rough glass, {distribution}"), &bsdf);
        }
    }

    #[test]
    fn blends() {
        let metal = r#"<bsdf type="roughconductor"><string name="material" value="Cu"/>
            <float name="alpha" value="0.3"/></bsdf>"#;
        let paint = r#"<bsdf type="roughplastic"><float name="alpha" value="0.2"/></bsdf>"#;
        let blend = |weight: &str| {
            let bsdf = format!(r#"<bsdf type="blendbsdf">{weight}{metal}{paint}</bsdf>"#);
            format!(r#"<bsdf type="twosided" id="material">{bsdf}</bsdf>"#)
        };
        agrees("constant blend", &blend(r#"<float name="weight" value="0.3"/>"#));
        agrees("textured blend", &blend(r#"<ref name="weight" id="checker"/>"#));
    }

    #[test]
    fn principled_materials() {
        let agrees = |name: &str, parameters: &str, sides: bool| {
            let (open, close) =
                if sides { ("<bsdf type=\"twosided\" id=\"material\">", "</bsdf>") } else { ("", "") };
            let id = if sides { "" } else { "id=\"material\"" };
            agrees(name, &format!("{open}<bsdf type=\"principled\" {id}>{parameters}</bsdf>{close}"));
        };
        let colour = r#"<rgb name="base_color" value="0.7, 0.4, 0.2"/>"#;
        let number = |name: &str, value: f32| format!(r#"<float name="{name}" value="{value}"/>"#);
        agrees("plain", &format!("{colour}{}", number("roughness", 0.6)), true);
        agrees("metal", &format!("{colour}{}{}", number("metallic", 1.0), number("roughness", 0.4)), true);
        let brushed = [("metallic", 0.8), ("roughness", 0.5), ("anisotropic", 0.8)];
        let brushed: String = brushed.into_iter().map(|(name, value)| number(name, value)).collect();
        agrees("brushed metal", &format!("{colour}{brushed}"), true);
        let all =
            [("metallic", 0.4), ("spec_tint", 0.5), ("sheen", 0.8), ("sheen_tint", 0.3), ("clearcoat", 0.8)];
        let all: String = all.into_iter().map(|(name, value)| number(name, value)).collect();
        agrees("all but glass", &format!("{colour}{all}{}", number("specular", 0.8)), true);
        let glass = format!("{}{}", number("spec_trans", 0.8), number("roughness", 0.5));
        agrees("partly glass", &format!("{colour}{glass}{}", number("eta", 1.4)), false);
        let texture = |name: &str| format!(r#"<ref name="{name}" id="checker"/>"#);
        let textured = ["base_color", "roughness", "metallic"].map(texture).concat();
        agrees("textured", &textured, true);
    }
}
