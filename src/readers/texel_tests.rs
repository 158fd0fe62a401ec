//! Tests: texels that are no colours, and texels above 1 with factors, in each format and use.

use super::{LoadOptions, Loaded, load};
use base::math::Rgb;
use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, WritableImage};
use scene::{Environment, Parameter, Reflectance, Scene, Texture, TextureId};
use std::fs;
use std::io::Cursor;
use std::path::Path;

const HEAD: &str = "camera = { origin = [0, 0, 5], target = [0, 0, 0], fov = 40 }\n";
const OBJ: &str =
    "mtllib s.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1 4/1\n";

/// Writes an image of 2 x 2 texels, whose first one differs.
fn write_exr(path: &Path, [first, others]: [[f32; 3]; 2]) {
    let plane = |i: usize| FlatSamples::F32([first, others, others, others].map(|texel| texel[i]).into());
    let list = ["R", "G", "B"].into_iter().enumerate();
    let list = list.map(|(i, name)| AnyChannel::new(name, plane(i))).collect();
    let mut bytes = Cursor::new(Vec::new());
    Image::from_channels((2, 2), AnyChannels::sort(list)).write().to_buffered(&mut bytes).unwrap();
    fs::write(path, bytes.into_inner()).unwrap();
}

/// Loads files beside the image `t.exr`, the first file as the scene.
fn load_with(texels: [[f32; 3]; 2], files: &[(&str, &str)], strict: bool) -> Result<Loaded, String> {
    let folder = tempfile::tempdir().unwrap();
    write_exr(&folder.path().join("t.exr"), texels);
    files.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).unwrap());
    load(&folder.path().join(files[0].0), &LoadOptions { strict, ..LoadOptions::default() })
        .map_err(|error| error.to_string())
}

fn texture(scene: &Scene, id: TextureId) -> &Texture {
    scene.textures.by_id(id).unwrap()
}

/// Returns the products of factor and texels of a material's diffuse reflectance.
fn paint(scene: &Scene) -> Vec<Rgb> {
    let painted = scene.materials.iter().find(|material| material.diffuse.is_textured()).unwrap();
    let Reflectance::Textured { texture: id, scale } = painted.diffuse else { panic!() };
    texture(scene, id).texels.iter().map(|texel| texel * scale).collect()
}

/// Returns scenes of each format whose paint is `t.exr` times a factor.
fn paints(factor: f32) -> [Vec<(&'static str, String)>; 4] {
    let toml = |material: &str| {
        format!(
            "{HEAD}material = [{{ name = \"m\", kind = \"diffuse\", {material} }}]\n\
            mesh = [{{ shape = \"rectangle\", material = \"m\" }}]\n"
        )
    };
    let mtl = |map: String| {
        let scene = format!("{HEAD}mesh = [{{ file = \"s.obj\" }}]\n");
        vec![("s.toml", scene), ("s.obj", OBJ.to_owned()), ("s.mtl", format!("newmtl m\nillum 1\n{map}\n"))]
    };
    let xml = format!(
        "<scene version=\"0.6.0\"><sensor type=\"perspective\"/><shape type=\"rectangle\"><bsdf type=\"diffuse\">\
        <texture type=\"scale\" name=\"reflectance\"><float name=\"scale\" value=\"{factor}\"/><texture type=\"bitmap\">\
        <string name=\"filename\" value=\"t.exr\"/></texture></texture></bsdf></shape></scene>"
    );
    [
        vec![("s.toml", toml(&format!("reflectance = {{ file = \"t.exr\", scale = {factor} }}")))],
        mtl(format!("Kd {factor} {factor} {factor}\nmap_Kd t.exr")),
        mtl(format!("Kd 1 1 1\nmap_Kd -mm 0 {factor} t.exr")),
        vec![("s.xml", xml)],
    ]
}

#[test]
fn texels_are_limited_after_their_factor() {
    let expected = Rgb::new(0.6, 0.3, 0.15);
    for factor in [1.0 / 255.0, 0.25, 1e-4, 1.0, 2.0] {
        let texel = (expected / factor).to_array();
        for files in paints(factor) {
            let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (*name, &**text)).collect();
            let loaded = load_with([texel, texel], &files, false).unwrap();
            let found = paint(&loaded.scene);
            assert!(found.iter().all(|colour| colour.distance(expected) < 1e-6), "{files:?} {found:?}");
        }
    }
    // Numbers: masks and roughness.
    for factor in [1.0 / 255.0, 0.25, 2.0] {
        let texel = [0.6 / factor; 3];
        let text = format!(
            "{HEAD}material = [{{ name = \"m\", kind = \"conductor\", preset = \"Al\", \
            alpha = {{ file = \"t.exr\", scale = {factor} }}, opacity = {{ file = \"t.exr\", scale = {factor} }} }}]\n\
            mesh = [{{ shape = \"rectangle\", material = \"m\" }}]\n"
        );
        let mut scene = load_with([texel, texel], &[("s.toml", &text)], false).unwrap().scene;
        let mut material = scene.materials.swap_remove(0);
        let opacity = material.opacity.unwrap();
        for number in material.alphas_mut().into_iter().map(|alpha| *alpha).chain([opacity]) {
            let Parameter::Textured { texture: id, scale } = number else { panic!() };
            let found = texture(&scene, id).texels.get(0, 0).x * scale;
            assert!((found - 0.6).abs() < 1e-6, "{factor} {found}");
        }
    }
}

