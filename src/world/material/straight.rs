//! Light that goes on straight through a surface: through gaps and thin sheets.

use super::lobe::{Interface, LobeModel, MAX_LOBES};
use base::math::{Rgb, V3};
use scene::MaterialId;

/// Lobes of a material that light passes straight, if nothing of the material is textured.
#[derive(Clone, Debug, Default)]
pub(super) struct Straight {
    /// Thin sheets and their factors.
    sheets: Vec<(Interface, Rgb)>,
    /// Share of the surface that is not there.
    gaps: Rgb,
}

/// Material, cosine and transmittance of the surface that was passed last. Parallel panes have the same transmittance.
pub type LastStraight = (MaterialId, f32, Rgb);

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

    /// Returns the share of the light that passes at the cosine `cos`, of either sign.
    #[inline]
    fn transmittance(&self, cos: f32) -> Rgb {
        let mut transmittance = Rgb::ZERO;
        for (sheet, scale) in &self.sheets {
            let through = sheet.delta::<f32>(V3::splat(*scale), V3::new(0.0, 0.0, cos));
            if through.found {
                transmittance += Rgb::from(through.weight);
            }
        }
        transmittance + self.gaps
    }

    /// Returns the share of the light that passes at the cosine `cos`, which is that of the surface before if the
    /// material and the cosine are the same.
    #[inline]
    pub fn transmittance_after(&self, id: MaterialId, cos: f32, last: &mut Option<LastStraight>) -> Rgb {
        match *last {
            Some((material, at, transmittance)) if material == id && at == cos => transmittance,
            _ => {
                let transmittance = self.transmittance(cos);
                *last = Some((id, cos, transmittance));
                transmittance
            }
        }
    }
}
