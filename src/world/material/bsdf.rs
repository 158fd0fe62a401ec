//! A material at one point, and its value and sampling density.
//!
//! Units: `eval` is 1/sr, without the cosine; `pdf` is per solid angle.

use super::lobe::{DullLobe, LobeModel, ReflectedLobe, mean};
use super::model::{Bsdf, LobeSet};
use super::seen::Seen;
use base::math::{Rgb, V3};
use glam::Vec3;
use scene::MaterialId;
use std::f32::consts::{FRAC_1_PI, PI};

impl<'m> Bsdf<'m> {
    /// Returns the value for light from `wi` seen from `wo`, without delta lobes. The directions may be on different
    /// sides.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.eval_pdf(wo, wi).0
    }

    /// Returns the density with which [`Bsdf::sample`] samples `wi`, without delta lobes.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.eval_pdf(wo, wi).1
    }

    /// Returns [`Bsdf::eval`] and [`Bsdf::pdf`].
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let side = self.side(wo);
        let (wo, wi) = (Vec3::new(wo.x, wo.y, wo.z * side), Vec3::new(wi.x, wi.y, wi.z * side));
        if !(wo.z > 0.0 && wi.z > 0.0 || self.model.kinds.across) {
            return (Rgb::ZERO, 0.0);
        }
        if self.is_lambert() {
            return (self.base, wi.z * FRAC_1_PI);
        }
        let seen = self.seen(wo, side);
        let (value, pdf) = seen.eval_pdf::<f32>(&seen.facet(V3::splat(wi)));
        (value.into(), pdf)
    }

    /// Returns true if light is reflected diffusely, so that photons and virtual lights are stored on the surface.
    pub fn stores_light(&self) -> bool {
        self.base != Rgb::ZERO || self.any_lobe(LobeModel::may_count_as_diffuse)
    }

    /// Returns true if light is scattered into more than isolated directions.
    #[inline]
    pub fn has_smooth(&self) -> bool {
        self.base != Rgb::ZERO || self.has_smooth_lobe()
    }

    /// Returns true if the material has delta lobes.
    #[inline]
    pub fn has_delta(&self) -> bool {
        self.model.kinds.delta
    }

    /// Returns true if part of the light is reflected as by a mirror or refracted into another direction.
    pub fn bends_light(&self) -> bool {
        self.any_lobe(LobeModel::bends)
    }

    /// Returns true if part of the light is reflected by rough lobes too sharp to count as diffuse.
    pub fn is_glossy(&self) -> bool {
        self.any_lobe(LobeModel::is_glossy)
    }

    /// Returns the part of the delta lobes and of the lobes too sharp to count as diffuse; `None` if there are no such
    /// sharp lobes.
    #[inline]
    pub fn glossy_part(&self) -> Option<Self> {
        let dull = self.lobes(|lobe| !lobe.is_glossy() && !lobe.is_delta());
        let glossy = !self.lobes(LobeModel::is_glossy).is_empty();
        glossy.then(|| Bsdf { base: Rgb::ZERO, ..*self }.without(dull))
    }

    /// Divides the material, seen from `wo`, into the albedo of all that is wide enough to count as diffuse, and the
    /// other lobes.
    pub fn split_diffuse(&self, wo: Vec3) -> (Rgb, Self) {
        let wide = self.lobes(|lobe| lobe.diffuse_albedo(Rgb::ONE, 1.0).is_some());
        (self.diffuse_albedo(wo), Bsdf { base: Rgb::ZERO, ..*self }.without(wide))
    }

    /// Returns true if part of the light is scattered to the other side in more than isolated directions.
    pub fn scatters_across(&self) -> bool {
        self.model.kinds.across && self.any_lobe(LobeModel::scatters_across)
    }

    /// Returns true if part of the light passes straight through the surface.
    pub fn passes_straight(&self) -> bool {
        self.any_lobe(LobeModel::passes_straight)
    }

    /// Returns true if light passes straight through gaps in the surface at most.
    pub fn passes_gaps_alone(&self) -> bool {
        !self.any_lobe(|lobe| lobe.passes_straight() && !matches!(lobe, LobeModel::Gap))
    }

    /// Returns the share of the surface that is not there.
    pub fn gaps(&self) -> f32 {
        let gap = |slot: usize| matches!(self.model.lobes[slot], LobeModel::Gap);
        (0..self.model.lobes.len()).filter(|slot| gap(*slot)).map(|slot| mean(self.scales[slot])).sum()
    }

    /// Splits the material into the part without sharp lobes and the part of the sharp lobes; `None` if there are no
    /// sharp lobes.
    #[inline]
    pub fn split_sharp_lobes(&self) -> Option<(Self, Self)> {
        let sharp = self.sharp_lobes();
        let without_base = Bsdf { base: Rgb::ZERO, ..*self };
        (!sharp.is_empty()).then(|| (self.without(sharp), without_base.without(LobeSet(!sharp.0))))
    }

    /// Returns the sharp lobes that reflect anything: rough lobes that eye paths follow by sampling.
    #[inline]
    pub fn sharp_lobes(&self) -> LobeSet {
        self.lobes(LobeModel::is_sharp)
    }

    /// Returns the rough lobes that reflect anything.
    #[inline]
    pub fn rough_lobes(&self) -> LobeSet {
        self.lobes(|lobe| !lobe.is_delta())
    }

    /// Returns the lobes that have a property and a factor other than 0.
    #[inline(always)]
    fn lobes(&self, property: impl Fn(&LobeModel) -> bool) -> LobeSet {
        let mut found = 0;
        if self.model.kinds.smooth {
            for (slot, lobe) in self.model.lobes.iter().enumerate() {
                found |= u8::from(self.scales[slot] != Rgb::ZERO && property(lobe)) << slot;
            }
        }
        LobeSet(found)
    }

    /// Returns the BSDF without some of its lobes.
    #[inline]
    pub fn without(&self, lobes: LobeSet) -> Self {
        let mut rest = *self;
        for (slot, scale) in rest.scales.iter_mut().enumerate() {
            *scale = if lobes.has(slot) { Rgb::ZERO } else { *scale };
        }
        rest
    }

    /// Returns the part of [`Bsdf::eval`] that is due to some of the lobes.
    #[inline]
    pub fn eval_lobes(&self, lobes: LobeSet, wo: Vec3, wi: Vec3) -> Rgb {
        let side = self.side(wo);
        let (wo, wi) = (Vec3::new(wo.x, wo.y, wo.z * side), Vec3::new(wi.x, wi.y, wi.z * side));
        let seen = self.seen(wo, side);
        seen.eval_lobes::<f32>(lobes, &seen.facet(V3::splat(wi))).into()
    }

    /// Returns true if the material is Lambertian and nothing else.
    #[inline]
    pub(super) fn is_lambert(&self) -> bool {
        self.model.lambert
    }

    /// Returns the number of the coat on the base (see [`super::Materials::coat_transmittance`]); 0 if there is none.
    #[inline]
    pub fn coat(&self) -> u32 {
        self.model.coat
    }

    /// Splits the material into base and smooth lobes. Returns the BRDF of the base, times the coat's transmittance for
    /// the cosine `cos_out`, and the part of the lobes, if they reflect anything.
    #[inline]
    pub fn split_base(&self, cos_out: f32) -> (Rgb, Option<Self>) {
        let base = self.base * self.coat_transmittance(cos_out.abs());
        (base, self.has_smooth_lobe().then_some(Bsdf { base: Rgb::ZERO, ..*self }))
    }

    /// Returns the albedo, if the material is Lambertian and nothing else.
    #[inline]
    pub fn lambert_albedo(&self) -> Option<Rgb> {
        self.is_lambert().then(|| self.base * PI)
    }

    /// Returns true if the side away from the normal behaves as the front does.
    #[inline]
    pub fn two_sided(&self) -> bool {
        self.model.two_sided
    }

    /// Returns the BSDF on a relief, given the normal without the relief in the shading frame, if shadows need it.
    #[inline]
    pub fn on_relief(self, level_normal: impl FnOnce() -> Vec3) -> Self {
        match self.model.shadows {
            true => Bsdf { level_normal: level_normal(), ..self },
            false => self,
        }
    }

    /// Returns the share of the light from `wi` that the relief leaves.
    #[inline]
    pub(super) fn lit_share(&self, wi: Vec3) -> f32 {
        self.model.lit_share::<f32>(V3::splat(self.level_normal), V3::splat(wi))
    }

    /// Returns the BSDF for directions whose z is negated.
    #[inline]
    pub fn turned(self) -> Self {
        Bsdf { level_normal: self.level_normal * Vec3::new(1.0, 1.0, -1.0), ..self }
    }

    /// Returns the material's id in the scene.
    #[inline]
    pub fn material(&self) -> MaterialId {
        self.model.material
    }

    /// Returns true if the roughness is textured and the material stands for its mean (see
    /// [`super::Materials::average`]).
    pub fn is_of_mean_roughness(&self) -> bool {
        self.model.mean_roughness
    }

    /// Returns true if the lobes differ in their factors only.
    #[inline]
    pub fn same_lobes(&self, other: &Bsdf) -> bool {
        self.model.lobe_list == other.model.lobe_list
    }

    /// Returns true if the materials differ in their colours only.
    #[inline]
    pub(super) fn is_alike(&self, other: &Bsdf) -> bool {
        self.same_lobes(other) && self.coat() == other.coat()
    }

    /// Lists slot and model of each lobe that is neither a delta lobe nor a sharp lobe and reflects anything.
    pub fn dull_lobes(&self) -> impl Iterator<Item = (usize, DullLobe<'m>)> {
        let lobes = self.model.lobes.iter().zip(self.scales).enumerate();
        let is_dull = |lobe: &LobeModel| !lobe.is_sharp() && !lobe.is_delta();
        lobes
            .filter(move |(_, (lobe, scale))| is_dull(lobe) && scale.max_element() > 0.0)
            .map(|(slot, (lobe, _))| (slot, DullLobe::new(lobe)))
    }

    /// Returns the BRDF of the base, to be multiplied by [`Bsdf::coat_transmittance`] of either direction.
    #[inline]
    pub fn base_brdf(&self) -> Rgb {
        self.base
    }

    /// Returns the factor on the lobe in a slot below `MAX_LOBES`.
    #[inline]
    pub fn lobe_scale(&self, slot: usize) -> Rgb {
        self.scales[slot]
    }

    /// Returns the share of the light at `cos` > 0 that passes the coat; 1 if there is none.
    #[inline]
    pub fn coat_transmittance(&self, cos: f32) -> f32 {
        self.model.base.interface.transmittance(cos)
    }

    /// Returns the share of the flux from `wi` that a virtual light at this point radiates diffusely to the side of
    /// `wi`: the reflection by the base, through the coat, and by the lobes rough enough to count as diffuse. Paths
    /// carry the rest.
    ///
    /// The virtual light's intensity per cosine is flux · `diffuse_albedo` / π.
    #[inline]
    pub fn diffuse_albedo(&self, wi: Vec3) -> Rgb {
        let cos = wi.z * self.side(wi);
        if !(cos > 0.0) {
            return Rgb::ZERO;
        }
        let mut albedo = self.base_albedo(cos);
        for (slot, lobe) in self.model.lobes.iter().enumerate() {
            if let Some(more) = lobe.diffuse_albedo(self.scales[slot], cos) {
                albedo += more;
            }
        }
        albedo * self.lit_share(wi)
    }

    /// Lists the reflections by lobes that a virtual light must not radiate diffusely, though the lobes are rough.
    pub fn reflected_lobes(&self, wi: Vec3) -> impl Iterator<Item = ReflectedLobe> {
        let cos = wi.z * self.side(wi);
        let lobes = self.model.lobes.iter().zip(self.scales);
        lobes.filter_map(move |(lobe, scale)| if cos > 0.0 { lobe.reflected(scale, cos) } else { None })
    }

    /// Returns the share of the light from `wo` that is scattered, without delta lobes.
    pub fn albedo(&self, wo: Vec3) -> Rgb {
        let cos = wo.z * self.side(wo);
        if !(cos > 0.0) {
            return Rgb::ZERO;
        }
        let mut albedo = self.base_albedo(cos);
        for (slot, lobe) in self.model.lobes.iter().enumerate() {
            albedo += lobe.albedo(self.scales[slot], cos);
        }
        albedo
    }

    /// Returns [`Bsdf::albedo`] at the cosine `cos` on the side of the viewer.
    pub fn albedo_at(&self, cos: f32) -> Rgb {
        self.albedo(Vec3::new(0.0, 0.0, cos.clamp(0.01, 1.0)))
    }

    /// Returns the mean with another material of the same lobes, weighted per channel.
    pub fn mean(&self, weight: Rgb, other: &Bsdf, other_weight: Rgb) -> Self {
        let total = weight + other_weight;
        let share = Rgb::select(total.cmpgt(Rgb::ZERO), other_weight / total, Rgb::ZERO);
        let mut mean = Bsdf { base: self.base + (other.base - self.base) * share, ..*self };
        for (scale, theirs) in mean.scales.iter_mut().zip(other.scales) {
            *scale = *scale + (theirs - *scale) * share;
        }
        mean
    }

    /// Returns true if a lobe of a factor other than 0 has a property.
    #[inline(always)]
    fn any_lobe(&self, property: impl Fn(&LobeModel) -> bool) -> bool {
        let mut found = false;
        for (slot, lobe) in self.model.lobes.iter().enumerate() {
            found |= self.scales[slot] != Rgb::ZERO && property(lobe);
        }
        found
    }

    /// Returns true if a lobe scatters into more than isolated directions.
    #[inline]
    fn has_smooth_lobe(&self) -> bool {
        self.model.kinds.smooth && self.any_lobe(|lobe| !lobe.is_delta())
    }

    /// Returns the factor on the z of directions that turns them to the side of the normal: -1 if a two-sided surface
    /// is seen from behind.
    #[inline]
    pub(super) fn side(&self, wo: Vec3) -> f32 {
        if wo.z < 0.0 && self.model.two_sided && !self.model.kinds.transmit { -1.0 } else { 1.0 }
    }

    /// Prepares the material for directions that were turned to the side of the normal, by the factor `side` on z.
    #[inline(always)]
    pub(super) fn seen(&self, wo: Vec3, side: f32) -> Seen<'m, f32> {
        let level_normal = self.level_normal * Vec3::new(1.0, 1.0, side);
        let [base, wo, level_normal] = [self.base, wo, level_normal].map(V3::splat);
        Seen::new(self.model, base, &self.scales.map(V3::splat), wo, level_normal)
    }

    /// Returns the share of the light from the cosine `cos` that the base reflects.
    #[inline]
    fn base_albedo(&self, cos: f32) -> Rgb {
        self.model.base.albedo::<f32>(V3::splat(self.base * self.coat_transmittance(cos))).into()
    }
}

/// Mean of BSDFs that differ only in colour, all with one weight.
#[derive(Clone, Copy, Debug)]
pub struct MeanBsdf<'m> {
    /// Sums of the colours.
    sum: Bsdf<'m>,
    count: f32,
}

impl<'m> MeanBsdf<'m> {
    /// Starts the mean with one BSDF.
    #[inline]
    pub fn new(bsdf: Bsdf<'m>) -> MeanBsdf<'m> {
        MeanBsdf { sum: bsdf, count: 1.0 }
    }

    /// Adds a BSDF of the same lobes.
    #[inline]
    pub fn add(&mut self, bsdf: &Bsdf<'m>) {
        debug_assert!(self.sum.same_lobes(bsdf) && self.sum.coat() == bsdf.coat());
        self.count += 1.0;
        self.sum.base += bsdf.base;
        for slot in 0..self.sum.model.lobes.len() {
            self.sum.scales[slot] += bsdf.scales[slot];
        }
    }

    /// Returns the mean of all BSDFs.
    #[inline]
    pub fn mean(&self) -> Bsdf<'m> {
        let share = 1.0 / self.count;
        let mut mean = self.sum;
        mean.base *= share;
        for scale in &mut mean.scales {
            *scale *= share;
        }
        mean
    }
}
