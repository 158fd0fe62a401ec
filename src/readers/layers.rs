//! Materials made of other materials: coats over them, and blends.

use super::error::{Location, Log, SceneError};
use base::math::Rgb;
use scene::{Blend, Coat, Lobe, Material, Reflectance, Share};

/// Dielectric surface of a coat.
pub(super) struct CoatSurface {
    /// Interior over exterior index of refraction.
    pub eta: f32,
    pub lobe: Lobe,
    /// Transmittance of the way through the coat and back.
    pub through: Rgb,
}

/// Returns a material under a dielectric coat.
///
/// A diffuse base becomes the base of plastic. Lobes are attenuated by the coat's transmittance at normal incidence.
/// Materials that cannot be coated stay bare, with a warning.
pub(super) fn coated(
    mut nested: Material,
    surface: CoatSurface,
    place: &Location,
    log: &mut Log,
) -> Result<Material, SceneError> {
    let CoatSurface { eta, lobe, through } = surface;
    let transmits = |lobe: &Lobe| matches!(lobe, Lobe::Dielectric { .. } | Lobe::RoughDielectric { .. });
    let is_layered = nested.coat.is_some() || nested.principled.is_some() || nested.blend.is_some();
    if is_layered || nested.lobes.iter().any(transmits) {
        let what = "a coating of plastic, glass, principled materials or blends is not supported";
        log.warn(place, what, "it is left out")?;
        return Ok(nested);
    }
    let normal = 4.0 * eta / ((eta + 1.0) * (eta + 1.0));
    for lobe in &mut nested.lobes {
        if let Lobe::Rough { scale, .. } | Lobe::Anisotropic { scale, .. } | Lobe::Mirror { scale, .. } = lobe
        {
            *scale = scale.times(through * (normal * normal));
        }
    }
    nested.diffuse = nested.diffuse.times(through);
    nested.coat = Some(Coat { eta, nonlinear: true });
    nested.lobes.insert(0, lobe);
    Ok(nested)
}

/// Returns the mixture of two materials; `weight` is the share of the second.
///
/// These are left out with a warning: masks and reliefs of the second material, and a blend as the first.
pub(super) fn blended(
    weight: Share,
    [first, other]: [Material; 2],
    place: &Location,
    log: &mut Log,
) -> Result<Material, SceneError> {
    let is_based =
        |material: &Material| material.principled.is_some() || material.diffuse != Reflectance::BLACK;
    let coat = |material: &Material| (material.coat, material.principled.is_some());
    if is_based(&first) && is_based(&other) && coat(&first) != coat(&other) {
        let fallback = "the coat of the first is on both";
        log.warn(place, "a blend of bases under different coats is not supported", fallback)?;
    }
    for (is_left_out, what) in [
        (first.blend.is_some(), "a blend as the first material of a blend"),
        (other.opacity.is_some() || other.relief.is_some(), "a mask or relief of the second material"),
    ] {
        if is_left_out {
            log.warn(place, format!("{what} is not supported"), "it is left out")?;
        }
    }
    Ok(Material { blend: Some(Box::new(Blend { weight, other })), ..first })
}
