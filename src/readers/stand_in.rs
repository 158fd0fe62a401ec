//! Stand-ins for textures whose files cannot be read or decoded.
//!
//! A grey of 0.5 stands in for a colour, and 0.5 for a number. A surface without its mask is opaque, and one without
//! its relief is smooth.

use crate::decode::DecodedImage;
use crate::error::{Location, Log, SceneError, Warning};
use base::math::Rgb;
use scene::{Material, Relief, Share, Texels};
use std::collections::BTreeMap;

/// Textures by index that cannot be read, with a warning about each.
pub(crate) type MissingImages = BTreeMap<usize, Warning>;

/// Linear value of the stand-in for a texel.
const GREY: f32 = 0.5;

/// Returns the warning about a texture that `error` tells of; `place` refers to it.
///
/// # Errors
/// If the image is sound, but does not fit into memory.
pub(crate) fn warning(error: SceneError, place: &Location) -> Result<Warning, SceneError> {
    let (what, remedy) = match error {
        SceneError::Read { path, error, .. } => {
            (format!("cannot read {}: {error}", path.display()), "check the name and its permissions")
        }
        SceneError::Foreign { path, kind, .. } => {
            (format!("{} is {}", path.display(), kind.what), kind.remedy)
        }
        SceneError::Image { path, what, .. } => {
            let remedy = "convert it to PNG, JPEG, BMP, TGA, Radiance HDR or OpenEXR";
            (format!("cannot decode {}: {what}", path.display()), remedy)
        }
        error => return Err(error),
    };
    Ok(Warning::new(place.clone(), what, format!("a grey of {GREY} is used instead; {remedy}")))
}

/// Replaces missing images, with their warnings.
///
/// # Errors
/// Under `strict`, all warnings as one error.
pub(crate) fn replace(
    missing: MissingImages,
    images: &mut [Option<DecodedImage>],
    materials: &mut [Material],
    log: &mut Log,
) -> Result<(), SceneError> {
    for material in materials {
        drop_masks_and_reliefs(material, &missing);
    }
    for (i, warning) in missing {
        let texels = Texels::new(1, &[Rgb::splat(GREY)]);
        images[i] = Some(DecodedImage { width: 1, height: 1, texels });
        let added = log.add(warning);
        log.part(added);
    }
    log.conclude(Ok(()))
}

fn drop_masks_and_reliefs(material: &mut Material, missing: &MissingImages) {
    let is_missing = |texture: u32| missing.contains_key(&(texture as usize));
    if let Some(Share::Textured { texture, scale }) = material.opacity
        && is_missing(texture.0)
    {
        material.opacity = Some(Share::Constant(scale));
    }
    if let Some(Relief::Normals { texture, .. } | Relief::Heights { texture, .. }) = material.relief
        && is_missing(texture.0)
    {
        material.relief = None;
    }
    if let Some(blend) = &mut material.blend {
        drop_masks_and_reliefs(&mut blend.other, missing);
    }
}
