//! From world coordinates in f64 to coordinates about the scene's centre in f32.
//!
//! A scene a millimetre across lies a million units from the origin without losing a bit that f32 can
//! hold: the subtraction happens in f64, before any rounding.

use super::draft::{Draft, DraftCamera};
use super::{Camera, DeltaLight, Mesh, Scene};
use glam::{DVec3, Vec3};

/// The middle of the box around all triangles; of all lights and the camera where there are none.
pub(crate) fn centre(draft: &Draft) -> DVec3 {
    let corners = draft.meshes.iter().flat_map(|mesh| {
        let used = mesh.triangles.iter().flatten();
        used.filter_map(|&i| mesh.positions.get(i as usize).copied())
    });
    let of_triangles = middle(corners);
    let others = draft.lights.iter().map(|l| l.1).chain([draft.camera.origin]);
    of_triangles.or_else(|| middle(others)).unwrap_or(DVec3::ZERO)
}

fn middle(points: impl Iterator<Item = DVec3>) -> Option<DVec3> {
    let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = points.filter(|p| p.is_finite()).fold(empty, |(l, h), p| (l.min(p), h.max(p)));
    (low.cmple(high).all()).then(|| 0.5 * low + 0.5 * high)
}

/// The scene about `centre`.
pub(crate) fn recentre(draft: Draft, centre: DVec3) -> Scene {
    let local = |p: DVec3| (p - centre).as_vec3();
    let camera = |c: &DraftCamera| Camera {
        origin: local(c.origin),
        forward: c.forward.as_vec3(),
        right: c.right.as_vec3(),
        up: c.up.as_vec3(),
        tan_half_x: c.tan_half_x as f32,
        near: c.near as f32,
        far: c.far as f32,
    };
    let mesh = |m: super::draft::DraftMesh| Mesh {
        name: m.name,
        positions: m.positions.into_iter().map(local).collect(),
        normals: m.normals,
        uvs: m.uvs,
        triangles: m.triangles,
        material: m.material,
        emission: m.emission,
    };
    Scene {
        name: draft.name,
        sources: draft.sources,
        camera: camera(&draft.camera),
        camera_path: draft.camera_path.iter().map(camera).collect(),
        resolution: draft.resolution,
        max_depth: draft.max_depth,
        meshes: draft.meshes.into_iter().map(mesh).collect(),
        materials: draft.materials,
        textures: draft.textures,
        lights: draft
            .lights
            .into_iter()
            .map(|(light, position)| place_light(light, local(position)))
            .collect(),
        environment: draft.environment,
        centre,
    }
}

fn place_light(light: DeltaLight, at: Vec3) -> DeltaLight {
    match light {
        DeltaLight::Point { intensity, .. } => DeltaLight::Point { position: at, intensity },
        DeltaLight::Spot { direction, intensity, inner_angle, outer_angle, .. } => {
            DeltaLight::Spot { position: at, direction, intensity, inner_angle, outer_angle }
        }
        directional @ DeltaLight::Directional { .. } => directional,
    }
}
