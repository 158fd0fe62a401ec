//! Parts of a polygon that a sweep line has passed and not yet divided into triangles.
//!
//! Each region between two edges that the line meets has a chain of corners on its left, from the lower edge's left
//! end to the upper edge's. The chain bulges into the region, so no two of its edges see each other. A new corner makes
//! triangles with all edges that it sees. (Hertel and Mehlhorn, Fast triangulation of simple polygons, 1983.)

/// Number of no node.
const NONE: u32 = u32::MAX;

/// Returns twice the area of a triangle of integer coordinates, positive if counter-clockwise.
pub(super) fn turn([a, b, c]: [[i64; 2]; 3]) -> i128 {
    let side = |p: [i64; 2], axis: usize| i128::from(p[axis] - a[axis]);
    side(b, 0) * side(c, 1) - side(b, 1) * side(c, 0)
}

/// Corner in a chain, with the nodes below and above it.
struct Node {
    corner: u32,
    below: u32,
    above: u32,
}

/// Region between two edges: its winding number, and its chain unless that is 0.
#[derive(Clone, Copy)]
pub(super) struct Region {
    pub winding: i32,
    bottom: u32,
    newest: u32,
    top: u32,
}

impl Region {
    pub fn with_winding(self, winding: i32) -> Self {
        Self { winding, ..self }
    }
}

/// Region outside of the polygon.
pub(super) const OUTSIDE: Region = Region { winding: 0, bottom: NONE, newest: NONE, top: NONE };

/// Chains of all regions, and the triangles found.
pub(super) struct Chains {
    pub points: Vec<[i64; 2]>,
    pub triangles: Vec<[u32; 3]>,
    nodes: Vec<Node>,
}

impl Chains {
    pub fn new(points: Vec<[i64; 2]>) -> Self {
        Self { points, triangles: Vec::new(), nodes: Vec::new() }
    }

    pub fn turn(&self, corners: [u32; 3]) -> i128 {
        turn(corners.map(|corner| self.points[corner as usize]))
    }

    /// Returns a region that begins at a corner.
    pub fn begin(&mut self, winding: i32, corner: u32) -> Region {
        if winding == 0 {
            return OUTSIDE;
        }
        let node = self.node(corner, NONE, NONE);
        Region { winding, bottom: node, newest: node, top: node }
    }

    /// Returns a region whose upper edge ends at a corner.
    pub fn extend_top(&mut self, region: Region, corner: u32) -> Region {
        if region.winding == 0 {
            return region;
        }
        let mut at = region.top;
        while self.joins(self.nodes[at as usize].below, at, corner) {
            at = self.nodes[at as usize].below;
        }
        let node = self.node(corner, at, NONE);
        self.nodes[at as usize].above = node;
        Region { newest: node, top: node, ..region }
    }

    /// Returns a region whose lower edge ends at a corner.
    pub fn extend_bottom(&mut self, region: Region, corner: u32) -> Region {
        if region.winding == 0 {
            return region;
        }
        let mut at = region.bottom;
        while self.joins(at, self.nodes[at as usize].above, corner) {
            at = self.nodes[at as usize].above;
        }
        let node = self.node(corner, NONE, at);
        self.nodes[at as usize].below = node;
        Region { newest: node, bottom: node, ..region }
    }

    /// Returns the parts of a region below and above a corner inside it.
    pub fn split(&mut self, region: Region, corner: u32) -> [Region; 2] {
        if region.winding == 0 {
            return [region; 2];
        }
        let Node { corner: newest, above, .. } = self.nodes[region.newest as usize];
        let copy = self.node(newest, NONE, above);
        if above != NONE {
            self.nodes[above as usize].below = copy;
        }
        self.nodes[region.newest as usize].above = NONE;
        let top = if region.top == region.newest { copy } else { region.top };
        let lower = self.extend_top(Region { top: region.newest, ..region }, corner);
        [lower, self.extend_bottom(Region { bottom: copy, top, ..region }, corner)]
    }

    /// Returns the union of two regions; the lower one's top and the upper one's bottom are nodes of one corner.
    pub fn join(&mut self, lower: Region, upper: Region) -> Region {
        if lower.winding == 0 || upper.winding == 0 {
            return lower;
        }
        let above = self.nodes[upper.bottom as usize].above;
        self.nodes[lower.top as usize].above = above;
        if above == NONE {
            return lower;
        }
        self.nodes[above as usize].below = lower.top;
        Region { newest: lower.top, top: upper.top, ..lower }
    }

    /// Ends a region at a corner, where both its edges end.
    pub fn end(&mut self, region: Region, corner: u32) {
        let mut at = region.bottom;
        while at != NONE {
            let above = self.nodes[at as usize].above;
            self.joins(at, above, corner);
            at = above;
        }
    }

    /// Adds the triangle of an edge of a chain and a corner that sees it; false if there is none.
    fn joins(&mut self, below: u32, above: u32, corner: u32) -> bool {
        if below == NONE || above == NONE {
            return false;
        }
        let [low, high] = [below, above].map(|node| self.nodes[node as usize].corner);
        let sees = self.turn([low, high, corner]) < 0;
        if sees {
            self.triangles.push([corner, high, low]);
        }
        sees
    }

    fn node(&mut self, corner: u32, below: u32, above: u32) -> u32 {
        self.nodes.push(Node { corner, below, above });
        self.nodes.len() as u32 - 1
    }
}
