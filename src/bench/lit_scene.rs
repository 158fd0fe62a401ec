//! A scene's eye samples and virtual lights, the inputs of benchmarks of parts.

use super::Context;
use base::math::{Frame, LANES};
use base::progress::Control;
use render::session::Session;
use std::ops::Range;
use transport::eye::{EyePass, EyeSettings};
use transport::lightcut::{
    CoherenceLimit, OrientedPoint, Receiver, ReceiverPacket, Transfer, group_coherent, group_compact,
};
use transport::lights::{LightPass, LightPassSettings, LightTrees, light_pass};
use world::World;
use world::view::View;

/// Number of neighbouring eye samples in a stretch.
const STRETCH: usize = 64;
/// Number of stretches, which are spread over the image.
const STRETCHES: usize = 6;

/// A scene with its eye samples and virtual lights.
pub(super) struct LitScene<'w> {
    pub world: &'w World,
    pub samples: EyePass<'w>,
    pub trees: LightTrees,
}

impl<'w> LitScene<'w> {
    /// Traces eye samples and virtual lights using the renderers' default settings.
    pub fn new(context: &Context<'w>) -> LitScene<'w> {
        let Session { world, cameras, .. } = context.session;
        let view = View::whole(cameras.still, cameras.resolution);
        let depth = world.scene.path_limit(None);
        (context.say)("tracing eye samples and virtual lights");
        let eye = EyeSettings { spp: 1, seed: 0, max_depth: depth };
        let samples = EyePass::trace(world, &view, eye, &Control::new());
        let LightPass { sets, profiles, .. } =
            light_pass(world, &LightPassSettings::default(), &[], depth, &Control::new());
        let trees = LightTrees::build(&sets, profiles, world.diagonal, &Control::new());
        LitScene { world, samples, trees }
    }

    /// Returns the transfer of light to points.
    pub fn transfer(&self) -> Transfer<'_> {
        Transfer::new(&self.trees, self.world.diagonal)
    }

    /// Returns the surface at an eye sample, as lightcuts per pixel shade it.
    pub fn surface(&self, sample: usize) -> Receiver<'w> {
        let (point, surface) =
            (&self.samples.points.geometry[sample], self.samples.points.surfaces.get(sample));
        let frame = Frame::from_normal(point.normal);
        Receiver::new(point.position, surface.geometric_normal, &frame, surface.bsdf, surface.out)
    }

    /// Returns a receiver of irradiance at an eye sample, as records use it.
    pub fn irradiance(&self, sample: usize) -> Receiver<'static> {
        let (point, surface) =
            (&self.samples.points.geometry[sample], self.samples.points.surfaces.get(sample));
        Receiver::irradiance(point.position, surface.geometric_normal, &Frame::from_normal(point.normal))
    }

    /// Returns stretches of `n` consecutive items.
    pub fn spread(&self, n: usize) -> Vec<Range<usize>> {
        let length = STRETCH.min(n);
        let first = |s| (n - length) * s / (STRETCHES - 1);
        (0..STRETCHES).map(|s| first(s)..first(s) + length).collect()
    }

    /// Divides a stretch into groups of pixels that share a cut.
    pub fn groups(&self, stretch: &[usize]) -> Vec<Vec<usize>> {
        let limit = CoherenceLimit::of(self.world.diagonal);
        group_coherent(limit, stretch.iter().copied(), LANES, |&sample| self.place(sample), |_| ())
    }

    /// Divides a stretch into groups of cache records that share a cut.
    pub fn groups_of_records(&self, stretch: &[usize]) -> Vec<Vec<usize>> {
        group_compact(stretch.to_vec(), self.world.diagonal, |&sample| self.place(sample))
    }

    fn place(&self, sample: usize) -> OrientedPoint {
        let point = &self.samples.points.geometry[sample];
        OrientedPoint { position: point.position, normal: point.normal }
    }
}

/// Returns receivers in lanes.
pub(super) fn packet<'m>(receivers: impl IntoIterator<Item = Receiver<'m>>) -> ReceiverPacket<'m> {
    let mut packet = ReceiverPacket::new();
    packet.set(receivers);
    packet
}
