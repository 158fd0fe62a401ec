//! Division of triangles that are very large compared with the camera's surroundings.
//!
//! The precision of a point on a triangle is relative to the triangle's size. Suppose that a floor is a million times
//! as large as an object on it. Points on the floor would then be off by up to a tenth of the object's size.
//!
//! Edges are halved until they are at most a multiple of their distance from the camera. The decision depends on the
//! ends of an edge only. So triangles that share an edge divide it alike, and no gap opens between them.

use crate::draft::{Draft, DraftMesh};
use crate::local::LocalCoordinates;
use glam::DVec3;
use scene::AttributeValues;
use std::collections::BTreeMap;

/// Maximum ratio of an edge's length to its distance from the camera, or to the vicinity if that is larger.
///
/// Points are then precise to 1e-5 of that distance.
const MAX_LENGTH: f64 = 64.0;

/// Maximum number of triangles to add. The largest floor that f64 can describe takes about ten thousand.
const MAX_ADDED: usize = 1 << 17;

/// Divides the triangles of a draft whose [`LocalCoordinates::vicinity`] is above 0.
pub fn divide(draft: &mut Draft, coordinates: &LocalCoordinates) {
    if !(coordinates.vicinity > 0.0) {
        return;
    }
    let vicinity = f64::from(coordinates.vicinity) / coordinates.scale();
    let is_long = |a: DVec3, b: DVec3| {
        let (a, b) = if a.to_array() <= b.to_array() { (a, b) } else { (b, a) };
        a.distance(b) > MAX_LENGTH * distance(draft.shot.camera.origin, a, b).max(vicinity)
    };
    let mut left = MAX_ADDED;
    // Meshes of groups lie at other distances at each place.
    let own = draft.meshes.iter_mut().filter(|mesh| mesh.group.is_none());
    own.for_each(|mesh| divide_mesh(mesh, is_long, &mut left));
}

/// Returns the distance of a point from the segment between two others.
fn distance(point: DVec3, a: DVec3, b: DVec3) -> f64 {
    let (along, to_point) = (b - a, point - a);
    let t = (to_point.dot(along) / along.length_squared()).clamp(0.0, 1.0);
    to_point.distance(along * if t.is_nan() { 0.0 } else { t })
}

fn divide_mesh(mesh: &mut DraftMesh, is_long: impl Fn(DVec3, DVec3) -> bool, left: &mut usize) {
    let mut middles = BTreeMap::new();
    let mut at = 0;
    while at < mesh.triangles.len() {
        let [a, b, c] = mesh.triangles[at];
        let length = |[a, b, _]: &[u32; 3]| {
            let [a, b] = [*a, *b].map(|vertex| mesh.positions[vertex as usize]);
            is_long(a, b).then(|| a.distance_squared(b))
        };
        let turns = [[a, b, c], [b, c, a], [c, a, b]];
        let long = turns.iter().filter_map(|turn| length(turn).map(|length| (length, *turn)));
        let longest = long.max_by(|(length, _), (other, _)| length.total_cmp(other));
        match longest.filter(|_| *left > 0 && mesh.positions.len() < u32::MAX as usize) {
            Some((_, [a, b, c])) => {
                let middle = *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| add_middle(mesh, [a, b]));
                mesh.triangles[at] = [a, middle, c];
                mesh.triangles.push([middle, b, c]);
                for attribute in &mut mesh.attributes {
                    if let AttributeValues::Triangles(values) = &mut attribute.values {
                        values.push(values[at]);
                    }
                }
                *left -= 1;
            }
            None => at += 1,
        }
    }
}

/// Adds the vertex in the middle of an edge.
fn add_middle(mesh: &mut DraftMesh, edge: [u32; 2]) -> u32 {
    fn add<T: Copy>(of: &mut Vec<T>, [a, b]: [u32; 2], middle: impl Fn(T, T) -> T) {
        if !of.is_empty() {
            of.push(middle(of[a as usize], of[b as usize]));
        }
    }
    let vertex = mesh.positions.len() as u32;
    add(&mut mesh.positions, edge, |a, b| 0.5 * a + 0.5 * b);
    // The middle normal is not of unit length, so interpolation along the edge gives the values of the whole edge.
    add(&mut mesh.normals, edge, |a, b| 0.5 * a + 0.5 * b);
    add(&mut mesh.uvs, edge, |a, b| 0.5 * a + 0.5 * b);
    add(&mut mesh.tangents, edge, |a, b| 0.5 * a + 0.5 * b);
    for attribute in &mut mesh.attributes {
        if let AttributeValues::Vertices(values) = &mut attribute.values {
            add(values, edge, |a, b| 0.5 * a + 0.5 * b);
        }
    }
    vertex
}

