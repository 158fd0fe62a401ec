//! Conversion of world coordinates in f64 to local coordinates in f32, relative to the scene's centre.
//!
//! The centre is subtracted in f64, before any rounding. So a scene of a millimetre, a million units from the origin,
//! keeps the full precision of f32. The centre is the middle of the bounding box. If something lies very far beyond the
//! camera's surroundings, the centre is the camera: far triangles do not cost the precision of near ones.
//!
//! Very small and very large scenes get another unit of length, a power of two. So no product of lengths leaves the
//! range of f32.

use crate::attributes::NamedAttribute;
use crate::draft::{Draft, DraftCamera, DraftMesh};
use base::math::Rgb;
use glam::{DVec3, Vec3};
use scene::{
    Attribute, AttributeId, Camera, Cameras, DeltaLight, MAX_RATIO, Material, Mesh, Projection, Projector,
    Relief, Scene,
};

/// Approximate number of corners that are sampled to compute the vicinity.
const SAMPLED_CORNERS: usize = 1 << 16;

/// Sizes of scenes that keep their unit, as binary logarithms.
const UNSCALED_SIZES: std::ops::Range<i32> = -10..24;

/// Local coordinates of a scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct LocalCoordinates {
    /// World position of the local origin.
    pub centre: DVec3,
    /// Binary logarithm of the local unit of length in world units.
    pub exponent: i32,
    /// Local distance from the camera that contains a tenth of all corners, if the scene is more than [`MAX_RATIO`]
    /// times larger; else 0.
    pub vicinity: f32,
}

impl LocalCoordinates {
    /// Returns the coordinates for a draft.
    pub fn of(draft: &Draft) -> LocalCoordinates {
        let lights = || draft.lights.iter().map(|light| light.1);
        let camera = draft.shot.camera.origin;
        let Some((low, high)) = bounds(corners(draft)) else {
            let others = bounds(lights().chain([camera])).unwrap_or_default();
            return LocalCoordinates {
                centre: 0.5 * others.0 + 0.5 * others.1,
                ..LocalCoordinates::default()
            };
        };
        let (middle, diagonal) = (0.5 * low + 0.5 * high, (high - low).length());
        // A camera with `fits` has no position yet.
        let vicinity = if draft.shot.fits { diagonal } else { vicinity(draft, camera) };
        let (centre, vicinity) = match vicinity > 0.0 && diagonal > MAX_RATIO * vicinity {
            true => (camera, vicinity),
            false => (middle, 0.0),
        };
        let size = match draft.shot.fits {
            _ if vicinity > 0.0 => vicinity,
            true => diagonal,
            false => diagonal.max(camera.distance(centre)),
        };
        let exponent = size.log2().floor();
        let has_size = exponent.is_finite() && !UNSCALED_SIZES.contains(&(exponent as i32));
        let exponent = if has_size { exponent as i32 } else { 0 };
        let coordinates = LocalCoordinates { centre, exponent, vicinity: 0.0 };
        LocalCoordinates { vicinity: (vicinity * coordinates.scale()) as f32, ..coordinates }
    }

    /// Returns the local length of a world unit.
    pub fn scale(&self) -> f64 {
        f64::from(-self.exponent).exp2()
    }

    /// Returns the local position of a point.
    pub fn local(&self, world: DVec3) -> Vec3 {
        ((world - self.centre) * self.scale()).as_vec3()
    }

    /// Returns the local intensity of a light. Intensities scale with the square of lengths.
    pub fn local_intensity(&self, intensity: Rgb) -> Rgb {
        (intensity.as_dvec3() * (self.scale() * self.scale())).as_vec3()
    }

    /// Returns a camera in local coordinates.
    pub fn local_camera(&self, c: &DraftCamera) -> Camera {
        let scale = self.scale();
        let length = |length: f32| (f64::from(length) * scale) as f32;
        let (mut tan_half_x, mut projection) = (c.tan_half_x, c.projection);
        match &mut projection {
            Projection::Pinhole => {}
            Projection::Lens { radius, distance } => {
                (*radius, *distance) = (length(*radius), length(*distance));
            }
            Projection::Parallel => tan_half_x *= scale,
        }
        Camera {
            origin: self.local(c.origin),
            forward: c.forward.as_vec3(),
            right: c.right.as_vec3(),
            up: c.up.as_vec3(),
            tan_half_x: tan_half_x as f32,
            near: (c.near * scale) as f32,
            far: (c.far * scale) as f32,
            projection,
            filter: c.filter,
        }
    }
}

/// Returns the corners of all triangles.
fn corners(draft: &Draft) -> impl Iterator<Item = DVec3> {
    draft.meshes.iter().flat_map(|mesh| {
        let used = mesh.triangles.iter().flatten();
        used.filter_map(|&i| mesh.positions.get(i as usize).copied())
    })
}

fn bounds(points: impl Iterator<Item = DVec3>) -> Option<(DVec3, DVec3)> {
    let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = points.filter(|p| p.is_finite()).fold(empty, |(l, h), p| (l.min(p), h.max(p)));
    low.cmple(high).all().then_some((low, high))
}

