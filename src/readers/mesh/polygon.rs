//! Triangulation of polygons: fans for convex ones, ear clipping (crate `earcut`) for others, and `large_polygon` for
//! those of many corners, for which ear clipping takes quadratic time.

use super::large_polygon;
use base::math::unit;
use earcut::Earcut;
use glam::{DMat3, DVec2, DVec3};

/// Number of corners up to which ears are clipped.
const MAX_CLIPPED: usize = 2_000;

/// Deviation of areas that counts as rounding, relative to the square of the polygon's length.
const ROUNDING: f64 = 1e-6;

/// Adds the triangles of a polygon of at least three corners; `position` returns the position of a corner. Returns
/// false if the polygon crosses itself, so that its surface is approximate.
pub(super) fn cut(corners: &[u32], position: impl Fn(&u32) -> DVec3, triangles: &mut Vec<[u32; 3]>) -> bool {
    let mut is_exact = true;
    if corners.len() > 3 {
        let points: Vec<DVec3> = corners.iter().map(position).collect();
        let flat = flattened(&points);
        is_exact = flat.is_some() || !is_folded(&points);
        if let Some(flat) = flat.filter(|flat| !is_convex(flat)) {
            let cut;
            (cut, is_exact) = if flat.len() > MAX_CLIPPED {
                let large = large_polygon::triangles(&flat);
                (large.triangles, !large.crosses_itself)
            } else {
                let ears = ears(&flat);
                let is_whole = is_whole(&flat, &ears);
                (ears, is_whole)
            };
            if !cut.is_empty() {
                triangles.extend(cut.into_iter().map(|t| t.map(|corner| corners[corner as usize])));
                return is_exact;
            }
        }
    }
    triangles.extend(corners[1..].windows(2).map(|w| [corners[0], w[0], w[1]]));
    is_exact
}

/// Returns the triangles of a polygon of few corners that is not convex.
fn ears(flat: &[DVec2]) -> Vec<[u32; 3]> {
    let mut ears: Vec<u32> = Vec::new();
    Earcut::new().earcut(flat.iter().map(|p| p.to_array()), &[], &mut ears);
    // The clipper may reverse triangles.
    let oriented = |e: &[u32]| match turn([0, 1, 2].map(|k| flat[e[k] as usize])) {
        turn if turn < 0.0 => [e[0], e[2], e[1]],
        _ => [e[0], e[1], e[2]],
    };
    ears.chunks_exact(3).map(oriented).collect()
}

/// True if triangles have the area of their polygon.
fn is_whole(flat: &[DVec2], triangles: &[[u32; 3]]) -> bool {
    let next = flat.iter().cycle().skip(1);
    let double_area: f64 = flat.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum();
    let covered: f64 = triangles.iter().map(|t| turn(t.map(|i| flat[i as usize]))).sum();
    let longest = flat.iter().map(|p| p.length_squared()).fold(0.0, f64::max);
    (covered - double_area.abs()).abs() <= ROUNDING * longest
}

/// True if parts of a polygon without an area in sum have one, as of a bow tie.
fn is_folded(points: &[DVec3]) -> bool {
    let area = |w: &[DVec3]| (w[0] - points[0]).cross(w[1] - points[0]).length();
    let longest = points.iter().map(|p| (p - points[0]).length_squared()).fold(0.0, f64::max);
    points.windows(2).any(|w| area(w) > ROUNDING * longest)
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
    let turns_left = |ring: &[DVec2]| {
        let n = ring.len();
        (0..n).all(|i| turn([ring[i], ring[(i + 1) % n], ring[(i + 2) % n]]) >= 0.0)
    };
    if !turns_left(flat) {
        return false;
    }
    // Repeated corners hide turns.
    if (0..n).any(|i| flat[i] == flat[(i + 1) % n]) {
        let distinct = |&i: &usize| flat[i] != flat[(i + 1) % n];
        let ring: Vec<DVec2> = (0..n).filter(distinct).map(|i| flat[i]).collect();
        if !turns_left(&ring) {
            return false;
        }
    }
    n <= MAX_CLIPPED || is_one_round(flat)
}

