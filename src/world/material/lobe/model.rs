//! A lobe of any kind: the dispatch over all lobes.

use super::{
    AnisotropicLobe, BsdfSample, ClearCoat, Directions, Directions16, FacetBound, FacetBounds16, Grazing,
    Interface, LobeLanes, Mirror, ReflectedLobe, RoughInterface, RoughLobe, Sampled16, SeenLobe, Thin,
    ValuePdf16, mean,
};
use base::math::{Rgb, Vec2x16, Vec3x16};
use glam::{Vec2, Vec3};

/// Maximum number of lobes of a material.
pub(in crate::material) const MAX_LOBES: usize = 6;

/// Lobe of any kind, without its factor.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::material) enum LobeModel {
    Rough(RoughLobe),
    Anisotropic(AnisotropicLobe),
    Mirror(Mirror),
    Interface(Interface),
    RoughInterface(RoughInterface),
    ClearCoat(ClearCoat),
    Grazing(Grazing),
    Thin(Thin),
    /// Gaps in the surface, through which light passes straight.
    Gap,
}

impl LobeModel {
    /// Returns true if the lobe scatters into isolated directions, so that value and density are 0 everywhere.
    #[inline]
    pub fn is_delta(&self) -> bool {
        matches!(self, LobeModel::Mirror(_) | LobeModel::Interface(_) | LobeModel::Gap)
    }

    /// Returns true if the lobe changes the direction of light as mirrors and smooth or rough glass do.
    pub fn bends(&self) -> bool {
        match self {
            LobeModel::Mirror(_) | LobeModel::RoughInterface(_) => true,
            LobeModel::Interface(interface) => interface.bends(),
            LobeModel::Rough(_)
            | LobeModel::Anisotropic(_)
            | LobeModel::ClearCoat(_)
            | LobeModel::Grazing(_)
            | LobeModel::Thin(_)
            | LobeModel::Gap => false,
        }
    }

    /// Returns true if light keeps its direction.
    #[inline]
    pub fn passes_straight(&self) -> bool {
        match self {
            LobeModel::Interface(interface) => interface.passes_straight(),
            LobeModel::Gap => true,
            _ => false,
        }
    }

    /// Returns true if the surface's two sides are the two sides of one interface.
    pub fn transmits(&self) -> bool {
        matches!(self, LobeModel::Interface(_) | LobeModel::RoughInterface(_))
    }

    /// Returns true if the lobe scatters light to the other side in more than isolated directions.
    #[inline]
    pub fn scatters_across(&self) -> bool {
        matches!(self, LobeModel::RoughInterface(_) | LobeModel::Thin(_))
    }

    /// Returns true if the lobe is rough, but too sharp to count as diffuse.
    #[inline]
    pub fn is_glossy(&self) -> bool {
        match self {
            LobeModel::Rough(rough) => rough.is_glossy(),
            LobeModel::RoughInterface(_)
            | LobeModel::ClearCoat(_)
            | LobeModel::Anisotropic(_)
            | LobeModel::Thin(_) => true,
            _ => false,
        }
    }

    /// Returns true if eye paths follow the lobe by sampling it, as they follow a mirror: lightcuts would show single
    /// virtual lights in it. Eye paths also follow lobes that scatter light across the surface, because cuts gather on
    /// one side, and anisotropic lobes, because cuts do not support a direction on the surface.
    #[inline]
    pub fn is_sharp(&self) -> bool {
        match self {
            LobeModel::Rough(rough) => rough.is_sharp(),
            LobeModel::RoughInterface(_)
            | LobeModel::ClearCoat(_)
            | LobeModel::Anisotropic(_)
            | LobeModel::Thin(_) => true,
            _ => false,
        }
    }

    /// Returns the minimum roughness α of a rough lobe over all directions on the surface; 1 for other lobes.
    pub fn min_alpha(&self) -> f32 {
        match self {
            LobeModel::Rough(rough) => rough.alpha(),
            LobeModel::Anisotropic(rough) => rough.min_alpha(),
            LobeModel::ClearCoat(coat) => coat.alpha(),
            LobeModel::Thin(thin) => thin.min_alpha(),
            _ => 1.0,
        }
    }

    /// Returns the index of refraction on the far side over that on the side of `wo` for a rough lobe that refracts; 1
    /// for other lobes.
    #[inline]
    pub fn refraction(&self, wo: Vec3) -> f32 {
        match self {
            LobeModel::RoughInterface(rough) => rough.refraction(wo),
            _ => 1.0,
        }
    }

