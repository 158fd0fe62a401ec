//! Nodes of the emitter tree, and their importance at a point.

use super::bounds::EmitterBounds;
use glam::Vec3;

/// Maximum number of children of a branch.
pub const ARITY: usize = 8;

/// Slack of the extents over the scene's extent. Light that arrives must not have importance zero because of rounding.
const SLACK: f32 = 1e-5;

/// Share of the choice between siblings that is by power.
pub const BY_POWER: f32 = 0.05;

/// Minimum cosine in an importance.
const MIN_COS: f32 = 1e-3;

/// Squared minimum distance over the squared radius of the extent.
const MIN_DIST_SQ: f32 = 0.25;

/// Point to be lit and its normal, zero if light may come from both sides.
#[derive(Clone, Copy, Debug)]
pub struct PointAndNormal {
    /// Position.
    pub x: Vec3,
    /// Unit normal.
    pub n: Vec3,
}

/// Quantities of a node that determine its importance.
#[derive(Clone, Copy, Debug)]
pub struct EmitterNode {
    /// Centre of a sphere around the positions.
    pub centre: Vec3,
    /// Radius of that sphere.
    pub radius: f32,
    /// Axis of the cone of normals.
    pub axis: Vec3,
    /// Cosine of the cone's half angle; -2 for all directions.
    pub cos_normals: f32,
    /// Sine of the cone's half angle.
    pub sin_normals: f32,
    /// Cosine of the largest angle between a normal and the light it stands for.
    pub cos_emission: f32,
    /// See [`EmitterBounds::peak`].
    pub peak: f32,
}

impl EmitterNode {
    /// Builds the node of the given bounds; `extent` determines the precision of the scene's positions.
    pub fn new(bounds: &EmitterBounds, extent: f32) -> EmitterNode {
        let cone = &bounds.cone;
        let all = cone.normals >= std::f32::consts::PI;
        EmitterNode {
            centre: 0.5 * (bounds.low + bounds.high),
            radius: 0.5 * bounds.low.distance(bounds.high) + SLACK * extent,
            axis: cone.axis,
            cos_normals: if all { -2.0 } else { cone.normals.cos() },
            sin_normals: if all { 0.0 } else { cone.normals.sin() },
            cos_emission: cone.emission.cos(),
            peak: bounds.peak,
        }
    }

    /// Estimates π times the irradiance at a point; zero only if no emitter of the node can light that side (Conty
    /// Estevez & Kulla 2018, equation 3, with a bound of the cosine at the surface).
    #[inline(always)]
    pub fn importance(&self, PointAndNormal { x, n }: PointAndNormal) -> f32 {
        let to_light = self.centre - x;
        let radius_sq = self.radius * self.radius;
        let dist_sq = to_light.length_squared().max(MIN_DIST_SQ * radius_sq).max(f32::MIN_POSITIVE);
        let dist = dist_sq.sqrt();
        // Cosines are scaled by the distance. The cosine of an angle minus the angle that the sphere subtends is at
        // most the cosine of the angle plus the sine of the other, which is the radius over the distance.
        let surface = n.dot(to_light) + self.radius;
        let cos_axis = -self.axis.dot(to_light);
        let sin_axis = (dist_sq - cos_axis * cos_axis).max(0.0).sqrt();
        let within = (cos_axis >= dist * self.cos_normals) | (dist_sq <= radius_sq);
        let beside = cos_axis * self.cos_normals + sin_axis * self.sin_normals;
        let light = if within { dist } else { beside } + self.radius;
        let shines = (surface > 0.0) & (light > dist * self.cos_emission);
        let cosines = surface.max(MIN_COS * dist).min(dist) * light.max(MIN_COS * dist).min(dist);
        let importance = self.peak * cosines / (dist_sq * dist_sq).max(f32::MIN_POSITIVE);
        // The minimum also replaces NaN.
        if shines { importance.min(f32::MAX / 64.0) } else { 0.0 }
    }
}

/// A child of a branch or of the cut: an emitter or a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TreeChild(u32);

/// Bit that marks emitters.
const EMITTER: u32 = 1 << 31;

impl TreeChild {
    /// Makes the child that is the emitter of the given index.
    pub fn emitter(index: usize) -> TreeChild {
        TreeChild(index as u32 | EMITTER)
    }

    /// Makes the child that is the branch of the given index.
    pub fn branch(index: usize) -> TreeChild {
        TreeChild(index as u32)
    }

    /// Returns the index of the branch; that of the emitter as the error.
    #[inline(always)]
    pub fn get(self) -> Result<usize, u32> {
        if self.0 & EMITTER == 0 { Ok(self.0 as usize) } else { Err(self.0 & !EMITTER) }
    }
}
