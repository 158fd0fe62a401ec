//! Tests of instances in all formats: what is stored once, what is copied, and where both are seen.

use crate::{LoadOptions, Loaded, load};
use glam::{DVec3, Vec3};
use serde_json::{Value, json};
use std::fs;

const HEAD: &str = "[camera]\norigin = [9, 9, 9]\ntarget = [0, 0, 0]\n[environment]\nradiance = 1\n\
    [[material]]\nname = \"m\"\nkind = \"diffuse\"\nreflectance = 0.5\n";

/// Meshes of a group: a square with normals, and a ball without.
const TREE: &str = "[[mesh]]\nshape = \"rectangle\"\nmaterial = \"m\"\nmember_of = \"tree\"\n\
    transform = [{ translate = [1, 0, 0] }]\n\
    [[mesh]]\nfile = \"t.obj\"\nmaterial = \"m\"\nmember_of = \"tree\"\n";

/// Reads a scene beside some files; `most` is the number of triangles that are copied.
fn read(name: &str, text: &str, most: Option<u64>) -> Result<Loaded, String> {
    let folder = tempfile::tempdir().unwrap();
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    fs::write(folder.path().join("t.obj"), obj).unwrap();
    let places = "# places\n1 0 0 5  0 1 0 0  0 0 1 0\n\n0 -2 0 0, 1 0 0 7, 0 0 1 1, 0 0 0 1 # turned\n";
    fs::write(folder.path().join("places.txt"), places).unwrap();
    fs::write(folder.path().join("wrong.txt"), "1 0 0 5  0 1 0 0  0 0 1 0\n1 2 3\n").unwrap();
    fs::write(folder.path().join("huge.txt"), "\n\n1e200 0 0 0  0 1e200 0 0  0 0 1e200 0\n").unwrap();
    fs::write(folder.path().join("none.txt"), "# nothing\n").unwrap();
    fs::write(folder.path().join(name), text).unwrap();
    let options = LoadOptions { most_copied: most, strict: true, ..LoadOptions::default() };
    load(&folder.path().join(name), &options).map_err(|error| error.to_string())
}

/// Returns the corners of all triangles at all places, in the unit of the file and in order.
fn corners(loaded: &Loaded) -> Vec<[DVec3; 3]> {
    let scene = &loaded.scene;
    let in_file = |p: Vec3| scene.centre + p.as_dvec3() * scene.unit();
    let mut all: Vec<[DVec3; 3]> = Vec::new();
    for (mesh, placement) in scene.seen() {
        let mesh = &scene.meshes[mesh];
        for t in 0..mesh.triangles.len() {
            let mut corners = mesh.corners(t).map(|p| in_file(placement.map_or(p, |place| place.point(p))));
            if placement.is_some_and(|place| place.mirrors()) {
                corners.swap(1, 2);
            }
            all.push(corners);
        }
    }
    all
}

/// Asserts that instances are where copies are, and returns the numbers of stored and of seen meshes.
fn assert_alike(name: &str, text: &str) -> (usize, usize) {
    let instances = read(name, text, Some(0)).unwrap_or_else(|e| panic!("{text}: {e}"));
    let copies = read(name, text, None).unwrap();
    assert!(copies.scene.groups.is_empty(), "few triangles are copied");
    assert_eq!(instances.scene.seen_triangle_count(), copies.scene.triangle_count());
    let (a, mut b) = (corners(&instances), corners(&copies));
    b.sort_by(|s, t| s[0].x.total_cmp(&t[0].x));
    for triangle in &a {
        let is_close = |other: &[DVec3; 3]| (0..3).all(|i| triangle[i].distance(other[i]) < 1e-5);
        let first = b.partition_point(|other| other[0].x < triangle[0].x - 1e-5);
        let mut near = b[first..].iter().take_while(|other| other[0].x < triangle[0].x + 1e-5);
        assert!(near.any(is_close), "{name}: {triangle:?}");
    }
    (instances.scene.meshes.len(), instances.scene.seen().count())
}

