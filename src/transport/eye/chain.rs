//! Eye rays through mirrors and glass to the surfaces that scatter light into a pixel.
//!
//! Paper: Herzog et al. 2009, section 4. The eye pass follows specular chains; the lightcut or the cache shades the
//! smoothly scattering surface at their ends.
//!
//! Both branches at glass are followed, so that the image has no noise from choosing one. Branches of small throughput
//! are subject to Russian roulette.
//!
//! Deviations: sharp rough lobes are followed too, in one sampled direction per sample. Virtual lights would be
//! individually visible in them, and cannot represent reflections of such lobes in each other. This adds noise, which
//! falls with the samples per pixel. Emitters are sampled for the lobe as well (`sharp`).

use super::counts::EyeCounts;
use super::sharp::{LobeSample, Sharp};
use base::math::{Cone, Rgb};
use base::sampling::Sampler;
use embree::Ray;
use glam::Vec3;
use world::material::{Bsdf, BsdfSample};
use world::shadow;
use world::{Interior, Surface, World};

/// Maximum number of pending branches. Each bounce adds at most two, one of which is followed at once.
const PENDING: usize = 32;

/// Throughput below which a branch survives only with probability throughput / threshold.
const ROULETTE_THROUGHPUT: f32 = 0.05;

/// Number of edges, including those straight through sheets, from which on the survival probability is limited.
/// Otherwise chains without absorption would not end.
const MANY_EDGES: u32 = 64;

/// Maximum survival probability of a branch after [`MANY_EDGES`].
const MAX_SURVIVAL: f32 = 0.9;

/// End of an edge of a chain.
// Values are passed on at once and never stored.
#[expect(clippy::large_enum_variant)]
pub enum EdgeEnd<'w> {
    /// Surface.
    Surface(ChainVertex<'w>),
    /// No surface.
    Nothing {
        /// Share of radiance from there that reaches the eye.
        throughput: Rgb,
        /// True if the eye ray itself arrives there, through gaps in surfaces at most.
        on_eye_ray: bool,
    },
}

/// Surface point that a chain has hit.
#[derive(Clone, Copy, Debug)]
pub struct ChainVertex<'w> {
    /// Surface.
    pub surface: Surface,
    /// BSDF without the sharp rough lobes that the chain itself follows.
    pub bsdf: Bsdf<'w>,
    /// Unit vector back along the ray.
    pub out: Vec3,
    /// Share of the radiance leaving along `out` that reaches the eye.
    pub throughput: Rgb,
    /// Number of edges from the eye to the surface.
    pub depth: u32,
    /// Total length of these edges.
    pub distance: f32,
}

/// Lobes that chains follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Follow {
    /// Mirrors and smooth glass.
    Delta,
    /// Sharp lobes too, with the light of emitters that they reflect.
    DeltaAndSharp,
}

struct ChainBranch {
    ray: Ray,
    throughput: Rgb,
    eta_sq: f32,
    /// Number of edges.
    depth: u32,
    /// True if the chain has passed nothing but gaps in surfaces.
    on_eye_ray: bool,
    /// Length of the chain up to the ray's origin.
    distance: f32,
    /// Start of the ray, if a sharp lobe sampled it.
    start: Option<LobeSample>,
    /// Interior in which the ray starts.
    interior: Interior,
}

impl ChainBranch {
    /// Returns the radiance of the environment that a ray sees which hits nothing, by MIS weight; `None` if there is
    /// none.
    fn radiance_of_environment(&self, world: &World) -> Option<Rgb> {
        let scene = &world.scene;
        let is_hidden = self.depth == 1 && scene.hides_emitters || self.on_eye_ray && scene.hides_background;
        let environment = world.emitters.environment.as_ref().filter(|_| !is_hidden)?;
        let direction = self.ray.direction;
        Some(match self.start {
            Some(start) => {
                let (radiance, pdf) = environment.radiance_pdf(direction);
                radiance * start.weight_of_environment(world, pdf)
            }
            None => environment.radiance(direction),
        })
    }

    /// Returns the light at the eye that the surface hit emits, by MIS weight. The share `passed` of it reaches the
    /// beginning of the edge.
    fn light_of(&self, world: &World, surface: &Surface, passed: Rgb) -> Rgb {
        let light = world.emitted(surface, -self.ray.direction);
        if light == Rgb::ZERO {
            return light;
        }
        let weight = |start: LobeSample| start.weight_of_area(world, surface, self.ray.direction);
        self.throughput * passed * light * self.start.map_or(1.0, weight)
    }

    /// Returns the throughput of a branch continued by `lobe`; `None` if Russian roulette ends it.
    fn surviving(&self, lobe: &BsdfSample, sampler: &mut Sampler) -> Option<Rgb> {
        let throughput = self.throughput * lobe.weight;
        let carried = throughput.max_element() * (self.eta_sq * lobe.eta * lobe.eta);
        let limit = if self.depth >= MANY_EDGES { MAX_SURVIVAL } else { 1.0 };
        let survival = (carried / ROULETTE_THROUGHPUT).min(limit);
        if survival < 1.0 {
            return (sampler.next_1d() < survival).then_some(throughput / survival);
        }
        Some(throughput)
    }