    /// Returns value and density. `probability`, with which the lobe is chosen, is a factor on the density.
    #[inline(always)]
    pub fn eval_pdf(&self, scale: Rgb, probability: f32, directions: &Directions) -> (Rgb, f32) {
        match self {
            LobeModel::Rough(rough) => rough.eval_pdf(scale, probability, directions),
            LobeModel::Anisotropic(rough) => rough.eval_pdf(scale, probability, directions),
            LobeModel::RoughInterface(rough) => rough.eval_pdf(scale, probability, directions),
            LobeModel::ClearCoat(coat) => coat.eval_pdf(scale, probability, directions),
            LobeModel::Grazing(grazing) => grazing.eval_pdf(scale, probability, directions),
            LobeModel::Thin(thin) => thin.eval_pdf(scale, probability, directions),
            _ => (Rgb::ZERO, 0.0),
        }
    }

    /// Samples a direction; `None` for delta lobes, or if the sampled facet reflects light into the surface.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Option<Directions> {
        match self {
            LobeModel::Rough(rough) => rough.sample(wo, u),
            LobeModel::Anisotropic(rough) => rough.sample(wo, u),
            LobeModel::RoughInterface(rough) => rough.sample(wo, u),
            LobeModel::ClearCoat(coat) => coat.sample(wo, u),
            LobeModel::Grazing(grazing) => grazing.sample(wo, u),
            LobeModel::Thin(thin) => thin.sample(wo, u),
            _ => None,
        }
    }

    /// Returns the direction into which a delta lobe scatters light from `wo`, with probability 1.
    #[inline(always)]
    pub fn delta(&self, scale: Rgb, wo: Vec3) -> Option<BsdfSample> {
        match self {
            LobeModel::Mirror(mirror) => mirror.delta(scale, wo),
            LobeModel::Interface(interface) => interface.delta(scale, wo),
            LobeModel::Gap => {
                let straight = BsdfSample { straight: true, ..BsdfSample::delta(-wo, scale, 1.0) };
                (scale != Rgb::ZERO).then_some(straight)
            }
            _ => None,
        }
    }

    /// Estimates the share of the light from `wo` that the lobe scatters, as a weight for the choice of a lobe.
    /// `transmittance` is the coat's for `wo`.
    #[inline(always)]
    pub fn sampling_weight(&self, scale: Rgb, wo: Vec3, transmittance: f32) -> f32 {
        match self {
            LobeModel::Rough(rough) => rough.sampling_weight(scale, wo.z, transmittance),
            LobeModel::Anisotropic(rough) => rough.sampling_weight(scale, wo.z),
            LobeModel::Mirror(mirror) => mean(mirror.weight(scale, wo.z)),
            LobeModel::Interface(interface) => interface.sampling_weight(scale, wo.z),
            LobeModel::RoughInterface(rough) => rough.sampling_weight(scale, wo.z),
            LobeModel::ClearCoat(coat) => coat.sampling_weight(scale, wo.z),
            LobeModel::Grazing(grazing) => mean(grazing.albedo(scale, wo.z)),
            LobeModel::Thin(thin) => mean(thin.albedo(scale, wo.z)),
            LobeModel::Gap => mean(scale),
        }
    }

    /// Returns the albedo for light at the cosine `cos` > 0; 0 for delta lobes.
    pub fn albedo(&self, scale: Rgb, cos: f32) -> Rgb {
        match self {
            LobeModel::Rough(rough) => rough.mean_reflectance(scale, cos),
            LobeModel::Anisotropic(rough) => rough.albedo(scale, cos),
            LobeModel::RoughInterface(rough) => rough.albedo(scale, cos),
            LobeModel::ClearCoat(coat) => coat.albedo(scale, cos),
            LobeModel::Grazing(grazing) => grazing.albedo(scale, cos),
            LobeModel::Thin(thin) => thin.albedo(scale, cos),
            _ => Rgb::ZERO,
        }
    }

    /// Returns true if the lobe may be wide enough to count as diffuse.
    pub fn may_count_as_diffuse(&self) -> bool {
        match self {
            LobeModel::Rough(rough) => !rough.is_glossy(),
            LobeModel::Grazing(_) => true,
            _ => false,
        }
    }

    /// Returns the albedo for light at the cosine `cos` > 0, if the lobe is wide enough to count as diffuse.
    #[inline]
    pub fn diffuse_albedo(&self, scale: Rgb, cos: f32) -> Option<Rgb> {
        match self {
            LobeModel::Rough(rough) => rough.diffuse_albedo(scale, cos),
            LobeModel::Grazing(grazing) => Some(grazing.albedo(scale, cos)),
            _ => None,
        }
    }

    /// Returns the light that a virtual light radiates by the lobe, for light at the cosine `cos` > 0, if the lobe is
    /// wide enough for one and reflects too much to count as diffuse.
    #[inline]
    pub fn reflected(&self, scale: Rgb, cos: f32) -> Option<ReflectedLobe> {
        match self {
            LobeModel::Rough(rough) => rough.reflected(scale, cos),
            _ => None,
        }
    }

    /// Returns an upper bound of value times cosine; 0 for delta lobes and lobes that scatter light across the surface.
    #[inline(always)]
    pub fn bound(&self, scale: Rgb, bound: &FacetBound) -> Rgb {
        match self {
            LobeModel::Rough(rough) => rough.bound(scale, bound),
            LobeModel::Anisotropic(rough) => rough.bound(scale, bound),
            LobeModel::ClearCoat(coat) => coat.bound(scale, bound),
            LobeModel::Grazing(grazing) => grazing.bound(scale, bound),
            _ => Rgb::ZERO,
        }
    }

    /// Sets a lane for `wo`, which is on the side of the normal.
    #[inline]
    pub fn set_lane(&self, lanes: &mut LobeLanes, lane: usize, scale: Rgb, wo: Vec3) {
        match self {
            LobeModel::Rough(rough) => rough.set_lane(lanes, lane, scale, wo),
            LobeModel::Anisotropic(rough) => rough.set_lane(lanes, lane, scale, wo),
            LobeModel::ClearCoat(coat) => coat.set_lane(lanes, lane, scale, wo),
            LobeModel::Grazing(grazing) => grazing.set_lane(lanes, lane, scale, wo),
            _ => {}
        }
    }

    /// Adds the lobe's values, without the cosine, in all lanes.
    #[inline]
    pub fn add_value16(&self, lanes: &LobeLanes, directions: &Directions16, sum: &mut Vec3x16) {
        match self {
            LobeModel::Rough(rough) => rough.add_value16(lanes, directions, sum),
            LobeModel::Anisotropic(rough) => rough.add_value16(lanes, directions, sum),
            LobeModel::ClearCoat(coat) => coat.add_value16(lanes, directions, sum),
            LobeModel::Grazing(grazing) => grazing.add_value16(lanes, directions, sum),
            _ => {}
        }
    }

    /// Prepares a lobe for `wo` on the side of the normal. `probability` is that of choosing the lobe. Lobes that
    /// transmit light have no such form.
    #[inline]
    pub fn seen(&self, probability: f32, wo: Vec3) -> SeenLobe {
        match self {
            LobeModel::Rough(rough) => rough.seen(probability, wo),
            LobeModel::Anisotropic(rough) => rough.seen(probability, wo),
            LobeModel::ClearCoat(coat) => coat.seen(probability, wo),
            LobeModel::Grazing(grazing) => grazing.seen(probability, wo),
            _ => SeenLobe::default(),
        }
    }

    /// Adds [`LobeModel::eval_pdf`] in all lanes, all of which have the `wo` of `seen`.
    #[inline]
    pub fn add_eval_pdf16(&self, scale: Rgb, seen: &SeenLobe, d: &Directions16, sum: &mut ValuePdf16) {
        match self {
            LobeModel::Rough(rough) => rough.add_eval_pdf16(scale, seen, d, sum),
            LobeModel::Anisotropic(rough) => rough.add_eval_pdf16(scale, seen, d, sum),
            LobeModel::ClearCoat(coat) => coat.add_eval_pdf16(scale, seen, d, sum),
            LobeModel::Grazing(grazing) => grazing.add_eval_pdf16(scale, seen, d, sum),
            _ => {}
        }
    }

    /// Sets the lanes of a mask to [`LobeModel::sample`].
    #[inline]
    pub fn sample16(&self, wo: Vec3, u: &Vec2x16, mask: u16, sampled: &mut Sampled16) {
        match self {
            LobeModel::Rough(rough) => rough.sample16(wo, u, mask, sampled),
            _ => sampled.one_by_one(mask, |l| self.sample(wo, u.get(l))),
        }
    }

    /// Adds the lobe's bounds of value times cosine in all lanes.
    #[inline]
    pub fn add_bound16(&self, lanes: &LobeLanes, bounds: &FacetBounds16, sum: &mut Vec3x16) {
        match self {
            LobeModel::Rough(rough) => rough.add_bound16(lanes, bounds, sum),
            LobeModel::Anisotropic(rough) => rough.add_bound16(lanes, bounds, sum),
            LobeModel::ClearCoat(coat) => coat.add_bound16(lanes, bounds, sum),
            LobeModel::Grazing(grazing) => grazing.add_bound16(lanes, bounds, sum),
            _ => {}
        }
    }
}
