//! Light that clamping takes from virtual lights close to a record, found again by short rays.
//!
//! Paper: Kollig and Keller, *Illumination in the Presence of Weak Singularities*, 2004; Herzog et al. 2009,
//! section 6.3 and Eq. 13. Virtual lights count with min(G, b) of their geometry term G = cosθ_x cosθ_y / r²; the
//! rest, max(0, G - b), is integrated over directions instead: E = π/N Σ max(0, 1 - b/G) L over N directions
//! distributed by the cosine. G exceeds b only where r < b^(-1/2), so rays end there and are cheap.
//!
//! Deviations: b comes from the mean intensity of all indirect virtual lights, so one that is much brighter than
//! the mean may give more than the limit. Every record is compensated, also where no light of its cut happens to
//! be clamped: the two parts complement each other on average only. All records use the same directions, in frames
//! of their own, so that their errors are alike and not seen between them. Light is looked up at up to `LOOKUPS`
//! of the points that rays meet, chosen in proportion to what they may give, and itself lacks what is clamped.
//! Series (light that lobes reflect) are clamped alike and not compensated. Where a longest path is set, paths
//! over these points may have an edge more.
//!
//! Units: b in 1/m².

use super::compute::Source;
use super::gather::Gathered;
use super::wave::Pick;
use crate::embree::{Hit, Hits16, Ray, Rays16};
use crate::eye::EyeSamples;
use crate::light_tree::LightTrees;
use crate::lightcut::group::{GroupLightcut, LANES, LEAST_SHARED, Likeness, Points, group_alike};
use crate::lightcut::{CutSettings, Lightcut, Reflector};
use crate::math::{Frame, Rgb, lanes_in, luminance};
use crate::sampling::{cosine_hemisphere, owen_sobol_2d};
use crate::shadow;
use crate::vpl::Origin;
use crate::world::{Surface, World};
use glam::Vec3;
use std::f32::consts::{FRAC_1_PI, PI};

/// Rays from each record; a multiple of sixteen.
const RAYS: u32 = 32;

/// Most lightcuts at points that rays of one record meet.
const LOOKUPS: usize = 2;

/// A record's light may change by less than about this without lightcuts to find it.
const NEGLIGIBLE: f32 = 5e-3;

/// Error bound of those lightcuts; their share in a record's light is small.
const EPSILON: f32 = 0.1;

/// Most clusters in those lightcuts, as a fraction of a record's.
const CUT_FRACTION: usize = 8;

/// Seed of the directions.
const SEED: u32 = 0x5eed;

/// How the contribution of an indirect virtual light is limited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clamp {
    /// Its luminance is at most this.
    Luminance(f32),
    /// Its geometry term is at most this.
    Geometry(f32),
}

impl Clamp {
    /// Share of a contribution that is kept, of the given luminance and geometry term.
    #[inline]
    pub fn kept(self, luminance: f32, geometry: f32) -> f32 {
        let (value, limit) = match self {
            Clamp::Luminance(limit) => (luminance, limit),
            Clamp::Geometry(limit) => (geometry, limit),
        };
        if value > limit { limit / value } else { 1.0 }
    }

    /// The largest geometry term, infinite if that is not what is limited.
    pub fn bound(self) -> f32 {
        match self {
            Clamp::Luminance(_) => f32::INFINITY,
            Clamp::Geometry(bound) => bound,
        }
    }
}

/// What is common to the compensation of all records.
#[derive(Clone, Copy, Debug)]
pub struct Compensation {
    mean_intensity: f32,
}

/// A point that a ray met, and what light from it would weigh.
#[derive(Clone, Copy)]
struct Near {
    surface: Surface,
    distance: f32,
    /// Unit shading normal on the side of the record.
    normal: Vec3,
    /// Radiance towards the record for an irradiance of 1, times the weight.
    weight: Rgb,
}

/// A point chosen to look up its light.
#[derive(Clone, Copy)]
struct Lookup {
    /// Record of the task.
    record: usize,
    near: Near,
    /// Irradiance at the record for an irradiance of 1 at the point.
    factor: Rgb,
}

/// What a thread computes cuts with.
pub struct Cutters<'a> {
    /// For one point.
    pub single: &'a mut Lightcut,
    /// For several.
    pub group: &'a mut GroupLightcut,
    /// The several.
    pub points: &'a mut Points<'static>,
}

impl Compensation {
    /// For all records lit by `trees`.
    pub fn new(trees: &LightTrees) -> Compensation {
        Compensation { mean_intensity: trees.mean_intensity(Origin::Indirect) }
    }

    /// The bound of the geometry term that keeps a light of mean intensity below the luminance `limit`.
    pub fn clamp(&self, limit: f32) -> Clamp {
        Clamp::Geometry(if self.mean_intensity > 0.0 { limit / self.mean_intensity } else { f32::INFINITY })
    }

