//! Triangulation of polygons of many corners, by a sweep line over corners on a fine grid, with exact tests.
//!
//! The inside is where the winding number is not 0. So bridges to holes, spikes and corners that touch an edge are no
//! trouble: edges that are passed in both directions cancel. The time is that of sorting. No corners are added, so
//! the surface about crossings is approximate.

use super::chains::{Chains, OUTSIDE, Region, turn};
use super::edge_order::{EdgeOrder, Place};
use glam::DVec2;
use std::collections::BTreeMap;

/// Half the size of the grid.
const GRID: f64 = (1_u64 << 50) as f64;

/// Number of edges that may change places at crossings, per corner. A worse tangle becomes its hull.
const MAX_CHANGES: usize = 4;

/// Part of the area and of the size by which bridges and spikes may cross an edge that they only touch.
const ROUNDING: f64 = 1e-9;

/// Edge of a polygon, from its left end; `step` is the change of the winding number across it upwards.
#[derive(Clone, Copy)]
struct Edge {
    from: u32,
    to: u32,
    step: i32,
}

/// Triangles of a polygon, counter-clockwise.
pub(super) struct Cut {
    pub triangles: Vec<[u32; 3]>,
    pub crosses_itself: bool,
}

/// Returns the triangles of a polygon with an area.
pub(super) fn triangles(polygon: &[DVec2]) -> Cut {
    let grid = on_grid(polygon);
    let mut sorted: Vec<u32> = (0..grid.len() as u32).collect();
    sorted.sort_by_key(|&corner| (grid[corner as usize], corner));
    // Corners of one position are one point.
    let mut ranks = vec![0; grid.len()];
    let (mut points, mut corners) = (Vec::new(), Vec::new());
    for corner in sorted {
        if points.last() != Some(&grid[corner as usize]) {
            points.push(grid[corner as usize]);
            corners.push(corner);
        }
        ranks[corner as usize] = points.len() as u32 - 1;
    }
    let mut sweep = Sweep::new(points, edges(&ranks));
    let by_rank = if sweep.run() { sweep.chains.triangles.clone() } else { hull(&sweep.chains) };
    let area: i128 = by_rank.iter().map(|t| sweep.chains.turn(*t)).sum();
    let next = grid.iter().cycle().skip(1);
    let double_area: i128 = grid.iter().zip(next).map(|(a, b)| turn([grid[0], *a, *b])).sum();
    let excess = (area - double_area) as f64;
    let triangles = by_rank.into_iter().map(|t| t.map(|rank| corners[rank as usize])).collect();
    Cut { triangles, crosses_itself: sweep.crosses || excess.abs() > ROUNDING * area as f64 }
}

fn on_grid(polygon: &[DVec2]) -> Vec<[i64; 2]> {
    let low = polygon.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = polygon.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let centre = 0.5 * low + 0.5 * high;
    let scale = GRID / (high - centre).max_element();
    let limit = DVec2::splat(GRID);
    polygon.iter().map(|p| ((p - centre) * scale).clamp(-limit, limit).to_array().map(|x| x as i64)).collect()
}

/// Returns the edges between points by their left ends, without edges that are passed as often in both directions.
fn edges(ring: &[u32]) -> Vec<Edge> {
    let mut steps = BTreeMap::new();
    for (&from, &to) in ring.iter().zip(ring.iter().cycle().skip(1)) {
        *steps.entry([from.min(to), from.max(to)]).or_insert(0) += (to > from) as i32 - (to < from) as i32;
    }
    let edges = steps.into_iter().map(|([from, to], step)| Edge { from, to, step });
    edges.filter(|edge| edge.step != 0).collect()
}

/// Returns the triangles of the convex hull of points that are in order.
fn hull(chains: &Chains) -> Vec<[u32; 3]> {
    let half = |points: &mut dyn Iterator<Item = u32>| {
        let mut half = Vec::new();
        for point in points {
            while let [.., a, b] = half[..]
                && chains.turn([a, b, point]) <= 0
            {
                half.pop();
            }
            half.push(point);
        }
        half.pop();
        half
    };
    let all = 0..chains.points.len() as u32;
    let mut hull = half(&mut all.clone());
    hull.extend(half(&mut all.rev()));
    hull.windows(2).skip(1).map(|w| [hull[0], w[0], w[1]]).collect()
}

