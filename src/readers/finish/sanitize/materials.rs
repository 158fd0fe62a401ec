//! Checks of materials. Numbers out of range are errors; reflectances and texels that would create energy are clamped.

use super::report::SanitizeReport;
use super::texels::TexelLimits;
use crate::error::{Location, Log, SceneError};
use base::math::Rgb;
use scene::{Fresnel, Lobe, Material, Parameter, Principled, Reflectance, Relief, Roughness, Share};

/// Excess of a reflectance over 1 that counts as rounding.
const ALBEDO_SLACK: f32 = 1e-3;
/// Minimum roughness α, as in Mitsuba.
pub(super) const MIN_ALPHA: f32 = 1e-4;
/// Maximum roughness α. Such a surface is almost black.
const MAX_ALPHA: f32 = 4.0;
/// Maximum η and k of a conductor. Metals are below 100. The fourth powers are finite in f32.
const MAX_CONDUCTOR: f32 = 1e6;

/// Checks a material and the materials mixed with it; clamps reflectances and texels.
pub(super) fn check_material(
    material: &mut Material,
    texels: &mut TexelLimits,
    place: &Location,
    report: &mut SanitizeReport,
    log: &mut Log,
) -> Result<(), SceneError> {
    let checks = MaterialChecks { name: material.name.clone(), place };
    if let Some(principled) = &mut material.principled {
        checks.principled(principled)?;
        if let Some(thin) = &mut principled.thin {
            checks.thin(thin, texels, report)?;
        }
    }
    for lobe in &mut material.lobes {
        checks.lobe(lobe, texels, report)?;
    }
    if let Some(blend) = &mut material.blend {
        check_material(&mut blend.other, texels, place, report, log)?;
    }
    checks.indices_of_refraction(material)?;
    for reflectance in material.reflectances_mut() {
        checks.reflectance(reflectance, texels, report, log)?;
    }
    for share in material.shares_mut() {
        checks.share(share, texels, report)?;
    }
    if let Some(relief) = &material.relief {
        let (Relief::Normals { strength: factor, .. } | Relief::Heights { scale: factor, .. }) = relief;
        if !factor.is_finite() {
            return Err(checks.wrong(format!("its relief has the factor {factor}"), "give a number"));
        }
    }
    if let Some(absorption) = material.absorption {
        if !(absorption.is_finite() && absorption.min_element() >= 0.0) {
            let what = format!("its absorption {absorption} per unit of length is invalid");
            return Err(checks.wrong(what, "give an attenuation colour from 0 to 1 and a distance above 0"));
        }
        material.absorption = Some(absorption).filter(|absorption| *absorption != Rgb::ZERO);
    }
    material.opacity = material.opacity.filter(|opacity| *opacity != Share::Constant(1.0));
    scale_sum(material, place, report, log)
}

/// Checker of the parts of one material.
struct MaterialChecks<'a> {
    name: String,
    place: &'a Location,
}