/// True if a polygon that only turns left does not go round more than once.
fn is_one_round(flat: &[DVec2]) -> bool {
    let edges = flat.iter().zip(flat.iter().cycle().skip(1)).filter(|(a, b)| a != b);
    let rises: Vec<bool> = edges.map(|(a, b)| a.to_array() < b.to_array()).collect();
    rises.iter().zip(rises.iter().cycle().skip(1)).filter(|(a, b)| a != b).count() <= 2
}

/// Returns twice the area of a triangle, positive if counter-clockwise.
fn turn([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    fn cut_all(points: &[DVec3]) -> (Vec<[u32; 3]>, f64) {
        let corners: Vec<u32> = (0..points.len() as u32).collect();
        let mut triangles = Vec::new();
        cut(&corners, |&corner| points[corner as usize], &mut triangles);
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| points[i as usize]);
            0.5 * (b - a).cross(c - a).z
        };
        let areas: Vec<f64> = triangles.iter().map(area).collect();
        let [least, most] = [f64::min, f64::max].map(|pick| areas.iter().copied().fold(0.0, pick));
        assert!(least > -1e-14 || most < 1e-14, "{least} to {most}");
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
    fn polygons_of_few_corners_that_cross_themselves_are_told() {
        let is_exact = |flat: &[[f64; 2]]| {
            let (points, corners) = (points(flat), (0..flat.len() as u32).collect::<Vec<_>>());
            cut(&corners, |&corner| points[corner as usize], &mut Vec::new())
        };
        for crossed in [
            &[[0.0, 0.0], [1.0, 0.0], [-4.0, 0.25], [0.0, 1.0]][..],
            &[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]],
            &[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 2.0]],
            &[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [1.0, -1.0], [0.0, 4.0]],
        ] {
            assert!(!is_exact(crossed), "{crossed:?}");
        }
        for simple in [
            &[[0.0, 0.0], [1.0, 0.0], [0.1, 0.1], [0.0, 1.0]][..],
            &[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]],
            &[[0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]],
            &[
                [0.0, 0.0],
                [3.0, 0.0],
                [3.0, 3.0],
                [0.0, 3.0],
                [0.0, 0.0],
                [1.0, 1.0],
                [1.0, 2.0],
                [2.0, 2.0],
                [2.0, 1.0],
                [1.0, 1.0],
            ],
        ] {
            assert!(is_exact(simple), "{simple:?}");
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
    fn comb(teeth: usize) -> Vec<[f64; 2]> {
        let mut flat = vec![[-1.0, -1.0], [1.0, -1.0]];
        flat.extend(teeth_upwards(teeth));
        flat
    }

    /// Returns the outline of teeth from the right to the left, from y = 0 to 1.
    fn teeth_upwards(teeth: usize) -> impl Iterator<Item = [f64; 2]> {
        let width = 2.0 / (2 * teeth - 1) as f64;
        (0..teeth).flat_map(move |tooth| {
            let [right, left] = [0, 1].map(|k| 1.0 - width * (2 * tooth + k) as f64);
            [[right, 0.0], [right, 1.0], [left, 1.0], [left, 0.0]]
        })
    }

    /// Cuts a polygon at several angles, and checks the area.
    fn check(name: &str, flat: &[[f64; 2]], expected: f64) {
        for angle in [0.0, 0.3, 0.25 * std::f64::consts::PI] {
            let turned: Vec<DVec3> =
                points(flat).iter().map(|p| DQuat::from_rotation_z(angle) * *p).collect();
            let corners: Vec<u32> = (0..turned.len() as u32).collect();
            assert!(
                cut(&corners, |&corner| turned[corner as usize], &mut Vec::new()),
                "{name}: crosses itself"
            );
            let (triangles, area) = cut_all(&turned);
            assert!((area - expected).abs() < 1e-9 * expected, "{name}: {area}, not {expected}");
            assert!(triangles.len() < flat.len(), "{name}");
        }
    }

    #[test]
    fn combs_of_any_size_keep_their_gaps() {
        for teeth in [10, 400, 3_000] {
            let area = 2.0 * teeth as f64 / (2 * teeth - 1) as f64;
            check("one side", &comb(teeth), 2.0 + area);
            let mut both: Vec<[f64; 2]> = teeth_upwards(teeth).collect();
            both.extend(teeth_upwards(teeth).map(|[x, y]| [-x, -1.0 - y]));
            check("both sides", &both, 2.0 + 2.0 * area);
        }
    }

    /// Returns the area of a ring of 3,000 corners.
    fn ring_area(radius: f64) -> f64 {
        1_500.0 * radius * radius * (std::f64::consts::TAU / 3_000.0).sin()
    }

    fn ring(radius: f64, sign: f64) -> impl Iterator<Item = [f64; 2]> {
        (0..3_000).map(move |i| {
            let (sin, cos) = (sign * f64::from(i) / 3_000.0 * std::f64::consts::TAU).sin_cos();
            [radius * cos, radius * sin]
        })
    }

    #[test]
    fn holes_and_spikes_of_large_polygons_are_kept() {
        // A bridge leads from the outer ring to the hole and back, and a spike out and back.
        let mut flat: Vec<[f64; 2]> = ring(2.0, 1.0).chain([[2.0, 0.0]]).collect();
        flat.extend(ring(1.0, -1.0).chain([[1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]));
        check("keyhole", &flat, ring_area(2.0) - ring_area(1.0));
        // The way back has one more corner, and each corner comes twice.
        flat.insert(flat.len() - 2, [1.5, 0.0]);
        let twice: Vec<[f64; 2]> = flat.iter().flat_map(|p| [*p, *p]).collect();
        let area = cut_all(&points(&twice)).1;
        assert!((area - ring_area(2.0) + ring_area(1.0)).abs() < 1e-9, "{area}");
    }

    #[test]
    fn runs_of_corners_on_a_line_and_spirals_are_kept() {
        let l = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]].map(DVec2::from);
        let side =
            |k: usize| (0..1_000).map(move |i| l[k].lerp(l[(k + 1) % 6], f64::from(i) / 1_000.0).to_array());
        check("runs", &(0..6).flat_map(side).collect::<Vec<_>>(), 5.0);
        let at = |i: u32, more: f64| {
            (DVec2::from_angle(f64::from(i) * 0.05) * (f64::from(i) * 0.05 + more)).to_array()
        };
        let spiral: Vec<[f64; 2]> =
            (0..3_000).map(|i| at(i, 3.0)).chain((0..3_000).rev().map(|i| at(i, 0.0))).collect();
        let next = spiral.iter().cycle().skip(1);
        let double_area: f64 = spiral.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
        check("spiral", &spiral, 0.5 * double_area);
    }

    #[test]
    fn polygons_that_cross_themselves_are_filled_and_told() {
        for teeth in [20, 600, 2_600] {
            let mut points = points(&comb(teeth));
            points.swap(3, 4);
            let corners: Vec<u32> = (0..points.len() as u32).collect();
            let is_exact = cut(&corners, |&corner| points[corner as usize], &mut Vec::new());
            assert!(!is_exact, "{teeth}");
            if teeth > 20 {
                let area = 2.0 + 2.0 * teeth as f64 / (2 * teeth - 1) as f64;
                assert!((cut_all(&points).1 - area).abs() < 2.0 / teeth as f64, "{teeth}");
            }
        }
        // A star: each edge crosses two others, and all turns are left.
        let at = |i: u32| DVec2::from_angle(f64::from(2 * i) * std::f64::consts::TAU / 2_501.0).to_array();
        let star = points(&(0..2_501).map(at).collect::<Vec<_>>());
        let corners: Vec<u32> = (0..star.len() as u32).collect();
        let mut triangles = Vec::new();
        assert!(!cut(&corners, |&corner| star[corner as usize], &mut triangles));
        assert!((cut_all(&star).1 - std::f64::consts::PI).abs() < 0.01);
        // A tangle: each edge crosses most others.
        let tangle: Vec<[f64; 2]> =
            (1..6_000).map(|i| [0.618, 0.755].map(|step| (f64::from(i) * step).fract())).collect();
        let corners: Vec<u32> = (0..tangle.len() as u32).collect();
        let tangle = points(&tangle);
        let mut triangles = Vec::new();
        assert!(!cut(&corners, |&corner| tangle[corner as usize], &mut triangles));
        assert!(!triangles.is_empty());
    }
}
