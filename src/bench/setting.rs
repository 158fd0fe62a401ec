//! Inputs of benchmarks on a scene: its eye samples, its virtual lights in their trees.

use super::Context;
use base::math::{Frame, LANES};
use base::progress::Control;
use base::sampling::hash;
use render::session::Session;
use std::ops::Range;
use transport::eye::{EyePass, EyeSettings};
use transport::lightcut::{CoherenceLimit, OrientedPoint, Receiver, Transfer, group_coherent};
use transport::lights::{Family, LightNode, LightPass, LightPassSettings, LightTrees, light_pass};
use world::World;
use world::view::View;

/// Number of neighbouring eye samples in a stretch.
const STRETCH: usize = 64;
/// Number of stretches, spread over the picture.
const STRETCHES: usize = 6;

/// A scene with its eye samples and virtual lights.
pub(super) struct Setting<'w> {
    pub world: &'w World,
    pub samples: EyePass<'w>,
    pub trees: LightTrees,
}

impl<'w> Setting<'w> {
    /// Prepares a scene with the renderers' default settings. `None` if there is no scene.
    pub fn new(context: &Context<'w>) -> Option<Setting<'w>> {
        let Session { world, cameras, .. } = context.session?;
        let view = View::whole(cameras.still, cameras.resolution);
        let depth = world.scene.path_limit(None);
        (context.say)("looking at the scene and lighting it");
        let eye = EyeSettings { spp: 1, seed: 0, max_depth: depth };
        let samples = EyePass::trace(world, &view, eye, &Control::new());
        let LightPass { sets, profiles, .. } =
            light_pass(world, &LightPassSettings::default(), &[], depth, &Control::new());
        let trees = LightTrees::build(&sets, profiles, world.diagonal, Family::default(), &Control::new());
        Some(Setting { world, samples, trees })
    }

    /// Returns the transfer of light to points.
    pub fn transfer(&self) -> Transfer<'_> {
        Transfer::new(&self.trees, self.world.diagonal)
    }

    /// Returns the surface at an eye sample, as lightcuts per pixel shade it.
    pub fn reflector(&self, sample: usize) -> Receiver<'w> {
        let (point, surface) = (&self.samples.points.geometry[sample], &self.samples.points.surfaces[sample]);
        let frame = Frame::from_normal(point.normal);
        Receiver::new(point.position, surface.geometric_normal, &frame, surface.bsdf, surface.out)
    }

    /// Returns the same as a receiver of irradiance, as records use it.
    pub fn collector(&self, sample: usize) -> Receiver<'static> {
        let (point, surface) = (&self.samples.points.geometry[sample], &self.samples.points.surfaces[sample]);
        Receiver::irradiance(point.position, surface.geometric_normal, &Frame::from_normal(point.normal))
    }

    /// Returns stretches of `n` consecutive items.
    pub fn spread(&self, n: usize) -> Vec<Range<usize>> {
        let length = STRETCH.min(n);
        let first = |s| (n - length) * s / (STRETCHES - 1);
        (0..STRETCHES).map(|s| first(s)..first(s) + length).collect()
    }

    /// Returns stretches of eye samples that are neighbours in space, as pixels are.
    pub fn pixels(&self) -> Vec<Vec<usize>> {
        self.spread(self.samples.len()).into_iter().map(Iterator::collect).collect()
    }

    /// Divides a stretch into groups that share a cut.
    pub fn groups(&self, stretch: &[usize]) -> Vec<Vec<usize>> {
        let place = |&sample: &usize| {
            let point = &self.samples.points.geometry[sample];
            OrientedPoint { position: point.position, normal: point.normal }
        };
        let limit = CoherenceLimit::close(self.world.diagonal);
        group_coherent(limit, stretch.iter().copied(), LANES, place, |_, _| true)
    }

    /// Returns all single lights, neighbours in their tree next to each other.
    pub fn leaves(&self) -> Vec<&LightNode> {
        self.trees.leaves().collect()
    }
}

/// A random number generator of fixed seed.
pub(super) struct Dice(pub u32);

impl Dice {
    /// Returns an integer from 0 to `n` - 1; 0 if `n` is 0.
    pub fn below(&mut self, n: usize) -> usize {
        self.0 += 1;
        ((u64::from(hash(self.0, 0xbe7c)) * n as u64) >> 32) as usize
    }
}