    /// Adds what virtual lights lack whose geometry terms were limited, to what the records of a task gather of
    /// indirect light.
    pub fn add(
        &self,
        source: &Source,
        mut cutters: Cutters,
        samples: &EyeSamples,
        task: &[Pick],
        gathered: &mut [&mut Gathered],
    ) {
        let mut lookups = Vec::new();
        for (record, (pick, gathered)) in task.iter().zip(gathered.iter()).enumerate() {
            let bound = gathered.bound;
            if pick.lacks[1] && bound > 0.0 && bound.is_finite() {
                choose(&self.near(source, samples, pick.sample, bound), record, &mut lookups);
            }
        }
        // What records met on one wall, then what they met on another: neighbours look up light side by side.
        lookups.sort_by_key(|lookup| (lookup.near.surface.mesh, lookup.record));
        let place = |lookup: &Lookup| (lookup.near.surface.position, lookup.near.normal);
        for group in group_alike(Likeness::CLOSE, lookups, LANES, source.world.diagonal, place, |_, _| true) {
            let irradiance = cutters.irradiance(source, &group);
            for (lookup, irradiance) in group.iter().zip(irradiance) {
                let found = lookup.factor * irradiance;
                if found.is_finite() {
                    let normal = samples.points[task[lookup.record].sample as usize].normal;
                    gathered[lookup.record].compensate(normal, found, lookup.near.distance);
                }
            }
        }
    }

    /// What rays from the record meet where the geometry term exceeds `bound`.
    fn near(&self, source: &Source, samples: &EyeSamples, sample: u32, bound: f32) -> Vec<Near> {
        let world = source.world;
        let point = &samples.points[sample as usize];
        let geometric_normal = samples.surfaces[sample as usize].geometric_normal;
        let frame = Frame::from_normal(point.normal);
        let t_far = bound.sqrt().recip();
        let filtered = |cos: f32| match point.sharing.coat() {
            0 => 1.0,
            coat => world.materials.coat_transmittance(coat, cos),
        };
        let mut near = Vec::new();
        for packet in 0..RAYS / 16 {
            let mut rays = Rays16::default();
            let mut locals = [Vec3::Z; 16];
            for (lane, local) in locals.iter_mut().enumerate() {
                *local = cosine_hemisphere(owen_sobol_2d(packet * 16 + lane as u32, SEED));
                let direction = frame.to_world(*local);
                rays.set(
                    lane,
                    &Ray { t_far, ..shadow::ray_from(point.position, geometric_normal, direction) },
                );
            }
            let mut hits = Hits16::default();
            let met = world.accel.closest_hit16(&rays, u16::MAX, true, &mut hits);
            for lane in lanes_in(met) {
                let hit = Hit {
                    t: hits.t[lane],
                    u: hits.u[lane],
                    v: hits.v[lane],
                    geometry: hits.geometry[lane],
                    primitive: hits.primitive[lane],
                };
                let cos = locals[lane].z;
                let found = weighed(world, &hit, frame.to_world(locals[lane]), cos, bound);
                near.extend(found.map(|n| Near { weight: n.weight * filtered(cos), ..n }));
            }
        }
        near
    }
}

/// Chooses at which of the points to look up light, and with what factor it counts.
fn choose(near: &[Near], record: usize, lookups: &mut Vec<Lookup>) {
    let total: f32 = near.iter().map(|n| luminance(n.weight)).sum();
    // As if the points met were lit as the record is.
    if total < NEGLIGIBLE * RAYS as f32 * FRAC_1_PI {
        return;
    }
    // Evenly spaced along the sum of the weights: each choice stands for an equal share of it.
    let share = total / LOOKUPS as f32;
    let (mut reached, mut next) = (0.0, 0.5 * share);
    for &near in near {
        let weight = luminance(near.weight);
        reached += weight;
        let mut chosen = 0.0;
        while next < reached {
            chosen += share;
            next += share;
        }
        if chosen > 0.0 {
            let factor = near.weight * (chosen / weight * PI / RAYS as f32);
            lookups.push(Lookup { record, near, factor });
        }
    }
}

impl Cutters<'_> {
    /// Irradiance at points met, on the side of the records.
    fn irradiance(&mut self, source: &Source, group: &[Lookup]) -> [Rgb; LANES] {
        let settings = CutSettings {
            epsilon: EPSILON,
            max_cut: source.settings.cut.max_cut.div_ceil(CUT_FRACTION),
            ..CutSettings::default()
        };
        let collectors = group.iter().map(|lookup| {
            let s = &lookup.near.surface;
            Reflector::collector(s.position, s.normal, &Frame::from_normal(lookup.near.normal))
        });
        let (trees, transfer, world) = (source.trees, &source.transfer, source.world);
        let mut irradiance = [Rgb::ZERO; LANES];
        if group.len() < LEAST_SHARED {
            for (irradiance, collector) in irradiance.iter_mut().zip(collectors) {
                *irradiance = self.single.gather(trees, transfer, world, &collector, &settings);
            }
        } else {
            self.points.set(collectors);
            self.group.gather(trees, transfer, world, self.points, &settings, &mut irradiance);
        }
        irradiance
    }
}

/// The point hit, unless it weighs nothing.
fn weighed(world: &World, hit: &Hit, direction: Vec3, cos: f32, bound: f32) -> Option<Near> {
    let surface = world.surface(hit);
    let out = surface.frame.to_local(-direction);
    let distance = hit.t;
    // Virtual lights radiate by the cosine to the geometric normal.
    let geometry = cos * surface.normal.dot(direction).abs() / (distance * distance);
    if !(geometry > bound) {
        return None;
    }
    let weight = world.bsdf(&surface).diffuse_albedo(out) * ((1.0 - bound / geometry) * FRAC_1_PI);
    let towards = surface.frame.normal.dot(direction) < 0.0;
    let normal = if towards { surface.frame.normal } else { -surface.frame.normal };
    let near = Near { surface, distance, normal, weight };
    (luminance(weight) > 0.0 && weight.is_finite()).then_some(near)
}
