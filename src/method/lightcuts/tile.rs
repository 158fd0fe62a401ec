//! A tile of the picture: eye samples gathered block by block, grouped by likeness, and lit.
//!
//! Blocks are aligned to the film and always computed whole, so a crop repeats the whole picture's pixels.

use super::render::{Scenery, Settings};
use crate::compensation::samples::{NearCounts, NearLight};
use crate::eye::{ChainCounts, EyeSample, eye_sampler, trace};
use crate::lightcut::{
    CoherenceLimit, CutCounts, Lightcut, MIN_SHARED, PacketLightcut, PacketSum, Receiver, ReceiverPacket,
};
use crate::math::{LANES, Rgb};
use crate::shadow::{Engine, ShadowCounts};
use crate::world::World;

/// Pixels along a tile's edge.
pub const TILE: u32 = 16;
/// Pixels along the edge of a block, within which eye samples may share a cut.
pub const BLOCK: u32 = 4;

/// A thread's buffers.
pub struct Workspace<'w> {
    single: Lightcut,
    /// Shadow rays; an occluder cache lives for a tile.
    shadows: Engine<'w>,
    group: PacketLightcut,
    points: ReceiverPacket<'w>,
    near: NearLight,
    samples: Vec<Lit<'w>>,
    members: Vec<usize>,
    values: Vec<Rgb>,
    cut_sizes: Vec<f32>,
}

impl<'w> Workspace<'w> {
    /// For any number of tiles.
    pub fn new(world: &'w World, settings: &Settings) -> Workspace<'w> {
        let shadows = settings.shadows;
        Workspace {
            single: Lightcut::new(),
            shadows: Engine::with(world, shadows.for_samples(settings.share), shadows.cache),
            group: PacketLightcut::new(),
            points: ReceiverPacket::new(),
            near: NearLight::default(),
            samples: Vec::new(),
            members: Vec::new(),
            values: Vec::new(),
            cut_sizes: Vec::new(),
        }
    }
}

/// An eye sample waiting for light.
struct Lit<'w> {
    reflector: Receiver<'w>,
    throughput: Rgb,
    /// Which pixel and sample of the block.
    place: usize,
    done: bool,
}

/// A tile's pixels, in rows over the part of it that lies in the window, and what was counted for them.
#[derive(Default)]
pub struct Tile {
    pub radiance: Vec<Rgb>,
    pub cut_sizes: Vec<f32>,
    pub counts: CutCounts,
    pub shadows: ShadowCounts,
    pub near: NearCounts,
    pub chains: ChainCounts,
    pub nonfinite: u64,
    pub done: bool,
}

impl Tile {
    /// Renders the tile whose first film pixel is `corner` (a multiple of [`TILE`]).
    pub fn render<'w>(&mut self, s: &Scenery<'w>, corner: [u32; 2], work: &mut Workspace<'w>) {
        work.single.counts = CutCounts::default();
        work.group.counts = CutCounts::default();
        work.shadows.begin_chunk();
        let area = s.tile_area(corner);
        let size = (area.width * area.height) as usize;
        self.radiance = vec![Rgb::ZERO; size];
        self.cut_sizes = vec![0.0; size];
        let spp = s.settings.spp.max(1);
        for block_y in (corner[1]..corner[1] + TILE).step_by(BLOCK as usize) {
            for block_x in (corner[0]..corner[0] + TILE).step_by(BLOCK as usize) {
                if !area.meets([block_x, block_y], BLOCK) {
                    continue;
                }
                self.look(s, [block_x, block_y], spp, work);
                light(s, work);
                self.store(&area, [block_x, block_y], spp, work);
            }
        }
        self.counts += work.single.counts;
        self.counts += work.group.counts;
        self.shadows = work.shadows.take_counts();
        self.near = work.near.take_counts();
        self.done = true;
    }

    /// Traces the eye rays of a block.
    fn look<'w>(&mut self, s: &Scenery<'w>, block: [u32; 2], spp: u32, work: &mut Workspace<'w>) {
        work.samples.clear();
        work.values.clear();
        for (x, y) in block_pixels(block) {
            for sample in 0..spp {
                if x >= s.view.window.film[0] || y >= s.view.window.film[1] {
                    work.values.push(Rgb::ZERO);
                    continue;
                }
                let (mut sampler, jitter) = eye_sampler([x, y], s.settings.seed, sample, spp);
                let ray = s.view.primary_ray([x, y], jitter);
                let place = work.values.len();
                let visit = |eye: EyeSample<'w>| {
                    if eye.depth < s.max_depth {
                        let surface = &eye.surface;
                        let reflector = Receiver::new(
                            surface.position,
                            surface.normal,
                            &surface.frame,
                            eye.bsdf,
                            eye.out,
                        );
                        work.samples.push(Lit { reflector, throughput: eye.throughput, place, done: false });
                    }
                };
                let emitted = trace(s.world, ray, s.max_depth, &mut sampler, &mut self.chains, visit);
                work.values.push(emitted);
            }
        }
        work.cut_sizes.clear();
        work.cut_sizes.resize(work.values.len(), 0.0);
    }

    /// Averages the samples of the block's pixels that are in `area`.
    fn store(&mut self, area: &Area, block: [u32; 2], spp: u32, work: &Workspace) {
        let spp = spp as usize;
        for (i, (x, y)) in block_pixels(block).enumerate() {
            let Some(at) = area.index(x, y) else { continue };
            let samples = i * spp..(i + 1) * spp;
            let mut sum = Rgb::ZERO;
            for value in &work.values[samples.clone()] {
                if value.is_finite() {
                    sum += *value;
                } else {
                    self.nonfinite += 1;
                }
            }
            self.radiance[at] = sum / spp as f32;
            self.cut_sizes[at] = work.cut_sizes[samples].iter().sum::<f32>() / spp as f32;
        }
    }
}

