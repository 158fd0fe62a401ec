//! Context, settings and tasks of the shading stage.

use crate::bias_compensation::Compensation;
use crate::eye::ShadingPoints;
use crate::lightcut::{CutSettings, Receiver, Samples, Transfer};
use crate::lights::{Lights, Origin};
use base::math::Frame;
use world::World;
use world::shadow::ShadowSettings;

/// Scene and its virtual lights, as the shading stage uses them.
#[derive(Clone, Copy)]
pub struct ShadingContext<'a> {
    /// The scene.
    pub world: &'a World,
    /// Transfer from its virtual lights.
    pub transfer: Transfer<'a>,
    /// Compensation of clamped light; `None` to leave it lost.
    pub compensation: Option<Compensation<'a>>,
    /// Samples for patches of anchors alone, which are taken if they are fewer than the clusters of a cut; `None` to
    /// use cuts everywhere.
    pub samples: Option<Samples>,
}

impl<'a> ShadingContext<'a> {
    /// Creates the context for shading by `lights`. With `compensated`, short rays find light clamped close to points.
    pub fn new(world: &'a World, lights: &'a Lights, compensated: bool) -> ShadingContext<'a> {
        let compensation = compensated.then(|| Compensation::new(world, lights));
        ShadingContext { world, transfer: Transfer::of(lights, compensated), compensation, samples: None }
    }
}

/// Settings of the shading stage.
#[derive(Clone, Copy, Debug)]
pub struct ShadeSettings<'a> {
    /// Settings of cuts.
    pub cut: &'a CutSettings,
    /// True if neighbours share cuts.
    pub share: bool,
    /// Approximate number of patches, if there is a task for each point.
    pub patches: u32,
    /// Settings of shadow rays, with those of the occluder cache.
    pub shadows: &'a ShadowSettings,
}

/// Light to gather at a shading point.
#[derive(Clone, Copy, Debug)]
pub struct ShadingTask {
    /// Index of the point.
    pub point: u32,
    /// True if only the light reflected by the lobe on the base is wanted.
    pub lobe_only: bool,
    /// Origin of the light; `None` for both.
    pub origin: Option<Origin>,
    /// Luminance of other light that the point reflects. Errors are judged relative to the whole.
    pub baseline_luminance: f32,
}

impl ShadingTask {
    /// Creates the task of all light of a point.
    pub fn all(point: u32) -> ShadingTask {
        ShadingTask { point, lobe_only: false, origin: None, baseline_luminance: 0.0 }
    }

    /// Returns the receiver of the light.
    pub fn receiver<'w>(&self, points: &ShadingPoints<'w>) -> Receiver<'w> {
        let i = self.point as usize;
        let (geometry, surface) = (&points.geometry[i], points.surfaces.get(i));
        let frame = Frame::from_normal(geometry.normal);
        let lobe = if self.lobe_only { surface.bsdf.split_base(1.0).1 } else { None };
        let bsdf = lobe.unwrap_or(surface.bsdf);
        Receiver::new(geometry.position, surface.geometric_normal, &frame, bsdf, surface.out)
            .with_baseline(self.baseline_luminance)
            .with_edges(geometry.edges)
    }
}