impl MaterialChecks<'_> {
    fn wrong(&self, what: String, remedy: &str) -> SceneError {
        self.place.wrong(format!("material \"{}\": {what}", self.name), remedy)
    }

    fn principled(&self, principled: &Principled) -> Result<(), SceneError> {
        if let Share::Constant(anisotropic) = principled.anisotropic
            && !(0.0..=1.0).contains(&anisotropic)
        {
            let what = format!("its anisotropy is {anisotropic}");
            return Err(self.wrong(what, "give 0 to 1"));
        }
        if !principled.anisotropic_rotation.is_finite() {
            return Err(self.wrong("the angle of its anisotropy is not finite".into(), "give an angle"));
        }
        if !(0.0..=1.0).contains(&principled.clearcoat_gloss) {
            let what = format!("its clear coat's gloss is {}", principled.clearcoat_gloss);
            return Err(self.wrong(what, "give 0 to 1"));
        }
        Ok(())
    }

    /// Checks the share of diffuse light that a sheet transmits. The factor on its texels may be below 1.
    fn thin(
        &self,
        share: &mut Share,
        texels: &mut TexelLimits,
        report: &mut SanitizeReport,
    ) -> Result<(), SceneError> {
        let (Share::Constant(value) | Share::Textured { scale: value, .. }) = *share;
        if !(0.0..=1.0 + ALBEDO_SLACK).contains(&value) {
            let what = format!("it transmits {} of its diffuse light", 2.0 * value);
            return Err(self.wrong(what, "give 0 to 2"));
        }
        if let Share::Textured { texture, scale } = share {
            texels.fit(texture, Rgb::splat(*scale), self.place, report);
        }
        Ok(())
    }

    /// Checks optical constants and roughness; raises roughness to [`MIN_ALPHA`].
    fn lobe(
        &self,
        lobe: &mut Lobe,
        texels: &mut TexelLimits,
        report: &mut SanitizeReport,
    ) -> Result<(), SceneError> {
        if let Lobe::Rough { fresnel: Fresnel::Conductor { eta, k }, .. }
        | Lobe::Anisotropic { fresnel: Fresnel::Conductor { eta, k }, .. }
        | Lobe::Mirror { fresnel: Fresnel::Conductor { eta, k }, .. } = lobe
        {
            let is_metal = |v: Rgb| v.cmpge(Rgb::ZERO).all() && v.cmple(Rgb::splat(MAX_CONDUCTOR)).all();
            if !(is_metal(*eta) && is_metal(*k)) {
                let what = format!("its optical constants eta {eta} and k {k} are out of range");
                return Err(self.wrong(what, "give numbers from 0 to 1e6"));
            }
        }
        match lobe {
            Lobe::Rough { alpha, .. } | Lobe::RoughDielectric { alpha, .. } => {
                self.roughness(alpha, texels, report)
            }
            Lobe::Anisotropic { alpha, .. } => {
                alpha.iter_mut().try_for_each(|alpha| self.roughness(alpha, texels, report))
            }
            Lobe::Mirror { .. } | Lobe::Dielectric { .. } => Ok(()),
        }
    }

    fn roughness(
        &self,
        alpha: &mut Roughness,
        texels: &mut TexelLimits,
        report: &mut SanitizeReport,
    ) -> Result<(), SceneError> {
        let (Roughness::Constant(value) | Roughness::Textured { scale: value, .. }) = alpha;
        if !(0.0..=MAX_ALPHA).contains(value) {
            return Err(self.wrong(format!("its roughness is {value}"), "give 0 to 1, at most 4"));
        }
        match alpha {
            Roughness::Constant(value) => *value = value.max(MIN_ALPHA),
            Roughness::Textured { texture, scale } => {
                texels.fit(texture, Rgb::splat(*scale), self.place, report);
            }
        }
        Ok(())
    }

    fn indices_of_refraction(&self, material: &Material) -> Result<(), SceneError> {
        let of_lobe = |lobe: &Lobe| match lobe {
            Lobe::Dielectric { eta, .. } | Lobe::RoughDielectric { eta, .. } => Some(*eta),
            Lobe::Rough { .. } | Lobe::Anisotropic { .. } | Lobe::Mirror { .. } => None,
        };
        let of_coat = material.coat.map(|coat| coat.eta);
        let of_principled = material.principled.as_ref().map(|principled| principled.eta);
        let of_lobes = material.lobes.iter().filter_map(of_lobe);
        let mut indices = of_coat.into_iter().chain(of_principled).chain(of_lobes);
        match indices.find(|eta| !(eta.is_finite() && *eta > 0.0)) {
            Some(eta) => {
                Err(self.wrong(format!("its index of refraction is {eta}"), "give a number above 0"))
            }
            None => Ok(()),
        }
    }

    fn reflectance(
        &self,
        reflectance: &mut Reflectance,
        texels: &mut TexelLimits,
        report: &mut SanitizeReport,
        log: &mut Log,
    ) -> Result<(), SceneError> {
        match reflectance {
            Reflectance::Constant(albedo) => {
                if !albedo.is_finite() || albedo.min_element() < 0.0 {
                    let what = format!("the reflectance {albedo} is negative or not a number");
                    return Err(self.wrong(what, "give 0 to 1"));
                }
                if albedo.max_element() > 1.0 + ALBEDO_SLACK {
                    let what = format!("material \"{}\": the reflectance {albedo} exceeds 1", self.name);
                    log.warn(self.place, what, "it is clamped to 1")?;
                }
                report.clamped += usize::from(albedo.max_element() > 1.0);
                *albedo = albedo.min(Rgb::ONE);
            }
            Reflectance::Textured { texture, scale } => {
                if !scale.is_finite() || scale.min_element() < 0.0 {
                    let what = format!("the texture's factor {scale} is negative or not a number");
                    return Err(self.wrong(what, "give 0 to 1"));
                }
                texels.fit(texture, *scale, self.place, report);
            }
        }
        Ok(())
    }

    fn share(
        &self,
        share: &mut Share,
        texels: &mut TexelLimits,
        report: &mut SanitizeReport,
    ) -> Result<(), SceneError> {
        let (value, most) = match share {
            Parameter::Constant(value) => (value, 1.0),
            Parameter::Textured { scale, .. } => (scale, f32::MAX),
        };
        if !(*value >= 0.0 && *value <= most + ALBEDO_SLACK) {
            return Err(self.wrong(format!("a share of {value}"), "give 0 to 1"));
        }
        *value = value.min(most);
        if let Parameter::Textured { texture, scale } = share {
            texels.fit(texture, Rgb::splat(*scale), self.place, report);
        }
        Ok(())
    }
}

/// Scales a bare Lambert base and lobes of constant reflectance whose sum exceeds 1, as Mitsuba does.
fn scale_sum(
    material: &mut Material,
    place: &Location,
    report: &mut SanitizeReport,
    log: &mut Log,
) -> Result<(), SceneError> {
    let (None, Reflectance::Constant(base)) = (material.coat, material.diffuse) else { return Ok(()) };
    let constant = |lobe: &Lobe| match lobe {
        Lobe::Rough { fresnel: Fresnel::One, scale: Reflectance::Constant(scale), .. }
        | Lobe::Anisotropic { fresnel: Fresnel::One, scale: Reflectance::Constant(scale), .. }
        | Lobe::Mirror { fresnel: Fresnel::One, scale: Reflectance::Constant(scale) } => *scale,
        _ => Rgb::ZERO,
    };
    let lobes: Rgb = material.lobes.iter().map(constant).sum();
    if lobes != Rgb::ZERO && (base + lobes).max_element() > 1.0 + ALBEDO_SLACK {
        let what =
            format!("material \"{}\": diffuse {base} and specular {lobes} exceed 1 together", material.name);
        log.warn(place, what, "they are scaled to 1; lower one of them")?;
        report.clamped += 1;
        let factor = (base + lobes).max_element().recip();
        material.diffuse = Reflectance::Constant(base * factor);
        for lobe in &mut material.lobes {
            if let Lobe::Rough { fresnel: Fresnel::One, scale: Reflectance::Constant(scale), .. }
            | Lobe::Anisotropic { fresnel: Fresnel::One, scale: Reflectance::Constant(scale), .. }
            | Lobe::Mirror { fresnel: Fresnel::One, scale: Reflectance::Constant(scale) } = lobe
            {
                *scale *= factor;
            }
        }
    }
    Ok(())
}
