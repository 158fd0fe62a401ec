//! Tests of spot lights with a texture, projectors and thin sheets.

use super::*;
use scene::FovAxis;

const LOOK: &str =
    "<transform name=\"to_world\"><lookat origin=\"1,5,0\" target=\"1,0,0\" up=\"0,0,1\"/></transform>";
const CHECKERS: &str = "type=\"checkerboard\"><rgb name=\"color0\" value=\"2 1 .5\"/><rgb name=\"color1\" value=\"0\"/></texture>";

#[test]
fn projectors_and_spots_have_their_image_and_its_frame() {
    let body = format!(
        "<emitter type=\"projector\">{LOOK}<float name=\"fov\" value=\"90\"/><float name=\"scale\" value=\"2\"/>\
        <string name=\"fov_axis\" value=\"y\"/><texture name=\"irradiance\" {CHECKERS}</emitter>\
        <emitter type=\"spot\">{LOOK}<rgb name=\"intensity\" value=\"3\"/><texture name=\"texture\" {CHECKERS}</emitter>\
        <emitter type=\"projector\"><rgb name=\"irradiance\" value=\".5\"/></emitter>"
    );
    let loaded = load_with(&body, &[], true).unwrap();
    let [DeltaLight::Projector { position, projector }, spot, DeltaLight::Projector { projector: plain, .. }] =
        loaded.scene.lights[..]
    else {
        panic!("{:?}", loaded.scene.lights)
    };
    assert!((position.as_dvec3() + loaded.scene.centre - DVec3::new(1.0, 5.0, 0.0)).length() < 1e-6);
    let pi = std::f32::consts::PI;
    assert!((projector.intensity - Rgb::splat(2.0 * pi)).length() < 1e-5 && projector.texture.is_some());
    assert!((projector.tan_half - 1.0).abs() < 1e-6 && projector.axis == FovAxis::Y);
    // Seen along the light, the picture's top is where `up` points, and its right is right.
    let close = |a: Vec3, b: Vec3| (a - b).length() < 1e-6;
    assert!(close(projector.to_local * Vec3::NEG_Y, Vec3::Z), "{:?}", projector.to_local);
    assert!(
        close(projector.to_local * Vec3::Z, Vec3::NEG_Y) && close(projector.to_local * Vec3::NEG_X, Vec3::X)
    );
    let DeltaLight::Spot { intensity, direction, image: Some(image), .. } = spot else { panic!("{spot:?}") };
    assert!(intensity == Rgb::splat(3.0) && close(direction, Vec3::NEG_Y));
    assert!(close(image.to_local * Vec3::Z, Vec3::Y) && Some(image.texture) == projector.texture);
    // 50 mm: the diagonal of 36 by 24 mm.
    assert!((plain.intensity - Rgb::splat(0.5 * pi)).length() < 1e-5 && plain.texture.is_none());
    assert!((plain.tan_half - 36f32.hypot(24.0) / 100.0).abs() < 1e-6 && plain.axis == FovAxis::Diagonal);
}

#[test]
fn images_that_cannot_be_projected_are_refused() {
    let wide = format!(
        "<emitter type=\"spot\"><float name=\"cutoff_angle\" value=\"95\"/><texture name=\"texture\" {CHECKERS}</emitter>"
    );
    assert!(load_body(&wide).unwrap_err().contains("less than 90"));
    let flat = "<emitter type=\"projector\"><float name=\"fov\" value=\"180\"/></emitter>";
    assert!(load_body(flat).unwrap_err().contains("field of view"));
    let sheared = "<transform name=\"to_world\"><matrix value=\"1 1 0 0 1 0 0 1 0\"/></transform>";
    let sheared = sheared.replace("1 1 0 0 1 0 0 1 0", "1 1 0 0 1 0 0 0 1");
    assert!(
        load_body(&format!("<emitter type=\"projector\">{sheared}</emitter>"))
            .unwrap_err()
            .contains("shears")
    );
    let dark = "<emitter type=\"projector\"><rgb name=\"irradiance\" value=\"0\"/></emitter>";
    assert!(load_body(&format!("{SKY}{dark}")).unwrap().scene.lights.is_empty());
    let black = "<emitter type=\"spot\"><texture name=\"texture\" type=\"checkerboard\"><rgb name=\"color0\" value=\"0\"/>\
        <rgb name=\"color1\" value=\"0\"/></texture></emitter>";
    assert!(load_body(&format!("{SKY}{black}")).unwrap().scene.lights.is_empty());
}

#[test]
fn thin_sheets_are_read_whole() {
    let text = "<bsdf type=\"principledthin\"><rgb name=\"base_color\" value=\".2 .5 .9\"/>\
        <float name=\"diff_trans\" value=\"1.5\"/><float name=\"spec_trans\" value=\".25\"/>\
        <float name=\"eta\" value=\"1.33\"/><float name=\"anisotropic\" value=\".5\"/></bsdf>";
    let (sheet, warnings) = bsdf(text);
    let p = sheet.principled.expect("one");
    assert_eq!((p.thin, p.spec_trans, warnings, sheet.two_sided), (Some(0.75.into()), 0.25.into(), 0, true));
    assert!((p.eta - 1.33).abs() < 1e-6 && p.anisotropic == 0.5.into() && p.metallic == 0.0.into());
    let checkers = "<texture name=\"diff_trans\" type=\"checkerboard\"><float name=\"color0\" value=\".4\"/>\
        <float name=\"color1\" value=\"1.4\"/></texture>";
    let loaded = load_body(&format!(
        "{SKY}<shape type=\"rectangle\"><bsdf type=\"principledthin\">{checkers}</bsdf></shape>"
    ));
    let scene = loaded.unwrap().scene;
    let Some(Share::Textured { texture, scale }) =
        scene.materials[0].principled.as_ref().and_then(|p| p.thin)
    else {
        panic!()
    };
    // Shares up to 2 are not clamped.
    let texels: Vec<f32> =
        scene.textures[texture.0 as usize].texels.iter().map(|texel| texel.x * scale).collect();
    assert!(texels.iter().any(|share| (share - 0.7).abs() < 1e-6), "{texels:?}");
    assert!(
        load_body(&format!("<shape type=\"cube\">{}</shape>", text.replace("1.5", "2.5")))
            .unwrap_err()
            .contains("give 0 to 2")
    );
    let (cloth, warnings) =
        bsdf("<bsdf type=\"difftrans\"><rgb name=\"transmittance\" value=\".3\"/></bsdf>");
    let p = cloth.principled.expect("one");
    assert_eq!((p.base_color, p.thin, warnings), (Rgb::splat(0.3).into(), Some(1.0.into()), 0));
}
