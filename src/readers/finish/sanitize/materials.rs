//! Materials: numbers out of range are errors; reflectances and texels that would create energy are clamped.

use super::SanitizeReport;
use crate::error::{Log, Place, SceneError};
use base::math::Rgb;
use scene::{Fresnel, Lobe, Material, Reflectance, Relief, Roughness, Share, Texels, Texture};

/// Tolerance by which a reflectance may exceed 1 through rounding.
const ALBEDO_SLACK: f32 = 1e-3;
/// Minimum roughness, that of Mitsuba.
pub(super) const MIN_ALPHA: f32 = 1e-4;
/// Maximum roughness, at which a surface is all but black.
const MAX_ALPHA: f32 = 4.0;
/// Maximum η and k of a conductor; those of metals are below 100, and the fourth powers of these are finite.
const MAX_CONDUCTOR: f32 = 1e6;

/// Checks a material and those mixed with it.
pub(super) fn check_material(
    material: &mut Material,
    textures: &mut [Texture],
    place: &Place,
    report: &mut SanitizeReport,
    log: &mut Log,
) -> Result<(), SceneError> {
    let name = material.name.clone();
    let wrong = |what: String, remedy: &str| Err(place.wrong(format!("material \"{name}\": {what}"), remedy));
    let positive = |v: f32| v.is_finite() && v > 0.0;
    let mut etas = Vec::from_iter(material.coat.map(|coat| coat.eta));
    if let Some(principled) = &material.principled {
        etas.push(principled.eta);
        if !(0.0..=1.0).contains(&principled.anisotropic) {
            return wrong(
                format!("its roughness is anisotropic by {}", principled.anisotropic),
                "give 0 to 1",
            );
        }
        if !principled.anisotropic_rotation.is_finite() {
            return wrong("the angle of its anisotropy is not finite".into(), "give an angle");
        }
        if !(0.0..=1.0).contains(&principled.clearcoat_gloss) {
            return wrong(format!("its clear coat's gloss is {}", principled.clearcoat_gloss), "give 0 to 1");
        }
    }
    for lobe in &mut material.lobes {
        if let Lobe::Rough { fresnel: Fresnel::Conductor { eta, k }, .. }
        | Lobe::Anisotropic { fresnel: Fresnel::Conductor { eta, k }, .. }
        | Lobe::Mirror { fresnel: Fresnel::Conductor { eta, k }, .. } = lobe
        {
            let is_metal = |v: Rgb| v.cmpge(Rgb::ZERO).all() && v.cmple(Rgb::splat(MAX_CONDUCTOR)).all();
            if !(is_metal(*eta) && is_metal(*k)) {
                return wrong(
                    format!("its optical constants eta {eta} and k {k} are out of range"),
                    "give numbers from 0 to 1e6",
                );
            }
        }
        if let Lobe::Dielectric { eta, .. } | Lobe::RoughDielectric { eta, .. } = lobe {
            etas.push(*eta);
        }
        match lobe {
            Lobe::Rough { alpha, .. } | Lobe::RoughDielectric { alpha, .. } => {
                let (Roughness::Constant(value) | Roughness::Textured { scale: value, .. }) = alpha;
                if !(0.0..=MAX_ALPHA).contains(value) {
                    return wrong(format!("its roughness is {value}"), "give 0 to 1, at most 4");
                }
                match alpha {
                    Roughness::Constant(value) => *value = value.max(MIN_ALPHA),
                    Roughness::Textured { texture, scale } => {
                        if let Some(texture) = textures.get_mut(texture.0 as usize) {
                            clamp_texels(texture, Rgb::splat(*scale), report);
                        }
                    }
                }
            }
            Lobe::Anisotropic { alpha, .. } => {
                if let Some(value) = alpha.iter().find(|value| !(0.0..=MAX_ALPHA).contains(*value)) {
                    return wrong(format!("its roughness is {value}"), "give 0 to 1, at most 4");
                }
                *alpha = alpha.map(|value| value.max(MIN_ALPHA));
            }
            Lobe::Mirror { .. } | Lobe::Dielectric { .. } => {}
        }
    }
    if let Some(blend) = &mut material.blend {
        check_material(&mut blend.other, textures, place, report, log)?;
    }
    if let Some(eta) = etas.into_iter().find(|eta| !positive(*eta)) {
        return wrong(format!("its index of refraction is {eta}"), "give a number above 0");
    }
    for reflectance in material.reflectances_mut() {
        match reflectance {
            Reflectance::Constant(albedo) => {
                if !albedo.is_finite() || albedo.min_element() < 0.0 {
                    return wrong(
                        format!("the reflectance {albedo} is negative or no number"),
                        "give 0 to 1",
                    );
                }
                if albedo.max_element() > 1.0 + ALBEDO_SLACK {
                    let what = format!("material \"{name}\": the reflectance {albedo} exceeds 1");
                    log.warn(place, what, "it is clamped to 1")?;
                }
                report.clamped += usize::from(albedo.max_element() > 1.0);
                *albedo = albedo.min(Rgb::ONE);
            }
            Reflectance::Textured { texture, scale } => {
                if !scale.is_finite() || scale.min_element() < 0.0 {
                    return wrong(
                        format!("the texture's factor {scale} is negative or no number"),
                        "give 0 to 1",
                    );
                }
                let Some(texture) = textures.get_mut(texture.0 as usize) else { continue };
                clamp_texels(texture, *scale, report);
            }
        }
    }
    for share in material.shares_mut() {
        let (Share::Constant(value) | Share::Textured { scale: value, .. }) = share;
        if !(*value >= 0.0 && *value <= 1.0 + ALBEDO_SLACK) {
            return wrong(format!("a share of {value}"), "give 0 to 1");
        }
        *value = value.min(1.0);
        if let Share::Textured { texture, .. } = share {
            textures.get_mut(texture.0 as usize).into_iter().for_each(|t| clamp_texels(t, Rgb::ONE, report));
        }
    }
    if let Some(relief) = &material.relief {
        let (Relief::Normals { strength: factor, .. } | Relief::Heights { scale: factor, .. }) = relief;
        if !factor.is_finite() {
            return wrong(format!("its relief has the factor {factor}"), "give a number");
        }
    }
    material.opacity = material.opacity.filter(|opacity| *opacity != Share::Constant(1.0));
    scale_sum(material, place, report, log)
}

/// Scales a bare Lambert base and lobes of constant reflectance that exceed 1 together, as Mitsuba does.
fn scale_sum(
    material: &mut Material,
    place: &Place,
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

fn clamp_texels(texture: &mut Texture, scale: Rgb, report: &mut SanitizeReport) {
    let limit = scale.max(Rgb::ONE).recip();
    let fits = |texel: Rgb| texel.cmpge(Rgb::ZERO).all() && texel.cmple(limit).all();
    if texture.texels.all(fits) {
        return;
    }
    let mut texels: Vec<Rgb> = texture.texels.iter().collect();
    for texel in &mut texels {
        if !texel.is_finite() || texel.min_element() < 0.0 {
            report.bad_texels += 1;
            *texel = if texel.is_nan() { Rgb::ZERO } else { texel.max(Rgb::ZERO) };
        }
        if texel.cmpgt(limit).any() {
            report.clamped += 1;
            *texel = texel.min(limit);
        }
    }
    texture.texels = Texels::new(texture.width, &texels);
}