#[test]
fn a_bad_texel_puts_out_no_emitter_and_is_named() {
    let inf = f32::INFINITY;
    for (bad, mended) in [(f32::NAN, 0.0), (inf, 65504.0), (3e38, 65504.0), (-1.0, 0.0)] {
        let texels = [[bad; 3], [2.0; 3]];
        let lamp = format!(
            "{HEAD}material = [{{ name = \"m\", kind = \"diffuse\", reflectance = 0 }}]\n\
            mesh = [{{ shape = \"rectangle\", material = \"m\", emission = \"t.exr\" }}]\n"
        );
        let of_obj = format!("{HEAD}mesh = [{{ file = \"s.obj\" }}]\n");
        let mtl = "newmtl m\nKd 0 0 0\nillum 1\nmap_Ke t.exr\n";
        let xml = "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><shape type=\"rectangle\">\
            <emitter type=\"area\"><texture type=\"bitmap\" name=\"radiance\">\
            <string name=\"filename\" value=\"t.exr\"/></texture></emitter></shape></scene>";
        let scenes: [&[(&str, &str)]; 3] =
            [&[("s.toml", &lamp)], &[("s.toml", &of_obj), ("s.obj", OBJ), ("s.mtl", mtl)], &[("s.xml", xml)]];
        for files in scenes {
            let loaded = load_with(texels, files, false).unwrap();
            let emission = loaded.scene.meshes[0].emission.unwrap();
            let found = texture(&loaded.scene, emission.texture.unwrap()).texels.get(0, 0);
            assert_eq!(found, Rgb::splat(mended), "{bad} {files:?}");
            let strict = load_with(texels, files, true).unwrap_err();
            assert!(strict.contains("column 1 of row 1"), "{strict}");
        }
        let sky = format!("{HEAD}environment = {{ file = \"t.exr\", scale = 0.5 }}\n");
        let loaded = load_with(texels, &[("s.toml", &sky)], false).unwrap();
        let Some(Environment::Map(map)) = &loaded.scene.environment else { panic!() };
        assert_eq!(map.radiance[0], Rgb::splat(0.5 * mended), "{bad}");
        let strict = load_with(texels, &[("s.toml", &sky)], true).unwrap_err();
        assert!(strict.contains("column 1 of row 1"), "{strict}");
        // Paint is limited to 1.
        let [files, ..] = paints(0.25);
        let loaded = load_with(texels, &[("s.toml", &files[0].1)], false).unwrap();
        assert_eq!(paint(&loaded.scene)[0], Rgb::splat((0.25 * mended).min(1.0)), "{bad}");
    }
}
