use super::materials::MIN_ALPHA;
use super::*;
use crate::draft::{DraftCamera, DraftMesh, Shot};
use base::math::Rgb;
use glam::{DVec3, Vec3};
use scene::{
    Coat, DeltaLight, Distribution, Emission, Environment, Filter, Fresnel, Lobe, Material, MaterialId,
    PixelFilter, Projection, Reflectance, Scene, Texels, Texture, TextureId, Wrap,
};

/// Sanitises a draft; warnings do not matter.
fn sanitize(draft: &mut Draft) -> Result<(SanitizeReport, LocalCoordinates), SceneError> {
    super::sanitize(draft, &mut Log::new(false))
}

fn grey() -> Material {
    let diffuse = Reflectance::Constant(Rgb::splat(0.5));
    Material { name: "grey".into(), diffuse, ..Material::default() }
}

fn draft(meshes: Vec<DraftMesh>, materials: Vec<Material>) -> Draft {
    let camera = DraftCamera { tan_half_x: 1.0, ..DraftCamera::default() };
    Draft {
        scene: Scene { name: "t".into(), sources: vec!["t.toml".into()], materials, ..Scene::default() },
        shot: Shot { camera, names: vec![], fits: false, path: vec![], resolution: [1, 1], crop: None },
        meshes,
        groups: vec![],
        lights: vec![],
        material_places: vec![],
        attribute_names: vec![],
    }
}

fn triangle_mesh() -> DraftMesh {
    DraftMesh {
        positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
        triangles: vec![[0, 1, 2]],
        ..DraftMesh::default()
    }
}

