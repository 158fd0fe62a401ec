//! Cameras for scenes without one: they see the whole scene.

use super::corners;
use crate::draft::{Draft, DraftCamera};
use base::math::unit;
use glam::{DVec2, DVec3};

/// Fraction of the film's height and width that stays empty around the scene.
const MARGIN: f64 = 0.05;

/// Returns the direction from a scene to its viewer: above the front, to the right.
///
/// The front is +z if y is up, and -y if z is up.
pub fn outlook(up: DVec3) -> DVec3 {
    let up = unit(up).unwrap_or(DVec3::Y);
    let front = if up.z.abs() > up.y.abs() { DVec3::NEG_Y } else { DVec3::Z };
    let side = unit(up.cross(front)).unwrap_or(DVec3::X);
    let (elevation, azimuth) = (20f64.to_radians(), 30f64.to_radians());
    let level = side * azimuth.sin() + side.cross(up) * azimuth.cos();
    level * elevation.cos() + up * elevation.sin()
}

/// Returns all vertices, and the corners of boxes around groups at their places.
fn points(draft: &Draft) -> impl Iterator<Item = DVec3> {
    let own = draft.meshes.iter().filter(|mesh| mesh.group.is_none());
    own.flat_map(|mesh| mesh.positions.iter().copied()).chain(corners::placed(draft))
}

/// Returns the middle of the bounding box of all vertices; the origin without vertices.
pub fn middle(draft: &Draft) -> DVec3 {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for p in points(draft).filter(|p| p.is_finite()) {
        (low, high) = (low.min(p), high.max(p));
    }
    if low.cmple(high).all() { 0.5 * low + 0.5 * high } else { DVec3::ZERO }
}

/// Moves a camera with `fits` to the nearest point from which it sees all vertices. The cameras of a turntable, its
/// path, move to one distance from the middle, from which all of them do.
///
/// The directions and the field of view stay. Without vertices the camera moves to `centre`.
pub fn frame(draft: &mut Draft, centre: DVec3) {
    if !draft.shot.fits {
        return;
    }
    let [width, height] = draft.shot.resolution.map(f64::from);
    let mut camera = draft.shot.camera;
    let tan = (1.0 - MARGIN) * camera.tan_half_x * DVec2::new(1.0, height / width);
    let [high, low] = extent(draft, &camera, centre, tan);
    if !(high.is_finite() && low.is_finite()) {
        draft.shot.camera.origin = centre;
        return;
    }
    let offset = 0.5 * (high - low);
    let distance = (0.5 * (high + low) / tan).max_element();
    camera.origin = centre + camera.right * offset.x + camera.up * offset.y - camera.forward * distance;
    draft.shot.camera = camera;
    let middle = middle(draft);
    let needed = |camera: &DraftCamera| {
        let [high, low] = extent(draft, camera, middle, tan);
        (high.max(low) / tan).max_element()
    };
    let distance = draft.shot.path.iter().map(needed).fold(0.0, f64::max);
    for camera in &mut draft.shot.path {
        camera.origin = middle - camera.forward * distance;
    }
}

/// Returns how far a film with the tangents `tan` must reach at distance 0 from `centre`: to the right and up, and to
/// the left and down.
///
/// A point p is within the film's right edge if p·right - x <= tan (p·forward + d), for the camera's offset x and
/// distance d behind the centre. The other edges are alike.
fn extent(draft: &Draft, camera: &DraftCamera, centre: DVec3, tan: DVec2) -> [DVec2; 2] {
    let (mut high, mut low) = (DVec2::NEG_INFINITY, DVec2::NEG_INFINITY);
    for p in points(draft).map(|p| p - centre) {
        let (across, depth) = (DVec2::new(p.dot(camera.right), p.dot(camera.up)), p.dot(camera.forward));
        high = high.max(across - tan * depth);
        low = low.max(-across - tan * depth);
    }
    [high, low]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LoadOptions, Loaded, load};
    use glam::Vec3;

    fn loaded(text: &str) -> Loaded {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.toml");
        std::fs::write(&path, text).unwrap();
        load(&path, &LoadOptions::default()).unwrap()
    }

    #[test]
    fn everything_is_in_view_and_fills_it() {
        let mesh = "[[material]]\nname = \"m\"\nkind = \"diffuse\"\nreflectance = 0.5\n\
            [[mesh]]\nshape = \"cube\"\nmaterial = \"m\"\n\
            transform = [{ scale = [1, 2, 30] }, { translate = [1000, 5, 6] }]\n";
        for head in ["", "resolution = [100, 300]\n", "camera = { up = [0, 0, 1], fov = 20 }\n"] {
            let Loaded { scene, cameras, .. } = loaded(&format!("{head}{mesh}"));
            let camera = cameras.still;
            let aspect = cameras.resolution[1] as f32 / cameras.resolution[0] as f32;
            let mut extent = DVec2::ZERO;
            for p in scene.meshes.iter().flat_map(|mesh| &mesh.positions) {
                let to = *p - camera.origin;
                let depth = to.dot(camera.forward) * camera.tan_half_x;
                assert!(depth > 0.0);
                let film = Vec3::new(to.dot(camera.right), to.dot(camera.up) / aspect, 0.0) / depth;
                extent = extent.max(film.abs().truncate().as_dvec2());
            }
            assert!(extent.max_element() < 0.951 && extent.max_element() > 0.949, "{head}: {extent}");
            assert!(camera.up.z < 0.5 || head.contains("up"));
        }
    }

    #[test]
    fn an_empty_scene_has_a_camera_too() {
        assert!(loaded("# nothing\n").cameras.still.origin.is_finite());
    }

    #[test]
    fn the_viewer_stands_in_front_and_above() {
        assert!(outlook(DVec3::Y).cmpgt(DVec3::ZERO).all());
        let z_up = outlook(DVec3::Z);
        assert!(z_up.z > 0.0 && z_up.y < 0.0 && z_up.x > 0.0);
        assert!(outlook(DVec3::ZERO).is_finite());
    }
}
