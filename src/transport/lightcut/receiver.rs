//! Receivers of light at a point: the function that a lightcut integrates against, and its upper bound.
//!
//! The weight of each direction determines the meaning of the cut's sum: BRDF · cosine gives reflected
//! radiance, the cosine alone irradiance.

use super::OffsetBox;
use base::math::{Frame, Rgb};
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;
use world::material::{Bsdf, DirectionBound};

/// A point on a surface seen from a direction: the cut's sum is the radiance it reflects there.
#[derive(Clone, Copy, Debug)]
pub struct Receiver<'m> {
    position: Vec3,
    geometric_normal: Vec3,
    /// Shading frame, z on the side of `wo`.
    frame: Frame,
    /// Frame whose z is the mirror direction of `wo`.
    mirror: Frame,
    wo: Vec3,
    material: Kind<'m>,
    baseline_luminance: f32,
}

#[derive(Clone, Copy, Debug)]
enum Kind<'m> {
    /// BRDF.
    Lambert(Rgb),
    General(Bsdf<'m>),
}

impl<'m> Receiver<'m> {
    /// The surface at `position` with the given normals and material, seen from the unit vector `out`.
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
            _ if !front && !bsdf.two_sided() => Kind::Lambert(Rgb::ZERO),
            Some(albedo) => Kind::Lambert(albedo * FRAC_1_PI),
            None => Kind::General(bsdf),
        };
        let mirror = Frame::from_normal(frame.to_world(Vec3::new(-wo.x, -wo.y, wo.z)));
        Receiver { position, geometric_normal, frame, mirror, wo, material, baseline_luminance: 0.0 }
    }

    /// Creates a receiver of irradiance on the side of the frame's z axis: a surface that reflects π times
    /// the physical maximum.
    pub fn irradiance(position: Vec3, geometric_normal: Vec3, frame: &Frame) -> Receiver<'static> {
        let material = Kind::Lambert(Rgb::ONE);
        let baseline_luminance = 0.0;
        Receiver {
            position,
            geometric_normal,
            frame: *frame,
            mirror: *frame,
            wo: Vec3::Z,
            material,
            baseline_luminance,
        }
    }

    /// The same, where light of this luminance is known to be reflected besides.
    pub fn with_baseline(self, baseline_luminance: f32) -> Self {
        Receiver { baseline_luminance, ..self }
    }

    /// BRDF, if the material is Lambertian and nothing else.
    pub(super) fn lambert_brdf(&self) -> Option<Rgb> {
        match self.material {
            Kind::Lambert(brdf) => Some(brdf),
            Kind::General(_) => None,
        }
    }

    /// BRDF of the base, for light that has passed the coat on its way in.
    pub fn base_brdf(&self) -> Rgb {
        match &self.material {
            Kind::Lambert(brdf) => *brdf,
            Kind::General(bsdf) => bsdf.split_base(self.wo.z).0,
        }
    }

    /// Returns the coat's transmittance for light from the direction of `incident`, which need not be of unit
    /// length.
    pub fn coat_transmittance(&self, incident: Vec3) -> f32 {
        match &self.material {
            Kind::General(bsdf) if bsdf.coat() != 0 => {
                bsdf.coat_transmittance(self.frame.normal.dot(incident.normalize_or_zero()).clamp(0.0, 1.0))
            }
            _ => 1.0,
        }
    }

    /// The material, where it is more than Lambertian, and the direction it is seen from, in the shading frame.
    pub(super) fn bsdf(&self) -> Option<(Bsdf<'m>, Vec3)> {
        match self.material {
            Kind::Lambert(_) => None,
            Kind::General(bsdf) => Some((bsdf, self.wo)),
        }
    }

    /// Shading frame, z on the side of the eye.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Frame whose z is the mirror direction of the eye's.
    pub(super) fn mirror(&self) -> &Frame {
        &self.mirror
    }

    /// No smaller than the response to any direction within `bound`.
    #[inline]
    pub(super) fn max_reflection(&self, bound: &DirectionBound) -> Rgb {
        match &self.material {
            Kind::Lambert(brdf) => *brdf * bound.cos_i_max.max(0.0),
            Kind::General(bsdf) => bsdf.bound(self.wo, bound),
        }
    }

    /// Position and unit shading normal on the side of the eye.
    pub fn place(&self) -> (Vec3, Vec3) {
        (self.position, self.frame.normal)
    }

    /// The same surface elsewhere.
    pub fn moved(self, position: Vec3) -> Self {
        Receiver { position, ..self }
    }

    /// Position.
    #[inline]
    pub fn position(&self) -> Vec3 {
        self.position
    }

    /// Unit geometric normal, for starting shadow rays; zero if the point lies on no surface.
    #[inline]
    pub fn geometric_normal(&self) -> Vec3 {
        self.geometric_normal
    }

    /// Luminance gathered from trees that are left out of the cut: errors are judged against the whole.
    #[inline]
    pub fn baseline_luminance(&self) -> f32 {
        self.baseline_luminance
    }

    /// Weight of light from the unit direction `wi`: BRDF times cosine.
    #[inline]
    pub fn response(&self, wi: Vec3) -> Rgb {
        match &self.material {
            Kind::Lambert(brdf) => *brdf * self.frame.normal.dot(wi).max(0.0),
            Kind::General(bsdf) => {
                let wi = self.frame.to_local(wi);
                if wi.z > 0.0 { bsdf.eval(self.wo, wi) * wi.z } else { Rgb::ZERO }
            }
        }
    }

    /// No smaller, in any channel, than the weight of any direction in a box; `local` is the box in the shading frame.
    #[inline]
    pub(super) fn max_response(&self, offsets: &OffsetBox, local: &OffsetBox) -> Rgb {
        let cos_max = local.max_cos_z();
        if cos_max <= 0.0 {
            return Rgb::ZERO;
        }
        if let Kind::Lambert(brdf) = &self.material {
            return *brdf * cos_max;
        }
        self.max_reflection(&DirectionBound {
            cos_i_max: cos_max,
            cos_i_min: local.min_cos_z(),
            cos_mirror_max: offsets.turned(&self.mirror).max_cos_z(),
        })
    }
}
