//! Directions drawn towards mirrors and glass from diffuse surfaces, mixed with those that these scatter light to.
//!
//! Paper: Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, section 9.2.4: a sample drawn from
//! either of two distributions has the density of their mixture.

use base::math::Frame;
use glam::{Vec2, Vec3};
use world::material::{BsdfSamples16, Bsdfs16};
use world::{Faces, World};

/// Lanes whose directions are drawn so, and the share of those towards mirrors and glass.
pub(super) struct Guided {
    pub lanes: u16,
    pub share: f32,
}

impl Guided {
    /// Density of a direction at the point `x` of a surface of normal `n`, whose own density of it is `pdf`.
    pub fn density(&self, world: &World, (x, n): (Vec3, Vec3), direction: Vec3, pdf: f32) -> f32 {
        self.mixed(&world.specular.faces(x, n), direction, pdf)
    }

    fn mixed(&self, faces: &Faces, direction: Vec3, pdf: f32) -> f32 {
        match faces.density(direction) {
            Some(towards) => pdf + self.share * (towards - pdf),
            None => pdf,
        }
    }

    /// Draws the direction of a lane, which `samples` has from its surface, anew from the mixture.
    pub fn turn(
        &self,
        world: &World,
        (x, n): (Vec3, Vec3),
        frame: &Frame,
        (bsdfs, lane): (&Bsdfs16, usize),
        (u_choice, u): (f32, Vec2),
        samples: &mut BsdfSamples16,
    ) {
        let faces = world.specular.faces(x, n);
        let towards = match u_choice < self.share {
            true => faces.towards(u_choice / self.share, u),
            false => None,
        };
        let wi = towards.map_or(samples.wi.get(lane), |direction| frame.to_local(direction));
        let (value, pdf) = bsdfs.lane(lane).eval_pdf(bsdfs.wo(lane), wi);
        let pdf = self.mixed(&faces, frame.to_world(wi), pdf);
        samples.wi.set(lane, wi);
        samples.weight.set(lane, value * (wi.z.abs() / pdf));
        samples.pdf[lane] = pdf;
        samples.goes_on[lane] &= u32::from(pdf > 0.0);
    }
}
