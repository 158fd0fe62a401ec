//! Policy of paths: the light that a batch finds along them, and how far they go.

use crate::irradiance::PathEnds;
use base::math::Rgb;
use glam::Vec3;
use world::Surface;
use world::light::Learned;
use world::material::{Bsdf, LobeSet};

/// End of a chain of mirrors, glass and sharp lobes: a surface that scatters light by other lobes, not always on the
/// side that is seen.
#[derive(Clone, Copy, Debug)]
pub struct ChainEnd<'w> {
    /// Index of the path in its batch.
    pub path: u32,
    /// Surface.
    pub surface: Surface,
    /// BSDF without the lobes that the chain follows.
    pub bsdf: Bsdf<'w>,
    /// Unit vector back along the edge.
    pub out: Vec3,
    /// Share of the radiance leaving along `out` that reaches the eye.
    pub throughput: Rgb,
    /// Length of the chain.
    pub distance: f32,
    /// Hash of the surfaces and lobes along the chain: equal for paths of the same class, 0 straight from the eye.
    pub path_class: u32,
    /// Number of edges from the eye. A sheet that light passes straight begins a new edge.
    pub depth: u32,
}

/// Probabilities for the edges that diffuse surfaces at chain ends scatter.
#[derive(Clone, Copy, Debug)]
pub struct ScatteredEdges {
    /// Share of these edges that are aimed at mirrors and glass, in [0, 1).
    pub guided: f32,
    /// Share of edges traced among those that can only find light sent on by other surfaces, in (0, 1].
    pub blind: f32,
}

/// Light samples at a chain end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightSamples {
    /// Number of light samples.
    pub count: u32,
    /// Offset of the first one in the sequence of light samples.
    pub first: u32,
}

impl LightSamples {
    /// One light sample.
    pub const ONE: LightSamples = LightSamples { count: 1, first: 0 };
}

impl Default for ScatteredEdges {
    fn default() -> ScatteredEdges {
        ScatteredEdges { guided: 0.0, blind: 1.0 }
    }
}

/// Policy of paths: how far they go, and which light they find.
pub trait PathPolicy<'w> {
    /// True if paths stop at the first surface that scatters by lobes which a chain does not follow. Of its incident
    /// light they find only emitters, by light samples and by one more edge, and light by a specular lobe of the
    /// surface that this edge hits. From there the path has full length: such light comes along no straight segment
    /// from a light or a virtual light. False for full paths from the eye.
    const STOPS_AT_DIFFUSE: bool;

    /// True if paths find only the light that reaches chain ends by specular lobes, and no emitters seen by chains.
    const ONLY_BY_SPECULAR_LOBES: bool = false;

    /// Returns the lobes that a chain follows besides delta lobes.
    fn followed(&self, bsdf: &Bsdf) -> LobeSet {
        bsdf.sharp_lobes()
    }

    /// Returns the learned visibility of emitters that guides light sampling, if any.
    fn learned(&self) -> Option<&Learned> {
        None
    }

    /// Returns the light samples at chain ends.
    fn light_samples(&self) -> LightSamples {
        LightSamples::ONE
    }

    /// Returns the probabilities for edges scattered at chain ends.
    fn edges(&self) -> ScatteredEdges {
        ScatteredEdges::default()
    }

    /// Returns the light by which paths end at diffuse surfaces; `None` if they go on.
    fn path_ends(&self) -> Option<&PathEnds> {
        None
    }

    /// Returns true if paths continue from the surface after a chain end by glossy lobes, too sharp to count as
    /// diffuse, as they do by delta lobes.
    fn goes_on_by_glossy_lobes(&self) -> bool {
        true
    }

    /// Returns the distance between neighbouring points over the distance from the eye, if first hits are to be shaded
    /// in groups; [`PathPolicy::see`] and [`PathPolicy::end`] are then called once per group.
    fn group_spacing(&self) -> Option<f32> {
        None
    }

    /// Returns true if [`PathPolicy::reflected`] is to be called for a path of a group.
    fn looks_up(&self, _path: u32) -> bool {
        false
    }

    /// Returns true if [`PathPolicy::see`] is to be called.
    fn sees(&self) -> bool {
        false
    }

    /// Receives the [guide albedo](world::World::guide_albedo) of the first surface that each path hits.
    /// Mirrors and glass give `None`. The normal is the shading normal on that side. Paths may continue from there.
    /// The order of calls does not depend on threads.
    fn see(&mut self, _path: u32, _albedo: Option<Rgb>, _normal: Vec3) {}

    /// Receives every surface that ends a chain. The order of calls does not depend on threads.
    fn end(&mut self, _end: &ChainEnd<'w>) {}

    /// Returns the radiance that a chain end reflects of light found by other means than paths.
    fn reflected(&mut self, _end: &ChainEnd<'w>) -> Rgb {
        Rgb::ZERO
    }

    /// Returns the share of an emitter's light, of the given radiance, that paths are to find when it reaches a chain
    /// end by delta lobes. The chain has the length `distance`. Other means find the rest.
    fn share_of_paths(&self, _radiance: Rgb, _distance: f32) -> f32 {
        1.0
    }
}
