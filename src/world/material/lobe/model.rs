//! A lobe of any kind: the dispatch over all lobes.

use super::{
    AnisotropicLobe, ClearCoat, Delta, Facet, FacetBound, Grazing, Interface, Mirror, ReflectedLobe,
    RoughInterface, RoughLobe, SeenLobe, Thin, mean, means,
};
use base::math::{LANES, Lane, Mask, Rgb, V3};
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
            LobeModel::Rough(_)
            | LobeModel::Anisotropic(_)
            | LobeModel::Mirror(_)
            | LobeModel::RoughInterface(_)
            | LobeModel::ClearCoat(_)
            | LobeModel::Grazing(_)
            | LobeModel::Thin(_) => false,
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
            LobeModel::Mirror(_) | LobeModel::Interface(_) | LobeModel::Grazing(_) | LobeModel::Gap => false,
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
            LobeModel::Mirror(_) | LobeModel::Interface(_) | LobeModel::Grazing(_) | LobeModel::Gap => false,
        }
    }

    /// Returns the minimum roughness α of a rough lobe over all directions on the surface; 1 for other lobes.
    pub fn min_alpha(&self) -> f32 {
        match self {
            LobeModel::Rough(rough) => rough.alpha(),
            LobeModel::Anisotropic(rough) => rough.min_alpha(),
            LobeModel::ClearCoat(coat) => coat.alpha(),
            LobeModel::Thin(thin) => thin.min_alpha(),
            LobeModel::Mirror(_)
            | LobeModel::Interface(_)
            | LobeModel::RoughInterface(_)
            | LobeModel::Grazing(_)
            | LobeModel::Gap => 1.0,
        }
    }

    /// Returns the index of refraction on the far side over that on the side of the cosine `cos_o`, for a rough lobe
    /// that refracts; 1 for other lobes.
    #[inline(always)]
    pub fn refraction<L: Lane>(&self, cos_o: L) -> L {
        match self {
            LobeModel::RoughInterface(rough) => cos_o.each(|cos| rough.refraction(cos)),
            LobeModel::Rough(_)
            | LobeModel::Anisotropic(_)
            | LobeModel::Mirror(_)
            | LobeModel::Interface(_)
            | LobeModel::ClearCoat(_)
            | LobeModel::Grazing(_)
            | LobeModel::Thin(_)
            | LobeModel::Gap => L::from(1.0),
        }
    }

    /// Prepares a lobe for directions `wo`. Lobes that scatter light across the surface, and delta lobes, need nothing.
    #[inline(always)]
    pub fn seen<L: Lane>(&self, wo: V3<L>) -> SeenLobe<L> {
        match self {
            LobeModel::Rough(rough) => rough.seen(wo),
            LobeModel::Anisotropic(rough) => rough.seen(wo),
            LobeModel::ClearCoat(coat) => coat.seen(wo),
            LobeModel::Grazing(grazing) => grazing.seen(wo),
            LobeModel::Mirror(_)
            | LobeModel::Interface(_)
            | LobeModel::RoughInterface(_)
            | LobeModel::Thin(_)
            | LobeModel::Gap => SeenLobe::none(),
        }
    }

    /// Returns value and density of a lobe that is `seen` from the `wo` of the facet. Delta lobes have none.
    #[inline(always)]
    pub fn value_pdf<L: Lane>(&self, seen: &SeenLobe<L>, facet: &Facet<L>) -> (V3<L>, L) {
        let (value, pdf) = match self {
            LobeModel::Rough(rough) => rough.value_pdf(seen, facet),
            LobeModel::Anisotropic(rough) => rough.value_pdf(seen, facet),
            LobeModel::ClearCoat(coat) => coat.value_pdf(seen, facet),
            LobeModel::Grazing(grazing) => grazing.value_pdf(seen, facet),
            LobeModel::RoughInterface(rough) => {
                return across(facet, |wo, wi| {
                    let (value, pdf) = rough.value_pdf(wo, wi);
                    (Rgb::splat(value), pdf)
                });
            }
            LobeModel::Thin(thin) => return across(facet, |wo, wi| thin.value_pdf(wo, wi)),
            LobeModel::Mirror(_) | LobeModel::Interface(_) | LobeModel::Gap => {
                return (V3::zero(), L::from(0.0));
            }
        };
        (value.keep(facet.reflects), pdf.keep(facet.reflects))
    }

    /// Samples directions in the lanes of `wanted`. Returns them with the facets that reflect light there, and the
    /// lanes in which one was found. Delta lobes have none.
    #[inline(always)]
    pub fn sample<L: Lane>(&self, wo: V3<L>, u: [L; 2], wanted: L::Mask) -> (Facet<L>, L::Mask) {
        let facet = match self {
            LobeModel::Rough(rough) => rough.sample(wo, u),
            LobeModel::Anisotropic(rough) => rough.sample(wo, u),
            LobeModel::ClearCoat(coat) => coat.sample(wo, u),
            LobeModel::Grazing(grazing) => grazing.sample(wo, u),
            LobeModel::RoughInterface(rough) => {
                return sample_across(wo, u, wanted, |wo, u| rough.sample(wo, u));
            }
            LobeModel::Thin(thin) => return sample_across(wo, u, wanted, |wo, u| thin.sample(wo, u)),
            LobeModel::Mirror(_) | LobeModel::Interface(_) | LobeModel::Gap => {
                return (Facet::between(wo, wo), L::Mask::all(false));
            }
        };
        (facet, facet.reflects)
    }

    /// Returns the directions into which a delta lobe scatters light from `wo`, with probability 1. Other lobes have
    /// none.
    #[inline(always)]
    pub fn delta<L: Lane>(&self, scale: V3<L>, wo: V3<L>) -> Delta<L> {
        let straight = |found| Delta { wi: -wo, weight: scale, eta: L::from(1.0), found, straight: true };
        match self {
            LobeModel::Mirror(mirror) => mirror.delta(scale, wo),
            LobeModel::Interface(interface) => interface.delta(scale, wo),
            LobeModel::Gap => straight(means(scale).is_positive()),
            LobeModel::Rough(_)
            | LobeModel::Anisotropic(_)
            | LobeModel::RoughInterface(_)
            | LobeModel::ClearCoat(_)
            | LobeModel::Grazing(_)
            | LobeModel::Thin(_) => straight(L::Mask::all(false)),
        }
    }

    /// Estimates the share of the light from `wo` that the lobe scatters, as a weight for the choice of a lobe.
    /// `transmittance` is the coat's for `wo`.
    #[inline(always)]
    pub fn sampling_weight<L: Lane>(&self, scale: V3<L>, wo: V3<L>, transmittance: L) -> L {
        let each =
            |weight: &dyn Fn(Rgb, f32) -> f32| L::from_fn(|lane| weight(scale.lane(lane), wo.z.lane(lane)));
        let weight = match self {
            LobeModel::Rough(rough) => rough.sampling_weight(scale, wo.z, transmittance),
            LobeModel::Anisotropic(rough) => rough.sampling_weight(scale, wo.z),
            LobeModel::Mirror(mirror) => means(mirror.weight(scale, wo.z)),
            LobeModel::ClearCoat(coat) => coat.sampling_weight(scale, wo.z),
            LobeModel::Grazing(grazing) => means(grazing.albedo(scale, wo.z)),
            LobeModel::Interface(interface) => return interface.sampling_weight(scale, wo.z),
            LobeModel::RoughInterface(rough) => return each(&|scale, cos| rough.sampling_weight(scale, cos)),
            LobeModel::Thin(thin) => return each(&|scale, cos| mean(thin.albedo(scale, cos))),
            LobeModel::Gap => return means(scale),
        };
        weight.keep(wo.z.is_positive())
    }

    /// Returns the albedo for light at the cosine `cos` > 0; 0 for delta lobes.
    pub fn albedo(&self, scale: Rgb, cos: f32) -> Rgb {
        match self {
            LobeModel::Rough(rough) => rough.mean_reflectance(scale, cos),
            LobeModel::Anisotropic(rough) => rough.albedo(scale, cos),
            LobeModel::RoughInterface(rough) => rough.albedo(scale, cos),
            LobeModel::ClearCoat(coat) => coat.albedo(V3::splat(scale), cos).into(),
            LobeModel::Grazing(grazing) => grazing.albedo(V3::splat(scale), cos).into(),
            LobeModel::Thin(thin) => thin.albedo(scale, cos),
            LobeModel::Mirror(_) | LobeModel::Interface(_) | LobeModel::Gap => Rgb::ZERO,
        }
    }

    /// Returns true if the lobe may be wide enough to count as diffuse.
    pub fn may_count_as_diffuse(&self) -> bool {
        match self {
            LobeModel::Rough(rough) => !rough.is_glossy(),
            LobeModel::Grazing(_) => true,
            LobeModel::Anisotropic(_)
            | LobeModel::Mirror(_)
            | LobeModel::Interface(_)
            | LobeModel::RoughInterface(_)
            | LobeModel::ClearCoat(_)
            | LobeModel::Thin(_)
            | LobeModel::Gap => false,
        }
    }

    /// Returns the albedo for light at the cosine `cos` > 0, if the lobe is wide enough to count as diffuse.
    #[inline]
    pub fn diffuse_albedo(&self, scale: Rgb, cos: f32) -> Option<Rgb> {
        match self {
            LobeModel::Rough(rough) => rough.diffuse_albedo(scale, cos),
            LobeModel::Grazing(grazing) => Some(grazing.albedo(V3::splat(scale), cos).into()),
            LobeModel::Anisotropic(_)
            | LobeModel::Mirror(_)
            | LobeModel::Interface(_)
            | LobeModel::RoughInterface(_)
            | LobeModel::ClearCoat(_)
            | LobeModel::Thin(_)
            | LobeModel::Gap => None,
        }
    }

    /// Returns the light that a virtual light radiates by the lobe, for light at the cosine `cos` > 0, if the lobe is
    /// wide enough for one and reflects too much to count as diffuse.
    #[inline]
    pub fn reflected(&self, scale: Rgb, cos: f32) -> Option<ReflectedLobe> {
        match self {
            LobeModel::Rough(rough) => rough.reflected(scale, cos),
            LobeModel::Anisotropic(_)
            | LobeModel::Mirror(_)
            | LobeModel::Interface(_)
            | LobeModel::RoughInterface(_)
            | LobeModel::ClearCoat(_)
            | LobeModel::Grazing(_)
            | LobeModel::Thin(_)
            | LobeModel::Gap => None,
        }
    }

    /// Returns the factor of [`LobeModel::bound`] that depends on the cosine of `wo` alone.
    #[inline(always)]
    pub fn max_masking<L: Lane>(&self, cos_o: L) -> L {
        match self {
            LobeModel::Rough(rough) => rough.max_masking(cos_o),
            LobeModel::Anisotropic(rough) => rough.max_masking(cos_o),
            LobeModel::ClearCoat(coat) => coat.max_masking(cos_o),
            LobeModel::Grazing(grazing) => grazing.max_masking(cos_o),
            LobeModel::Mirror(_)
            | LobeModel::Interface(_)
            | LobeModel::RoughInterface(_)
            | LobeModel::Thin(_)
            | LobeModel::Gap => L::from(0.0),
        }
    }

    /// Returns an upper bound of value times cosine, given [`LobeModel::max_masking`]; 0 for delta lobes and lobes that
    /// scatter light across the surface.
    #[inline(always)]
    pub fn bound<L: Lane>(&self, masking: L, bound: &FacetBound<L>) -> V3<L> {
        match self {
            LobeModel::Rough(rough) => rough.bound(masking, bound),
            LobeModel::Anisotropic(rough) => rough.bound(masking, bound),
            LobeModel::ClearCoat(coat) => coat.bound(masking, bound),
            LobeModel::Grazing(grazing) => grazing.bound(masking, bound),
            LobeModel::Mirror(_)
            | LobeModel::Interface(_)
            | LobeModel::RoughInterface(_)
            | LobeModel::Thin(_)
            | LobeModel::Gap => V3::zero(),
        }
    }
}

/// Evaluates a lobe that scatters light across the surface, lane by lane.
#[inline]
fn across<L: Lane>(facet: &Facet<L>, value_pdf: impl Fn(Vec3, Vec3) -> (Rgb, f32)) -> (V3<L>, L) {
    let mut pdfs = [0.0; LANES];
    let values = V3::from_fn(|lane| {
        let (value, pdf) = value_pdf(facet.wo.lane(lane), facet.wi.lane(lane));
        pdfs[lane] = pdf;
        value
    });
    (values, L::from_fn(|lane| pdfs[lane]))
}

/// Samples a lobe that scatters light across the surface, lane by lane.
#[inline]
fn sample_across<L: Lane>(
    wo: V3<L>,
    [x, y]: [L; 2],
    wanted: L::Mask,
    sample: impl Fn(Vec3, Vec2) -> Option<Vec3>,
) -> (Facet<L>, L::Mask) {
    let wi = V3::from_fn(|lane| {
        let sampled = || sample(wo.lane(lane), Vec2::new(x.lane(lane), y.lane(lane)));
        if wanted.lane(lane) { sampled().unwrap_or_default() } else { Vec3::ZERO }
    });
    (Facet::between(wo, wi), wi.length_sq().is_positive())
}
