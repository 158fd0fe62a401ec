//! Tests of films, integrators, spectra of black bodies, and metals in water.

use super::*;

/// Loads a scene with a film of 8 by 4 pixels that contains `film`, and with `integrator`.
fn with_film(film: &str, integrator: &str) -> Result<Loaded, String> {
    let sensor = SENSOR.replace("<rfilter type=\"box\"/>", film);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.xml");
    fs::write(&path, format!("<scene version=\"3.0.0\">{integrator}{sensor}{SKY}</scene>")).unwrap();
    load(&path, &LoadOptions::default()).map_err(|e| e.to_string())
}

const BOX: &str = "<rfilter type=\"box\"/>";

#[test]
fn a_films_crop_is_the_part_that_is_rendered() {
    let crop = |[x, y, width, height]: [i32; 4]| {
        let number = |name: &str, value: i32| format!("<integer name=\"{name}\" value=\"{value}\"/>");
        let offset = number("cropOffsetX", x) + &number("crop_offset_y", y);
        with_film(&(offset + &number("crop_width", width) + &number("cropHeight", height) + BOX), "")
    };
    let loaded = crop([1, 2, 5, 2]).unwrap();
    assert_eq!(loaded.cameras.crop, Some([[1, 2], [5, 2]]));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    assert_eq!(crop([0, 0, 8, 4]).unwrap().cameras.crop, None);
    for off_the_film in [[0, 0, 9, 4], [4, 0, 5, 4], [0, 0, 8, 0], [-1, 0, 8, 4], [0, i32::MAX, 1, 1]] {
        let message = crop(off_the_film).unwrap_err();
        assert!(message.contains("film's crop"), "{off_the_film:?}: {message}");
    }
}

#[test]
fn filters_with_negative_lobes_are_those_asked_for() {
    let filter = |text: &str| {
        let loaded = with_film(text, "").unwrap();
        (loaded.cameras.still.filter, loaded.warnings.len())
    };
    assert_eq!(filter("<rfilter type=\"mitchell\"/>"), (PixelFilter::Mitchell, 0));
    assert_eq!(filter("<rfilter type=\"catmullrom\"/>"), (PixelFilter::CatmullRom, 0));
    assert_eq!(filter("<rfilter type=\"lanczos\"/>"), (PixelFilter::Lanczos, 0));
    let three = "<rfilter type=\"lanczos\"><integer name=\"lobes\" value=\"3\"/></rfilter>";
    assert_eq!(filter(three), (PixelFilter::Lanczos, 0));
    let soft = "<rfilter type=\"mitchell\"><float name=\"B\" value=\"1\"/></rfilter>";
    assert_eq!(filter(soft), (PixelFilter::Mitchell, 1));
    assert_eq!(filter("<rfilter type=\"sinc\"/>"), (PixelFilter::GAUSSIAN, 1));
}

#[test]
fn emitters_are_hidden_where_the_integrator_says() {
    for (value, hidden) in [("true", true), ("false", false)] {
        let integrator = format!(
            "<integrator type=\"path\"><boolean name=\"hideEmitters\" value=\"{value}\"/></integrator>"
        );
        let loaded = with_film(BOX, &integrator).unwrap();
        assert_eq!((loaded.scene.hides_emitters, loaded.warnings.len()), (hidden, 0));
    }
}

#[test]
fn black_bodies_shine_in_the_spellings_of_both_versions() {
    let radiance = |text: &str| {
        let body = format!("<shape type=\"rectangle\"><emitter type=\"area\">{text}</emitter></shape>");
        let loaded = load_body(&body).unwrap();
        assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
        loaded.scene.meshes[0].emission.as_ref().unwrap().radiance
    };
    let new = "<spectrum name=\"radiance\" type=\"blackbody\"><float name=\"temperature\" value=\"5000\"/></spectrum>";
    let expected = radiance(new);
    assert!((expected / Vec3::new(15233.0, 12106.0, 9457.5) - 1.0).abs().max_element() < 0.02, "{expected}");
    let old = radiance("<blackbody name=\"radiance\" temperature=\"5000K\" scale=\"0.5\"/>");
    assert!((old * 2.0 / expected - 1.0).abs().max_element() < 1e-5, "{old} {expected}");
    let sky = load_body(&format!("<emitter type=\"constant\">{new}</emitter>")).unwrap().scene;
    assert!(matches!(sky.environment, Some(Environment::Constant(radiance)) if radiance == expected));
    let cold = "<emitter type=\"constant\"><blackbody name=\"radiance\" temperature=\"0\"/></emitter>";
    assert!(load_body(cold).unwrap_err().contains("kelvin"));
}

#[test]
fn negative_optical_constants_are_clamped_with_a_warning() {
    let text = "<bsdf type=\"conductor\"><rgb name=\"eta\" value=\"-0.05 4 4\"/><rgb name=\"k\" value=\"1\"/></bsdf>";
    let (material, warnings) = bsdf(text);
    let [Lobe::Mirror { fresnel: Fresnel::Conductor { eta, k }, .. }] = material.lobes[..] else { panic!() };
    assert_eq!((eta, k, warnings), (Rgb::new(0.0, 4.0, 4.0), Rgb::ONE, 1));
}

#[test]
fn metals_are_relative_to_what_is_around_them() {
    let metal = |outside: &str| {
        let text =
            format!("<bsdf type=\"conductor\"><string name=\"material\" value=\"Cr\"/>{outside}</bsdf>");
        let (material, warnings) = bsdf(&text);
        let [Lobe::Mirror { fresnel: Fresnel::Conductor { eta, k }, .. }] = material.lobes[..] else {
            panic!("{material:?}")
        };
        assert_eq!(warnings, 0);
        (eta, k)
    };
    let ((eta, k), (wet_eta, wet_k)) = (metal(""), metal("<float name=\"extEta\" value=\"1.5\"/>"));
    assert!((eta / wet_eta - 1.5).length() < 1e-5 && (k / wet_k - 1.5).length() < 1e-5);
}
