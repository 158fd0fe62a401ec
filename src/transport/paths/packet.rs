//! State of paths in flight: sixteen paths, as a structure of arrays.

use base::math::{Cone, F32x16, LANES, Rgb, U32x16, Vec3x16, lanes_in, mask_of};
use base::sampling::Samplers16;
use embree::Rays16;
use world::Interior;

/// Light that a path finds. Paths without [`super::PathPolicy::STOPS_AT_DIFFUSE`] are `Bent` from the start, and `Full`
/// behind lobes that are not narrow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(super) enum PathStage {
    /// Light of surfaces seen by chains.
    Chain,
    /// Light that reaches the chain end from emitters, or by delta and glossy lobes of the next surface.
    Scattered,
    /// All light, behind such a delta lobe and no others.
    Bent,
    /// All light, behind other lobes.
    Full,
}

/// Sixteen paths in flight.
#[derive(Clone, Debug, Default)]
pub(super) struct Packet {
    /// Edges to be traced.
    pub rays: Rays16,
    /// Share of the radiance reflected at the edge's end that reaches the eye.
    pub throughput: Vec3x16,
    /// Share of the radiance emitted at the edge's end that reaches the eye.
    pub emission_throughput: Vec3x16,
    /// Factor that undoes the scaling of radiance inside dense media, for Russian roulette.
    pub eta_sq: F32x16,
    /// Shading normals at the edges' starts, on the side of arrival; zero if the surface scatters to both sides.
    pub normal: Vec3x16,
    /// Densities of the edges' directions; infinite if light sampling could not have chosen them.
    pub pdf: F32x16,
    /// Numbers of light samples at the edges' starts.
    pub light_samples: F32x16,
    /// Random number generators.
    pub samplers: Samplers16,
    /// Index of the result that each path contributes to.
    pub slot: U32x16,
    /// Lengths of the chains up to the edges' starts; of the whole chains for paths that have left them.
    pub distance: F32x16,
    /// Hashes of the surfaces and lobes along the chains.
    pub path_class: U32x16,
    /// Values of [`PathStage`].
    pub stage: U32x16,
    /// Numbers of gaps that light has passed straight.
    pub gaps: U32x16,
    /// Cones around the edges.
    pub cones: [Cone; LANES],
    /// Interiors in which the edges start.
    pub interior: [Interior; LANES],
}

impl Packet {
    /// Returns paths along eye rays, with results from index `slot` on.
    pub fn new(rays: Rays16, samplers: Samplers16, cone: Cone, slot: u32) -> Packet {
        let ones = Vec3x16 { x: [1.0; LANES], y: [1.0; LANES], z: [1.0; LANES] };
        Packet {
            rays,
            throughput: ones,
            emission_throughput: ones,
            eta_sq: [1.0; LANES],
            normal: Vec3x16::default(),
            pdf: [f32::INFINITY; LANES],
            light_samples: [1.0; LANES],
            samplers,
            slot: std::array::from_fn(|i| slot + i as u32),
            distance: [0.0; LANES],
            path_class: [0; LANES],
            stage: [PathStage::Chain as u32; LANES],
            gaps: [0; LANES],
            cones: [cone; LANES],
            interior: [Interior::NONE; LANES],
        }
    }

    /// Copies a path of another packet into a lane.
    #[inline]
    pub fn copy_lane(&mut self, to: usize, packet: &Packet, from: usize) {
        self.rays.set(to, &packet.rays.get(from));
        self.throughput.set(to, packet.throughput.get(from));
        self.emission_throughput.set(to, packet.emission_throughput.get(from));
        self.eta_sq[to] = packet.eta_sq[from];
        self.normal.set(to, packet.normal.get(from));
        self.pdf[to] = packet.pdf[from];
        self.light_samples[to] = packet.light_samples[from];
        self.samplers.seed[to] = packet.samplers.seed[from];
        self.samplers.index[to] = packet.samplers.index[from];
        self.slot[to] = packet.slot[from];
        self.distance[to] = packet.distance[from];
        self.path_class[to] = packet.path_class[from];
        self.stage[to] = packet.stage[from];
        self.gaps[to] = packet.gaps[from];
        self.cones[to] = packet.cones[from];
        self.interior[to] = packet.interior[from];
    }

    /// Returns the lanes whose edge `depth` continues the eye ray, through gaps at most.
    #[inline]
    pub fn on_eye_ray(&self, depth: u32) -> u16 {
        mask_of(&self.gaps.map(|gaps| u32::from(gaps + 1 == depth)))
    }

    /// Returns the lanes at a stage.
    #[inline]
    pub fn at(&self, stage: PathStage) -> u16 {
        mask_of(&self.stage.map(|other| u32::from(other == stage as u32)))
    }

    /// Returns the lanes in which light emitted by the next surface counts.
    #[inline]
    pub fn sees_emitters(&self) -> u16 {
        let sees = |i: &usize| self.emission_throughput.get(*i) != Rgb::ZERO;
        lanes_in(u16::MAX).filter(sees).fold(0, |mask, i| mask | 1 << i)
    }

    /// Returns the lanes whose next surface reflects light to the eye.
    #[inline]
    pub fn followed(&self) -> u16 {
        lanes_in(u16::MAX).filter(|i| self.throughput.get(*i) != Rgb::ZERO).fold(0, |mask, i| mask | 1 << i)
    }
}
