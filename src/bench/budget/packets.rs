//! Packets of rays like those of the eye pass, of one tile of pixels at a time.
//!
//! Eye rays have the positions and numbers of the eye pass's first samples. At their hits, emitters are sampled with
//! the random numbers of single vertices, and directions by the surfaces' BSDFs. Left out are further edges, pilots,
//! learned visibility, edges guided to mirrors and glass, and lobes that records leave to chains.

use base::math::{LANES, U32x16, Vec3x16, first_lanes, lanes_in};
use base::sampling::{Samplers16, cosine_hemisphere, hash};
use embree::{Hits16, Ray, Rays16};
use glam::Vec3;
use render::method::Sampling;
use transport::eye::TILE;
use world::light::Receivers16;
use world::material::{Bsdfs16, LobeSet};
use world::view::View;
use world::{Surfaces16, World, shadow};

/// Pairs of random numbers: for the position in the pixel, and for light, direction and choices at the hit.
const PLACE: u32 = 1;
const LIGHT: u32 = 2;
const DIRECTION: u32 = 3;
const CHOICE: u32 = 4;

/// Number of eye packets for each whose hits scatter rays to all sides.
const SCATTERED: usize = 4;

/// Origin of the rays.
pub struct Source<'a> {
    pub world: &'a World,
    pub view: &'a View,
    /// Samples per pixel and seed.
    pub sampling: Sampling,
    /// Number of light samples at a hit.
    pub light_samples: u32,
}

/// Packets of rays, each with the mask of its lanes.
#[derive(Default)]
pub struct Packets {
    full: Vec<(Rays16, u16)>,
    last: Rays16,
    count: usize,
}

/// Rays of a tile.
#[derive(Default)]
pub struct TileRays {
    /// Rays from the eye.
    pub eye: Packets,
    /// Segments to sampled lights, and rays that can find only the environment.
    pub shadow: Packets,
    /// Rays along directions that BSDFs sample, as far as the eye pass traces them.
    pub bsdf: Packets,
    /// Rays to all sides of the hits, which the eye pass does not trace.
    pub scattered: Packets,
}

/// Hits of a packet of eye rays.
struct EyeHits<'a> {
    found: u16,
    surfaces: &'a Surfaces16,
    bsdfs: &'a Bsdfs16<'a>,
    samplers: &'a Samplers16,
}

impl Packets {
    /// Returns the packets with the masks of their lanes.
    pub fn each(&self) -> impl Iterator<Item = (&Rays16, u16)> {
        let last = (self.count > 0).then_some((&self.last, first_lanes(self.count)));
        self.full.iter().map(|(rays, valid)| (rays, *valid)).chain(last)
    }

    /// Returns the number of rays.
    pub fn rays(&self) -> u64 {
        self.each().map(|(_, valid)| u64::from(valid.count_ones())).sum()
    }

    /// Adds a ray to the last packet.
    fn push(&mut self, ray: &Ray) {
        self.last.set(self.count, ray);
        self.count += 1;
        if self.count == LANES {
            self.full.push((std::mem::take(&mut self.last), u16::MAX));
            self.count = 0;
        }
    }
}

impl TileRays {
    /// Makes the rays of a tile.
    pub fn new(source: &Source, tile: usize) -> TileRays {
        let (window, spp) = (&source.view.window, source.sampling.spp.max(1));
        let mut samples = window
            .tile(tile, TILE)
            .flat_map(|pixel| (0..spp).map(move |sample| (window.film_pixel(pixel), sample)));
        let mut rays = TileRays::default();
        loop {
            let packet: Vec<([u32; 2], u32)> = samples.by_ref().take(LANES).collect();
            if packet.is_empty() {
                return rays;
            }
            rays.add(source, &packet);
        }
    }

