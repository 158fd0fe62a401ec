//! Properties of scenes that every stage relies on.

use lightsplat::math::Rgb;
use lightsplat::readers::Loaded;
use lightsplat::scene::{Material, Parameter, TextureId, Textures};

/// Asserts the properties of a scene that has been read.
pub fn assert_sound(Loaded { scene, cameras, .. }: &Loaded) {
    for mesh in &scene.meshes {
        let count = mesh.positions.len();
        assert!(mesh.positions.iter().all(|p| p.is_finite()));
        assert!(mesh.normals.is_empty() || mesh.normals.len() == count);
        // Normals within edges that were cut may be shorter. Only scenes with a vicinity have such edges.
        let shortest = if scene.vicinity > 0.0 { 0.0 } else { 1.0 };
        assert!(mesh.normals.iter().all(|n| n.length() > shortest - 1e-3 && n.length() < 1.0 + 1e-3));
        assert!(mesh.uvs.is_empty() || mesh.uvs.len() == count);
        assert!(mesh.uvs.iter().all(|uv| uv.is_finite()));
        assert!(mesh.triangles.iter().flatten().all(|&i| (i as usize) < count));
        assert!((mesh.material.0 as usize) < scene.materials.len());
    }
    let mut stored = scene.own_mesh_count();
    for group in &scene.groups {
        assert_eq!(group.meshes.start, stored);
        stored = group.meshes.end;
        for mesh in &scene.meshes[group.meshes.clone()] {
            assert!(mesh.emission.is_none());
        }
        assert!(group.placements.iter().all(|place| place.0.is_finite() && place.determinant() != 0.0));
    }
    assert_eq!(stored, scene.meshes.len());
    for texture in &scene.textures {
        assert_eq!(texture.texels.len(), texture.width * texture.height);
        // Heights and normals may be negative or exceed 1.
        assert!(texture.texels.iter().all(|t| t.is_finite()));
    }
    scene.materials.iter().for_each(|material| assert_limited(material, &scene.textures));
    let emissions = scene.meshes.iter().filter_map(|mesh| mesh.emission.as_ref()?.texture);
    for texture in emissions.filter_map(|id| scene.textures.by_id(id)) {
        assert!(texture.texels.iter().all(|t| t.min_element() >= 0.0), "{}", texture.name);
    }
    assert!(scene.centre.is_finite());
    for camera in cameras.path.iter().chain([&cameras.still]) {
        assert!(camera.origin.is_finite() && camera.forward.is_normalized());
        assert!(camera.tan_half_x.is_finite() && camera.tan_half_x > 0.0);
    }
}

/// Asserts that colours, shares and roughness of a material are within 0 to 1 after their factors.
fn assert_limited(material: &Material, textures: &Textures) {
    let mut material = material.clone();
    let mut uses: Vec<(TextureId, Rgb)> = Vec::new();
    for colour in material.reflectances_mut() {
        if let Parameter::Textured { texture, scale } = *colour {
            uses.push((texture, scale));
        }
    }
    let thin = material.principled.as_ref().and_then(|principled| principled.thin);
    let shares: Vec<Parameter<f32>> = material.shares_mut().into_iter().map(|share| *share).collect();
    let alphas = material.alphas_mut().into_iter().map(|alpha| *alpha);
    for number in shares.into_iter().chain(thin).chain(alphas) {
        if let Parameter::Textured { texture, scale } = number {
            uses.push((texture, Rgb::splat(scale)));
        }
    }
    for (texture, factor) in uses {
        let Some(texture) = textures.by_id(texture) else { continue };
        let fits = |texel: Rgb| texel.min_element() >= 0.0 && (texel * factor).max_element() <= 1.0 + 1e-5;
        assert!(texture.texels.iter().all(fits), "{}: {}", material.name, texture.name);
    }
}