/// State of the sweep line.
struct Sweep {
    chains: Chains,
    edges: Vec<Edge>,
    /// Region above each edge that the line meets.
    regions: Vec<Region>,
    order: EdgeOrder,
    /// Number of edges that changed places at crossings.
    changes: usize,
    /// True if edges cross by more than rounding.
    crosses: bool,
}

impl Sweep {
    fn new(points: Vec<[i64; 2]>, edges: Vec<Edge>) -> Self {
        let regions = vec![OUTSIDE; edges.len()];
        let order = EdgeOrder::new(edges.len());
        Self { chains: Chains::new(points), edges, regions, order, changes: 0, crosses: false }
    }

    /// Passes all points from the left; false if too many edges cross.
    fn run(&mut self) -> bool {
        let max_changes = MAX_CHANGES * self.chains.points.len();
        let lefts: Vec<u32> = self.edges.iter().map(|edge| edge.from).collect();
        let mut starting = (0..lefts.len() as u32).peekable();
        let mut by_right_end: Vec<u32> = (0..lefts.len() as u32).collect();
        by_right_end.sort_by_key(|&edge| self.edges[edge as usize].to);
        let mut ending = by_right_end.into_iter().peekable();
        for point in 0..self.chains.points.len() as u32 {
            let mut starts = Vec::new();
            while let Some(edge) = starting.next_if(|&edge| lefts[edge as usize] == point) {
                starts.push(edge);
            }
            let mut ends = Vec::new();
            while let Some(edge) = ending.next_if(|&edge| self.edges[edge as usize].to == point) {
                // An edge that became one with another is not met.
                ends.extend(self.order.contains(edge).then_some(edge));
            }
            if !(starts.is_empty() && ends.is_empty()) {
                self.pass(point, ends, starts);
            }
            if self.changes > max_changes {
                return false;
            }
        }
        true
    }

    /// Passes a point at which some edges end and others start.
    fn pass(&mut self, point: u32, mut ends: Vec<u32>, mut starts: Vec<u32>) {
        let place = self.locate(point, &mut ends);
        let below = self.add_touched(point, place, &mut ends, &mut starts);
        let outer = below.map_or(OUTSIDE, |edge| self.regions[edge as usize]);
        let [low, high] = if let Some((&last, inner)) = ends.split_last() {
            for &edge in inner {
                self.chains.end(self.regions[edge as usize], point);
            }
            let low = self.chains.extend_top(outer, point);
            [low, self.chains.extend_bottom(self.regions[last as usize], point)]
        } else {
            self.chains.split(outer, point)
        };
        for &edge in &ends {
            self.order.remove(edge);
        }
        let starts = self.ordered(point, starts);
        if let Some(below) = below {
            let region = if starts.is_empty() { self.chains.join(low, high) } else { low };
            self.regions[below as usize] = region;
        }
        let (mut under, mut winding) = (below, low.winding);
        for (k, &edge) in starts.iter().enumerate() {
            winding += self.edges[edge as usize].step;
            let is_last = k + 1 == starts.len();
            self.regions[edge as usize] = if is_last { high } else { self.chains.begin(winding, point) };
            self.order.insert(under, edge);
            under = Some(edge);
        }
    }

    /// Returns the place of a point in the order, and orders the edges that end there.
    fn locate(&mut self, point: u32, ends: &mut Vec<u32>) -> Place {
        if ends.is_empty() {
            return self.order.search(|edge| self.height(point, edge) > 0);
        }
        ends.sort_by_cached_key(|&edge| self.order.place(edge));
        let places: Vec<Place> = ends.iter().map(|&edge| self.order.place(edge)).collect();
        let is_above = |edge: &u32| self.height(point, *edge) > 0;
        let is_below = |edge: &u32| self.height(point, *edge) < 0;
        let (mut first, mut last) = (places[0], places[places.len() - 1]);
        while let Some(edge) = self.order.before(first).filter(is_below) {
            first = self.order.place(edge);
        }
        while let Some(edge) = self.order.at(self.order.after(last)).filter(is_above) {
            last = self.order.place(edge);
        }
        let is_apart = |pair: &[Place]| self.order.after(pair[0]) != pair[1];
        if (first, last) != (places[0], places[places.len() - 1]) || places.windows(2).any(is_apart) {
            self.gather(point, [first, last], ends);
        }
        self.order.place(ends[0])
    }

