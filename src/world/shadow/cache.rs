//! Cache of recent occluders, which are tested before a ray towards a light is traced.
//!
//! Paper: Herzog et al. 2009, section 3 (an occluder hash cache saves more than 20 % of shadow rays).
//! Deviations: a slot holds several triangles and no key. Occluders of another light with the same slot do no harm;
//! they are only less likely to help.
//!
//! **The cache changes no answer.** It reports an occlusion only if the ray keeps a margin of [`MARGIN`] to the
//! triangle's edges, to the segment's ends and to grazing incidence, so that rounding in Embree cannot change the
//! answer. All other rays are traced.
//!
//! The content of a cache depends on earlier queries. Its user clears it ([`OccluderCache::forget`]) at boundaries of
//! the work that do not depend on threads, so that results do not either.

use base::setting::settings;
use embree::{Occluder, Ray, TriangleId};
use glam::Vec3;

/// Relative margin to edges and ends that a ray must keep.
const MARGIN: f32 = 64.0 * f32::EPSILON;

/// Number of values stored per triangle: corner, two edges, largest coordinate and largest component of an edge.
const ROWS: usize = 11;

settings! {
    /// Size of a cache.
    pub struct OccluderCacheSettings in "Lightcuts" {
        /// Number of slots of the occluder cache, rounded up to a power of two.
        slots: usize = 4096 => [.named("occluder_slots").range(1.0, 1048576.0)];
        /// Number of occluders per slot, rounded up to 1, 2, 4 or 8.
        ways: usize = 4 => [.named("occluder_ways").range(1.0, 8.0)];
    }
}

/// A hash table of occluding triangles.
#[derive(Clone, Debug)]
pub struct OccluderCache {
    /// Number of occluders per slot.
    ways: usize,
    /// Number of slots minus 1.
    mask: u32,
    slots: Vec<CacheSlot>,
    /// Triangles: `ROWS` rows of `ways` values per slot.
    triangles: Vec<f32>,
    /// Ids of the triangles.
    ids: Vec<TriangleId>,
    /// Number of clears; slots of other generations are empty.
    generation: u32,
}

/// State of a slot. The slot is empty unless it has the cache's generation.
#[derive(Clone, Copy, Debug, Default)]
struct CacheSlot {
    generation: u32,
    /// Index of the occluder that is replaced next.
    next: u32,
}

impl OccluderCache {
    /// Creates an empty cache.
    pub fn new(settings: OccluderCacheSettings) -> OccluderCache {
        let slots = settings.slots.clamp(1, 1 << 20).next_power_of_two();
        let ways = settings.ways.clamp(1, 8).next_power_of_two();
        OccluderCache {
            ways,
            mask: slots as u32 - 1,
            slots: vec![CacheSlot::default(); slots],
            triangles: vec![0.0; slots * ways * ROWS],
            ids: vec![TriangleId::NONE; slots * ways],
            generation: 1,
        }
    }

    /// Clears the cache.
    pub fn forget(&mut self) {
        self.generation = self.generation.wrapping_add(1);
        if self.generation == 0 {
            self.slots.fill(CacheSlot::default());
            self.generation = 1;
        }
    }

    /// Returns the slot of `key`.
    #[inline(always)]
    fn slot(&self, key: u32) -> usize {
        // Fibonacci hashing sends neighbouring keys to distant slots.
        (key.wrapping_mul(2_654_435_769).rotate_left(15) & self.mask) as usize
    }

    /// Returns the slot of `key`, if it is not empty.
    #[inline(always)]
    fn filled_slot(&self, key: u32) -> Option<usize> {
        let slot = self.slot(key);
        (self.slots[slot].generation == self.generation).then_some(slot)
    }

    /// Returns a triangle in the slot of `key` that certainly occludes the ray; `None` if there is none.
    #[inline]
    pub fn occluder(&self, key: u32, ray: &Ray) -> Option<Occluder> {
        let slot = self.filled_slot(key)?;
        match self.ways {
            1 => self.search::<1>(slot, ray),
            2 => self.search::<2>(slot, ray),
            4 => self.search::<4>(slot, ray),
            _ => self.search::<8>(slot, ray),
        }
    }

    /// Tests the triangles of a slot.
    #[inline(always)]
    fn search<const W: usize>(&self, slot: usize, ray: &Ray) -> Option<Occluder> {
        let rows = &self.triangles[slot * W * ROWS..][..W * ROWS];
        let ids = &self.ids[slot * W..][..W];
        let extent = RayExtent::new(ray);
        let mut hits = [false; W];
        let mut t = [0.0; W];
        for w in 0..W {
            let triangle = CachedTriangle::from_rows(|row| rows[row * W + w]);
            (hits[w], t[w]) = certain(&triangle, ray, extent);
        }
        let w = hits.iter().position(|&hit| hit)?;
        Some(Occluder { t: t[w], geometry: ids[w].geometry, primitive: ids[w].primitive })
    }

