//! Tests of the settings of integrators, also of nested ones.

use super::*;

/// Returns path limit and hidden emitters of a scene with an integrator, and the texts of its warnings and notes.
fn settings(integrator: &str) -> ((Option<u32>, bool), Vec<String>, Vec<String>) {
    let loaded = load_body(&format!("{SKY}{integrator}")).unwrap();
    let of = |severity| {
        let such = loaded.warnings.iter().filter(move |warning| warning.severity == severity);
        such.map(|warning| warning.to_string()).collect::<Vec<String>>()
    };
    let (warnings, notes) = (of(Severity::Warning), of(Severity::Note));
    ((loaded.scene.max_depth, loaded.scene.hides_emitters), warnings, notes)
}

const DEPTH: &str = "<integer name=\"max_depth\" value=\"3\"/>";
const HIDDEN: &str = "<boolean name=\"hide_emitters\" value=\"true\"/>";

#[test]
fn settings_are_those_of_the_innermost_integrator() {
    let path = format!(
        "<integrator type=\"path\">{DEPTH}{HIDDEN}<integer name=\"rr_depth\" value=\"9\"/></integrator>"
    );
    let direct = format!("<integrator type=\"direct\">{HIDDEN}</integrator>");
    for (inner, expected) in [(&path, (Some(3), true)), (&direct, (Some(2), true))] {
        assert_eq!(settings(inner), (expected, Vec::new(), Vec::new()), "{inner}");
        for (wrapper, warned) in [("moment", 1), ("stokes", 1), ("aov", 0), ("adaptive", 0)] {
            let text = format!("<integrator type=\"{wrapper}\">{inner}</integrator>");
            let (found, warnings, notes) = settings(&text);
            assert_eq!((found, warnings.len(), notes.len()), (expected, warned, 0), "{text} {warnings:?}");
            let deeper = format!("<integrator type=\"aov\">{text}</integrator>");
            assert_eq!(settings(&deeper).0, expected);
        }
    }
    let channels = "<string name=\"aovs\" value=\"dd:depth\"/>";
    let (_, warnings, _) = settings(&format!("<integrator type=\"aov\">{channels}{path}</integrator>"));
    assert!(warnings.len() == 1 && warnings[0].contains("dd:depth"), "{warnings:?}");
}

#[test]
fn other_ways_to_the_same_light_keep_its_limits() {
    for plugin in ["volpath", "volpathmis", "ptracer", "bdpt", "mlt", "sppm", "photonmapper", "prb"] {
        let (found, warnings, notes) =
            settings(&format!("<integrator type=\"{plugin}\">{DEPTH}</integrator>"));
        assert_eq!((found, warnings.len(), notes.len()), ((Some(3), false), 0, 1), "{plugin} {warnings:?}");
        assert!(notes[0].contains(plugin) && notes[0].contains("--method"), "{notes:?}");
    }
}

#[test]
fn integrators_that_are_not_as_written_are_named() {
    let cases = [
        ("<integrator type=\"depth\"/>", "\"depth\""),
        ("<integrator type=\"mist\"/>", "\"mist\""),
        ("<integrator type=\"aov\"/>", "nests no other"),
        ("<integrator type=\"path\"><float name=\"clamp\" value=\"1\"/></integrator>", "\"clamp\""),
        ("<integrator type=\"path\"/><integrator type=\"path\"/>", "second <integrator>"),
        (
            "<integrator type=\"aov\"><boolean name=\"hide_emitters\" value=\"true\"/>\
            <integrator type=\"path\"/></integrator>",
            "\"hide_emitters\"",
        ),
    ];
    for (text, what) in cases {
        let (found, warnings, _) = settings(text);
        assert!(warnings.len() == 1 && warnings[0].contains(what), "{text} {warnings:?}");
        assert_eq!(found, (None, false), "{text}");
        assert!(load_with(&format!("{SKY}{text}"), &[], true).unwrap_err().contains("strict"));
    }
    let circle = "<integrator type=\"aov\" id=\"a\"><ref id=\"a\"/></integrator>";
    assert!(load_body(circle).unwrap_err().contains("refer to each other"));
}

#[test]
fn what_stands_where_nothing_reads_it_is_named() {
    let cases = [
        ("<float name=\"gamma\" value=\"2\"/>", "\"gamma\""),
        ("<scene type=\"x\"/>", "<scene>"),
        ("<medium type=\"homogeneous\" id=\"fog\"/>", "<medium>"),
        ("<shape type=\"cube\" colour=\"red\"/>", "\"colour\""),
        ("<shape type=\"cube\">red</shape>", "red"),
        (
            "<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"1\" w=\"2\"/></transform></shape>",
            "\"w\"",
        ),
        ("<shape type=\"cube\"><bsdf type=\"diffuse\"/><bsdf type=\"plastic\"/></shape>", "second <bsdf>"),
        ("<shape type=\"cube\"><emitter type=\"area\"/><emitter type=\"area\"/></shape>", "second <emitter>"),
        ("<shape type=\"cube\"><sensor type=\"perspective\"/></shape>", "the sensor"),
        ("<shape type=\"cube\"><sensor type=\"irradiancemeter\"/></shape>", "\"irradiancemeter\""),
        ("<shape type=\"cube\"><medium name=\"interior\" type=\"homogeneous\"/></shape>", "\"interior\""),
        (
            "<shape type=\"cube\"><bsdf type=\"twosided\"><bsdf type=\"diffuse\"/><bsdf type=\"plastic\"/></bsdf></shape>",
            "second <bsdf>",
        ),
        ("<path value=\"nowhere\"/>", "nowhere"),
    ];
    for (text, what) in cases {
        let body = format!("{SKY}{text}");
        let loaded = load_body(&body).unwrap();
        let [warning] = &loaded.warnings[..] else { panic!("{text} {:?}", loaded.warnings) };
        assert!(warning.to_string().contains(what), "{warning}");
        assert!(load_with(&body, &[], true).unwrap_err().contains("strict"), "{text}");
    }
}

#[test]
fn files_are_searched_in_the_folders_of_paths_first() {
    let folder = tempfile::tempdir().unwrap();
    let part = |name: &str, inside: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, inside).unwrap();
    };
    let triangle = |z: i32| format!("v 0 0 {z}\nv 1 0 {z}\nv 0 1 {z}\nf 1 2 3\n");
    part("a.obj", &triangle(1));
    part("parts/a.obj", &triangle(2));
    part("parts/more.xml", "<scene version=\"3.0.0\"><emitter type=\"constant\"/></scene>");
    let shape = "<shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/></shape>";
    for (paths, z) in [("", 1.0), ("<path value=\"parts\"/><include filename=\"more.xml\"/>", 2.0)] {
        let path = folder.path().join("s.xml");
        fs::write(&path, format!("<scene version=\"3.0.0\">{SENSOR}{paths}{shape}</scene>")).unwrap();
        let scene = load(&path, &LoadOptions::default()).unwrap().scene;
        assert_eq!(f64::from(scene.meshes[0].positions[0].z) + scene.centre.z, z);
        assert_eq!(scene.environment.is_some(), z == 2.0);
    }
}
