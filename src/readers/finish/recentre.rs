//! Conversion of world coordinates in f64 to local coordinates in f32, relative to the scene's centre.
//!
//! The centre is subtracted in f64, before any rounding. So a scene of a millimetre, a million units from the origin,
//! keeps the full precision of f32. The centre is the middle of the bounding box. If something lies very far beyond the
//! camera's surroundings, the centre is the camera: far triangles do not cost the precision of near ones.
//!
//! Very small and very large scenes get another unit of length, a power of two. So no product of lengths leaves the
//! range of f32.

use super::corners;
use crate::attributes::NamedAttribute;
use crate::draft::{Draft, DraftCamera, DraftGroup, DraftMesh};
use crate::local::LocalCoordinates;
use glam::{DMat4, DVec3};
use scene::{
    Attribute, AttributeId, Camera, Cameras, DeltaLight, Group, MAX_RATIO, Material, Mesh, Projection,
    Projector, Relief, Scene,
};

/// Approximate number of corners that are sampled to compute the vicinity.
const SAMPLED_CORNERS: usize = 1 << 16;

/// Largest distance from the camera to the origin of a scene with instances, in units of its vicinity.
const MAX_ASIDE: f64 = 64.0;

/// Sizes of scenes that keep their unit, as binary logarithms.
const UNSCALED_SIZES: std::ops::Range<i32> = -10..24;

impl LocalCoordinates {
    /// Returns the coordinates for a draft.
    pub fn around(draft: &Draft) -> LocalCoordinates {
        let lights = || draft.lights.iter().map(|light| light.1);
        let camera = draft.shot.camera.origin;
        let Some((low, high)) = bounds(corners::hull(draft)) else {
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
        let centre = beside_instances(draft, centre, low, vicinity);
        let coordinates = LocalCoordinates { centre, exponent, vicinity: 0.0 };
        LocalCoordinates { vicinity: (vicinity * coordinates.scale()) as f32, ..coordinates }
    }

    /// Returns a camera in local coordinates.
    pub fn local_camera(&self, c: &DraftCamera) -> Camera {
        let scale = self.scale();
        let length = |length: f32| (f64::from(length) * scale) as f32;
        let (mut tan_half_x, mut shift, mut projection) = (c.tan_half_x, c.shift, c.projection);
        match &mut projection {
            Projection::Pinhole => {}
            Projection::Lens { radius, distance } => {
                (*radius, *distance) = (length(*radius), length(*distance));
            }
            Projection::Parallel => {
                tan_half_x *= scale;
                shift = shift.map(|shift| shift * scale);
            }
        }
        Camera {
            origin: self.local(c.origin),
            forward: c.forward.as_vec3(),
            right: c.right.as_vec3(),
            up: c.up.as_vec3(),
            tan_half_x: tan_half_x as f32,
            shift: shift.map(|shift| shift as f32),
            pixel_height: c.pixel_height as f32,
            near: (c.near * scale) as f32,
            far: (c.far * scale) as f32,
            projection,
            filter: c.filter,
        }
    }
}

/// Returns the origin of a scene with instances: outside of the box from `low` on along its shortest side, as far as
/// instances reach around their middle. In scenes of a vicinity, it stays near the camera.
///
/// Rays and points of an instance round relative to its middle, and offsets of rays relative to the origin. So no point
/// may be closer to the origin than to its instance's middle.
fn beside_instances(draft: &Draft, centre: DVec3, low: DVec3, vicinity: f64) -> DVec3 {
    let reach = corners::reach(draft);
    if reach == 0.0 {
        return centre;
    }
    let axis = (centre - low).min_position();
    let mut beside = centre;
    beside[axis] =
        if vicinity > 0.0 { centre[axis] - reach.min(MAX_ASIDE * vicinity) } else { low[axis] - reach };
    beside
}

fn bounds(points: impl Iterator<Item = DVec3>) -> Option<(DVec3, DVec3)> {
    let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = points.filter(|p| p.is_finite()).fold(empty, |(l, h), p| (l.min(p), h.max(p)));
    low.cmple(high).all().then_some((low, high))
}

/// Returns the distance from `camera` that contains a tenth of the corners.
fn vicinity(draft: &Draft, camera: DVec3) -> f64 {
    let mut distances: Vec<f64> =
        corners::sample(draft, SAMPLED_CORNERS).into_iter().map(|p| p.distance(camera)).collect();
    let tenth = distances.len() / 10;
    *distances.select_nth_unstable_by(tenth, f64::total_cmp).1
}

/// Returns the scene in local coordinates, and its cameras.
pub(crate) fn recentre(draft: Draft, coordinates: &LocalCoordinates) -> (Scene, Cameras) {
    let scale = coordinates.scale();
    let groups = groups(&draft, coordinates);
    let of_groups: Vec<LocalCoordinates> = draft.groups.iter().map(|group| group.coordinates).collect();
    let names = draft.attribute_names;
    let attribute = |NamedAttribute { name, values }: NamedAttribute| {
        let number = names.iter().position(|other| *other == name)?;
        Some(Attribute { id: AttributeId(number as u32), values })
    };
    let mesh = |m: DraftMesh| Mesh {
        name: m.name,
        positions: {
            let own = m.group.and_then(|group| of_groups.get(group)).unwrap_or(coordinates);
            m.positions.into_iter().map(|p| own.local(p)).collect()
        },
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
        groups,
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

/// Returns the groups that have meshes, with their places in local coordinates.
fn groups(draft: &Draft, coordinates: &LocalCoordinates) -> Vec<Group> {
    let range = |number: usize| {
        let first = draft.meshes.iter().position(|mesh| mesh.group == Some(number))?;
        let count = draft.meshes[first..].iter().take_while(|mesh| mesh.group == Some(number)).count();
        Some(first..first + count)
    };
    let group = |(number, group): (usize, &DraftGroup)| {
        let place = |to_world: &DMat4| group.coordinates.placed(to_world, coordinates);
        Some(Group { meshes: range(number)?, placements: group.placements.iter().map(place).collect() })
    };
    draft.groups.iter().enumerate().filter_map(group).collect()
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
