//! Candidates: points at which records are to be computed.

use crate::lightcut::Receiver;
use crate::lights::DirectIndirect;
use base::math::Frame;
use world::SurfacePoint;

/// Point at which records are to be computed.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// Index of the eye sample that it was chosen from; seeds the directions of rays.
    pub sample: u32,
    /// Position and normals.
    pub point: SurfacePoint,
    /// Approximate number of eye samples in the cell that it was chosen for.
    pub cell: u32,
    /// Approximate distance to the next eye sample: the unit of footprint radii.
    pub spacing: f32,
    /// Distance to the nearest visible point that rises from the surface; infinite if there is none nearby.
    pub clearance: f32,
    /// Coat that the light has to pass (see [`world::material::Bsdf::coat`]); 0 without a coat.
    pub coat: u32,
    /// Maximum number of edges that light may take to the point.
    pub edges: u16,
    /// Bands of the series that the surface needs; 0 if irradiance is enough.
    pub bands: u8,
    /// Layers that lack a record here.
    pub missing: DirectIndirect<bool>,
    /// Luminance of the irradiance known from other sources: records of the other layer, and sampled light.
    pub baseline_luminance: f32,
}

impl Candidate {
    /// Returns the receiver of the irradiance on the side of the normal.
    pub fn receiver(&self) -> Receiver<'static> {
        let SurfacePoint { position, normal, geometric_normal } = self.point;
        Receiver::irradiance(position, geometric_normal, &Frame::from_normal(normal))
            .with_baseline(self.baseline_luminance)
            .with_edges(self.edges)
    }
}
