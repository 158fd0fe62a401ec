//! Attributes among the properties of a PLY element, by the naming rules of Mitsuba 3.
//!
//! - `r`, `g`, `b` or `red`, `green`, `blue` are the attribute `color`; `a` or `alpha` beside them is the attribute
//!   `alpha`.
//! - Neighbours of one name that end with `_x`, `_y`, `_z`, with `_r`, `_g`, `_b`, with `_0`, `_1`, `_2` or with `_1`,
//!   `_2`, `_3` are the attribute of that name. So is one property that ends with the first of them.
//!
//! Integers are fractions of the maximum of their type, coded in sRGB but for `alpha`. Floating-point numbers are
//! linear. Blender's importer has the same default.

use crate::attributes::NamedAttribute;
use crate::decode::srgb_to_linear;
use base::math::Rgb;
use scene::AttributeValues;

/// Endings of the channels of an attribute.
const ENDINGS: [&str; 4] = ["xyzw", "rgba", "0123", "1234"];

/// Names of colours, and of the opacity beside them.
const COLOURS: [([&str; 3], &str); 3] = [
    (["r", "g", "b"], "a"),
    (["red", "green", "blue"], "alpha"),
    (["diffuse_red", "diffuse_green", "diffuse_blue"], "diffuse_alpha"),
];

/// A property that may be a channel of an attribute.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChannelProperty<'a> {
    pub name: &'a str,
    /// Maximum of the type, if the type is an integer.
    pub max: Option<f64>,
}

/// An attribute of an element.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PlyAttribute {
    /// Name with the prefix of the element.
    pub name: String,
    /// Properties of the channels, and the maxima of their types: one or three.
    channels: Vec<(usize, Option<f64>)>,
    /// True if integers are coded in sRGB.
    is_coded: bool,
}

impl PlyAttribute {
    /// Returns the numbers of the properties that are channels of the attribute.
    pub fn properties(&self) -> impl Iterator<Item = usize> {
        self.channels.iter().map(|(at, _)| *at)
    }

    /// Returns the value of an element, whose properties have the values `row`.
    pub fn value(&self, row: &[f64]) -> Rgb {
        let channel = |&(at, max): &(usize, Option<f64>)| {
            let value = row.get(at).copied().unwrap_or_default();
            match max {
                Some(max) if self.is_coded => srgb_to_linear((value / max).clamp(0.0, 1.0) as f32),
                Some(max) => (value / max) as f32,
                None => value as f32,
            }
        };
        match &self.channels[..] {
            [r, g, b] => Rgb::new(channel(r), channel(g), channel(b)),
            all => Rgb::splat(all.first().map_or(0.0, channel)),
        }
    }
}

/// Attributes of an element, with the values read so far.
pub(super) struct CollectedAttributes(Vec<(PlyAttribute, Vec<Rgb>)>);

impl CollectedAttributes {
    /// Prepares to collect the values of attributes.
    pub fn new(attributes: Vec<PlyAttribute>) -> CollectedAttributes {
        CollectedAttributes(attributes.into_iter().map(|attribute| (attribute, Vec::new())).collect())
    }

    /// Adds, `count` times, the values of an element whose properties have the values `row`.
    pub fn push(&mut self, row: &[f64], count: usize) {
        for (attribute, values) in &mut self.0 {
            values.extend(std::iter::repeat_n(attribute.value(row), count));
        }
    }

    /// Returns the attributes; `values` makes their values.
    pub fn finish(self, values: fn(Vec<Rgb>) -> AttributeValues) -> impl Iterator<Item = NamedAttribute> {
        self.0.into_iter().map(move |(of, all)| NamedAttribute { name: of.name, values: values(all) })
    }
}

/// Returns the maximum of an integer type; `None` for types of floating-point numbers.
pub(super) fn max_of_type(name: &str) -> Option<f64> {
    Some(match name {
        "char" | "int8" => i8::MAX.into(),
        "uchar" | "uint8" => u8::MAX.into(),
        "short" | "int16" => i16::MAX.into(),
        "ushort" | "uint16" => u16::MAX.into(),
        "int" | "int32" => i32::MAX.into(),
        "uint" | "uint32" => u32::MAX.into(),
        _ => return None,
    })
}

