//! Directions aimed at mirrors and glass from diffuse surfaces, mixed with BSDF samples.
//!
//! Paper: Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, section 9.2.4. A sample from
//! either of two distributions has the density of their mixture.

use base::math::Frame;
use glam::{Vec2, Vec3};
use world::material::{Bsdf, BsdfSamples16};
use world::{Faces, World};

/// Lanes with guided directions, and the share of directions aimed at mirrors and glass.
pub(super) struct Guided {
    pub lanes: u16,
    pub share: f32,
}

/// Vertex in one lane of a packet.
pub(super) struct LaneVertex<'w> {
    pub lane: usize,
    pub position: Vec3,
    /// Shading normal on the side of arrival.
    pub normal: Vec3,
    pub frame: Frame,
    pub bsdf: Bsdf<'w>,
    /// Direction from which it is seen, in the frame.
    pub wo: Vec3,
}

impl Guided {
    /// Returns the mixture density of a direction at the point `x` of a surface with normal `n`, given its BSDF
    /// density `pdf`.
    pub fn density(&self, world: &World, x: Vec3, n: Vec3, direction: Vec3, pdf: f32) -> f32 {
        self.mixed(&world.specular.faces(x, n), direction, pdf)
    }

    fn mixed(&self, faces: &Faces, direction: Vec3, pdf: f32) -> f32 {
        match faces.density(direction) {
            Some(towards) => pdf + self.share * (towards - pdf),
            None => pdf,
        }
    }

    /// Resamples the direction of a lane from the mixture. `samples` holds the direction that its BSDF sampled.
    pub fn turn(
        &self,
        world: &World,
        vertex: &LaneVertex,
        u_choice: f32,
        u: Vec2,
        samples: &mut BsdfSamples16,
    ) {
        let LaneVertex { lane, position, normal, ref frame, ref bsdf, wo } = *vertex;
        let faces = world.specular.faces(position, normal);
        let towards = match u_choice < self.share {
            true => faces.towards(u_choice / self.share, u),
            false => None,
        };
        let wi = towards.map_or(samples.wi.get(lane), |direction| frame.to_local(direction));
        let (value, pdf) = bsdf.eval_pdf(wo, wi);
        let pdf = self.mixed(&faces, frame.to_world(wi), pdf);
        samples.wi.set(lane, wi);
        samples.weight.set(lane, value * (wi.z.abs() / pdf));
        samples.pdf[lane] = pdf;
        samples.goes_on[lane] &= u32::from(pdf > 0.0);
    }
}