    /// Adds the edges that a point touches to those that end and start there; returns the edge below them.
    fn add_touched(
        &self,
        point: u32,
        place: Place,
        ends: &mut Vec<u32>,
        starts: &mut Vec<u32>,
    ) -> Option<u32> {
        let touches = |&edge: &u32| self.edges[edge as usize].to != point && self.height(point, edge) == 0;
        let mut above = (0..ends.len()).fold(place, |place, _| self.order.after(place));
        while let Some(edge) = self.order.at(above).filter(touches) {
            ends.push(edge);
            starts.push(edge);
            above = self.order.after(above);
        }
        let mut below = self.order.before(place);
        while let Some(edge) = below.filter(touches) {
            ends.insert(0, edge);
            starts.push(edge);
            below = self.order.before(self.order.place(edge));
        }
        below
    }

    /// Returns the edges that start at a point from below. Edges with both ends in common become one.
    fn ordered(&mut self, point: u32, mut starts: Vec<u32>) -> Vec<u32> {
        for &edge in &starts {
            self.edges[edge as usize].from = point;
        }
        let end = |edge: u32| self.edges[edge as usize].to;
        starts.sort_by(|&a, &b| {
            let turn = self.chains.turn([point, end(a), end(b)]);
            0.cmp(&turn).then(end(a).cmp(&end(b)))
        });
        starts.dedup_by(|&mut edge, &mut kept| {
            let Edge { to, step, .. } = self.edges[edge as usize];
            let kept = &mut self.edges[kept as usize];
            kept.step += if kept.to == to { step } else { 0 };
            kept.to == to
        });
        starts.retain(|&edge| self.edges[edge as usize].step != 0);
        starts
    }

    /// Orders the edges from one place to another about a point that they pass on the wrong side, as they cross.
    fn gather(&mut self, point: u32, [first, last]: [Place; 2], ends: &mut Vec<u32>) {
        let (mut spanned, mut at) = (Vec::new(), first);
        while at <= last
            && let Some(edge) = self.order.at(at)
        {
            spanned.push(edge);
            at = self.order.after(at);
        }
        self.changes += spanned.len();
        self.crosses |= spanned.iter().any(|&edge| self.distance(point, edge) > ROUNDING * GRID);
        let mut under = self.order.before(first);
        let mut winding = under.map_or(0, |edge| self.regions[edge as usize].winding);
        let regions: Vec<Region> = spanned.iter().map(|&edge| self.regions[edge as usize]).collect();
        for &edge in &spanned {
            self.order.remove(edge);
        }
        // Edges below the point come first, then those that end there, then those above.
        let is_end = |edge: u32| self.edges[edge as usize].to == point;
        spanned.sort_by_cached_key(|&edge| match self.height(point, edge) {
            _ if is_end(edge) => 0,
            height if height > 0 => -1,
            _ => 1,
        });
        *ends = spanned.iter().copied().filter(|&edge| is_end(edge)).collect();
        for (k, &edge) in spanned.iter().enumerate() {
            let Edge { from, step, .. } = self.edges[edge as usize];
            winding += step;
            self.regions[edge as usize] = match (spanned.get(k + 1), regions[k]) {
                (None, region) => region,
                (Some(_), _) if winding == 0 => OUTSIDE,
                (Some(&above), region) if region.winding == 0 => {
                    self.chains.begin(winding, from.max(self.edges[above as usize].from))
                }
                (Some(_), region) => region.with_winding(winding),
            };
            self.order.insert(under, edge);
            under = Some(edge);
        }
    }

    /// Returns the distance of a point from the line of an edge.
    fn distance(&self, point: u32, edge: u32) -> f64 {
        let Edge { from, to, .. } = self.edges[edge as usize];
        let [from, to] =
            [from, to].map(|end| DVec2::from(self.chains.points[end as usize].map(|x| x as f64)));
        self.height(point, edge).abs() as f64 / from.distance(to)
    }

    /// Returns a number of the sign of the height of a point above an edge.
    fn height(&self, point: u32, edge: u32) -> i128 {
        let Edge { from, to, .. } = self.edges[edge as usize];
        self.chains.turn([from, to, point])
    }
}
