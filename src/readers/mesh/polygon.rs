//! Triangulation of polygons: fans for convex ones, else ear clipping (crate `earcut`).

use base::math::unit;
use earcut::Earcut;
use glam::{DMat3, DVec2, DVec3};

/// Number of corners beyond which a polygon counts as convex.
const MAX_CLIPPED: usize = 10_000;

/// Adds the triangles of a polygon of at least three corners; `position` returns the position of a corner.
/// Returns false if its inside is not found.
pub(super) fn cut(corners: &[u32], position: impl Fn(&u32) -> DVec3, triangles: &mut Vec<[u32; 3]>) -> bool {
    if corners.len() > 3 && corners.len() <= MAX_CLIPPED {
        let points: Vec<DVec3> = corners.iter().map(position).collect();
        if let Some(flat) = flattened(&points).filter(|flat| !is_convex(flat)) {
            let mut ears: Vec<u32> = Vec::new();
            Earcut::new().earcut(flat.iter().map(|p| p.to_array()), &[], &mut ears);
            if ears.len() >= 3 {
                let corner = |ear: u32| corners[ear as usize];
                // The clipper may reverse triangles.
                triangles.extend(ears.chunks_exact(3).map(|e| {
                    match turn([0, 1, 2].map(|k| flat[e[k] as usize])) {
                        turn if turn < 0.0 => [corner(e[0]), corner(e[2]), corner(e[1])],
                        _ => [corner(e[0]), corner(e[1]), corner(e[2])],
                    }
                }));
                return true;
            }
        }
    }
    triangles.extend(corners[1..].windows(2).map(|w| [corners[0], w[0], w[1]]));
    true
}

/// Returns the polygon in the plane across its mean normal, counter-clockwise; `None` without area.
fn flattened(points: &[DVec3]) -> Option<Vec<DVec2>> {
    let next = points.iter().cycle().skip(1);
    let double_area: DVec3 = points.iter().zip(next).map(|(a, b)| (a - points[0]).cross(b - points[0])).sum();
    let normal = unit(double_area)?;
    let across = normal.any_orthonormal_vector();
    let plane = DMat3::from_cols(across, normal.cross(across), normal).transpose();
    let flat: Vec<DVec2> = points.iter().map(|p| (plane * (p - points[0])).truncate()).collect();
    flat.iter().all(|p| p.is_finite()).then_some(flat)
}

fn is_convex(flat: &[DVec2]) -> bool {
    let n = flat.len();
    (0..n).all(|i| turn([flat[i], flat[(i + 1) % n], flat[(i + 2) % n]]) >= 0.0)
}

/// Returns twice the area of a triangle, positive if counter-clockwise.
fn turn([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut_all(points: &[DVec3]) -> (Vec<[u32; 3]>, f64) {
        let corners: Vec<u32> = (0..points.len() as u32).collect();
        let mut triangles = Vec::new();
        cut(&corners, |&corner| points[corner as usize], &mut triangles);
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| points[i as usize]);
            0.5 * (b - a).cross(c - a).z
        };
        let areas: Vec<f64> = triangles.iter().map(area).collect();
        assert!(areas.iter().all(|area| *area >= 0.0) || areas.iter().all(|area| *area <= 0.0), "{areas:?}");
        (triangles, areas.iter().sum())
    }

    fn points(flat: &[[f64; 2]]) -> Vec<DVec3> {
        flat.iter().map(|[x, y]| DVec3::new(*x, *y, 0.0)).collect()
    }

    #[test]
    fn an_l_keeps_its_notch_in_either_winding() {
        let l = points(&[[0.0, 0.0], [0.0, 3.0], [1.0, 3.0], [1.0, 1.0], [3.0, 1.0], [3.0, 0.0]]);
        for start in 0..6 {
            let turned: Vec<DVec3> = (0..6).map(|i| l[(start + i) % 6]).collect();
            assert_eq!(cut_all(&turned).1, -5.0);
            let back: Vec<DVec3> = turned.into_iter().rev().collect();
            let (triangles, area) = cut_all(&back);
            assert_eq!((triangles.len(), area), (4, 5.0));
        }
    }

    #[test]
    fn convex_polygons_are_fans_and_those_without_area_no_trouble() {
        let square = points(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(cut_all(&square).0, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(cut_all(&points(&[[0.0, 0.0]; 5])).0.len(), 3);
        let mut triangles = Vec::new();
        cut(&[0, 1, 2, 3], |_| DVec3::NAN, &mut triangles);
        assert_eq!(triangles.len(), 2);
        assert_eq!(cut_all(&points(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [3.0, 0.0]])).0.len(), 2);
    }
}
