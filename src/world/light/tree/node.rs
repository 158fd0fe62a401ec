//! Nodes of the emitter tree, and their importance at a point.

use super::bounds::EmitterBounds;
use base::math::WIDTH;
use glam::Vec3;

/// Maximum number of children of a branch.
pub const ARITY: usize = WIDTH;

/// Slack of the extents, over the scene's: positions are rounded, and light that arrives must not have
/// importance zero.
const SLACK: f32 = 1e-5;

/// Share of the choice between siblings that is by power, whatever the point.
pub const BY_POWER: f32 = 0.05;

/// Minimum cosine by which an importance is reduced.
const MIN_COS: f32 = 1e-3;

/// Square of the minimum distance, over the square of the extent's radius.
const MIN_DIST_SQ: f32 = 0.25;

/// Part of a node that the importance needs.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Centre of a sphere around the positions.
    pub centre: Vec3,
    /// Its radius.
    pub radius: f32,
    /// Axis of the cone of normals.
    pub axis: Vec3,
    /// Cosine of its half angle; -2 for all directions.
    pub cos_normals: f32,
    /// Its sine.
    pub sin_normals: f32,
    /// Cosine of the largest angle between a normal and the light it stands for.
    pub cos_emission: f32,
    /// See [`EmitterBounds::peak`].
    pub peak: f32,
}

impl Node {
    /// Node of the given bounds, in a scene whose positions are as precise as its `extent` lets them be.
    pub fn new(bounds: &EmitterBounds, extent: f32) -> Node {
        let cone = &bounds.cone;
        let all = cone.normals >= std::f32::consts::PI;
        Node {
            centre: 0.5 * (bounds.low + bounds.high),
            radius: 0.5 * bounds.low.distance(bounds.high) + SLACK * extent,
            axis: cone.axis,
            cos_normals: if all { -2.0 } else { cone.normals.cos() },
            sin_normals: if all { 0.0 } else { cone.normals.sin() },
            cos_emission: cone.emission.cos(),
            peak: bounds.peak,
        }
    }

    /// Estimates π times the irradiance at `x` on a surface of normal `n`; zero only where none of the members can
    /// shine on that side (Conty Estevez & Kulla 2018, equation 3, with a bound of the cosine at the surface).
    #[inline(always)]
    pub fn importance(&self, x: Vec3, n: Vec3) -> f32 {
        let to_light = self.centre - x;
        let radius_sq = self.radius * self.radius;
        let dist_sq = to_light.length_squared().max(MIN_DIST_SQ * radius_sq).max(f32::MIN_POSITIVE);
        let dist = dist_sq.sqrt();
        // Cosines are scaled by the distance. That of an angle less the one in which the sphere is seen is at most the
        // cosine of the angle plus that sine, the radius over the distance.
        let surface = n.dot(to_light) + self.radius;
        let cos_axis = -self.axis.dot(to_light);
        let sin_axis = (dist_sq - cos_axis * cos_axis).max(0.0).sqrt();
        let within = (cos_axis >= dist * self.cos_normals) | (dist_sq <= radius_sq);
        let beside = cos_axis * self.cos_normals + sin_axis * self.sin_normals;
        let light = if within { dist } else { beside } + self.radius;
        let shines = (surface > 0.0) & (light > dist * self.cos_emission);
        let cosines = surface.max(MIN_COS * dist).min(dist) * light.max(MIN_COS * dist).min(dist);
        let importance = self.peak * cosines / (dist_sq * dist_sq).max(f32::MIN_POSITIVE);
        // The minimum also replaces what is not a number.
        if shines { importance.min(f32::MAX / 64.0) } else { 0.0 }
    }
}

/// A child of a branch, or an entry of the top: an emitter, a branch, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Child(u32);

/// Tells emitters from branches.
const EMITTER: u32 = 1 << 31;

impl Child {
    /// The emitter of the given index.
    pub fn emitter(index: usize) -> Child {
        Child(index as u32 | EMITTER)
    }

    /// The branch of the given index.
    pub fn branch(index: usize) -> Child {
        Child(index as u32)
    }

    /// Index of the branch, or that of the emitter as the error.
    #[inline(always)]
    pub fn get(self) -> Result<usize, u32> {
        if self.0 & EMITTER == 0 { Ok(self.0 as usize) } else { Err(self.0 & !EMITTER) }
    }
}
