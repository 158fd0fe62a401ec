//! Records in the making: the points where they are needed, and the sources that compute them.

use super::record::Record;
use super::settings::CacheSettings;
use crate::hsh::Radiance;
use crate::lightcut::{CutCounts, Receiver};
use crate::lights::{DirectIndirect, Origin};
use crate::shade::ShadingContext;
use base::math::Frame;
use world::SurfacePoint;

/// Point at which to compute records.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// Eye sample of the current frame that it was chosen from; it seeds the directions of rays.
    pub sample: u32,
    /// Position and normals.
    pub point: SurfacePoint,
    /// Distance to the next eye sample, about: the unit of footprints' radii.
    pub spacing: f32,
    /// Distance to the nearest point seen that rises from the surface; infinite if there is none nearby.
    pub clearance: f32,
    /// Coat that the light has to pass (see [`world::material::Bsdf::coat`]); 0 for none.
    pub coat: u32,
    /// Bands of the series that the surface needs; 0 where irradiance is enough.
    pub bands: u8,
    /// Layers without a record here.
    pub missing: DirectIndirect<bool>,
    /// Luminance of the irradiance known besides: of the other layer's records, and of light that was drawn.
    pub baseline_luminance: f32,
}

impl Candidate {
    /// Gatherer of the irradiance on the side of the normal.
    pub fn receiver(&self) -> Receiver<'static> {
        let SurfacePoint { position, normal, geometric_normal } = self.point;
        Receiver::irradiance(position, geometric_normal, &Frame::from_normal(normal))
            .with_baseline(self.baseline_luminance)
    }
}

/// A record, and its light as a series where the surface needs it.
pub struct NewRecord {
    /// Layer that it belongs to.
    pub origin: Origin,
    /// Eye sample of the candidate.
    pub sample: u32,
    /// The record.
    pub record: Record,
    /// Radiance by direction, in the bands of the candidate.
    pub series: Option<Radiance>,
}

/// Computes records.
pub trait RecordSource: Sync {
    /// Settings of the cache.
    fn settings(&self) -> &CacheSettings;

    /// Records of the missing layers, in the same order for any number of threads; none where the light is not finite.
    fn records(&self, candidates: &[Candidate]) -> (Vec<NewRecord>, CutCounts);
}

/// Source of records by lightcuts.
#[derive(Clone, Copy)]
pub struct LightcutSource<'a> {
    /// The scene and its virtual lights.
    pub context: ShadingContext<'a>,
    /// Settings of the cache.
    pub settings: &'a CacheSettings,
}
