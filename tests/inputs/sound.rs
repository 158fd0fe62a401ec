//! Properties of scenes that every stage relies on.

use lightsplat::readers::Loaded;

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
        // Uses as a colour or a share have limited copies. Heights and normals may be negative or exceed 1.
        assert!(texture.texels.iter().all(|t| t.is_finite()));
    }
    assert!(scene.centre.is_finite());
    for camera in cameras.path.iter().chain([&cameras.still]) {
        assert!(camera.origin.is_finite() && camera.forward.is_normalized());
        assert!(camera.tan_half_x.is_finite() && camera.tan_half_x > 0.0);
    }
}
