//! Attributes among the properties of a PLY element, by the naming rules of Mitsuba 3.
//!
//! - `r`, `g`, `b` or `red`, `green`, `blue` are the attribute `color`; `a` or `alpha` beside them is the attribute
//!   `alpha`.
//! - Neighbours of one name that end with `_x`, `_y`, `_z`, with `_r`, `_g`, `_b`, with `_0`, `_1`, `_2` or with `_1`,
//!   `_2`, `_3` are the attribute of that name. So is one property that ends with the first of them.
//!
//! Integers are fractions of the maximum of their type, coded in sRGB but for `alpha`. Floating-point numbers are
//! linear. Blender's importer has the same default. Colours of other types than bytes that are whole numbers above 16
//! are bytes nonetheless.

use super::faults::{MAX_CODE, are_codes};
use crate::attributes::NamedAttribute;
use crate::colour_profile::srgb_to_linear;
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
    /// True for the attribute `color`.
    is_colour: bool,
}

impl PlyAttribute {
    /// Returns the numbers of the properties that are channels of the attribute.
    pub fn properties(&self) -> impl Iterator<Item = usize> {
        self.channels.iter().map(|(at, _)| *at)
    }

    /// Returns the value of an element, whose properties have the values `row`.
    #[cfg(test)]
    pub fn value(&self, row: &[f64]) -> Rgb {
        self.decoded(self.numbers(row))
    }

    /// Returns the numbers of the channels; one number stands for three.
    fn numbers(&self, row: &[f64]) -> [f64; 3] {
        let number = |&(at, _): &(usize, Option<f64>)| row.get(at).copied().unwrap_or_default();
        match &self.channels[..] {
            [r, g, b] => [r, g, b].map(number),
            all => [all.first().map_or(0.0, number); 3],
        }
    }

    /// Returns the value of the numbers of the channels,
    fn decoded(&self, numbers: [f64; 3]) -> Rgb {
        let max = |i: usize| self.channels.get(i).or(self.channels.first()).and_then(|channel| channel.1);
        let channel = |i: usize| match max(i) {
            Some(max) if self.is_coded => srgb_to_linear((numbers[i] / max).clamp(0.0, 1.0) as f32),
            Some(max) => (numbers[i] / max) as f32,
            None => numbers[i] as f32,
        };
        Rgb::new(channel(0), channel(1), channel(2))
    }

    /// True if the numbers may be bytes in another type.
    fn may_be_codes(&self) -> bool {
        self.is_colour && self.channels.iter().all(|channel| channel.1.is_none_or(|max| max > MAX_CODE))
    }
}

/// Attributes of an element, with the values read so far.
pub(super) struct CollectedAttributes(Vec<CollectedAttribute>);

struct CollectedAttribute {
    of: PlyAttribute,
    values: Vec<Rgb>,
    /// Greatest value.
    most: f32,
    /// True if all values are whole numbers.
    are_whole: bool,
}

impl CollectedAttributes {
    /// Prepares to collect the values of attributes.
    pub fn new(attributes: Vec<PlyAttribute>) -> CollectedAttributes {
        let empty = |of| CollectedAttribute { of, values: Vec::new(), most: 0.0, are_whole: true };
        CollectedAttributes(attributes.into_iter().map(empty).collect())
    }

    /// Adds, `count` times, the values of an element whose properties have the values `row`. Returns false if a
    /// colour is not finite; it becomes white.
    pub fn push(&mut self, row: &[f64], count: usize) -> bool {
        let mut are_finite = true;
        for CollectedAttribute { of, values, most, are_whole } in &mut self.0 {
            let numbers = of.numbers(row);
            let mut value =
                if of.may_be_codes() { Rgb::from(numbers.map(|n| n as f32)) } else { of.decoded(numbers) };
            if of.is_colour && !value.is_finite() {
                (value, are_finite) = (Rgb::ONE, false);
            }
            *most = value.max_element().max(*most);
            *are_whole &= value.fract() == Rgb::ZERO;
            values.extend(std::iter::repeat_n(value, count));
        }
        are_finite
    }

    /// Returns the attributes, and whether one has bytes in another type; `values` makes their values.
    pub fn finish(self, values: fn(Vec<Rgb>) -> AttributeValues) -> (Vec<NamedAttribute>, bool) {
        let mut has_codes = false;
        let finish = |CollectedAttribute { mut of, values: mut all, most, are_whole }: CollectedAttribute| {
            if of.may_be_codes() {
                if are_codes(most.into(), are_whole) {
                    has_codes = true;
                    of.channels.iter_mut().for_each(|channel| channel.1 = Some(MAX_CODE));
                }
                all.iter_mut().for_each(|value| *value = of.decoded(value.as_dvec3().to_array()));
            }
            NamedAttribute { name: of.name, values: values(all) }
        };
        (self.0.into_iter().map(finish).collect(), has_codes)
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
    let find =
        |name: &str| properties.iter().position(|p| p.is_some_and(|p| p.name.eq_ignore_ascii_case(name)));
    let attribute = |name: &str, at: &[usize], is_coded| PlyAttribute {
        name: format!("{prefix}{name}"),
        channels: at.iter().map(|&at| (at, properties[at].and_then(|p| p.max))).collect(),
        is_coded,
        is_colour: name == "color",
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
