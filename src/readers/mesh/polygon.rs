//! Triangulation of polygons: fans for convex ones, ear clipping (crate `earcut`) for others, and `large_polygon` for
//! those of many corners, for which ear clipping takes quadratic time.

use super::large_polygon;
use base::math::unit;
use earcut::Earcut;
use glam::{DMat3, DVec2, DVec3};

/// Number of corners up to which ears are clipped.
const MAX_CLIPPED: usize = 2_000;

/// Number of corners up to which ears of a polygon that crosses itself are clipped.
const MAX_CROSSING: usize = 10_000;

/// Adds the triangles of a polygon of at least three corners; `position` returns the position of a corner. Returns
/// false if the inside is not searched for, because the polygon crosses itself and has too many corners.
pub(super) fn cut(corners: &[u32], position: impl Fn(&u32) -> DVec3, triangles: &mut Vec<[u32; 3]>) -> bool {
    let mut is_found = true;
    if corners.len() > 3 {
        let points: Vec<DVec3> = corners.iter().map(position).collect();
        if let Some(flat) = flattened(&points).filter(|flat| !is_convex(flat)) {
            let found = inside(&flat);
            is_found = found.is_some();
            let found = found.unwrap_or_default();
            if !found.is_empty() {
                triangles.extend(found.into_iter().map(|t| t.map(|corner| corners[corner as usize])));
                return true;
            }
        }
    }
    triangles.extend(corners[1..].windows(2).map(|w| [corners[0], w[0], w[1]]));
    is_found
}

/// Returns the triangles of a polygon that is not convex; `None` if it crosses itself and has too many corners.
fn inside(flat: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    if flat.len() > MAX_CLIPPED {
        let triangles = large_polygon::triangles(flat);
        if triangles.is_some() || flat.len() > MAX_CROSSING {
            return triangles;
        }
    }
    let mut ears: Vec<u32> = Vec::new();
    Earcut::new().earcut(flat.iter().map(|p| p.to_array()), &[], &mut ears);
    // The clipper may reverse triangles.
    let oriented = |e: &[u32]| match turn([0, 1, 2].map(|k| flat[e[k] as usize])) {
        turn if turn < 0.0 => [e[0], e[2], e[1]],
        _ => [e[0], e[1], e[2]],
    };
    Some(ears.chunks_exact(3).map(oriented).collect())
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

    /// Returns a comb of `teeth` teeth, 1 long, on a back of 2 x 1.
    fn comb(teeth: usize) -> Vec<DVec3> {
        let width = 2.0 / (2 * teeth - 1) as f64;
        let mut flat = vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0]];
        for gap in 0..teeth - 1 {
            let [right, left] = [1, 2].map(|k| 1.0 - width * (2 * gap + k) as f64);
            flat.extend([[right, 1.0], [right, 0.0], [left, 0.0], [left, 1.0]]);
        }
        flat.push([-1.0, 1.0]);
        points(&flat)
    }

    #[test]
    fn combs_of_any_size_keep_their_gaps() {
        for teeth in [10, 400, 2_521, 10_000] {
            let start = std::time::Instant::now();
            let (triangles, area) = cut_all(&comb(teeth));
            let expected = 2.0 + 2.0 * teeth as f64 / (2 * teeth - 1) as f64;
            assert!((area - expected).abs() < 1e-9, "{teeth}: {area}, not {expected}");
            assert_eq!(triangles.len(), 4 * teeth - 2);
            assert!(start.elapsed().as_secs_f64() < 10.0, "{teeth}");
        }
    }

    #[test]
    fn holes_and_spikes_of_large_polygons_are_kept() {
        let ring = |radius: f64, sign: f64| {
            (0..3_000).map(move |i| {
                let (sin, cos) = (sign * f64::from(i) / 3_000.0 * std::f64::consts::TAU).sin_cos();
                [radius * cos, radius * sin]
            })
        };
        // A bridge leads from the outer ring to the hole and back, and a spike out and back.
        let mut flat: Vec<[f64; 2]> = ring(2.0, 1.0).chain([[2.0, 0.0]]).collect();
        flat.extend(ring(1.0, -1.0).chain([[1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]));
        let area = |radius: f64| 1_500.0 * radius * radius * (std::f64::consts::TAU / 3_000.0).sin();
        let expected = area(2.0) - area(1.0);
        let found = cut_all(&points(&flat)).1;
        assert!((found - expected).abs() < 1e-9, "{found}, not {expected}");
    }

    #[test]
    fn large_polygons_that_cross_themselves_are_told() {
        for (teeth, expected) in [(20, true), (600, true), (2_600, false)] {
            let mut points = comb(teeth);
            points.swap(4, 5);
            let corners: Vec<u32> = (0..points.len() as u32).collect();
            let is_found = cut(&corners, |&corner| points[corner as usize], &mut Vec::new());
            assert_eq!(is_found, expected, "{teeth}");
        }
    }
}
