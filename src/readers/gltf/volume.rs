//! Volumes inside surfaces: `KHR_materials_volume`.
//!
//! Light is absorbed by the length of its way inside, whatever the stated thickness: a thickness above 0 only tells
//! solid glass from sheets. Base colour tints light at each passage through the surface, as the extension says.
//!
//! Units: the attenuation distance is in metres of the file, and scales with the placement of the whole model.

use super::importer::Importer;
use crate::attenuation::absorption;
use base::math::Rgb;
use glam::DMat4;
use gltf_json::extensions::material::Volume;

impl Importer<'_> {
    /// Returns the absorption coefficient inside a surface; `None` if nothing is absorbed.
    pub(super) fn absorption(&mut self, volume: &Volume, name: &str) -> Option<Rgb> {
        let distance = f64::from(volume.attenuation_distance.0);
        let colour = Rgb::from(volume.attenuation_color.0);
        if !(distance > 0.0 && colour.is_finite()) {
            let what = "an attenuation without a distance above 0 and a colour of numbers";
            self.report.lacks(what, "nothing is absorbed inside", name);
            return None;
        }
        absorption(colour, distance * mean_scale(&self.options.to_world))
    }
}

/// Returns the factor of a transform on lengths, averaged over all directions.
fn mean_scale(transform: &DMat4) -> f64 {
    transform.determinant().abs().cbrt()
}
