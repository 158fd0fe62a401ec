//! Means and ranges of textures, over texels or over the surfaces that have an attribute.

use super::attribute::{Attribute, AttributeId};
use super::texture::{Texels, TextureId};
use super::{Mesh, Scene};
use base::math::{Rgb, luminance};
use glam::DVec3;

impl Scene {
    /// Returns the mean of an attribute over the surfaces that have it; white if none has.
    pub fn attribute_mean(&self, id: AttributeId) -> Rgb {
        let add = |(sum, area): (DVec3, f64), (of_mesh, of_its_area): (DVec3, f64)| {
            (sum + of_mesh, area + of_its_area)
        };
        let of_mesh = |(mesh, areas): (&Mesh, f64)| {
            let (sum, area) = mesh.integrate_attribute(id);
            (sum * areas, area * areas)
        };
        let (sum, area) =
            self.meshes.iter().zip(self.area_factors()).map(of_mesh).fold((DVec3::ZERO, 0.0), add);
        if area > 0.0 { (sum / area).as_vec3() } else { Rgb::ONE }
    }

    /// Returns bounds of the luminance of a texture; `None` if there is no such texture.
    pub fn luminance_range(&self, id: TextureId) -> Option<(f32, f32)> {
        let Some(texture) = self.textures.attribute(id) else {
            return self.textures.by_id(id).and_then(|image| range_of_texels(&image.texels));
        };
        let attributes = self.meshes.iter().flat_map(|mesh| &mesh.attributes);
        let of_id = |attribute: &&Attribute| attribute.id == texture.attribute;
        let values = attributes.filter(of_id).flat_map(|attribute| attribute.values.all());
        let of_attribute = range(values.map(|value| luminance(*value))).unwrap_or((1.0, 1.0));
        let of_image = texture.image.and_then(|image| self.luminance_range(image)).unwrap_or((1.0, 1.0));
        Some((of_attribute.0 * of_image.0, of_attribute.1 * of_image.1))
    }
}

fn range_of_texels(texels: &Texels) -> Option<(f32, f32)> {
    range(texels.iter().map(luminance))
}

fn range(values: impl Iterator<Item = f32>) -> Option<(f32, f32)> {
    values.map(|value| (value, value)).reduce(|(low, high), (value, _)| (low.min(value), high.max(value)))
}