#[test]
fn toml_instances_are_where_copies_are() {
    let inline = "[[instance]]\ngroup = \"tree\"\n\
        places = [[1,0,0,0, 0,1,0,0, 0,0,-1,0], [2,0,0,3, 0,1,0.5,0, 0,0,1,0, 0,0,0,1]]\n";
    let by_file = "[[instance]]\ngroup = \"tree\"\nplaces = \"places.txt\"\n\
        transform = [{ scale = 2 }, { translate = [0, 1, 0] }]\n";
    let single =
        "[[instance]]\ngroup = \"tree\"\ntransform = [{ rotate = { axis = [0, 1, 0], angle = 30 } }]\n";
    let own = "[[mesh]]\nshape = \"cube\"\nmaterial = \"m\"\n";
    let text = format!("{HEAD}{TREE}{own}{inline}{by_file}{single}");
    assert_eq!(assert_alike("s.toml", &text), (3, 1 + 2 * 5));
    // A group at one place is no instance.
    assert_eq!(assert_alike("s.toml", &format!("{HEAD}{TREE}{single}")), (2, 2));
}

#[test]
fn groups_of_instances_multiply_their_transforms() {
    let copse = "[[instance]]\ngroup = \"tree\"\nmember_of = \"copse\"\nplaces = \"places.txt\"\n\
        [[mesh]]\nshape = \"cube\"\nmaterial = \"m\"\nmember_of = \"copse\"\n\
        [[instance]]\ngroup = \"copse\"\ntransform = [{ scale = [1, 1, -0.5] }]\n\
        [[instance]]\ngroup = \"copse\"\ntransform = [{ translate = [0, 0, 20] }]\n";
    assert_eq!(assert_alike("s.toml", &format!("{HEAD}{TREE}{copse}")), (3, 2 * 4 + 2));
}

#[test]
fn emitting_and_small_groups_are_copied() {
    let emitter = TREE.replace("[[mesh]]\nshape", "[[mesh]]\nemission = 1\nshape");
    let twice = "[[instance]]\ngroup = \"tree\"\nplaces = \"places.txt\"\n";
    let loaded = read("s.toml", &format!("{HEAD}{emitter}{twice}"), Some(0)).unwrap();
    assert!(loaded.scene.groups.is_empty() && loaded.scene.meshes.len() == 4);
    // The copies of the cubes are fewer than those of the trees.
    let cubes = "[[mesh]]\nshape = \"cube\"\nmaterial = \"m\"\nmember_of = \"cubes\"\n\
        [[instance]]\ngroup = \"cubes\"\nplaces = \"places.txt\"\n";
    let more = TREE.replace("member_of", "transform = [{ scale = 3 }]\nmember_of");
    let more = more.replace("transform = [{ translate = [1, 0, 0] }]\n", "");
    let text = format!("{HEAD}{cubes}{TREE}{more}{twice}{twice}");
    for (most, groups) in [(23, 2), (24, 1), (71, 1), (72, 0)] {
        assert_eq!(read("s.toml", &text, Some(most)).unwrap().scene.groups.len(), groups, "{most}");
    }
    // A sheared place would round too much.
    let sheared = "[[instance]]\ngroup = \"tree\"\nplaces = [[1,0,0,0, 0,1,0,0, 0,0,1,0], \
        [1,100,0,0, 0,1,0,0, 0,0,1,0], [100,0,0,0, 0,1,0,0, 0,0,1,0]]\n";
    let scene = read("s.toml", &format!("{HEAD}{TREE}{sheared}"), Some(0)).unwrap().scene;
    assert_eq!((scene.groups[0].placements.len(), scene.own_mesh_count()), (2, 2));
}

#[test]
fn no_point_is_closer_to_the_origin_than_instances_reach() {
    let text = format!("{HEAD}{TREE}[[instance]]\ngroup = \"tree\"\nplaces = \"places.txt\"\n");
    let loaded = read("s.toml", &text, Some(0)).unwrap();
    let reach = |place: &base::math::Placement| {
        let [low, high] = place.bounds([Vec3::splat(-0.5), Vec3::splat(0.5)]);
        0.25 * (high - low).max_element()
    };
    let most = loaded.scene.groups[0].placements.iter().map(reach).fold(0.0, f32::max);
    for p in corners(&loaded).into_iter().flatten() {
        let local = (p - loaded.scene.centre) / loaded.scene.unit();
        assert!(local.abs().max_element() > f64::from(most), "{local} {most}");
    }
}

