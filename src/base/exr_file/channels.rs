//! Choice of the channels of an OpenEXR file that are its picture. All readers of pictures follow it.
//!
//! The last segment of a channel's name is the component, the segments before it are the layer: `diffuse.R` is red of
//! the layer `diffuse`. In files of several parts the name of a part precedes the names of its layers. Letter case
//! does not matter.
//!
//! In stereo files the last layer may be a view. The default view is the first that the file names. Its name is no
//! layer, and the channels of other views are left out (*Storing Multi-View Images in OpenEXR Files*, 2007).
//!
//! The first of these is the picture:
//! 1. the colour without a layer;
//! 2. the colour of a layer called as one of [`PICTURE_LAYERS`], in this order;
//! 3. the luminance without a layer;
//! 4. the colour of the only layer that has one;
//! 5. the luminance of a layer called as one of [`PICTURE_LAYERS`], then of the only layer that has one.

use std::fmt;

/// Names of layers that hold the picture, by preference: those of Blender, Arnold, Nuke and others.
pub const PICTURE_LAYERS: [&str; 6] = ["combined", "beauty", "rgba", "rgb", "color", "colour"];

/// Maximum number of channels that a message lists.
const MAX_LISTED: usize = 40;

/// Names of a part and its channels.
#[derive(Clone, Debug, PartialEq)]
pub struct PartNames {
    /// Name of the part; empty if it has none.
    pub name: String,
    /// Names of its channels, in the order of the file.
    pub channels: Vec<String>,
    /// True if its pixels are deep data.
    pub is_deep: bool,
    /// Names of its views, the default view first; empty if it does not tell.
    pub views: Vec<String>,
}

/// Meaning of the channels of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColourModel {
    /// Red, green and blue.
    Rgb,
    /// Luminance `Y`, and the differences `RY` and `BY` of red and blue from it, over `Y`.
    LumaChroma,
    /// One channel, for all three colours.
    Luma,
}

/// Place of the channels of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureChannels {
    /// Index of the part.
    pub part: usize,
    /// Indices of the channels in the part; equal for [`ColourModel::Luma`].
    pub channels: [usize; 3],
    /// Meaning of the channels.
    pub model: ColourModel,
}

/// No channels of a file are clearly its picture.
#[derive(Clone, Debug, PartialEq)]
pub struct NoPicture {
    /// Names of all channels, with those of their parts.
    pub channels: Vec<String>,
    /// True if some channels are deep data.
    pub has_deep: bool,
}

impl fmt::Display for NoPicture {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let listed = &self.channels[..self.channels.len().min(MAX_LISTED)];
        write!(
            f,
            "no channels are clearly the colour of the image; its channels are: {}",
            listed.join(", ")
        )?;
        if listed.len() < self.channels.len() {
            write!(f, " and {} more", self.channels.len() - listed.len())?;
        }
        let remedy = "save the image as R, G, B or Y without a layer, or in a layer Combined, beauty or rgba";
        write!(f, "; {remedy}")?;
        if self.has_deep { write!(f, "; deep data is not supported, so flatten the image") } else { Ok(()) }
    }
}

/// Channels of one layer that have a colour or a luminance.
struct LayerChannels<'a> {
    /// Last segment of the layer's name; empty if there is no layer.
    layer: &'a str,
    place: PictureChannels,
}

/// Returns the channels that are the picture of a file.
///
/// # Errors
/// If the rule of this module chooses no channels, or several.
pub fn picture_channels(parts: &[PartNames]) -> Result<PictureChannels, NoPicture> {
    let several = parts.len() > 1;
    let view = parts.iter().find_map(|part| part.views.first());
    let is_seen =
        |part: &PartNames| part.views.is_empty() || view.is_some_and(|view| part.views.contains(view));
    let usable = parts.iter().enumerate().filter(|(_, part)| !part.is_deep && is_seen(part));
    let view = view.map_or("", String::as_str);
    let groups: Vec<LayerChannels> =
        usable.flat_map(|(index, part)| groups(index, part, view, several)).collect();
    let (luma, colours): (Vec<&LayerChannels>, Vec<&LayerChannels>) =
        groups.iter().partition(|group| group.place.model == ColourModel::Luma);
    let called = |of: &[&LayerChannels], name: &str| -> Vec<PictureChannels> {
        let own = of.iter().filter(|group| group.layer.eq_ignore_ascii_case(name));
        own.map(|group| group.place.clone()).collect()
    };
    let of_picture_layers =
        |of: &[&LayerChannels]| PICTURE_LAYERS.iter().map(|name| called(of, name)).collect();
    let all = |of: &[&LayerChannels]| of.iter().map(|group| group.place.clone()).collect::<Vec<_>>();
    let by_layer: [Vec<Vec<PictureChannels>>; 2] = [of_picture_layers(&colours), of_picture_layers(&luma)];
    let [named_colours, named_luma] = by_layer;
    let steps =
        [vec![called(&colours, "")], named_colours, vec![called(&luma, ""), all(&colours)], named_luma];
    let images = steps.into_iter().flatten().chain([all(&luma)]).find(|images| !images.is_empty());
    match images.as_deref() {
        Some([one]) => Ok(one.clone()),
        _ => Err(NoPicture {
            channels: parts.iter().flat_map(full_names).collect(),
            has_deep: parts.iter().any(|part| part.is_deep),
        }),
    }
}

