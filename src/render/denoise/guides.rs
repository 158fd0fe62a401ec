//! Layers of albedo and normals among the layers of a file, by the names that renderers use.

/// Names of layers of albedo in lower case, in order of preference.
pub const ALBEDO: [&str; 2] = ["denoising albedo", "albedo"];
/// Names of layers of normals in lower case, in order of preference.
///
/// Blender uses the first, lightsplat and many others the second, then Mitsuba, pbrt and Arnold.
pub const NORMAL: [&str; 6] = ["denoising normal", "normal", "sh_normal", "nn", "ns", "n"];

/// Finds the layer of one of these names among the channels of a file. Prefixes of views and parts are ignored.
pub fn layer(channels: &[String], names: &[&str]) -> Option<String> {
    let layers = || channels.iter().filter_map(|channel| Some(channel.rsplit_once('.')?.0));
    let own = |layer: &str| layer.rsplit('.').next().unwrap_or_default().to_lowercase();
    names.iter().find_map(|name| layers().find(|layer| own(layer) == *name)).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_found_by_the_names_of_many_renderers() {
        let find = |channels: &[&str], names| {
            let channels: Vec<String> = channels.iter().map(|name| (*name).to_owned()).collect();
            layer(&channels, names)
        };
        let found = |name: &str| Some(name.to_owned());
        let blender =
            ["View.Combined.R", "View.Normal.X", "View.Denoising Normal.X", "View.Denoising Albedo.B"];
        assert_eq!(find(&blender, &NORMAL), found("View.Denoising Normal"));
        assert_eq!(find(&blender, &ALBEDO), found("View.Denoising Albedo"));
        for name in ["normal", "Normal", "N", "Ns", "nn", "sh_normal"] {
            assert_eq!(find(&["R", &format!("{name}.X"), "Albedo.R"], &NORMAL), found(name));
        }
        assert_eq!(find(&["R", "geometricNormal.X", "noisy.R", "N"], &NORMAL), None);
        assert_eq!(find(&["R", "G", "B"], &ALBEDO), None);
    }
}