    /// Stores an occluder of a ray to `key`, in place of the oldest.
    #[inline]
    pub fn keep(&mut self, key: u32, id: TriangleId, corner: Vec3, edges: [Vec3; 2]) {
        let slot = self.slot(key);
        let ids = &mut self.ids[slot * self.ways..][..self.ways];
        let state = &mut self.slots[slot];
        if state.generation != self.generation {
            // Triangles without extent occlude nothing.
            ids.fill(TriangleId::NONE);
            self.triangles[slot * self.ways * ROWS..][..self.ways * ROWS].fill(0.0);
            *state = CacheSlot { generation: self.generation, next: 0 };
        }
        if ids.contains(&id) {
            return;
        }
        let way = state.next as usize;
        state.next = (state.next + 1) & (self.ways as u32 - 1);
        ids[way] = id;
        for (row, value) in CachedTriangle::new(corner, edges).rows().into_iter().enumerate() {
            self.triangles[(slot * ROWS + row) * self.ways + way] = value;
        }
    }
}

/// A cached triangle, ready for the test.
#[derive(Clone, Copy)]
struct CachedTriangle {
    corner: Vec3,
    edges: [Vec3; 2],
    /// Largest coordinate.
    size: f32,
    /// Bound of the components of all three edges.
    edge: f32,
}

impl CachedTriangle {
    /// Prepares a triangle.
    fn new(corner: Vec3, edges: [Vec3; 2]) -> CachedTriangle {
        let largest = |v: Vec3| v.abs().max_element();
        let edge = largest(edges[0]).max(largest(edges[1]));
        CachedTriangle { corner, edges, size: largest(corner) + edge, edge: 2.0 * edge }
    }

    /// Reads a triangle; `row` returns its values.
    #[inline(always)]
    fn from_rows(row: impl Fn(usize) -> f32) -> CachedTriangle {
        let v = |i| Vec3::new(row(i), row(i + 1), row(i + 2));
        CachedTriangle { corner: v(0), edges: [v(3), v(6)], size: row(9), edge: row(10) }
    }

    /// Returns the values to be stored.
    fn rows(&self) -> [f32; ROWS] {
        let ([x, y, z], [a, b]) = (self.corner.to_array(), self.edges);
        [x, y, z, a.x, a.y, a.z, b.x, b.y, b.z, self.size, self.edge]
    }
}

/// Largest coordinates of a ray.
#[derive(Clone, Copy)]
struct RayExtent {
    origin: f32,
    direction: f32,
}

impl RayExtent {
    /// Measures a ray.
    #[inline(always)]
    fn new(ray: &Ray) -> RayExtent {
        let larger = |a: f32, b: f32| if a > b { a } else { b };
        let largest = |v: Vec3| larger(v.x.abs(), larger(v.y.abs(), v.z.abs()));
        RayExtent { origin: largest(ray.origin), direction: largest(ray.direction) }
    }
}

/// Tests if the ray hits the inside of a triangle with certainty. Returns the ray parameter, too. The test fails for
/// values that are not finite.
///
/// Paper: Möller and Trumbore, *Fast, Minimum Storage Ray/Triangle Intersection*, 1997. Every quantity is scaled by the
/// determinant and compared with its rounding error.
#[inline(always)]
fn certain(triangle: &CachedTriangle, ray: &Ray, extent: RayExtent) -> (bool, f32) {
    let [e1, e2] = triangle.edges;
    let to_corner = triangle.corner - ray.origin;
    let r = to_corner.cross(ray.direction);
    let normal = e1.cross(e2);
    let determinant = normal.dot(ray.direction);
    let sign = if determinant < 0.0 { -1.0 } else { 1.0 };
    let determinant = determinant.abs();
    let (u, v) = (sign * e2.dot(r), -sign * e1.dot(r));
    let t = sign * normal.dot(to_corner);
    let area = triangle.edge * triangle.edge;
    let length = triangle.size + extent.origin;
    let aside = MARGIN * length * extent.direction * triangle.edge;
    let turned = MARGIN * extent.direction * area;
    let along = MARGIN * length * area;
    let least = determinant - turned;
    let certain = (least > turned)
        & (u > aside)
        & (v > aside)
        & (least - u - v > 2.0 * aside)
        & (t > (determinant + turned) * ray.t_near + along)
        & (t < least * ray.t_far - along);
    (certain, t / determinant)
}

settings! {
    /// Use of the occluder cache by a method. It changes the render time and nothing in the image.
    ///
    /// Single rays use the cache, packets do not. Embree's answers in coherent packets depend, for very few rays, on
    /// the other rays of the packet. If cached rays were left out, images could change.
    pub struct ShadowSettings in "Lightcuts" {
        /// Test recent occluders before the scene with single shadow rays, for speed. `auto` does so if samples do not
        /// share cuts.
        cached: Option<bool> = None => [.named("occluder_cache")];
        /// Size of the cache.
        cache: OccluderCacheSettings = OccluderCacheSettings::default() => [group];
    }
}

impl ShadowSettings {
    /// Returns true if rays from eye samples use the cache. `shared` is true if neighbouring samples share cuts: the
    /// few single rays then have hardly any occluders in common.
    pub fn for_samples(&self, shared: bool) -> bool {
        self.cached.unwrap_or(!shared)
    }
}