/// Returns the names of the channels of a part, preceded by its own.
pub(super) fn full_names(part: &PartNames) -> impl Iterator<Item = String> + '_ {
    part.channels.iter().map(|channel| match part.name.as_str() {
        "" => channel.clone(),
        own => format!("{own}.{}", without_part(channel, own)),
    })
}

/// Returns the name of a channel without that of its part, which some programs repeat.
fn without_part<'a>(channel: &'a str, part: &str) -> &'a str {
    let rest = channel.strip_prefix(part).and_then(|rest| rest.strip_prefix('.'));
    rest.filter(|_| !part.is_empty()).unwrap_or(channel)
}

/// Returns a layer without the default view `view` at its end; `None` for a layer of another view.
fn in_view<'a>(layer: &'a str, views: &[String], view: &str) -> Option<&'a str> {
    let (before, last) = layer.rsplit_once('.').unwrap_or(("", layer));
    match views.iter().any(|name| name == last) {
        true => (last == view).then_some(before),
        false => Some(layer),
    }
}

/// Returns the layers of a part that have a colour or a luminance in the default view `view`, in the order of their
/// first channels.
fn groups<'a>(index: usize, part: &'a PartNames, view: &str, several: bool) -> Vec<LayerChannels<'a>> {
    let mut layers: Vec<(&str, Vec<(usize, &str)>)> = Vec::new();
    for (i, channel) in part.channels.iter().enumerate() {
        let name = without_part(channel, &part.name);
        let (layer, component) = name.rsplit_once('.').unwrap_or(("", name));
        let Some(layer) = in_view(layer, &part.views, view) else { continue };
        match layers.iter_mut().find(|(known, _)| *known == layer) {
            Some((_, components)) => components.push((i, component)),
            None => layers.push((layer, vec![(i, component)])),
        }
    }
    let of_part = if several { in_view(&part.name, &part.views, view).unwrap_or_default() } else { "" };
    let mut found = Vec::new();
    for (layer, components) in layers {
        let Some((channels, model)) = colour(&components) else { continue };
        let layer = if layer.is_empty() { of_part } else { layer };
        let layer = layer.rsplit('.').next().unwrap_or(layer);
        found.push(LayerChannels { layer, place: PictureChannels { part: index, channels, model } });
    }
    found
}

