//! Texels within the limits of their uses.
//!
//! Limits apply to the product of texel and factor. A use whose limits a texture exceeds gets a copy with clamped
//! texels, so that other uses keep theirs.

use super::report::SanitizeReport;
use crate::error::{Location, Warning};
use crate::mend::{INFINITE, counted};
use base::math::Rgb;
use scene::{AttributeTexture, Texels, Texture, TextureId, Textures};

/// Textures of a scene, and clamped copies of them.
pub(super) struct TexelLimits<'a> {
    textures: &'a Textures,
    /// Original, limit and copy.
    copies: Vec<(TextureId, Rgb, Texture)>,
    remarks: Vec<Warning>,
}

impl<'a> TexelLimits<'a> {
    /// Starts without copies.
    pub fn new(textures: &'a Textures) -> TexelLimits<'a> {
        TexelLimits { textures, copies: Vec::new(), remarks: Vec::new() }
    }

    /// Lets a use of a texture at `place` see only texels from 0 to 1 after their multiplication by `factor`.
    pub fn fit(&mut self, id: &mut TextureId, factor: Rgb, place: &Location, report: &mut SanitizeReport) {
        self.limit(id, factor.max(Rgb::splat(f32::MIN_POSITIVE)).recip(), place, report);
    }

    /// Lets a use of a texture at `place` see only texels from 0 to `limit`.
    pub fn limit(&mut self, id: &mut TextureId, limit: Rgb, place: &Location, report: &mut SanitizeReport) {
        let Some(texture) = self.textures.by_id(*id) else { return };
        let fits = |texel: Rgb| texel.cmpge(Rgb::ZERO).all() && texel.cmple(limit).all();
        if texture.texels.all(fits) {
            return;
        }
        let known = self.copies.iter().position(|(original, at, _)| original == id && *at == limit);
        let copy = known.unwrap_or_else(|| {
            self.copies.push((*id, limit, clamped(texture, limit, report)));
            self.remark(texture, place);
            self.copies.len() - 1
        });
        *id = TextureId((self.textures.len() + copy) as u32);
    }

    /// Limits the image that is a factor of an attribute to 0 to 1.
    pub fn fit_image(&mut self, of: &mut AttributeTexture, place: &Location, report: &mut SanitizeReport) {
        if let Some(image) = &mut of.image {
            self.fit(image, Rgb::ONE, place, report);
        }
    }

    /// Names negative texels.
    fn remark(&mut self, texture: &Texture, place: &Location) {
        let is_negative = |texel: Rgb| texel.min_element() < 0.0;
        let mut negative = (0..).zip(texture.texels.iter()).filter(|(_, texel)| is_negative(*texel));
        if let Some((first, _)) = negative.next() {
            let counted = counted(1 + negative.count(), first, texture.width, "negative");
            let what = format!("the image \"{}\": {counted}", texture.name);
            self.remarks.push(Warning::new(
                place.clone(),
                what,
                "negative texels count as 0; repair the image",
            ));
        }
    }

    /// Returns the copies, which follow the images of the scene, and warnings about them.
    pub fn finish(self) -> (Vec<Texture>, Vec<Warning>) {
        (self.copies.into_iter().map(|(.., copy)| copy).collect(), self.remarks)
    }
}

/// Returns a texture with its texels clamped to 0 to `limit`.
fn clamped(texture: &Texture, limit: Rgb, report: &mut SanitizeReport) -> Texture {
    let mut texels: Vec<Rgb> = texture.texels.iter().collect();
    texels.iter_mut().for_each(|texel| clamp_value(texel, limit, report));
    Texture { texels: Texels::new(texture.width, &texels), ..texture.clone() }
}

/// Raises a value to 0 and lowers it to a limit. NaN becomes 0, and infinity the limit, at most [`INFINITE`].
pub(super) fn clamp_value(value: &mut Rgb, limit: Rgb, report: &mut SanitizeReport) {
    if !value.is_finite() || value.min_element() < 0.0 {
        report.bad_texels += 1;
        let mended = |value: f32| match value {
            f32::INFINITY => INFINITE,
            value => value.max(0.0),
        };
        *value = Rgb::from(value.to_array().map(mended));
    }
    if value.cmpgt(limit).any() {
        report.clamped += 1;
        *value = value.min(limit);
    }
}