/// Returns the attributes among the properties of an element, which are `None` where they are lists. `prefix` is that
/// of the attributes' names.
pub(super) fn attributes(prefix: &str, properties: &[Option<ChannelProperty>]) -> Vec<PlyAttribute> {
    let find = |name: &str| properties.iter().position(|p| p.is_some_and(|p| p.name == name));
    let attribute = |name: &str, at: &[usize], is_coded| PlyAttribute {
        name: format!("{prefix}{name}"),
        channels: at.iter().map(|&at| (at, properties[at].and_then(|p| p.max))).collect(),
        is_coded,
    };
    let mut all = Vec::new();
    for (names, alpha) in COLOURS {
        if let [Some(r), Some(g), Some(b)] = names.map(find) {
            all.push(attribute("color", &[r, g, b], true));
            all.extend(find(alpha).map(|alpha| attribute("alpha", &[alpha], false)));
            break;
        }
    }
    let split = |at: usize| properties.get(at)?.and_then(|p| p.name.rsplit_once('_'));
    let mut at = 0;
    while let Some(property) = properties.get(at) {
        let group = property.and_then(|_| split(at)).and_then(|(name, first)| {
            let endings = ENDINGS.iter().find(|endings| *first == endings[..1])?;
            let has =
                |k: usize| split(at + k).is_some_and(|(other, end)| other == name && *end == endings[k..=k]);
            Some((name, (1..4).take_while(|&k| has(k)).count() + 1))
        });
        let Some((name, count)) = group else {
            at += 1;
            continue;
        };
        let channels: Vec<usize> = (at..at + if count >= 3 { 3 } else { 1 }).collect();
        let is_known = all.iter().any(|known: &PlyAttribute| known.name == format!("{prefix}{name}"));
        if count != 2 && !is_known {
            all.push(attribute(name, &channels, true));
        }
        at += count;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(properties: &str) -> Vec<(String, usize)> {
        let channels: Vec<Option<ChannelProperty>> =
            properties.split(' ').map(|name| Some(ChannelProperty { name, max: None })).collect();
        attributes("vertex_", &channels).into_iter().map(|a| (a.name, a.channels.len())).collect()
    }

    fn named(names: &[(&str, usize)]) -> Vec<(String, usize)> {
        names.iter().map(|(name, count)| (name.to_string(), *count)).collect()
    }

    #[test]
    fn channels_are_grouped_by_their_endings() {
        assert_eq!(names("x y z nx ny nz u v"), []);
        assert_eq!(names("x red y green blue alpha"), named(&[("vertex_color", 3), ("vertex_alpha", 1)]));
        assert_eq!(names("a r g b"), named(&[("vertex_color", 3), ("vertex_alpha", 1)]));
        assert_eq!(names("red green quality"), []);
        assert_eq!(
            names("color_0 color_1 color_2 weight_0 dust_r dust_g dust_b dust_a"),
            named(&[("vertex_color", 3), ("vertex_weight", 1), ("vertex_dust", 3)])
        );
        // Two channels are no attribute, nor is a name without its first channel.
        assert_eq!(
            names("a_b_1 flow_x flow_y heat_2 r_1 r_2 r_3"),
            named(&[("vertex_a_b", 1), ("vertex_r", 3)])
        );
        assert_eq!(names("texture_u texture_v"), []);
    }

    #[test]
    fn integers_are_srgb_and_alpha_is_not() {
        let channel = |name| Some(ChannelProperty { name, max: Some(255.0) });
        let found = attributes("face_", &["red", "green", "blue", "alpha"].map(channel));
        let row = [255.0, 188.0, 0.0, 127.5];
        // 188 of 255 is 0.502886 linear, by the standard's formula in f64.
        assert!(
            (found[0].value(&row) - Rgb::new(1.0, 0.502886, 0.0)).length() < 1e-6,
            "{}",
            found[0].value(&row)
        );
        assert_eq!(found[1].value(&row), Rgb::splat(0.5));
        let linear =
            attributes("face_", &["r", "g", "b"].map(|name| Some(ChannelProperty { name, max: None })));
        assert_eq!(linear[0].value(&[0.25, 2.0, 0.5]), Rgb::new(0.25, 2.0, 0.5));
    }
}