#[cfg(test)]
mod tests {
    use crate::{LoadOptions, Loaded, load};
    use glam::{Vec2, Vec3};
    use scene::{Mesh, Scene};

    /// Returns a ball on a slanted floor that reaches `reach` to all sides.
    fn ball_on_floor(reach: f64) -> Loaded {
        let text = format!(
            "resolution = [8, 8]\ncamera = {{ origin = [0.1, 0.6, 2.5], target = [0, 0, 0], fov = 60 }}\n\
            material = [{{ name = \"m\", kind = \"diffuse\", reflectance = 0.5 }}]\n\
            mesh = [{{ shape = \"sphere\", material = \"m\" }},\
            {{ shape = \"rectangle\", material = \"m\", transform = [{{ scale = {reach:e} }}, \
            {{ rotate = {{ axis = [1, 0.1, 0], angle = -80 }} }}, {{ translate = [0, -1, 0] }}] }}]\n\
            light = [{{ kind = \"point\", position = [0, 3, 0], intensity = [1, 1, 1] }}]\n"
        );
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.toml");
        std::fs::write(&path, text).unwrap();
        load(&path, &LoadOptions::default()).unwrap()
    }

    fn floor(scene: &Scene) -> &Mesh {
        &scene.meshes[1]
    }

    #[test]
    fn ordinary_floors_stay_whole() {
        assert_eq!(floor(&ball_on_floor(100.0).scene).triangles.len(), 2);
    }

    #[test]
    fn triangles_near_the_camera_are_small_and_leave_no_gaps() {
        for reach in [1e5, 1e8] {
            let Loaded { scene, cameras, .. } = ball_on_floor(reach);
            let floor = floor(&scene);
            assert!((20..4000).contains(&floor.triangles.len()), "{}", floor.triangles.len());
            let mut area = 0.0;
            for triangle in &floor.triangles {
                let [a, b, c] = triangle.map(|vertex| floor.positions[vertex as usize].as_dvec3());
                area += 0.5 * (b - a).cross(c - a).length();
                let far = a.distance(cameras.still.origin.as_dvec3()) + a.distance(b);
                assert!(a.distance(b) < 64.0 * far.max(f64::from(scene.vicinity)));
            }
            assert!((area / (4.0 * reach * reach) - 1.0).abs() < 1e-5, "{area}");
            // Each inner edge belongs to one triangle on either side.
            let mut edges: Vec<[u32; 2]> =
                floor.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
            edges.sort_unstable();
            let outer = edges.iter().filter(|[a, b]| edges.binary_search(&[*b, *a]).is_err());
            let on_outside = |v: Vec2| v.min(Vec2::ONE - v).min_element() == 0.0;
            for edge in outer {
                let [a, b] = edge.map(|vertex| floor.uvs[vertex as usize]);
                assert!(on_outside(a) && on_outside(b) && on_outside(0.5 * (a + b)), "{a} {b}");
            }
        }
    }

    #[test]
    fn texture_coordinates_and_normals_are_interpolated_as_before() {
        let (small, large) = (ball_on_floor(100.0).scene, ball_on_floor(1e6).scene);
        let [a, b, c, _] = floor(&small).positions[..] else { panic!("four corners") };
        let (along, across) = ((b - a) * 1e4, (c - a) * 1e4);
        let large = floor(&large);
        let from = large.positions[0];
        for (position, uv) in large.positions.iter().zip(&large.uvs) {
            let share = |edge: Vec3| (*position - from).dot(edge) / edge.length_squared();
            let difference = *uv - floor(&small).uvs[0];
            assert!((share(along).abs() - difference.x.abs()).abs() < 1e-5, "{position} {uv}");
            assert!((share(across).abs() - difference.y.abs()).abs() < 1e-5, "{position} {uv}");
        }
    }
}