/// Adds the light that the eye samples of a block reflect.
fn light<'w>(s: &Scenery<'w>, work: &mut Workspace<'w>) {
    for first in 0..work.samples.len() {
        if work.samples[first].done {
            continue;
        }
        work.members.clear();
        let seed = &work.samples[first].reflector;
        for (i, sample) in work.samples.iter().enumerate().skip(first) {
            if !sample.done
                && work.members.len() < LANES
                && CoherenceLimit::CLOSE.holds(s.world.diagonal, seed.place(), sample.reflector.place())
            {
                work.members.push(i);
            }
        }
        let cut = &s.settings.cut;
        if !s.settings.share || work.members.len() < MIN_SHARED {
            let sample = &mut work.samples[first];
            sample.done = true;
            let reflector = &sample.reflector;
            let own = work.single.gather(&s.transfer, &work.shadows, reflector, cut);
            let (mut sum, size) = (PacketSum::default(), own.clusters.len());
            (sum.radiance[0], sum.limits[0]) = (own.radiance, own.limit);
            if let Some(c) = &s.compensation {
                work.points.set([*reflector]);
                work.near.begin(c, cut.origin, &work.points, &mut sum);
            }
            work.values[sample.place] += sample.throughput * sum.radiance[0];
            work.cut_sizes[sample.place] += size as f32;
            continue;
        }
        work.points.set(work.members.iter().map(|&i| work.samples[i].reflector));
        let mut shared = work.group.gather(&s.transfer, &work.shadows, &work.points, cut);
        if let Some(c) = &s.compensation {
            work.near.begin(c, cut.origin, &work.points, &mut shared.sum);
        }
        for (&i, radiance) in work.members.iter().zip(shared.sum.radiance) {
            let sample = &mut work.samples[i];
            sample.done = true;
            work.values[sample.place] += sample.throughput * radiance;
            work.cut_sizes[sample.place] += shared.clusters.len() as f32;
        }
    }
}

impl Scenery<'_> {
    /// The part of a tile inside the window, in film coordinates.
    pub fn tile_area(&self, corner: [u32; 2]) -> Area {
        let w = &self.view.window;
        let low = [0, 1].map(|i| corner[i].max(w.offset[i]));
        let high =
            [(corner[0] + TILE).min(w.offset[0] + w.width), (corner[1] + TILE).min(w.offset[1] + w.height)];
        Area { low, width: high[0].saturating_sub(low[0]), height: high[1].saturating_sub(low[1]) }
    }
}

/// A rectangle of film pixels.
pub struct Area {
    pub low: [u32; 2],
    pub width: u32,
    pub height: u32,
}

impl Area {
    /// Place of a pixel in rows, if it is inside.
    fn index(&self, x: u32, y: u32) -> Option<usize> {
        let (dx, dy) = (x.wrapping_sub(self.low[0]), y.wrapping_sub(self.low[1]));
        (dx < self.width && dy < self.height).then(|| (dy * self.width + dx) as usize)
    }

    /// Whether a square of the given edge at `corner` has a pixel in common with it.
    fn meets(&self, corner: [u32; 2], edge: u32) -> bool {
        let overlaps =
            |i: usize, extent: u32| corner[i] < self.low[i] + extent && self.low[i] < corner[i] + edge;
        overlaps(0, self.width) && overlaps(1, self.height)
    }

    /// Film coordinates of all pixels, in rows.
    pub fn pixels(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let ([x, y], [w, h]) = (self.low, [self.width, self.height]);
        (y..y + h).flat_map(move |y| (x..x + w).map(move |x| [x, y]))
    }
}

/// Film coordinates of a block's pixels, in rows; some may lie beyond the film.
fn block_pixels([x, y]: [u32; 2]) -> impl Iterator<Item = (u32, u32)> {
    (y..y + BLOCK).flat_map(move |y| (x..x + BLOCK).map(move |x| (x, y)))
}