/// Returns the distance from `camera` that contains a tenth of the corners.
fn vicinity(draft: &Draft, camera: DVec3) -> f64 {
    let count: usize = draft.meshes.iter().map(|mesh| 3 * mesh.triangles.len()).sum();
    let mut distances: Vec<f64> =
        corners(draft).step_by(count.div_ceil(SAMPLED_CORNERS).max(1)).map(|p| p.distance(camera)).collect();
    let tenth = distances.len() / 10;
    *distances.select_nth_unstable_by(tenth, f64::total_cmp).1
}

/// Returns the scene in local coordinates, and its cameras.
pub(crate) fn recentre(draft: Draft, coordinates: &LocalCoordinates) -> (Scene, Cameras) {
    let scale = coordinates.scale();
    let local = |p: DVec3| coordinates.local(p);
    let names = draft.attribute_names;
    let attribute = |NamedAttribute { name, values }: NamedAttribute| {
        let number = names.iter().position(|other| *other == name)?;
        Some(Attribute { id: AttributeId(number as u32), values })
    };
    let mesh = |m: DraftMesh| Mesh {
        name: m.name,
        positions: m.positions.into_iter().map(local).collect(),
        normals: m.normals,
        uvs: m.uvs,
        tangents: m.tangents,
        triangles: m.triangles,
        material: m.material,
        emission: m.emission,
        attributes: m.attributes.into_iter().filter_map(attribute).collect(),
    };
    let cameras = Cameras {
        still: coordinates.local_camera(&draft.shot.camera),
        path: draft.shot.path.iter().map(|camera| coordinates.local_camera(camera)).collect(),
        resolution: draft.shot.resolution,
        crop: draft.shot.crop,
    };
    let place = |(light, position)| place_light(light, position, coordinates);
    let mut scene = Scene {
        meshes: draft.meshes.into_iter().map(mesh).collect(),
        lights: draft.lights.into_iter().map(place).collect(),
        centre: coordinates.centre,
        exponent: coordinates.exponent,
        vicinity: coordinates.vicinity,
        ..draft.scene
    };
    scene.materials.iter_mut().for_each(|material| scale_lengths(material, scale));
    (scene, cameras)
}

/// Converts heights of reliefs and absorption by length to the local unit.
fn scale_lengths(material: &mut Material, by: f64) {
    if let Some(absorption) = &mut material.absorption {
        *absorption = (absorption.as_dvec3() / by).min(DVec3::splat(f32::MAX.into())).as_vec3();
    }
    if let Some(Relief::Heights { scale, .. }) = &mut material.relief {
        *scale = (f64::from(*scale) * by).clamp(f32::MIN.into(), f32::MAX.into()) as f32;
    }
    if let Some(blend) = &mut material.blend {
        scale_lengths(&mut blend.other, by);
    }
}

/// Returns a light at a world position, in local coordinates.
fn place_light(light: DeltaLight, world: DVec3, coordinates: &LocalCoordinates) -> DeltaLight {
    let position = coordinates.local(world);
    match light {
        DeltaLight::Point { intensity, .. } => {
            DeltaLight::Point { position, intensity: coordinates.local_intensity(intensity) }
        }
        DeltaLight::Spot { direction, intensity, inner_angle, outer_angle, image, .. } => {
            let intensity = coordinates.local_intensity(intensity);
            DeltaLight::Spot { position, direction, intensity, inner_angle, outer_angle, image }
        }
        DeltaLight::Projector { projector, .. } => {
            let intensity = coordinates.local_intensity(projector.intensity);
            DeltaLight::Projector { position, projector: Projector { intensity, ..projector } }
        }
        directional @ DeltaLight::Directional { .. } => directional,
    }
}

#[cfg(test)]
mod tests {
    use crate::{LoadOptions, Loaded, load};
    use scene::DeltaLight;

    /// Returns a small room, moved by `offset` and scaled by `scale`.
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
            // f64 is precise to 1e-10 at 1e6, f32 to 2.4e-7 near 4.
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
    fn glass_absorbs_the_same_in_any_unit() {
        for scale in [1e-6, 1.0, 1e9] {
            let text = format!(
                "material = [{{ name = \"m\", kind = \"glass\", attenuation_colour = 0.5, attenuation_distance = {scale:e} }}]\n\
                mesh = [{{ shape = \"sphere\", material = \"m\", transform = [{{ scale = {scale:e} }}] }}]\n"
            );
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("s.toml");
            std::fs::write(&path, text).unwrap();
            let scene = load(&path, &LoadOptions::default()).unwrap().scene;
            let distance = (scale / scene.unit()) as f32;
            let left = (-scene.materials[0].absorption.unwrap().x * distance).exp();
            assert!((left - 0.5).abs() < 1e-5 && (scene.exponent != 0) == (scale != 1.0), "{scale}: {left}");
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
