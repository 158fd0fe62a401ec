//! Changes of what a scene shows: meshes that are left out, and clay in place of all materials.

use crate::draft::{Draft, DraftMesh};
use crate::error::{Location, SceneError};
use base::math::Rgb;
use scene::{Material, Parameter};
use std::mem;

/// Reflectance of clay.
const CLAY: f32 = 0.5;

/// Maximum number of names that an error lists.
const MAX_NAMED: usize = 12;

/// Changes of what a scene shows. The default changes nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Looks {
    /// True if all surfaces are of grey clay. Emitters and gaps stay.
    pub clay: bool,
    /// Names of meshes or materials: others are left out, if there is a name. `*` stands for any characters.
    pub show: Vec<String>,
    /// Names of meshes or materials that are left out, likewise.
    pub hide: Vec<String>,
}

impl Looks {
    /// Changes a draft.
    ///
    /// # Errors
    /// If a name is not that of a mesh or a material.
    pub(crate) fn apply(&self, draft: &mut Draft, place: &Location) -> Result<(), SceneError> {
        let materials = &draft.scene.materials;
        let names = |mesh: &DraftMesh| {
            let material = materials.get(mesh.material.0 as usize);
            [mesh.name.clone(), material.map_or(String::new(), |material| material.name.clone())]
        };
        let named: Vec<[String; 2]> = draft.meshes.iter().map(names).collect();
        for pattern in self.show.iter().chain(&self.hide) {
            if !named.iter().flatten().any(|name| matches(pattern, name)) {
                return Err(unknown(pattern, &named, place));
            }
        }
        let is_any = |patterns: &[String], names: &[String; 2]| {
            patterns.iter().any(|pattern| names.iter().any(|name| matches(pattern, name)))
        };
        let mut kept = named
            .iter()
            .map(|names| (self.show.is_empty() || is_any(&self.show, names)) && !is_any(&self.hide, names));
        draft.meshes.retain(|_| kept.next().unwrap_or(true));
        for material in draft.scene.materials.iter_mut().filter(|_| self.clay) {
            *material = Material {
                name: mem::take(&mut material.name),
                two_sided: true,
                diffuse: Parameter::Constant(Rgb::splat(CLAY)),
                opacity: material.opacity,
                ..Material::default()
            };
        }
        Ok(())
    }
}

/// Returns true if a name has a pattern, in which `*` stands for any characters.
fn matches(pattern: &str, name: &str) -> bool {
    let Some((start, rest)) = pattern.split_once('*') else { return pattern == name };
    let Some(left) = name.strip_prefix(start) else { return false };
    left.char_indices().map(|(at, _)| at).chain([left.len()]).any(|at| matches(rest, &left[at..]))
}

fn unknown(pattern: &str, named: &[[String; 2]], place: &Location) -> SceneError {
    let mut names: Vec<&str> =
        named.iter().flatten().map(String::as_str).filter(|name| !name.is_empty()).collect();
    names.sort_unstable();
    names.dedup();
    let others = names.len().saturating_sub(MAX_NAMED);
    names.truncate(MAX_NAMED);
    let more = if others > 0 { format!(", and {others} more") } else { String::new() };
    let what = format!("there is no mesh or material \"{pattern}\" to show or hide");
    place.wrong(what, format!("name one of {}{more}", names.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LoadOptions, Loaded, load};

    fn loaded(looks: Looks) -> Result<Loaded, SceneError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.toml");
        let material = |name: &str, more: &str| format!("[[material]]\nname = \"{name}\"\n{more}\n");
        let mesh = |shape: &str, material: &str| {
            format!("[[mesh]]\nshape = \"{shape}\"\nmaterial = \"{material}\"\n")
        };
        let text = material("red", "kind = \"diffuse\"\nreflectance = [0.8, 0.1, 0.1]")
            + &material("glass", "kind = \"glass\"")
            + &mesh("cube", "red")
            + &mesh("sphere", "glass")
            + &mesh("rectangle", "red");
        std::fs::write(&path, text).unwrap();
        load(&path, &LoadOptions { looks, ..LoadOptions::default() })
    }

    fn names(show: &[&str], hide: &[&str]) -> Vec<String> {
        let [show, hide] = [show, hide].map(|names| names.iter().map(|name| (*name).to_owned()).collect());
        let scene = loaded(Looks { show, hide, clay: false }).unwrap().scene;
        scene.meshes.into_iter().map(|mesh| mesh.name).collect()
    }

    #[test]
    fn meshes_are_shown_and_hidden_by_their_names_and_materials() {
        assert_eq!(names(&[], &[]), ["cube", "sphere", "rectangle"]);
        assert_eq!(names(&["cu*"], &[]), ["cube"]);
        assert_eq!(names(&[], &["red"]), ["sphere"]);
        assert_eq!(names(&["s*", "*tang*le"], &["glass"]), ["rectangle"]);
        let hide = vec!["table".to_owned()];
        let error = loaded(Looks { hide, ..Looks::default() }).unwrap_err().to_string();
        assert!(error.contains("no mesh or material \"table\"") && error.contains("cube, glass"), "{error}");
    }

    #[test]
    fn clay_takes_the_place_of_all_materials() {
        let scene = loaded(Looks { clay: true, ..Looks::default() }).unwrap().scene;
        let all = scene.materials.iter();
        assert!(all.clone().all(|material| material.lobes.is_empty() && material.two_sided));
        assert_eq!(all.map(|material| material.name.as_str()).collect::<Vec<_>>(), ["red", "glass"]);
    }
}
