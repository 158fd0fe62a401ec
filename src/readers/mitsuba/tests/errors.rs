//! Tests of errors and warnings: inputs that cannot be read, or not as meant.

use super::*;

#[test]
fn what_is_not_modelled_is_replaced_with_a_warning_of_its_line() {
    let nested = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.3\"/></bsdf>";
    let cases = [
        ("<bsdf type=\"coating\"><bsdf type=\"dielectric\"/></bsdf>", "coating of"),
        ("<bsdf type=\"principled\"><float name=\"flatness\" value=\"0.5\"/></bsdf>", "flatness"),
        ("<bsdf type=\"roughdiffuse\"><rgb name=\"reflectance\" value=\"0.3\"/></bsdf>", "roughdiffuse"),
        ("<bsdf type=\"phong\"><float name=\"exponent\" value=\"98\"/></bsdf>", "\"phong\""),
        ("<bsdf type=\"velvet\"/>", "\"velvet\""),
        ("<bsdf type=\"diffuse\"><float name=\"sheen\" value=\"1\"/></bsdf>", "\"sheen\""),
        ("<emitter type=\"area\"><float name=\"glow\" value=\"1\"/></emitter>", "\"glow\""),
        (
            "<bsdf type=\"roughdielectric\"><float name=\"alpha_u\" value=\"0.1\"/><float name=\"alpha_v\" value=\"0.4\"/></bsdf>",
            "anisotropic",
        ),
    ];
    for (text, what) in cases {
        let body = format!("{SKY}<shape type=\"rectangle\">\n{text}</shape>");
        let loaded = load_body(&body).unwrap();
        let [warning] = &loaded.warnings[..] else { panic!("{:?}", loaded.warnings) };
        assert!(warning.to_string().contains(what) && warning.place.line == Some(5), "{warning}");
        assert_eq!(warning.severity, Severity::Warning);
        let message = load_with(&body, &[], true).unwrap_err();
        assert!(message.contains("s.xml:5") && message.contains("strict"), "{message}");
    }
    let (phong, _) = bsdf("<bsdf type=\"phong\"><float name=\"exponent\" value=\"98\"/></bsdf>");
    assert!(
        matches!(phong.lobes[..], [Lobe::Rough { alpha: Roughness::Constant(alpha), .. }] if (alpha - 0.1).abs() < 1e-6)
    );
    let checkers = "<texture name=\"alpha\" type=\"checkerboard\"/>";
    let (rough, warnings) = bsdf(&format!("<bsdf type=\"roughconductor\">{checkers}</bsdf>"));
    assert!(
        matches!(rough.lobes[..], [Lobe::Rough { alpha: Roughness::Textured { .. }, .. }]) && warnings == 0
    );
    let both = "<float name=\"alpha_u\" value=\"0.1\"/><float name=\"alpha_v\" value=\"0.4\"/>";
    let (brushed, warnings) = bsdf(&format!("<bsdf type=\"roughconductor\">{both}</bsdf>"));
    assert!(
        matches!(
            brushed.lobes[..],
            [Lobe::Anisotropic { alpha: [Roughness::Constant(0.1), Roughness::Constant(0.4)], .. }]
        ) && warnings == 0
    );
    let along = format!("<float name=\"alpha_u\" value=\"0.1\"/>{}", checkers.replace("alpha", "alpha_v"));
    let (brushed, warnings) = bsdf(&format!("<bsdf type=\"roughconductor\">{along}</bsdf>"));
    assert!(matches!(
        brushed.lobes[..],
        [Lobe::Anisotropic { alpha: [Roughness::Constant(0.1), Roughness::Textured { .. }], .. }]
    ));
    assert_eq!(warnings, 0);
    let (brushed, warnings) =
        bsdf(&format!("<bsdf type=\"principled\">{}</bsdf>", checkers.replace("alpha", "anisotropic")));
    assert!(brushed.principled.is_some_and(|p| p.anisotropic.is_textured()) && warnings == 0);
    let (brushed, warnings) =
        bsdf("<bsdf type=\"principled\"><float name=\"anisotropic\" value=\"0.5\"/></bsdf>");
    assert!(brushed.principled.is_some_and(|p| p.anisotropic == 0.5.into()) && warnings == 0);
    let (mask, _) = bsdf(&format!("<bsdf type=\"mask\">{nested}</bsdf>"));
    assert_eq!((mask.diffuse, mask.opacity), (Rgb::splat(0.3).into(), Some(0.5.into())));
    let absorbing = "<float name=\"thickness\" value=\"0.5\"/><rgb name=\"sigma_a\" value=\"1\"/>";
    let (coated, _) = bsdf(&format!("<bsdf type=\"coating\">{absorbing}{nested}</bsdf>"));
    assert!(matches!(coated.lobes[..], [Lobe::Mirror { fresnel: Fresnel::Dielectric(_), .. }]));
    let Reflectance::Constant(below) = coated.diffuse else { panic!() };
    assert!(coated.coat.is_some() && (below - 0.3 * (-1.0f32).exp()).length() < 1e-6);
    let (mixed, warnings) =
        bsdf(&format!("<bsdf type=\"blendbsdf\">{nested}<bsdf type=\"conductor\"/></bsdf>"));
    assert!(mixed.blend.is_some_and(|b| b.weight == 0.5.into() && b.other.lobes.len() == 1) && warnings == 0);
    let weights = "<string name=\"weights\" value=\"0.2, 0.3, 0.25\"/>";
    let three = format!("{nested}{nested}<bsdf type=\"conductor\"/>");
    let (mixed, warnings) = bsdf(&format!("<bsdf type=\"mixturebsdf\">{weights}{three}</bsdf>"));
    let shares: Vec<f32> = mixed
        .parts()
        .filter_map(|part| part.blend.as_ref())
        .map(|blend| if let Share::Constant(weight) = blend.weight { weight } else { panic!() })
        .collect();
    assert_eq!(warnings, 0);
    // The weights are those of the last three, of the last two, and of black, which takes the rest.
    let expected = [0.8, 0.5 / 0.8, 0.25 / 0.5];
    assert!(
        shares.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6) && shares.len() == 3,
        "{shares:?}"
    );
    let black = mixed.parts().last().expect("one");
    assert!(black.diffuse == Reflectance::BLACK && black.lobes.is_empty());
    let (car, _) = bsdf("<bsdf type=\"principled\"><float name=\"specular\" value=\"0.5\"/></bsdf>");
    assert!((car.principled.expect("one").eta - 1.5).abs() < 1e-6);
}