    /// Adds the rays of up to sixteen samples of pixels.
    fn add(&mut self, source: &Source, samples: &[([u32; 2], u32)]) {
        let (Source { world, view, .. }, seed) = (source, source.sampling.seed);
        let mut samplers = Samplers16::default();
        let (mut pixels, mut numbers) = ([[0; 2]; LANES], [[0; 2]; LANES]);
        for (i, &([x, y], sample)) in samples.iter().enumerate() {
            samplers.seed[i] = hash(hash(x, y), seed);
            samplers.index[i] = sample;
            (pixels[i], numbers[i]) = ([x, y], [seed, sample]);
        }
        let mut rays = Rays16::default();
        view.sample_rays16(&pixels, &samplers.point(PLACE), &numbers, &mut rays);
        if world.scene.hides_emitters {
            (0..samples.len()).for_each(|i| rays.set(i, &world.behind_hidden(rays.get(i))));
        }
        let valid = first_lanes(samples.len());
        let mut hits = Hits16::default();
        let found = world.accel.closest_hit16(&rays, valid, true, &mut hits);
        self.eye.full.push((rays.clone(), valid));
        if found == 0 {
            return;
        }
        hits.repeat(found.trailing_zeros() as usize, !found);
        let mut surfaces = world.surfaces(&hits);
        let (directions, cone) = (rays.directions(), view.cone(source.sampling.spp));
        world.cover(&mut surfaces, &directions, found, |_| cone);
        let (mut out, mut normal) = (Vec3x16::default(), Vec3x16::default());
        (0..LANES).for_each(|i| out.set(i, surfaces.frame(i).to_local(-directions.get(i))));
        let bsdfs = world.bsdfs(&surfaces, out);
        for i in 0..LANES {
            let towards = surfaces.shading_normal.get(i) * if out.z[i] < 0.0 { -1.0 } else { 1.0 };
            normal.set(i, if bsdfs.lane(i).scatters_across() { Vec3::ZERO } else { towards });
        }
        let at = Receivers16 { position: &surfaces.position, normal: &normal, learned: None };
        let hit = EyeHits { found, surfaces: &surfaces, bsdfs: &bsdfs, samplers: &samplers };
        self.add_shadow_rays(source, &hit, at);
        self.add_bsdf_rays(world, &hit);
        if self.eye.full.len().is_multiple_of(SCATTERED) {
            self.add_scattered_rays(&hit);
        }
    }

    /// Adds the segments to lights that are sampled at the hits.
    fn add_shadow_rays(&mut self, source: &Source, hit: &EyeHits, at: Receivers16) {
        let lit = hit.found & hit.bsdfs.smooth();
        for sample in 0..source.light_samples {
            let index: U32x16 =
                hit.samplers.index.map(|i| i.wrapping_mul(source.light_samples).wrapping_add(sample));
            let samplers = Samplers16 { index, ..*hit.samplers };
            let (choices, places) = (samplers.number(CHOICE), samplers.point(LIGHT));
            let lights = source.world.emitters.sample_direct(at, &choices, &places, lit);
            let useful = lit & lights.useful();
            let (mut wi, mut segments) = (Vec3x16::default(), Rays16::default());
            for i in 0..LANES {
                let (position, normal) = (hit.surfaces.position.get(i), hit.surfaces.normal.get(i));
                let (direction, distance) = (lights.direction.get(i), lights.distance[i]);
                wi.set(i, hit.surfaces.frame(i).to_local(direction));
                let end = position + direction * distance;
                let ray = match distance < f32::INFINITY {
                    true => shadow::segment(position, normal, end, lights.normal.get(i)),
                    false => shadow::ray_from(position, normal, direction),
                };
                segments.set(i, &ray);
            }
            let (value, _) = hit.bsdfs.eval_pdf(&wi, useful);
            let reflects = |i: &usize| value.get(*i) != Vec3::ZERO;
            let wanted = lanes_in(useful).filter(reflects).fold(0, |mask, i| mask | 1 << i);
            if wanted != 0 {
                self.shadow.full.push((segments, wanted));
            }
        }
    }

    /// Adds the rays that continue from the hits. Those that can find only the environment are shadow rays.
    fn add_bsdf_rays(&mut self, world: &World, hit: &EyeHits) {
        let (choices, places) = (hit.samplers.point(CHOICE).y, hit.samplers.point(DIRECTION));
        let samples = hit.bsdfs.sample(&choices, &places, hit.found);
        let going_on = hit.found & samples.going_on();
        let mut rays = Rays16::default();
        for i in 0..LANES {
            let direction = hit.surfaces.frame(i).to_world(samples.wi.get(i));
            let (position, normal) = (hit.surfaces.position.get(i), hit.surfaces.normal.get(i));
            rays.set(i, &shadow::ray_from(position, normal, direction));
        }
        let (origins, directions) = (rays.origins(), rays.directions());
        let mut met = world.emitters.may_be_met(&origins, &directions);
        if world.specular.bends_light() {
            met |= world.specular.may_be_met(&origins, &directions);
        }
        for i in lanes_in(going_on) {
            let bsdf = hit.bsdfs.lane(i);
            let is_chain = bsdf.has_delta() || bsdf.sharp_lobes() != LobeSet::default();
            if is_chain || met & 1 << i != 0 {
                self.bsdf.push(&rays.get(i));
            } else if world.emitters.environment.is_some() {
                self.shadow.push(&rays.get(i));
            }
        }
    }

    /// Adds a ray from every hit, with the distribution of a diffuse surface.
    fn add_scattered_rays(&mut self, hit: &EyeHits) {
        let places = hit.samplers.point(DIRECTION);
        for i in lanes_in(hit.found) {
            let mut direction = cosine_hemisphere(places.get(i));
            direction.z *= if hit.bsdfs.wo(i).z < 0.0 { -1.0 } else { 1.0 };
            let direction = hit.surfaces.frame(i).to_world(direction);
            let (position, normal) = (hit.surfaces.position.get(i), hit.surfaces.normal.get(i));
            self.scattered.push(&shadow::ray_from(position, normal, direction));
        }
    }
}