/// Flat instances are what is left of them, whether the others are stored or copied.
#[test]
fn instances_with_a_scale_of_0_are_flat_or_nothing() {
    let shown = "[[instance]]\ngroup = \"tree\"\nplaces = [[1,0,0,0, 0,1,0,0, 0,0,1,0], [1,0,0,9, 0,1,0,0, 0,0,1,0]]\n";
    let flat = |scale: &str| format!("[[instance]]\ngroup = \"tree\"\ntransform = [{{ scale = {scale} }}]\n");
    let text = |more: &str| format!("{HEAD}{TREE}{shown}{more}");
    let shapes = |text: &str, most| read("s.toml", text, most).unwrap();
    for most in [Some(0), None] {
        let plain = shapes(&text(""), most);
        let hidden = shapes(&text(&flat("0")), most);
        assert_eq!(corners(&hidden), corners(&plain));
        let flattened = shapes(&text(&flat("[1, 0, 1]")), most);
        let count = corners(&flattened).len();
        assert!(count > corners(&plain).len(), "{count}");
        assert!(corners(&flattened)[..].iter().any(|triangle| triangle.iter().all(|p| p.y.abs() < 1e-6)));
    }
}

#[test]
fn wrong_instances_are_named_with_their_line() {
    let twice = "[[instance]]\ngroup = \"tree\"\nplaces = \"places.txt\"\n";
    for (text, expected) in [
        ("[[instance]]\ngroup = \"bush\"\n", "no group called \"bush\""),
        ("[[instance]]\ngroup = \"tree\"\nplaces = \"gone.txt\"\n", "cannot read"),
        ("[[instance]]\ngroup = \"tree\"\nplaces = \"wrong.txt\"\n", "wrong.txt:2: a place is no matrix"),
        ("[[instance]]\ngroup = \"tree\"\nplaces = \"huge.txt\"\n", "huge.txt:3: a place is no matrix"),
        ("[[instance]]\ngroup = \"tree\"\nplaces = \"none.txt\"\n", "none.txt: there are no places"),
        ("[[instance]]\ngroup = \"tree\"\nplaces = []\n", "there are no places"),
        ("[[instance]]\ngroup = \"tree\"\nplaces = [[1, 2]]\n", "a place is no matrix"),
        ("[[instance]]\ngroup = \"tree\"\nplaces = 3\n", "expected the name of a file"),
        (
            "[[instance]]\ngroup = \"tree\"\nplaces = [[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,1,0,1]]\n",
            "is not 0 0 0 1",
        ),
        (
            "[[instance]]\ngroup = \"tree\"\nmember_of = \"tree\"\n[[instance]]\ngroup = \"tree\"\n",
            "a member of itself: tree > tree",
        ),
        (
            "[[instance]]\ngroup = \"a\"\nmember_of = \"b\"\n[[instance]]\ngroup = \"b\"\nmember_of = \"a\"\n[[instance]]\ngroup = \"a\"\n",
            "a member of itself: a > b > a",
        ),
        ("[[instance]]\nplaces = \"places.txt\"\n", "missing field `group`"),
    ] {
        let message = read("s.toml", &format!("{HEAD}{TREE}{twice}{text}"), None).unwrap_err();
        assert!(message.contains(expected), "{text}: {message}");
        assert!(message.contains("s.toml:") || message.contains(".txt"), "{message}");
    }
    // Strict reading makes an error of the warning.
    let message = read("s.toml", &format!("{HEAD}{TREE}"), None).unwrap_err();
    assert!(message.contains("no instance shows the group \"tree\""), "{message}");
}

#[test]
fn instances_beyond_any_memory_are_refused_before_they_are_placed() {
    let mut text =
        format!("{HEAD}{TREE}[[instance]]\ngroup = \"tree\"\nmember_of = \"g0\"\nplaces = \"places.txt\"\n");
    for level in 1..62 {
        text += &format!(
            "[[instance]]\ngroup = \"g{}\"\nmember_of = \"g{level}\"\nplaces = \"places.txt\"\n",
            level - 1
        );
    }
    text += "[[instance]]\ngroup = \"g61\"\n";
    let message = read("s.toml", &text, None).unwrap_err();
    assert!(
        message.contains("the instances place meshes") && message.contains("leave some of them out"),
        "{message}"
    );
}

#[test]
fn mitsuba_instances_are_where_copies_are() {
    let group = "<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\"><transform name=\"to_world\">\
        <translate x=\"1\"/></transform></shape><shape type=\"obj\"><string name=\"filename\" value=\"t.obj\"/>\
        </shape></shape>";
    let instance = |transform: &str| {
        format!(
            "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\">{transform}</transform></shape>"
        )
    };
    let shown = [
        instance("<scale value=\"2\"/>"),
        instance("<translate z=\"9\"/>"),
        instance("<scale x=\"-1\" y=\"2\"/><rotate x=\"1\" angle=\"40\"/><translate y=\"-5\"/>"),
    ];
    let scene = |body: &str| {
        format!(
            "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"constant\"/>{body}</scene>"
        )
    };
    let text = scene(&format!("{group}{}<shape type=\"sphere\"/>", shown.concat()));
    assert_eq!(assert_alike("s.xml", &text), (3, 7));
    for (body, expected) in [
        (format!("{group}{}", instance("<scale value=\"1e150\"/>")), "not finite"),
        (
            "<shape type=\"shapegroup\" id=\"g\"/><shape type=\"instance\"><ref id=\"g\"/></shape>"
                .to_owned(),
            "has no shape",
        ),
    ] {
        let message = read("s.xml", &scene(&body), None).unwrap_err();
        assert!(message.contains(expected) && message.contains("s.xml:1"), "{message}");
    }
}