#[test]
fn each_kind_of_bad_triangle_is_dropped_and_counted() {
    let mut mesh = triangle_mesh();
    mesh.positions.extend([DVec3::new(f64::NAN, 0.0, 0.0), DVec3::new(1e19, 0.0, 0.0), DVec3::X * 2.0]);
    mesh.positions.push(DVec3::new(0.0, f64::INFINITY, 0.0));
    mesh.triangles =
        vec![[0, 1, 2], [0, 1, 99], [0, 1, 4], [0, 1, 7], [0, 1, 5], [0, 1, 1], [0, 1, 6], [2, 1, 3]];
    let mut d = draft(vec![mesh], vec![grey()]);
    let (report, coordinates) = sanitize(&mut d).unwrap();
    let expected = SanitizeReport {
        out_of_range: 1,
        not_finite: 2,
        huge: 1,
        degenerate: 2,
        ..SanitizeReport::default()
    };
    assert_eq!(report, expected);
    assert_eq!(d.meshes[0].triangles, [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(d.meshes[0].positions.len(), 4, "unused vertices go");
    assert_eq!(coordinates.centre, DVec3::splat(0.5), "of what could be hit");
    assert!(!report.is_clean() && report.to_string().contains("2 triangles without area"));
}

#[test]
fn triangles_that_vanish_in_f32_are_degenerate() {
    // The triangle is far from its centre, and smaller than the spacing of f32 there.
    let mut mesh = triangle_mesh();
    mesh.positions =
        [DVec3::ZERO, DVec3::X * 1e-9, DVec3::Y * 1e-9].iter().map(|p| *p + DVec3::ONE).collect();
    let other_mesh = || {
        let positions = triangle_mesh().positions.iter().map(|p| -*p).collect();
        DraftMesh { positions, ..triangle_mesh() }
    };
    let mut d = draft(vec![mesh.clone(), other_mesh()], vec![grey()]);
    let (report, _) = sanitize(&mut d).unwrap();
    assert_eq!((report.degenerate, report.empty_meshes, d.meshes.len()), (1, 1, 1));
    let mut log = Log::new(true);
    let mut d = draft(vec![mesh.clone(), other_mesh()], vec![grey()]);
    let error = super::sanitize(&mut d, &mut log).unwrap_err().to_string();
    assert!(error.contains("1 triangles are too small"), "{error}");
    // A triangle alone is kept.
    let mut d = draft(vec![mesh], vec![grey()]);
    assert!(sanitize(&mut d).unwrap().0.is_clean());
}

#[test]
fn all_is_finite_however_small_what_is_left_of_a_scene() {
    // Triangles without area have distinct vertices here. They stand alone, and beside others.
    let mut flat = triangle_mesh();
    flat.positions = vec![DVec3::Y, DVec3::new(5e-39, 1.0, 0.0)];
    flat.triangles = vec![[0, 0, 0], [1, 1, 1]];
    let tiny = |size: f64, at: DVec3| {
        let positions = triangle_mesh().positions.iter().map(|p| *p * size + at).collect();
        DraftMesh { positions, ..triangle_mesh() }
    };
    let scenes = [
        vec![flat.clone()],
        vec![flat, tiny(1.0, DVec3::X)],
        vec![tiny(1e-40, DVec3::ZERO)],
        vec![tiny(1e-120, DVec3::ZERO), tiny(1.0, DVec3::splat(1e17))],
        vec![tiny(1e-160, DVec3::ZERO)],
        vec![tiny(1e17, DVec3::ZERO)],
    ];
    for (i, meshes) in scenes.into_iter().enumerate() {
        for fits in [true, false] {
            let mut d = draft(meshes.clone(), vec![grey()]);
            d.shot.fits = fits;
            let (_, coordinates) = sanitize(&mut d).unwrap();
            let camera = coordinates.local_camera(&d.shot.camera);
            assert!(camera.origin.abs().max_element() <= 1e18, "{i} {fits}: {}", camera.origin);
            for p in d.meshes.iter().flat_map(|mesh| &mesh.positions) {
                assert!(coordinates.local(*p).abs().max_element() <= 1e18, "{i} {fits}: {p}");
            }
        }
    }
}

#[test]
fn lights_and_cameras_out_of_reach_of_a_tiny_scene_are_errors() {
    let tiny = || {
        let positions = triangle_mesh().positions.iter().map(|p| *p * 1e-40).collect();
        draft(vec![DraftMesh { positions, ..triangle_mesh() }], vec![grey()])
    };
    let light = |at: f64, intensity: f32| {
        let light = DeltaLight::Point { position: Vec3::ZERO, intensity: Rgb::splat(intensity) };
        let mut d = tiny();
        d.lights.push((light, DVec3::splat(at)));
        sanitize(&mut d).map(|_| ()).map_err(|error| error.to_string())
    };
    assert!(light(1e-40, 1.0).unwrap_err().contains("overflows"));
    assert!(light(1.0, 0.0).unwrap_err().contains("stands at"));
    light(1e-40, 0.0).unwrap();
    let mut d = tiny();
    d.shot.path.push(DraftCamera { origin: DVec3::ONE, ..d.shot.camera });
    assert!(sanitize(&mut d).unwrap_err().to_string().contains("camera stands at"));
}

#[test]
fn bad_normals_become_geometric_and_bad_uvs_zero() {
    let mut mesh = triangle_mesh();
    mesh.positions.truncate(3);
    mesh.normals = vec![Vec3::ZERO, Vec3::NAN, Vec3::new(0.0, 0.6, 0.8)];
    mesh.uvs = vec![Vec2::NAN, Vec2::ONE, Vec2::new(f32::INFINITY, 0.0)];
    let mut d = draft(vec![mesh], vec![grey()]);
    let (report, _) = sanitize(&mut d).unwrap();
    assert_eq!((report.bad_normals, report.nan_normals, report.bad_uvs), (1, 1, 2));
    assert_eq!(d.meshes[0].normals, [Vec3::Z, Vec3::Z, Vec3::new(0.0, 0.6, 0.8)]);
    assert_eq!(d.meshes[0].uvs, [Vec2::ZERO, Vec2::ONE, Vec2::ZERO]);
}

#[test]
fn reflectances_must_not_create_energy() {
    let with = |diffuse: Rgb| Material { diffuse: Reflectance::Constant(diffuse), ..grey() };
    for bad in [Rgb::new(0.5, -0.1, 0.5), Rgb::new(0.5, f32::NAN, 0.5), Rgb::splat(f32::INFINITY)] {
        let message = sanitize(&mut draft(vec![], vec![with(bad)])).unwrap_err().to_string();
        assert!(message.contains("\"grey\"") && message.contains("give 0 to 1"), "{message}");
    }
    let mut log = Log::new(false);
    let mut d = draft(vec![], vec![with(Rgb::new(1.1, 0.5, 0.0))]);
    super::sanitize(&mut d, &mut log).unwrap();
    assert_eq!(d.scene.materials[0].diffuse, Reflectance::Constant(Rgb::new(1.0, 0.5, 0.0)));
    let warnings = log.into_warnings();
    assert!(
        warnings.len() == 1 && warnings[0].to_string().contains("exceeds 1; it is clamped"),
        "{warnings:?}"
    );
    let mut d = draft(vec![], vec![with(Rgb::new(1.0005, 1.0, 0.0))]);
    assert_eq!(sanitize(&mut d).unwrap().0.clamped, 1);
    assert_eq!(d.scene.materials[0].diffuse, Reflectance::Constant(Rgb::new(1.0, 1.0, 0.0)));

    let lobe = |fresnel, scale| Lobe::Rough {
        distribution: Distribution::Ggx,
        alpha: 0.0.into(),
        fresnel,
        scale: Reflectance::Constant(Rgb::splat(scale)),
    };
    let glossy = |fresnel, scale| Material { lobes: vec![lobe(fresnel, scale)], ..grey() };
    // 0.5 + 0.75 are scaled to 1.
    let mut d = draft(vec![], vec![glossy(Fresnel::One, 0.75)]);
    let mut log = Log::new(false);
    super::sanitize(&mut d, &mut log).unwrap();
    assert_eq!(d.scene.materials[0].diffuse, Reflectance::Constant(Rgb::splat(0.4)));
    let scaled = Reflectance::Constant(Rgb::splat(0.6));
    assert!(matches!(d.scene.materials[0].lobes[..], [Lobe::Rough { scale, .. }] if scale == scaled));
    assert!(log.into_warnings()[0].to_string().contains("exceed 1 together"));
    assert!(
        super::sanitize(&mut draft(vec![], vec![glossy(Fresnel::One, 0.75)]), &mut Log::new(true)).is_err()
    );
    assert!(sanitize(&mut draft(vec![], vec![glossy(Fresnel::Dielectric(1.5), 1.0)])).is_ok());
    let mut d = draft(vec![], vec![glossy(Fresnel::One, 0.5)]);
    sanitize(&mut d).unwrap();
    assert!(
        matches!(d.scene.materials[0].lobes[..], [Lobe::Rough { alpha, .. }] if alpha == MIN_ALPHA.into())
    );

    let coated = |eta| Material { coat: Some(Coat { eta, nonlinear: false }), ..grey() };
    for eta in [0.0, -1.5, f32::NAN] {
        assert!(sanitize(&mut draft(vec![], vec![coated(eta)])).is_err());
    }
}

#[test]
fn optical_constants_are_those_of_metals() {
    let metal = |eta: f32, k: f32| {
        let fresnel = Fresnel::Conductor { eta: Rgb::splat(eta), k: Rgb::new(1.0, k, 1.0) };
        let scale = Reflectance::Constant(Rgb::ONE);
        let smooth = Lobe::Mirror { fresnel, scale };
        let rough = Lobe::Rough { distribution: Distribution::Ggx, alpha: 0.1.into(), fresnel, scale };
        [smooth, rough].map(|lobe| Material { lobes: vec![lobe], ..grey() })
    };
    for (eta, k) in
        [(f32::NAN, 1.0), (1.0, f32::NAN), (f32::INFINITY, 1.0), (-1.0, 1.0), (1.0, -1e-9), (1.0, 1e30)]
    {
        for material in metal(eta, k) {
            let message = sanitize(&mut draft(vec![], vec![material])).unwrap_err().to_string();
            assert!(message.contains("out of range"), "{eta} {k}: {message}");
        }
    }
    for (eta, k) in [(0.0, 0.0), (0.0, 1e6), (1e6, 0.0), (1e6, 1e6)] {
        for material in metal(eta, k) {
            sanitize(&mut draft(vec![], vec![material])).unwrap();
        }
    }
}

#[test]
fn cameras_and_lights_stand_where_f32_has_numbers() {
    let light = DeltaLight::Point { position: Vec3::ZERO, intensity: Rgb::ONE };
    let mut far = draft(vec![], vec![]);
    far.lights.push((light, DVec3::splat(1e39)));
    assert!(sanitize(&mut far).unwrap_err().to_string().contains("a light stands at"));
    let mut far = draft(vec![], vec![]);
    far.shot.camera.origin.x = 1e39;
    assert!(sanitize(&mut far).unwrap_err().to_string().contains("a camera stands at"));
    let camera = draft(vec![], vec![]).shot.camera;
    let lens = |radius, distance| Projection::Lens { radius, distance };
    for wrong in [
        DraftCamera { tan_half_x: 1e39, ..camera },
        DraftCamera { tan_half_x: 1e-60, ..camera },
        DraftCamera { near: 1e39, ..camera },
        DraftCamera { projection: lens(f32::INFINITY, 1.0), ..camera },
        DraftCamera { projection: lens(1.0, f32::NAN), ..camera },
        DraftCamera { filter: PixelFilter::Gaussian { deviation: f32::INFINITY }, ..camera },
        DraftCamera { filter: PixelFilter::Tent { radius: 1e30 }, ..camera },
    ] {
        let mut walk = draft(vec![], vec![]);
        walk.shot.path.push(wrong);
        let message = sanitize(&mut walk).unwrap_err().to_string();
        assert!(message.starts_with("t.toml: ") && message.contains("up to"), "{message}");
    }
}

#[test]
fn texels_are_clamped_to_what_their_factor_leaves() {
    let texels = vec![Rgb::splat(0.9), Rgb::splat(5.0), Rgb::new(-1.0, 0.2, 0.2), Rgb::splat(0.4)];
    let texture = Texture {
        name: "t".into(),
        width: 2,
        height: 2,
        texels: Texels::new(2, &texels),
        filter: Filter::Nearest,
        wrap: Wrap::Repeat,
        to_uv: glam::Mat3::IDENTITY,
    };
    let of_scale = |scale: f32| {
        let diffuse = Reflectance::Textured { texture: TextureId(0), scale: Rgb::splat(scale) };
        Material { diffuse, ..grey() }
    };
    let lamp = Emission { radiance: Rgb::ONE, texture: Some(TextureId(0)), two_sided: false };
    let lamp = DraftMesh { emission: Some(lamp), material: MaterialId(0), ..triangle_mesh() };
    let mut d = draft(vec![lamp], vec![of_scale(2.0), of_scale(0.25), of_scale(2.0)]);
    d.scene.textures = vec![texture].into();
    let mut log = Log::new(false);
    let (report, _) = super::sanitize(&mut d, &mut log).unwrap();
    assert_eq!((report.clamped, report.bad_texels), (3, 3));
    let red = |texture: TextureId| {
        let texels = &d.scene.textures[texture.0 as usize].texels;
        texels.iter().map(|texel| texel.x).collect::<Vec<f32>>()
    };
    let of_material = |i: usize| red(d.scene.materials[i].diffuse.texture().unwrap());
    assert_eq!(of_material(0), [0.5, 0.5, 0.0, 0.4]);
    assert_eq!(of_material(1), [0.9, 4.0, 0.0, 0.4]);
    assert_eq!(of_material(2), of_material(0));
    // Light has no upper limit.
    assert_eq!(red(d.meshes[0].emission.unwrap().texture.unwrap()), [0.9, 5.0, 0.0, 0.4]);
    let said = log.into_warnings()[0].to_string();
    assert!(said.contains("\"t\": the texel in column 1 of row 2 is negative"), "{said}");
}

#[test]
fn lights_without_light_go_and_negative_light_is_an_error() {
    let emitting = |radiance| DraftMesh {
        emission: Some(Emission { radiance, texture: None, two_sided: false }),
        material: MaterialId(0),
        ..triangle_mesh()
    };
    let flat = DraftMesh { triangles: vec![[0, 0, 1]], ..emitting(Rgb::ONE) };
    let mut d = draft(vec![emitting(Rgb::ZERO), emitting(Rgb::ONE), flat], vec![grey()]);
    let point = |intensity| (DeltaLight::Point { position: Vec3::ZERO, intensity }, DVec3::ZERO);
    d.lights = vec![point(Rgb::ZERO), point(Rgb::X)];
    d.scene.environment = Some(Environment::Constant(Rgb::ZERO));
    let (report, _) = sanitize(&mut d).unwrap();
    assert_eq!((report.black_lights, report.empty_meshes, report.degenerate), (3, 1, 1));
    assert_eq!(d.meshes.iter().map(|m| m.emission.is_some()).collect::<Vec<_>>(), [false, true]);
    assert_eq!(d.lights.len(), 1);
    assert!(d.scene.environment.is_none());

    assert!(sanitize(&mut draft(vec![emitting(Rgb::new(1.0, -1.0, 1.0))], vec![grey()])).is_err());
    let mut d = draft(vec![], vec![]);
    d.lights = vec![point(Rgb::splat(f32::NAN))];
    assert!(sanitize(&mut d).is_err());
}

#[test]
fn an_emitter_without_area_is_missed() {
    let emission = Some(Emission { radiance: Rgb::ONE, texture: None, two_sided: false });
    let flat = DraftMesh { name: "lamp".into(), triangles: vec![[0, 1, 1]], emission, ..triangle_mesh() };
    let mut log = Log::new(false);
    super::sanitize(&mut draft(vec![flat], vec![grey()]), &mut log).unwrap();
    let warnings = log.into_warnings();
    assert!(warnings.len() == 1 && warnings[0].to_string().contains("\"lamp\""), "{warnings:?}");
}
