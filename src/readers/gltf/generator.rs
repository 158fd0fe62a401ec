//! Program that wrote a file: what Blender's exporter leaves out can be told from its name and version.

use super::document::GltfFile;

/// First version of Blender's exporter that writes candela and lux.
const FIRST_WITH_UNITS: [u32; 2] = [3, 4];

/// Program that wrote a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Generator {
    /// Blender's exporter before version 3.4, which writes the watts of lamps.
    BlenderWithWatts,
    /// Blender's exporter since version 3.4, which writes candela and lux unless its Lighting Mode is another.
    Blender,
    Other,
}

impl Generator {
    pub fn read(document: &GltfFile) -> Generator {
        Generator::named(document.root.asset.generator.as_deref().unwrap_or_default())
    }

    fn named(name: &str) -> Generator {
        if !name.contains("Blender") {
            return Generator::Other;
        }
        // The exporter's first versions write none.
        let is_first = name == "Khronos Blender glTF 2.0 exporter";
        let version = name.split_once("I/O v").map(|(_, version)| {
            let mut parts = version.split('.').map(|part| part.parse().unwrap_or(0));
            [(); 2].map(|()| parts.next().unwrap_or(0))
        });
        match version {
            Some(version) if version < FIRST_WITH_UNITS => Generator::BlenderWithWatts,
            None if is_first => Generator::BlenderWithWatts,
            _ => Generator::Blender,
        }
    }

    pub fn is_blender(self) -> bool {
        self != Generator::Other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_of_blender_are_told_apart() {
        for (name, generator) in [
            ("Khronos Blender glTF 2.0 exporter", Generator::BlenderWithWatts),
            ("Khronos glTF Blender I/O v1.8.19", Generator::BlenderWithWatts),
            ("Khronos glTF Blender I/O v3.3.27", Generator::BlenderWithWatts),
            ("Khronos glTF Blender I/O v3.4.50", Generator::Blender),
            ("Khronos glTF Blender I/O v4.2.60", Generator::Blender),
            ("Khronos glTF Blender I/O v10.0", Generator::Blender),
            ("a fork of the Blender exporter", Generator::Blender),
            ("something else", Generator::Other),
            ("", Generator::Other),
        ] {
            assert_eq!(Generator::named(name), generator, "{name}");
        }
    }
}
