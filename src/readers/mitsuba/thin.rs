//! Conversion of BSDFs of thin sheets that transmit diffuse light.

use super::converter::Converter;
use super::tree::Object;
use crate::error::SceneError;
use scene::{Material, Principled, Share};

impl Converter<'_> {
    /// Converts `principledthin`.
    pub(super) fn principled_thin(&mut self, bsdf: &Object, name: String) -> Result<Material, SceneError> {
        // Mitsuba's share counts from 0 to 2.
        let transmitted = match self.share(bsdf, "diff_trans", 0.0)? {
            Share::Constant(twice) => Share::Constant(0.5 * twice),
            Share::Textured { texture, scale } => Share::Textured { texture, scale: 0.5 * scale },
        };
        let mut share = |name: &str, default: f32| self.share(bsdf, name, default);
        let mut principled = Principled {
            roughness: share("roughness", 0.5)?,
            spec_tint: share("spec_tint", 0.0)?,
            spec_trans: share("spec_trans", 0.0)?,
            sheen: share("sheen", 0.0)?,
            sheen_tint: share("sheen_tint", 0.0)?,
            thin: Some(transmitted),
            ..Principled::default()
        };
        principled.base_color = self.reflectance(bsdf, "base_color", 0.5)?;
        if bsdf.has("eta") {
            principled.eta = self.ior(bsdf, "eta", "bk7")? as f32;
        }
        principled.anisotropic = self.share(bsdf, "anisotropic", 0.0)?;
        if self.share(bsdf, "flatness", 0.0)? != Share::Constant(0.0) {
            self.log.warn(&bsdf.place, "flatness is not supported", "it is left out")?;
        }
        let principled = Some(Box::new(principled));
        Ok(Material { name, two_sided: true, principled, ..Material::default() })
    }

    /// Converts `difftrans` of Mitsuba 0.6: a sheet that passes diffuse light and reflects none.
    pub(super) fn diffuse_transmitter(
        &mut self,
        bsdf: &Object,
        name: String,
    ) -> Result<Material, SceneError> {
        let base_color = self.reflectance(bsdf, "transmittance", 0.5)?;
        let thin = Some(Share::Constant(1.0));
        let principled = Some(Box::new(Principled { base_color, thin, ..Principled::default() }));
        Ok(Material { name, two_sided: true, principled, ..Material::default() })
    }
}
