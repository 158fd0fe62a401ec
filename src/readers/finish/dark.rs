//! Emission that gives no light.

use base::math::Rgb;
use scene::{Emission, MaterialId, Scene, Share, Texture, TextureId};

/// Returns true if a surface of the given emission and material gives no light: if the emission is black, or the surface
/// is nowhere there.
pub(super) fn is_dark_emission(emission: &Emission, material: MaterialId, scene: &Scene) -> bool {
    let is_black = |id: TextureId| scene.textures.by_id(id).is_some_and(Texture::is_black);
    let opacity = scene.materials.get(material.0 as usize).and_then(|material| material.opacity);
    let is_absent = match opacity {
        Some(Share::Constant(share)) => share <= 0.0,
        Some(Share::Textured { texture, scale }) => scale <= 0.0 || is_black(texture),
        None => false,
    };
    is_absent || emission.radiance == Rgb::ZERO || emission.texture.is_some_and(is_black)
}

#[cfg(test)]
mod tests {
    use crate::{LoadOptions, load};

    #[test]
    fn surfaces_that_are_not_there_are_no_emitters_and_hide_none() {
        let square =
            |material: &str| format!("{{ shape = \"rectangle\", material = \"{material}\", emission = 2 }}");
        let text = format!(
            "material = [{{ name = \"no\", kind = \"mirror\", opacity = 0 }}, {{ name = \"yes\", kind = \"mirror\", opacity = 0.5 }}]\n\
            mesh = [{}, {}]\n",
            square("no"),
            square("yes")
        );
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.toml");
        std::fs::write(&path, text).unwrap();
        let loaded = load(&path, &LoadOptions::default()).unwrap();
        let emits: Vec<bool> = loaded.scene.meshes.iter().map(|mesh| mesh.emission.is_some()).collect();
        assert_eq!((emits, loaded.warnings.len()), (vec![false, true], 0), "{:?}", loaded.warnings);
    }
}
