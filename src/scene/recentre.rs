//! From world coordinates in f64 to coordinates about the scene's centre in f32.
//!
//! A scene a millimetre across, a million units from the origin, loses no bit that f32 can hold: the
//! subtraction happens in f64, before any rounding.

use super::draft::{Draft, DraftCamera};
use super::{Camera, Cameras, DeltaLight, Mesh, Scene};
use glam::{DVec3, Vec3};

/// Returns the middle of the box around all triangles; of all lights and the camera where there are none.
pub(crate) fn centre(draft: &Draft) -> DVec3 {
    let corners = draft.meshes.iter().flat_map(|mesh| {
        let used = mesh.triangles.iter().flatten();
        used.filter_map(|&i| mesh.positions.get(i as usize).copied())
    });
    let of_triangles = middle(corners);
    let others = draft.lights.iter().map(|l| l.1).chain([draft.shot.camera.origin]);
    of_triangles.or_else(|| middle(others)).unwrap_or(DVec3::ZERO)
}

fn middle(points: impl Iterator<Item = DVec3>) -> Option<DVec3> {
    let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = points.filter(|p| p.is_finite()).fold(empty, |(l, h), p| (l.min(p), h.max(p)));
    (low.cmple(high).all()).then(|| 0.5 * low + 0.5 * high)
}

/// Returns the scene about `centre`, and its cameras.
pub(crate) fn recentre(draft: Draft, centre: DVec3) -> (Scene, Cameras) {
    let local = |p: DVec3| (p - centre).as_vec3();
    let camera = |c: &DraftCamera| Camera {
        origin: local(c.origin),
        forward: c.forward.as_vec3(),
        right: c.right.as_vec3(),
        up: c.up.as_vec3(),
        tan_half_x: c.tan_half_x as f32,
        near: c.near as f32,
        far: c.far as f32,
        projection: c.projection,
        filter: c.filter,
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
    let cameras = Cameras {
        still: camera(&draft.shot.camera),
        path: draft.shot.path.iter().map(camera).collect(),
        resolution: draft.shot.resolution,
    };
    let scene = Scene {
        name: draft.name,
        sources: draft.sources,
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
        discs: draft.discs,
        centre,
    };
    (scene, cameras)
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

#[cfg(test)]
mod tests {
    use crate::scene::DeltaLight;
    use crate::scene::formats::{LoadOptions, Loaded, load};

    /// Returns the same small room with everything moved by `offset` and scaled by `scale`.
    fn room(scale: f64, offset: f64) -> Loaded {
        let at = |x: f64, y: f64, z: f64| {
            format!("[{:e}, {:e}, {:e}]", x * scale + offset, y * scale + offset, z * scale + offset)
        };
        let text = format!(
            "resolution = [8, 8]\ncamera = {{ origin = {}, target = {}, fov = 60 }}\n\
            material = [{{ name = \"m\", kind = \"diffuse\", reflectance = 0.5 }}]\n\
            mesh = [{{ shape = \"sphere\", material = \"m\", transform = [{{ scale = {scale:e} }}, {{ translate = {} }}] }},\
            {{ shape = \"cube\", material = \"m\", transform = [{{ scale = {:e} }}, {{ translate = {} }}] }}]\n\
            light = [{{ kind = \"point\", position = {}, intensity = [1, 1, 1] }}]\n",
            at(0.125, 0.5, 3.0),
            at(0.125, 0.5, 2.0),
            at(0.25, 0.5, -1.0),
            scale * 4.0,
            at(0.0, 0.0, 0.0),
            at(0.75, 2.5, 0.375),
        );
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.toml");
        std::fs::write(&path, text).unwrap();
        load(&path, &LoadOptions::default()).unwrap()
    }

    #[test]
    fn an_offset_of_a_million_loses_nothing() {
        let (here, there) = (room(1.0, 0.0), room(1.0, 1e6));
        for (a, b) in here.scene.meshes.iter().zip(&there.scene.meshes) {
            let worst =
                a.positions.iter().zip(&b.positions).map(|(a, b)| (a - b).length()).fold(0.0, f32::max);
            // f64 at 1e6 is good to 1e-10, f32 near 4 to 2.4e-7.
            assert!(worst <= 5e-7, "{worst}");
        }
        assert!((here.cameras.still.origin - there.cameras.still.origin).length() < 5e-7);
        let position = |loaded: &Loaded| match loaded.scene.lights[0] {
            DeltaLight::Point { position, .. } => position,
            _ => panic!(),
        };
        assert!((position(&here) - position(&there)).length() < 5e-7);
        assert!((there.scene.centre - here.scene.centre - 1e6).length() < 1e-9);
    }

    #[test]
    fn a_millimetre_at_a_thousand_kilometres_keeps_its_shape() {
        let (unit, tiny) = (room(1.0, 0.0), room(1e-3, 1e6));
        for (a, b) in unit.scene.meshes.iter().zip(&tiny.scene.meshes) {
            let worst =
                a.positions.iter().zip(&b.positions).map(|(a, b)| (a - b * 1e3).length()).fold(0.0, f32::max);
            // Rounding of f64 at 1e6, magnified by 1e3.
            assert!(worst < 1e-6, "{worst}");
        }
    }

    #[test]
    fn scenes_from_micrometres_to_megametres_are_alike() {
        let unit = room(1.0, 0.0);
        for scale in [1e-6, 1e6] {
            let scaled = room(scale, 0.0);
            for (a, b) in unit.scene.meshes.iter().zip(&scaled.scene.meshes) {
                assert_eq!(a.triangles, b.triangles);
                assert!(a.normals.iter().zip(&b.normals).all(|(a, b)| (a - b).length() < 1e-5));
            }
        }
    }
}