#[test]
fn errors_name_the_line_and_a_remedy() {
    let cases = [
        ("<shape type=\"obj\"><string name=\"filename\" value=\"no.obj\"/></shape>", "no.obj"),
        ("<shape type=\"obj\"/>", "names no file"),
        ("<shape type=\"rectangle\"><ref id=\"nobody\"/></shape>", "\"nobody\""),
        (
            "<shape type=\"rectangle\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"a b c\"/></bsdf></shape>",
            "a b c",
        ),
        (
            "<shape type=\"rectangle\"><bsdf type=\"diffuse\"><string name=\"reflectance\" value=\"red\"/></bsdf></shape>",
            "not a colour",
        ),
        (
            "<shape type=\"rectangle\"><bsdf type=\"conductor\"><string name=\"material\" value=\"Zz\"/></bsdf></shape>",
            "\"Zz\"",
        ),
        (
            "<shape type=\"rectangle\"><bsdf type=\"plastic\"><string name=\"int_ior\" value=\"cheese\"/></bsdf></shape>",
            "cheese",
        ),
        ("<shape type=\"rectangle\"><bsdf type=\"twosided\"/></shape>", "holds no other"),
        (
            "<bsdf type=\"mixturebsdf\" id=\"a\"><string name=\"weights\" value=\"0.5\"/></bsdf>\
             <shape type=\"cube\"><ref id=\"a\"/></shape>",
            "do not fit 0 bsdfs",
        ),
        ("<shape type=\"rectangle\"><boolean name=\"flip_normals\" value=\"2\"/></shape>", "boolean"),
        ("<bsdf type=\"diffuse\" id=\"a\"/><bsdf type=\"diffuse\" id=\"a\"/>", "already taken"),
        (
            "<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf><shape type=\"cube\"><ref id=\"a\"/></shape>",
            "each other",
        ),
        ("<emitter type=\"constant\"/><emitter type=\"constant\"/>", "more than one environment"),
        ("<emitter type=\"constant\"><rgb name=\"radiance\" value=\"-1\"/></emitter>", "negative"),
        (
            "<texture type=\"checkerboard\" id=\"a\"><ref name=\"color0\" id=\"a\"/></texture>\
            <shape type=\"cube\"><bsdf type=\"diffuse\"><ref name=\"reflectance\" id=\"a\"/></bsdf></shape>",
            "each other",
        ),
        (
            "<integrator type=\"path\"><integer name=\"max_depth\" value=\"0\"/></integrator>",
            "max_depth is 0",
        ),
        (
            "<integrator type=\"path\"><integer name=\"max_depth\" value=\"-2\"/></integrator>",
            "max_depth is -2",
        ),
        (
            "<shape type=\"cube\"><bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"1e30\"/></bsdf></shape>",
            "its roughness is",
        ),
        ("<emitter type=\"point\"><point name=\"position\" x=\"1e39\"/></emitter>", "a light stands at"),
        ("<translate x=\"1\"/>", "outside"),
        ("<flout name=\"a\" value=\"1\"/>", "<flout>"),
        ("<include filename=\"s.xml\"/>", "deeply"),
        ("<include filename=\"gone.xml\"/>", "gone.xml"),
        ("<float name=\"a\" value=\"$x\"/>", "$x"),
        ("<shape>", "s.xml"),
    ];
    for (body, what) in cases {
        let message = load_body(body).map(|l| format!("{:?}", l.warnings)).unwrap_err();
        assert!(message.contains(what) && message.contains("s.xml"), "{message}\n{body}");
    }
}

