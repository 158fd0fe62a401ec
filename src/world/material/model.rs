//! A material at one point: the part that all points share, and the colours of that point.

use super::base::BaseModel;
use super::lobe::{LobeModel, MAX_LOBES};
use base::math::{Lane, Rgb, V3};
use glam::Vec3;
use scene::MaterialId;

/// Material at one point of a surface: textures are looked up, the rest is shared with [`super::Materials`].
#[derive(Clone, Copy, Debug)]
pub struct Bsdf<'m> {
    pub(super) model: &'m Model,
    /// BRDF of the base, without the transmittances of the coat.
    pub(super) base: Rgb,
    /// Factors on the lobes; zero in the slots beyond them.
    pub(super) scales: [Rgb; MAX_LOBES],
    /// Normal without the relief, in the shading frame; used if the relief has shadows.
    pub(super) level_normal: Vec3,
}

/// Colours of a material.
#[derive(Clone, Copy, Debug)]
pub(super) struct Colours<T> {
    /// Albedo or BRDF of the base.
    pub base: T,
    /// Factors on the lobes.
    pub scales: [T; MAX_LOBES],
}

/// Material without its colours.
#[derive(Clone, Debug)]
pub(super) struct Model {
    /// Material of the scene.
    pub material: MaterialId,
    /// True if the back behaves as the front, unless the two sides are those of an interface.
    pub two_sided: bool,
    /// True if a relief shadows itself (see [`Model::lit_share`]).
    pub shadows: bool,
    pub base: BaseModel,
    /// Number of the coat on the base; 0 if there is none.
    pub coat: u32,
    pub lobes: Vec<LobeModel>,
    /// Number of the list of lobes. Lists that differ only in their factors have the same number.
    pub lobe_list: u32,
    /// Properties of the lobes.
    pub kinds: LobeKinds,
    /// True if the material is Lambertian and nothing else.
    pub lambert: bool,
    /// True if the roughness is textured and the model stands for its mean.
    pub mean_roughness: bool,
    /// Minimum roughness α of the rough lobes; 1 without one.
    pub min_alpha: f32,
}

/// Properties of a list of lobes: true if some lobe has the property.
#[derive(Clone, Copy, Debug)]
pub(super) struct LobeKinds {
    /// The lobe scatters into more than isolated directions.
    pub smooth: bool,
    /// The lobe scatters into isolated directions.
    pub delta: bool,
    /// The two sides of the surface are the two sides of one interface.
    pub transmit: bool,
    /// Light may be scattered to the other side.
    pub across: bool,
    /// Light may go to the other side, through the surface or through gaps in it.
    pub pass_light: bool,
}

impl LobeKinds {
    /// Collects the properties of a list of lobes.
    pub fn new(lobes: &[LobeModel]) -> LobeKinds {
        let any = |property: fn(&LobeModel) -> bool| lobes.iter().any(property);
        let transmit = any(LobeModel::transmits);
        let across = transmit || any(|lobe| matches!(lobe, LobeModel::Thin(_)));
        LobeKinds {
            smooth: any(|lobe| !lobe.is_delta()),
            delta: any(LobeModel::is_delta),
            transmit,
            across,
            pass_light: across || any(|lobe| matches!(lobe, LobeModel::Gap)),
        }
    }
}

impl Model {
    /// Returns the share of the light from `wi` that the bumps of a relief do not shadow: Smith's masking by GGX. α² is
    /// an eighth of the squared slope at the point. `level_normal` is the normal without the relief.
    ///
    /// Paper: Estevez, Lecocq, Stein, *A Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem*,
    /// Ray Tracing Gems, 2019.
    #[inline(always)]
    pub fn lit_share<L: Lane>(&self, level_normal: V3<L>, wi: V3<L>) -> L {
        let one = L::from(1.0);
        if !self.shadows {
            return one;
        }
        let tan_sq = |cos: L| (cos.sq().max(L::from(f32::MIN_POSITIVE)).recip() - one).positive();
        let alpha_sq = (tan_sq(level_normal.z) * 0.125).min(one);
        L::from(2.0) / (one + (one + alpha_sq * tan_sq(level_normal.dot(wi))).sqrt())
    }

    /// Returns the material with the given colours, of which `base` is the BRDF of the base.
    #[inline(always)]
    pub fn with_colours(&self, colours: &Colours<Rgb>) -> Bsdf<'_> {
        Bsdf { model: self, base: colours.base, scales: colours.scales, level_normal: Vec3::Z }
    }
}

/// Set of some of a material's lobes, one bit per slot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LobeSet(pub(super) u8);

impl LobeSet {
    /// Returns true if the set is empty.
    #[inline]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns true if the lobe in a slot is in the set.
    #[inline(always)]
    pub(super) fn has(self, slot: usize) -> bool {
        self.0 >> slot & 1 != 0
    }
}
