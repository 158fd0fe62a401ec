//! Nodes that may be lamps which the exporter left out. glTF has no area lights, and exporters write empty nodes.

use super::document::GltfFile;
use super::nodes::Placed;
use crate::findings::Findings;
use std::collections::BTreeSet;

/// Last words of names that suggest a lamp.
const LAMPS: [&str; 7] = ["area", "arealight", "lamp", "lamps", "light", "lights", "softbox"];
/// Names that suggest a lamp if they stand alone.
const KINDS: [&str; 3] = ["point", "spot", "sun"];

/// Notes the empty nodes whose names suggest a lamp.
pub(super) fn report(document: &GltfFile, tree: &[Placed], report: &mut Findings) {
    let joints: BTreeSet<usize> =
        document.root.skins.iter().flat_map(|skin| &skin.joints).map(|joint| joint.value()).collect();
    for placed in tree.iter().filter(|placed| placed.selected) {
        let node = &document.root.nodes[placed.node];
        let has_children = node.children.as_ref().is_some_and(|children| !children.is_empty());
        let has_light = node.extensions.as_ref().is_some_and(|e| e.khr_lights_punctual.is_some());
        let is_empty = node.mesh.is_none() && node.camera.is_none() && !has_children && !has_light;
        let name = node.name.as_deref().unwrap_or_default();
        if is_empty && !joints.contains(&placed.node) && suggests_lamp(name) {
            let what = "an empty node may be a lamp that the exporter left out";
            let remedy = "for an area light, put a plane there that emits watts / (pi times its area); \
                          for other lamps, tick Punctual Lights in Blender";
            report.note(what, remedy, name);
        }
    }
}

/// True if a name, apart from numbers, is that of a lamp, or ends in a word for one.
fn suggests_lamp(name: &str) -> bool {
    let name = name.trim_end_matches(|c: char| c.is_ascii_digit() || ".-_ ".contains(c));
    let word = name.rsplit(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
    // Words of names like KeyLight begin with a capital.
    let own = word.rfind(char::is_uppercase).map_or(word, |at| &word[at..]);
    let is_lamp = |word: &str| LAMPS.contains(&word.to_lowercase().as_str());
    let ends = ["light", "lamp"].iter().any(|end| word.to_lowercase().ends_with(end));
    is_lamp(word) || is_lamp(own) || ends || KINDS.contains(&name.to_lowercase().as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_lamps_are_recognised() {
        for name in
            ["Area", "Area.001", "AreaLight", "area light 2", "Key_Light", "Lamp.003", "Sun", "Spot.001"]
        {
            assert!(suggests_lamp(name), "{name}");
        }
        for name in ["", "Empty", "Cube.001", "Areas", "Sunflower", "Point of view", "LightHouse", "0"] {
            assert!(!suggests_lamp(name), "{name}");
        }
    }
}
