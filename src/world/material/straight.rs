//! Light that goes on straight through a surface: by gaps, and by thin sheets.

use super::lobe::{Interface, LobeModel, MAX_LOBES};
use super::model::Materials;
use base::math::Rgb;
use glam::{Vec2, Vec3};
use scene::MaterialId;

/// Lobes that light passes straight, where nothing of the material is textured.
#[derive(Clone, Debug, Default)]
pub(super) struct Straight {
    /// Thin sheets, with their factors.
    sheets: Vec<(Interface, Rgb)>,
    /// Share of the surface that is not there.
    gaps: Rgb,
}

impl Straight {
    /// Collects the lobes that light passes straight; `None` if there are none.
    pub fn new(lobes: &[LobeModel], scales: &[Rgb; MAX_LOBES]) -> Option<Straight> {
        let mut straight = Straight::default();
        for (lobe, scale) in lobes.iter().zip(*scales).filter(|(_, scale)| *scale != Rgb::ZERO) {
            match lobe {
                LobeModel::Gap => straight.gaps += scale,
                LobeModel::Interface(sheet) if lobe.passes_straight() => {
                    straight.sheets.push((*sheet, scale))
                }
                _ => {}
            }
        }
        (straight.gaps != Rgb::ZERO || !straight.sheets.is_empty()).then_some(straight)
    }

    /// Share of the light at the cosine `cos`, of either sign.
    #[inline]
    fn transmittance(&self, cos: f32) -> Rgb {
        let mut transmittance = Rgb::ZERO;
        for (sheet, scale) in &self.sheets {
            if let Some(sample) = sheet.delta(*scale, Vec3::new(0.0, 0.0, cos)) {
                transmittance += sample.weight;
            }
        }
        transmittance + self.gaps
    }
}

/// Material, cosine and transmittance of the surface passed last: parallel panes pass the same.
pub type LastStraight = (MaterialId, f32, Rgb);

impl Materials {
    /// Share of the light at the cosine to the shading normal, of either sign, that passes straight through a surface.
    /// The cosine is only asked for where it counts, and texture coordinates where there is a texture.
    #[inline]
    pub fn straight_transmittance(
        &self,
        id: MaterialId,
        cos: impl FnOnce() -> f32,
        uv: impl Fn() -> Vec2,
        last: &mut Option<LastStraight>,
    ) -> Rgb {
        let Some(straight) = self.straight(id) else {
            if let Some(gaps) = self.gaps(id, &uv) {
                return Rgb::splat(gaps);
            }
            return self.at_coordinates(id, uv, || 0.0).straight_transmittance(cos());
        };
        let cos = cos();
        match *last {
            Some((material, at, transmittance)) if material == id && at == cos => transmittance,
            _ => {
                let transmittance = straight.transmittance(cos);
                *last = Some((id, cos, transmittance));
                transmittance
            }
        }
    }
}