/// Returns the channels of a colour, or of a luminance, among the components of a layer.
fn colour(components: &[(usize, &str)]) -> Option<([usize; 3], ColourModel)> {
    let find = |names: &[&str]| {
        let is_it = |component: &str| names.iter().any(|name| component.eq_ignore_ascii_case(name));
        components.iter().find(|(_, component)| is_it(component)).map(|(index, _)| *index)
    };
    let three = |names: [&[&str]; 3]| match names.map(find) {
        [Some(a), Some(b), Some(c)] => Some([a, b, c]),
        _ => None,
    };
    let rgb = three([&["R", "red"], &["G", "green"], &["B", "blue"]]);
    let chroma = || three([&["Y"], &["RY"], &["BY"]]);
    // Y with X is a coordinate.
    let luma = || find(&["Y", "L"]).filter(|_| find(&["X"]).is_none());
    (rgb.map(|channels| (channels, ColourModel::Rgb)))
        .or_else(|| chroma().map(|channels| (channels, ColourModel::LumaChroma)))
        .or_else(|| luma().map(|channel| ([channel; 3], ColourModel::Luma)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(name: &str, channels: &[&str]) -> PartNames {
        let channels = channels.iter().map(|&channel| channel.to_owned()).collect();
        PartNames { name: name.to_owned(), channels, is_deep: false, views: Vec::new() }
    }

    /// Returns part and channels of the picture.
    fn chosen(parts: &[PartNames]) -> Option<(usize, [usize; 3])> {
        picture_channels(parts).ok().map(|found| (found.part, found.channels))
    }

    #[test]
    fn a_colour_without_layer_comes_first_wherever_it_stands() {
        let layers = ["A", "Albedo.B", "Albedo.G", "Albedo.R", "B", "G", "Ns.X", "Ns.Y", "Ns.Z", "R"];
        assert_eq!(chosen(&[part("", &layers)]), Some((0, [9, 5, 4])));
        // The name of the only part is no layer.
        assert_eq!(chosen(&[part("view", &["B", "G", "R", "variance.R"])]), Some((0, [2, 1, 0])));
        let depth = part("depth", &["Z"]);
        let albedo = part("albedo", &["B", "G", "R"]);
        assert_eq!(
            chosen(&[depth.clone(), albedo.clone(), part("", &["R", "G", "B"])]),
            Some((2, [0, 1, 2]))
        );
        assert_eq!(chosen(&[part("", &["Y", "beauty.B", "beauty.G", "beauty.R"])]), Some((0, [3, 2, 1])));
    }

    #[test]
    fn layers_of_the_picture_have_the_names_that_programs_give_them() {
        let other = ["a.B", "a.G", "a.R"];
        for names in [
            ["ViewLayer.Combined.B", "ViewLayer.Combined.G", "ViewLayer.Combined.R"],
            ["rgba.B", "rgba.G", "rgba.R"],
            ["beauty.blue", "beauty.green", "beauty.red"],
            ["BEAUTY.b", "BEAUTY.g", "BEAUTY.r"],
        ] {
            let channels = [&other[..], &names, &["z.Z"]].concat();
            assert_eq!(chosen(&[part("", &channels)]), Some((0, [5, 4, 3])), "{names:?}");
        }
        // Names of parts are those of layers, repeated by the channels or not.
        let normals = part("normal", &["B", "G", "R"]);
        for names in [["B", "G", "R"], ["beauty.B", "beauty.G", "beauty.R"]] {
            let parts = [normals.clone(), part("depth", &["depth.Z"]), part("beauty", &names)];
            assert_eq!(chosen(&parts), Some((2, [2, 1, 0])), "{names:?}");
        }
    }

    #[test]
    fn a_single_colour_or_luminance_is_the_picture_and_vectors_are_none() {
        let vectors = ["N.X", "N.Y", "N.Z", "depth.Z"];
        assert_eq!(chosen(&[part("", &vectors)]), None);
        let layers = [&vectors[..], &["shot.B", "shot.G", "shot.R"]].concat();
        assert_eq!(chosen(&[part("", &layers)]), Some((0, [6, 5, 4])));
        assert_eq!(chosen(&[part("", &["A", "Y"])]), Some((0, [1; 3])));
        assert_eq!(chosen(&[part("", &[&vectors[..], &["shot.L"]].concat())]), Some((0, [4; 3])));
        let found = picture_channels(&[part("", &["BY", "RY", "Y"])]).unwrap();
        assert_eq!((found.channels, found.model), ([2, 1, 0], ColourModel::LumaChroma));
    }

    #[test]
    fn several_candidates_are_an_error_that_lists_the_channels() {
        let two = ["a.B", "a.G", "a.R", "b.B", "b.G", "b.R"];
        let error = picture_channels(&[part("", &two)]).unwrap_err();
        assert_eq!(error.channels, two);
        assert!(error.to_string().contains("a.B, a.G") && error.to_string().contains("Combined"), "{error}");
        let views = ["left.Combined.B", "left.Combined.G", "left.Combined.R"];
        let views = [&views[..], &["right.Combined.B", "right.Combined.G", "right.Combined.R"]].concat();
        assert_eq!(chosen(&[part("", &views)]), None);
        let many: Vec<String> = (0..100).map(|i| format!("c{i}")).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        let error = picture_channels(&[part("", &many)]).unwrap_err().to_string();
        assert!(error.contains("c39 and 60 more") && !error.contains("deep"), "{error}");
    }

    #[test]
    fn the_default_view_of_a_stereo_file_is_the_picture() {
        let of_view = |part: PartNames, views: &[&str]| PartNames {
            views: views.iter().map(|&view| view.to_owned()).collect(),
            ..part
        };
        let rgb = ["B", "G", "R"];
        let (left, right) = (part("rgba.left", &rgb), part("rgba.right", &rgb));
        let parts = [of_view(left, &["left"]), of_view(right, &["right"])];
        assert_eq!(chosen(&parts), Some((0, [2, 1, 0])));
        // Parts of depth, without colours, and parts without names of their own.
        let depths = ["left", "right"].map(|view| of_view(part(&format!("depth.{view}"), &["Z"]), &[view]));
        let [depth_left, depth_right] = depths;
        let [left, right] = parts;
        assert_eq!(chosen(&[depth_left, left, depth_right, right]), Some((1, [2, 1, 0])));
        let parts = ["right", "left"].map(|view| of_view(part(view, &rgb), &[view]));
        assert_eq!(chosen(&parts), Some((0, [2, 1, 0])));
        // One part: the default view has no name, or one of its own.
        let both = ["left.B", "left.G", "left.R", "right.B", "right.G", "right.R"];
        assert_eq!(chosen(&[of_view(part("", &both), &["right", "left"])]), Some((0, [5, 4, 3])));
        let layers =
            ["a.right.B", "a.right.G", "a.right.R", "beauty.left.B", "beauty.left.G", "beauty.left.R"];
        assert_eq!(chosen(&[of_view(part("", &layers), &["left", "right"])]), Some((0, [5, 4, 3])));
        assert_eq!(chosen(&[part("", &both)]), None);
    }

    #[test]
    fn deep_parts_are_no_pictures() {
        let deep = PartNames { is_deep: true, ..part("beauty", &["B", "G", "R"]) };
        assert_eq!(chosen(&[deep.clone(), part("flat", &["B", "G", "R"])]), Some((1, [2, 1, 0])));
        let error = picture_channels(&[deep]).unwrap_err().to_string();
        assert!(error.contains("flatten"), "{error}");
    }
}
