//! Triangulation of polygons of many corners, by a constrained Delaunay triangulation (crate `spade`).
//!
//! Triangles are inside where the winding number is not 0. So bridges to holes, spikes and corners that touch an edge
//! are no trouble: edges that are passed in both directions cancel. The time is that of sorting for usual outlines.

use glam::DVec2;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Intersection, LineIntersectionIterator};
use spade::{Point2, Triangulation, mitigate_underflow};
use std::collections::HashMap;

/// Corner of a polygon: its position and number.
struct Corner {
    position: Point2<f64>,
    number: u32,
}

impl HasPosition for Corner {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.position
    }
}

type Delaunay = ConstrainedDelaunayTriangulation<Corner>;

/// Returns the corners of the triangles of a polygon, counter-clockwise; `None` if the polygon crosses itself.
pub(super) fn triangles(polygon: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    let (corners, edges) = distinct(polygon);
    let mut crosses = false;
    let delaunay = Delaunay::try_bulk_load_cdt(corners, edges.clone(), |_| crosses = true).ok()?;
    let steps = if crosses { None } else { steps(&delaunay, &edges) };
    Some(inside(&delaunay, &steps?))
}

/// Returns the corners of distinct positions, and the edges of a length between them, in a unit square.
fn distinct(polygon: &[DVec2]) -> (Vec<Corner>, Vec<[usize; 2]>) {
    let size = polygon.iter().fold(0.0, |size: f64, p| size.max(p.abs().max_element()));
    let mut numbers: HashMap<[u64; 2], usize> = HashMap::with_capacity(polygon.len());
    let mut corners = Vec::with_capacity(polygon.len());
    let mut ring = Vec::with_capacity(polygon.len());
    for (number, p) in (0..).zip(polygon) {
        let unit = *p / size;
        let position = mitigate_underflow(Point2::new(unit.x, unit.y));
        // A sum with 0 has no negative zeros.
        let key = [position.x + 0.0, position.y + 0.0].map(f64::to_bits);
        let new = corners.len();
        let at = *numbers.entry(key).or_insert(new);
        if at == new {
            corners.push(Corner { position, number });
        }
        ring.push(at);
    }
    let next = ring.iter().cycle().skip(1);
    let edges = ring.iter().zip(next).map(|(&from, &to)| [from, to]).filter(|[from, to]| from != to);
    let edges = edges.collect();
    (corners, edges)
}

/// Returns the change of the winding number across each directed edge to its left; `None` if edges cross.
fn steps(delaunay: &Delaunay, edges: &[[usize; 2]]) -> Option<Vec<i32>> {
    let mut steps = vec![0; delaunay.num_directed_edges()];
    for ends in edges {
        let [from, to] = ends.map(FixedVertexHandle::from_index);
        for met in LineIntersectionIterator::new_from_handles(delaunay, from, to) {
            match met {
                Intersection::EdgeOverlap(edge) => {
                    steps[edge.fix().index()] += 1;
                    steps[edge.fix().rev().index()] -= 1;
                }
                Intersection::EdgeIntersection(_) => return None,
                Intersection::VertexIntersection(_) => {}
            }
        }
    }
    Some(steps)
}

/// Returns the triangles whose winding number is not 0, from the outside inwards.
fn inside(delaunay: &Delaunay, steps: &[i32]) -> Vec<[u32; 3]> {
    let mut windings: Vec<Option<i32>> = vec![None; delaunay.num_all_faces()];
    windings[delaunay.outer_face().fix().index()] = Some(0);
    let mut next: Vec<_> = delaunay.convex_hull().map(|edge| edge.rev()).collect();
    let mut triangles = Vec::new();
    while let Some(edge) = next.pop() {
        let Some(face) = edge.face().as_inner() else { continue };
        let winding = windings[edge.rev().face().fix().index()].unwrap_or(0) + steps[edge.fix().index()];
        if windings[face.fix().index()].is_some() {
            continue;
        }
        windings[face.fix().index()] = Some(winding);
        if winding != 0 {
            triangles.push(face.vertices().map(|vertex| vertex.data().number));
        }
        next.extend(face.adjacent_edges().map(|edge| edge.rev()));
    }
    triangles
}
