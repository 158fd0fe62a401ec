//! Materials of MTL files before an even light: pictures whose values follow from the statements.

use crate::kit::*;
use lightsplat::math::Rgb;
use lightsplat::method::path;
use std::fs;

const QUAD: &str = "mtllib m.mtl # the only one\nv -1 -1 0\nv 1 -1 0\nv 1 1 \\\n 0\nv -1 1 0\nvt 0 0\nvt U 0\nvt U V\n\
    vt 0 V\nusemtl m # front\nf 1/1 2/2 3/3 4/4 # whole\n";

/// Returns the pixels of a square that fills the film, under light of 1 from everywhere. Texture coordinates go from 0
/// to `uv`.
fn pixels(mtl: &str, uv: [u32; 2]) -> Vec<Rgb> {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    let quad = QUAD.replace('U', &uv[0].to_string()).replace('V', &uv[1].to_string());
    write("a.obj", quad.as_bytes());
    write("m.mtl", format!("newmtl m # front\n{mtl}\n").as_bytes());
    fs::copy(
        concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes/valid/tile.png"),
        folder.path().join("my tile.png"),
    )
    .unwrap();
    let text = "resolution = [8, 8]\nenvironment = { radiance = 1 }\nmesh = [{ file = \"a.obj\" }]\n\
        camera = { origin = [0, 0, 5], target = [0, 0, 0], film_width = 2 }\n";
    write("s.toml", text.as_bytes());
    let world = world(load_scene(&folder.path().join("s.toml"), None));
    image(&world, &path::Settings { spp: 256, ..Default::default() }).pixels
}

fn mean(mtl: &str) -> Rgb {
    let pixels = pixels(mtl, [1, 1]);
    pixels.iter().sum::<Rgb>() / pixels.len() as f32
}

#[test]
fn surfaces_have_the_radiance_of_their_statements() {
    for (mtl, expected) in [
        ("Kd 0.6 0.15 \\\n 0.1\nillum 1", [0.6, 0.15, 0.1]),
        ("Kd 0.6 0.15 0.1\nTr 1\nd 1\nillum 1", [0.6, 0.15, 0.1]),
        ("Kd 0.6 0.15 0.1\nTr 1\nillum 1", [1.0, 1.0, 1.0]),
        ("Kd 0.5 0.25 0\nd 0.4\nKs 0\nillum 9\nNi 1.45", [0.8, 0.7, 0.6]),
        ("Kd 0.5 0.25 0\nTf 0.4 0.4 0.4\nKs 0\nillum 4\nNi 1.00", [0.8, 0.7, 0.6]),
        ("Kd 0.5 0.25 0\nKs 0.5 0.5 0.5\nillum 3", [1.0, 0.75, 0.5]),
        ("Kd 0.9 0.6 0.2\nKs 0.5 0.5 0.5\nillum 3", [0.9, 0.6, 0.2]),
        ("Kd 0\nTf 0.5 0.6 0.7\nNi 1\nillum 7", [0.5, 0.6, 0.7]),
        ("map_Kd no such.png\nillum 1", [0.5, 0.5, 0.5]),
        ("Kd 0.5\nmap_d no such.png\nillum 1", [0.5, 0.5, 0.5]),
    ] {
        let found = mean(mtl);
        assert!((found - Rgb::from(expected)).abs().max_element() < 0.01, "{mtl}: {found}");
    }
}

#[test]
fn brass_of_blender_has_the_hue_of_brass_with_and_without_the_extension() {
    let plain = "Ns 562.5\nKa 1 1 1\nKd 0.9 0.6 0.2\nKs 0.5 0.5 0.5\nKe 0 0 0\nNi 1.5\nd 1\nillum 3\n";
    let rough = mean(plain);
    assert!((rough - Rgb::new(0.9, 0.6, 0.2)).abs().max_element() < 0.02, "{rough}");
    let extended = mean(&format!("{plain}Pr 0.25\nPm 1\nPs 0\nPc 0\nPcr 0.03\naniso 0\nanisor 0\n"));
    assert!((rough - extended).abs().max_element() < 0.01, "{rough} and {extended}");
    let half = mean(&format!("{plain}Pr 0.25\nPm 1\nillum 6\nd 0.5\n"));
    assert!((half - 0.5 * (extended + 1.0)).abs().max_element() < 0.02, "{half}");
}

#[test]
fn options_of_maps_are_as_other_texture_coordinates() {
    let scaled = pixels("map_Kd -s 4 2 1 my tile.png\nillum 1", [1, 1]);
    let repeated = pixels("map_Kd my tile.png\nillum 1", [4, 2]);
    let plain = pixels("map_Kd my tile.png -o 1 -1 0\nillum 1", [1, 1]);
    let difference = |a: &[Rgb], b: &[Rgb]| {
        a.iter().zip(b).map(|(a, b)| (a - b).abs().max_element()).sum::<f32>() / a.len() as f32
    };
    assert!(difference(&scaled, &repeated) < 0.01);
    assert!(difference(&scaled, &plain) > 0.05);
    assert!(difference(&plain, &pixels("map_Kd my tile.png\nillum 1", [1, 1])) < 0.01);
    // Half of the image's width further on, left and right change sides.
    let shifted = pixels("map_Kd -o 0.5 my tile.png\nillum 1", [1, 1]);
    let sides: Vec<Rgb> = (0..64).map(|i| plain[i / 8 * 8 + (i + 4) % 8]).collect();
    assert!(difference(&shifted, &sides) < 0.02);
}
