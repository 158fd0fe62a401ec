//! Receivers of light at a point: the weight of each direction of light, and its upper bound.
//!
//! The weight determines the meaning of the cut's sum: BRDF · cosine gives reflected radiance, the cosine alone
//! irradiance.

use base::math::{Frame, Rgb};
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;
use world::material::{Bsdf, DirectionBound};

/// Point on a surface, seen from a direction: the cut's sum is the radiance that it reflects in this direction.
#[derive(Clone, Copy, Debug)]
pub struct Receiver<'m> {
    position: Vec3,
    geometric_normal: Vec3,
    /// Shading frame, z on the side of `wo`.
    frame: Frame,
    /// Frame whose z is the mirror direction of `wo`.
    mirror: Frame,
    wo: Vec3,
    material: ReceiverMaterial<'m>,
    baseline_luminance: f32,
    /// Maximum number of edges that light may take to the point.
    edges: u16,
}

#[derive(Clone, Copy, Debug)]
enum ReceiverMaterial<'m> {
    /// Lambertian BRDF.
    Lambert(Rgb),
    General(Bsdf<'m>),
}

impl<'m> Receiver<'m> {
    /// Creates the receiver for the surface at `position` with the given normals and material, seen from the unit
    /// vector `out`.
    pub fn new(
        position: Vec3,
        geometric_normal: Vec3,
        frame: &Frame,
        bsdf: Bsdf<'m>,
        out: Vec3,
    ) -> Receiver<'m> {
        let mut wo = frame.to_local(out);
        let mut frame = *frame;
        let front = wo.z > 0.0;
        if !front {
            frame.normal = -frame.normal;
            wo.z = -wo.z;
        }
        let material = match bsdf.lambert_albedo() {
            _ if !front && !bsdf.two_sided() => ReceiverMaterial::Lambert(Rgb::ZERO),
            Some(albedo) => ReceiverMaterial::Lambert(albedo * FRAC_1_PI),
            None => ReceiverMaterial::General(if front { bsdf } else { bsdf.turned() }),
        };
        let mirror = Frame::from_normal(frame.to_world(Vec3::new(-wo.x, -wo.y, wo.z)));
        let (baseline_luminance, edges) = (0.0, u16::MAX);
        Receiver { position, geometric_normal, frame, mirror, wo, material, baseline_luminance, edges }
    }

    /// Creates a receiver of irradiance on the side of the frame's z axis: a surface that reflects π times the physical
    /// maximum.
    pub fn irradiance(position: Vec3, geometric_normal: Vec3, frame: &Frame) -> Receiver<'static> {
        let material = ReceiverMaterial::Lambert(Rgb::ONE);
        let (baseline_luminance, edges) = (0.0, u16::MAX);
        Receiver {
            position,
            geometric_normal,
            frame: *frame,
            mirror: *frame,
            wo: Vec3::Z,
            material,
            baseline_luminance,
            edges,
        }
    }

    /// Returns the receiver with errors judged relative to this additional luminance of reflected light.
    pub fn with_baseline(self, baseline_luminance: f32) -> Self {
        Receiver { baseline_luminance, ..self }
    }

    /// Returns the receiver with a limit of the number of edges that light may take to it.
    pub fn with_edges(self, edges: u16) -> Self {
        Receiver { edges, ..self }
    }

    /// Maximum number of edges that light may take to the point.
    pub fn edges(&self) -> u16 {
        self.edges
    }

    /// Returns the maximum number of sheets that light may pass which has come along `before` edges to a VPL; `None`
    /// if it may not even arrive straight.
    pub fn sheets(&self, before: u8) -> Option<u32> {
        u32::from(self.edges).checked_sub(u32::from(before) + 1)
    }

    /// BRDF of a Lambertian material; `None` for other materials.
    pub(super) fn lambert_brdf(&self) -> Option<Rgb> {
        match self.material {
            ReceiverMaterial::Lambert(brdf) => Some(brdf),
            ReceiverMaterial::General(_) => None,
        }
    }

    /// BRDF of the base, for light that has already passed the coat.
    pub fn base_brdf(&self) -> Rgb {
        match &self.material {
            ReceiverMaterial::Lambert(brdf) => *brdf,
            ReceiverMaterial::General(bsdf) => bsdf.split_base(self.wo.z).0,
        }
    }

    /// Returns the coat's transmittance for light from the direction of `incident`, which need not be of unit length.
    pub fn coat_transmittance(&self, incident: Vec3) -> f32 {
        match &self.material {
            ReceiverMaterial::General(bsdf) if bsdf.coat() != 0 => {
                bsdf.coat_transmittance(self.frame.normal.dot(incident.normalize_or_zero()).clamp(0.0, 1.0))
            }
            _ => 1.0,
        }
    }

    /// A material that is not just Lambertian, and the direction from which it is seen, in the shading frame.
    pub(super) fn bsdf(&self) -> Option<(Bsdf<'m>, Vec3)> {
        match self.material {
            ReceiverMaterial::Lambert(_) => None,
            ReceiverMaterial::General(bsdf) => Some((bsdf, self.wo)),
        }
    }

    /// Shading frame; z is on the side of the eye.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Frame whose z is the mirror direction of the direction to the eye.
    pub(super) fn mirror(&self) -> &Frame {
        &self.mirror
    }

    /// Returns an upper bound of the response to all directions within `bound`.
    #[inline]
    pub(super) fn max_reflection(&self, bound: &DirectionBound) -> Rgb {
        match &self.material {
            ReceiverMaterial::Lambert(brdf) => *brdf * bound.cos_i_max.max(0.0),
            ReceiverMaterial::General(bsdf) => bsdf.bound(self.wo, bound),
        }
    }

    /// Position and unit shading normal on the side of the eye.
    pub fn place(&self) -> (Vec3, Vec3) {
        (self.position, self.frame.normal)
    }

    /// Returns the surface moved to another position.
    pub fn moved(self, position: Vec3) -> Self {
        Receiver { position, ..self }
    }

    /// Position.
    #[inline]
    pub fn position(&self) -> Vec3 {
        self.position
    }

    /// Unit geometric normal, from which shadow rays start; zero if the point lies on no surface.
    #[inline]
    pub fn geometric_normal(&self) -> Vec3 {
        self.geometric_normal
    }

    /// Luminance of reflected light that is not part of the cut. Errors are judged relative to the whole.
    #[inline]
    pub fn baseline_luminance(&self) -> f32 {
        self.baseline_luminance
    }

    /// Weight of light from the unit direction `wi`: BRDF times cosine.
    #[inline]
    pub fn response(&self, wi: Vec3) -> Rgb {
        match &self.material {
            ReceiverMaterial::Lambert(brdf) => *brdf * self.frame.normal.dot(wi).max(0.0),
            ReceiverMaterial::General(bsdf) => {
                let wi = self.frame.to_local(wi);
                if wi.z > 0.0 { bsdf.eval(self.wo, wi) * wi.z } else { Rgb::ZERO }
            }
        }
    }
}