/// Returns a model of a triangle, with nodes and accessors. `bytes` are 36 of the triangle and those of the accessors.
fn model(nodes: Value, accessors: Value, bytes: &[u8], used: &[&str]) -> String {
    use base64::Engine;
    let data = base64::engine::general_purpose::STANDARD.encode(bytes);
    let mut all = vec![json!({ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 })];
    all.extend(accessors.as_array().unwrap().iter().cloned());
    let count = nodes.as_array().unwrap().len();
    json!({
        "asset": { "version": "2.0" }, "scenes": [{ "nodes": (0..count).collect::<Vec<_>>() }], "nodes": nodes,
        "extensionsUsed": used, "extensionsRequired": used,
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }], "accessors": all,
        "bufferViews": [
            { "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": bytes.len() - 36 },
        ],
        "buffers": [{ "byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{data}") }],
    })
    .to_string()
}

fn bytes(numbers: &[f32]) -> Vec<u8> {
    [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]
        .iter()
        .chain(numbers)
        .flat_map(|x| x.to_le_bytes())
        .collect()
}

#[test]
fn meshes_of_several_nodes_are_where_copies_are() {
    let nodes = json!([
        { "mesh": 0 }, { "mesh": 0, "translation": [3, 0, 0], "scale": [1, -2, 1] },
        { "mesh": 0, "rotation": [0.6, 0.0, 0.0, 0.8] },
    ]);
    assert_eq!(assert_alike("m.gltf", &model(nodes, json!([]), &bytes(&[0.0]), &[])), (1, 3));
    let hidden = json!([{ "mesh": 0 }, { "mesh": 0, "scale": [0, 0, 0] }]);
    let loaded = read("m.gltf", &model(hidden, json!([]), &bytes(&[0.0]), &[]), Some(0)).unwrap();
    assert_eq!((loaded.scene.meshes.len(), loaded.scene.groups.len()), (1, 1));
    assert_eq!(loaded.scene.groups[0].placements.len(), 1);
}

#[test]
fn instances_of_the_gpu_extension_are_where_copies_are() {
    let instancing = |attributes: Value| json!([{ "mesh": 0, "translation": [1, 0, 0], "extensions": { "EXT_mesh_gpu_instancing": { "attributes": attributes } } }]);
    let accessors = json!([
        { "bufferView": 1, "componentType": 5126, "type": "VEC3", "count": 2 },
        { "bufferView": 1, "byteOffset": 24, "componentType": 5126, "type": "VEC4", "count": 2 },
        { "bufferView": 1, "byteOffset": 24, "componentType": 5126, "type": "VEC3", "count": 1 },
    ]);
    let numbers = [0.0, 2.0, 0.0, 5.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.6, 0.0, 0.0, 0.8];
    let name = ["EXT_mesh_gpu_instancing"];
    let of = |attributes: Value| model(instancing(attributes), accessors.clone(), &bytes(&numbers), &name);
    let text = of(json!({ "TRANSLATION": 1, "ROTATION": 2, "_ID": 1 }));
    assert_eq!(assert_alike("m.gltf", &text), (1, 2));
    let found = corners(&read("m.gltf", &text, Some(0)).unwrap());
    assert!(found[0][0].distance(DVec3::new(1.0, 2.0, 0.0)) < 1e-5, "{found:?}");
    assert!(found[1][2].distance(DVec3::new(6.0, 0.28, 1.96)) < 1e-5, "{found:?}");
    for (attributes, expected) in [
        (json!({ "TRANSLATION": 1, "SCALE": 3 }), "different lengths"),
        (json!({ "TRANSLATION": 9 }), "accessor 9 does not exist"),
        (json!({ "TRANSLATION": "x" }), "is no accessor"),
        (json!({}), "has no TRANSLATION"),
    ] {
        let message = read("m.gltf", &of(attributes), None).unwrap_err();
        assert!(message.contains(expected) && message.contains("m.gltf"), "{message}");
    }
}