    /// Returns the branch continued by `lobe` from the surface that it has hit. Throughput and start stay as they are.
    fn along(&self, world: &World, at: &ChainVertex, lobe: &BsdfSample) -> ChainBranch {
        let surface = &at.surface;
        let direction = surface.frame.to_world(lobe.wi);
        ChainBranch {
            ray: shadow::ray_from(surface.position, surface.normal, direction),
            throughput: self.throughput,
            eta_sq: self.eta_sq * lobe.eta * lobe.eta,
            depth: self.depth + 1,
            on_eye_ray: self.on_eye_ray && lobe.straight && at.bsdf.passes_gaps_alone(),
            distance: at.distance,
            start: self.start,
            interior: world.interior_after(self.interior, surface, direction, lobe.straight),
        }
    }
}

/// Branches of a chain that are still to be followed, the first of each surface before all others.
struct ChainBranches {
    current: Option<ChainBranch>,
    pending: [Option<ChainBranch>; PENDING],
    /// Number of pending branches.
    waiting: usize,
}

impl ChainBranches {
    /// Begins a chain with an eye ray.
    fn new(ray: Ray) -> ChainBranches {
        let (throughput, eta_sq, depth, distance) = (Rgb::ONE, 1.0, 1, 0.0);
        let (on_eye_ray, start, interior) = (true, None, Interior::NONE);
        let first = ChainBranch { ray, throughput, eta_sq, depth, on_eye_ray, distance, start, interior };
        ChainBranches { current: Some(first), pending: [const { None }; PENDING], waiting: 0 }
    }

    /// Removes the next branch.
    fn next(&mut self) -> Option<ChainBranch> {
        self.current.take().or_else(|| {
            self.waiting = self.waiting.checked_sub(1)?;
            self.pending[self.waiting].take()
        })
    }

    /// Adds a branch; returns false if there is no room for it.
    fn push(&mut self, branch: ChainBranch) -> bool {
        if self.current.is_none() {
            self.current = Some(branch);
        } else if self.waiting < PENDING {
            self.pending[self.waiting] = Some(branch);
            self.waiting += 1;
        } else {
            return false;
        }
        true
    }
}

/// Tracer of the chains of eye rays.
#[derive(Clone, Copy)]
pub struct ChainTracer<'w> {
    /// Scene.
    pub world: &'w World,
    /// Cone around the rays.
    pub cone: Cone,
    /// Maximum number of edges.
    pub max_depth: u32,
    /// Lobes that the chains follow.
    pub follow: Follow,
}

impl<'w> ChainTracer<'w> {
    /// Follows `ray` and calls `visit` for the end of every edge. Returns the radiance emitted into the ray by surfaces
    /// and the environment, directly or along specular chains. The result is incomplete if chains do not follow sharp
    /// lobes.
    pub fn trace(
        &self,
        ray: Ray,
        sampler: &mut Sampler,
        counts: &mut EyeCounts,
        mut visit: impl FnMut(EdgeEnd<'w>),
    ) -> Rgb {
        let ChainTracer { world, cone, .. } = *self;
        let (mut emitted, mut branches) = (Rgb::ZERO, ChainBranches::new(ray));
        while let Some(mut branch) = branches.next() {
            counts.rays += 1;
            let out = -branch.ray.direction;
            let Some(mut surface) = world.intersect(&branch.ray) else {
                let ChainBranch { throughput, on_eye_ray, .. } = branch;
                visit(EdgeEnd::Nothing { throughput, on_eye_ray });
                if let Some(radiance) = branch.radiance_of_environment(world) {
                    emitted += branch.throughput * radiance;
                }
                continue;
            };
            let distance = branch.distance + surface.t;
            surface.footprint = branch.ray.direction * cone.width_at(distance);
            let [of_emission, of_rest] = match world.absorbs() {
                true => world.edge_shares(branch.interior, &surface, branch.ray.direction, branch.ray.t_near),
                false => [Rgb::ONE; 2],
            };
            emitted += branch.light_of(world, &surface, of_emission);
            branch.throughput *= of_rest;
            let whole = world.bsdf(&surface);
            let (bsdf, sharp) = match whole.split_sharp_lobes() {
                Some((bsdf, sharp)) if self.follow == Follow::DeltaAndSharp => (bsdf, Some(sharp)),
                _ => (whole, None),
            };
            let ChainBranch { throughput, depth, .. } = branch;
            let vertex = ChainVertex { surface, bsdf, out, throughput, depth, distance };
            visit(EdgeEnd::Surface(vertex));
            if branch.depth >= self.max_depth || !(bsdf.has_delta() || sharp.is_some()) {
                continue;
            }
            let (wo, sheets) = (surface.frame.to_local(out), self.max_depth - branch.depth - 1);
            let lobes = bsdf.delta_lobes(wo);
            let sampled = sharp.and_then(|sharp| {
                emitted += branch.throughput
                    * Sharp { world, surface: &surface, lobe: &sharp, wo, sheets }.reflected(sampler, counts);
                sharp.sample(wo, sampler.next_1d(), sampler.next_2d())
            });
            for lobe in [lobes.refraction, lobes.reflection, sampled].into_iter().flatten() {
                let Some(throughput) = branch.surviving(&lobe, sampler) else { continue };
                // Shadow rays pass sheets too, so an edge through a sheet keeps its start.
                let start = match lobe.straight {
                    true => branch.start,
                    false => {
                        sharp.filter(|_| !lobe.delta).map(|by| LobeSample::new(&surface, &by, wo, lobe.pdf))
                    }
                };
                let next = branch.along(world, &vertex, &lobe);
                counts.overflow += u64::from(!branches.push(ChainBranch { throughput, start, ..next }));
            }
        }
        emitted
    }
}