#[test]
fn parameters_and_includes_that_multiply_are_refused_before_they_fill_memory() {
    let value = |i: usize| format!("$a{}", i - 1).repeat(10);
    let defaults = (1..40).map(|i| format!("<default name=\"a{i}\" value=\"{}\"/>\n", value(i)));
    let bomb = format!("<default name=\"a0\" value=\"xxxxxxxxxx\"/>\n{}", defaults.collect::<String>());
    let message = load_body(&bomb).map(drop).unwrap_err();
    assert!(message.contains("16 MiB") && message.contains("s.xml:"), "{message}");

    let names: Vec<String> = (1..40).map(|i| format!("{i}.xml")).collect();
    let twice = |i: usize| format!("<include filename=\"{}.xml\"/>", i + 1).repeat(2);
    let texts: Vec<String> = (1..40)
        .map(|i| {
            format!("<scene version=\"3.0.0\">{}</scene>", if i < 39 { twice(i) } else { String::new() })
        })
        .collect();
    let files: Vec<(&str, &str)> =
        names.iter().map(String::as_str).zip(texts.iter().map(String::as_str)).collect();
    let message = load_with(&twice(0), &files, false).map(drop).unwrap_err();
    assert!(message.contains("4096 files"), "{message}");
}

#[test]
fn errors_of_several_objects_are_told_together_each_with_its_line() {
    let body = "<shape type=\"obj\"/>\n<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>\n\
        <emitter type=\"spot\"><float name=\"cutoff_angle\" value=\"200\"/></emitter>";
    let message = load_body(body).map(|_| ()).unwrap_err();
    for (line, part) in message.lines().zip(["s.xml:4: ", "s.xml:5: ", "s.xml:6: "]) {
        assert!(line.contains(part) && line.contains("; "), "{message}");
    }
    assert_eq!(message.lines().count(), 3, "{message}");
    // Values that cannot be read are reported before errors that follow from them.
    let body =
        "<shape type=\"obj\"><string name=\"filename\" value=\"$a\"/><float name=\"x\" value=\"y\"/></shape>";
    let message = load_body(body).map(|_| ()).unwrap_err();
    assert!(message.lines().count() == 2 && message.contains("-D a="), "{message}");
    // Messages of files that cannot be opened give the system's reason once.
    let body = "<shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/></shape>\n\
        <shape type=\"ply\"><string name=\"filename\" value=\"b.ply\"/></shape>";
    let message = load_body(body).map(|_| ()).unwrap_err();
    assert_eq!((message.lines().count(), message.matches("No such file").count()), (2, 2), "{message}");
}

#[test]
fn a_scene_without_light_is_warned_of() {
    let cube = "<shape type=\"cube\"/>";
    let black = "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"0\"/></emitter>";
    let flat = "<shape type=\"cube\"><emitter type=\"area\"/>\
        <transform name=\"to_world\"><scale x=\"0\" y=\"0\"/></transform></shape>";
    for (body, warnings) in [(cube.to_owned(), 1), (format!("{cube}{black}"), 1), (flat.to_owned(), 2)] {
        let loaded = load_body(&body).unwrap();
        assert_eq!(loaded.warnings.len(), warnings, "{:?}", loaded.warnings);
        let warning = loaded.warnings.last().unwrap();
        assert!(warning.what.contains("no light") && warning.fallback.contains("--env sky"), "{warning}");
        assert!(load_with(&body, &[], true).unwrap_err().contains("strict"));
    }
    assert!(load_body(&format!("{SKY}{cube}")).unwrap().warnings.is_empty());
}
