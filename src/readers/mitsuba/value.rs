//! Property values of Mitsuba XML: numbers, colours, vectors and transforms.

use super::cie;
use crate::colour_profile::srgb_to_linear;
use crate::error::{Location, SceneError};
use base::math::{Rgb, right_of, unflattened, unit};
use glam::{DMat4, DVec3, DVec4};
use std::collections::BTreeMap;

/// The value of a property.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum PropertyValue {
    Boolean(bool),
    Integer(i64),
    Float(f64),
    String(String),
    Vector(DVec3),
    Rgb(DVec3),
    /// A spectrum constant over wavelength.
    Spectrum(f64),
    /// A sampled spectrum: wavelengths in nm, ascending, and values.
    Samples(Vec<(f64, f64)>),
    /// Name of a file with a sampled spectrum.
    SamplesFile(String),
    /// A transform, and the one with a scale of 1 in place of each scale of 0, with an equal translation.
    Transform(Box<[DMat4; 2]>),
}

type Attributes = BTreeMap<String, String>;

/// Parses the value of a property element such as `<float name="alpha" value="0.1"/>`.
pub(super) fn parse(
    tag: &str,
    attributes: &Attributes,
    place: &Location,
) -> Result<PropertyValue, SceneError> {
    let text = || {
        let missing = || place.wrong(format!("<{tag}> has no value"), "add value=\"...\"");
        attributes.get("value").map(|v| v.trim()).ok_or_else(missing)
    };
    let unreadable = |text: &str| {
        place.wrong(format!("cannot read <{tag}> value \"{text}\""), format!("write a valid {tag}"))
    };
    Ok(match tag {
        "boolean" => match text()?.to_ascii_lowercase().as_str() {
            "true" => PropertyValue::Boolean(true),
            "false" => PropertyValue::Boolean(false),
            other => return Err(unreadable(other)),
        },
        "integer" => PropertyValue::Integer(text()?.parse().map_err(|_| unreadable(text().unwrap_or("")))?),
        "float" => PropertyValue::Float(number(text()?).ok_or_else(|| unreadable(text().unwrap_or("")))?),
        "string" => PropertyValue::String(attributes.get("value").cloned().unwrap_or_default()),
        "point" | "vector" => PropertyValue::Vector(vector(attributes, 0.0, place)?),
        "rgb" | "srgb" | "color" => {
            let text = text()?;
            let rgb = colour(text).ok_or_else(|| unreadable(text))?;
            let decode = |c: f64| f64::from(srgb_to_linear(c as f32));
            PropertyValue::Rgb(if tag == "srgb" { DVec3::from(rgb.to_array().map(decode)) } else { rgb })
        }
        "spectrum" if attributes.contains_key("filename") => {
            PropertyValue::SamplesFile(attributes.get("filename").cloned().unwrap_or_default())
        }
        "spectrum" => spectrum(text()?, place)?,
        "blackbody" => blackbody(attributes, place)?,
        "translate" | "rotate" | "scale" | "lookat" | "lookAt" | "matrix" => {
            let what = format!("<{tag}> is outside a <transform>");
            return Err(place.wrong(what, "put it inside <transform name=\"to_world\">"));
        }
        _ => {
            let what = format!("unknown element <{tag}>");
            return Err(place.wrong(what, "use an element of Mitsuba's scene format"));
        }
    })
}

/// Parses a spectrum: one number, a colour, or wavelengths and values.
fn spectrum(text: &str, place: &Location) -> Result<PropertyValue, SceneError> {
    if let Some(value) = number(text) {
        return Ok(PropertyValue::Spectrum(value));
    }
    if let Some(rgb) = colour(text) {
        // Mitsuba 0.6 reads three numbers as red, green and blue.
        return Ok(PropertyValue::Rgb(rgb));
    }
    let pairs = text.split([',', ' ', '\n', '\t']).filter(|s| !s.is_empty());
    let samples = pairs.map(|s| {
        let (wavelength, value) = s.split_once(':')?;
        Some((number(wavelength)?, number(value)?))
    });
    let samples = samples.collect::<Option<_>>().and_then(ascending);
    samples.map(PropertyValue::Samples).ok_or_else(|| {
        let remedy = "write one number, red, green and blue, or ascending wavelength:value pairs";
        place.wrong(format!("cannot read the spectrum \"{text}\""), remedy)
    })
}

/// Parses a black body of Mitsuba 0.6, from its temperature in kelvin and its scale.
fn blackbody(attributes: &Attributes, place: &Location) -> Result<PropertyValue, SceneError> {
    let read = |name: &str| attributes.get(name).map(|text| number(text.trim_end_matches(['k', 'K'])));
    let positive = |value: Option<f64>| value.filter(|value| *value > 0.0);
    let temperature = read("temperature").and_then(positive);
    let scale = read("scale").map_or(Some(1.0), positive);
    let (Some(temperature), Some(scale)) = (temperature, scale) else {
        let remedy = "give a temperature in kelvin, and a scale, above 0";
        return Err(place.wrong("cannot read the black body", remedy));
    };
    let spectrum = cie::blackbody(temperature).into_iter();
    Ok(PropertyValue::Samples(spectrum.map(|(wavelength, value)| (wavelength, scale * value)).collect()))
}

/// Parses a file of sampled spectra: one wavelength and value per line.
pub(super) fn samples_of_file(text: &str) -> Result<Vec<(f64, f64)>, u32> {
    let mut samples: Vec<(f64, f64)> = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.split('#').next().unwrap_or("");
        match numbers(line).as_deref() {
            Some([]) => {}
            Some([wavelength, value]) if samples.last().is_none_or(|last| last.0 < *wavelength) => {
                samples.push((*wavelength, *value));
            }
            _ => return Err(number),
        }
    }
    ascending(samples).ok_or(1)
}

/// Returns samples if there are any, in ascending order of wavelength.
fn ascending(samples: Vec<(f64, f64)>) -> Option<Vec<(f64, f64)>> {
    let ascends = samples.windows(2).all(|pair| pair[0].0 < pair[1].0);
    (ascends && !samples.is_empty()).then_some(samples)
}

/// Parses a finite number.
fn number(text: &str) -> Option<f64> {
    text.trim().parse::<f64>().ok().filter(|v| v.is_finite())
}

/// Parses finite numbers, separated by commas or spaces.
pub fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split(|c: char| c == ',' || c.is_whitespace()).filter(|s| !s.is_empty()).map(number).collect()
}

/// Parses one number, three numbers or `#rrggbb`.
fn colour(text: &str) -> Option<DVec3> {
    if let Some(hex) = text.strip_prefix('#') {
        let digits = if hex.len() == 6 { u32::from_str_radix(hex, 16).ok()? } else { return None };
        let channel = |shift: u32| f64::from((digits >> shift) & 255) / 255.0;
        return Some(DVec3::new(channel(16), channel(8), channel(0)));
    }
    match numbers(text)?[..] {
        [v] => Some(DVec3::splat(v)),
        [r, g, b] => Some(DVec3::new(r, g, b)),
        _ => None,
    }
}

/// Parses `x`, `y` and `z`, each `default` if absent, or all three in `value`.
fn vector(attributes: &Attributes, default: f64, place: &Location) -> Result<DVec3, SceneError> {
    let unreadable = |text: &str| {
        place.wrong(format!("cannot read the vector \"{text}\""), "write one or three finite numbers")
    };
    if let Some(text) = attributes.get("value") {
        return match numbers(text).as_deref() {
            Some([v]) => Ok(DVec3::splat(*v)),
            Some([x, y, z]) => Ok(DVec3::new(*x, *y, *z)),
            _ => Err(unreadable(text)),
        };
    }
    let component = |name: &str| match attributes.get(name) {
        Some(text) => number(text).ok_or_else(|| unreadable(text)),
        None => Ok(default),
    };
    Ok(DVec3::new(component("x")?, component("y")?, component("z")?))
}

/// Composes the operations of a `<transform>`; the first one is applied first.
pub(super) fn transform(operations: &[(String, Attributes, Location)]) -> Result<PropertyValue, SceneError> {
    let (mut matrix, mut axes) = (DMat4::IDENTITY, DMat4::IDENTITY);
    for (tag, attributes, place) in operations {
        let next = operation(tag, attributes, place)?;
        matrix = next * matrix;
        axes = without_flat_scale(tag, next) * axes;
    }
    axes.w_axis = matrix.w_axis;
    if !matrix.is_finite() {
        let place = operations
            .last()
            .map(|o| o.2.clone())
            .unwrap_or(Location { path: Default::default(), line: None });
        return Err(place.wrong("the transform is not finite", "correct its numbers"));
    }
    Ok(PropertyValue::Transform(Box::new([matrix, axes])))
}

/// Returns an operation with a scale of 1 in place of each scale of 0.
fn without_flat_scale(tag: &str, operation: DMat4) -> DMat4 {
    if tag != "scale" {
        return unflattened(operation);
    }
    let scale = DVec3::new(operation.x_axis.x, operation.y_axis.y, operation.z_axis.z);
    DMat4::from_scale(DVec3::select(scale.cmpeq(DVec3::ZERO), DVec3::ONE, scale))
}

fn operation(tag: &str, attributes: &Attributes, place: &Location) -> Result<DMat4, SceneError> {
    let bad = |what: String, remedy: &str| place.wrong(what, remedy);
    let need = |name: &str| {
        let missing = || bad(format!("<{tag}> lacks the attribute \"{name}\""), "add it");
        attributes.get(name).map(String::as_str).ok_or_else(missing)
    };
    Ok(match tag {
        "translate" => DMat4::from_translation(vector(attributes, 0.0, place)?),
        "scale" => DMat4::from_scale(vector(attributes, 1.0, place)?),
        "rotate" => {
            let angle = number(need("angle")?);
            let angle =
                angle.ok_or_else(|| bad("cannot read the rotation's angle".into(), "write degrees"))?;
            match unit(vector(attributes, 0.0, place)?) {
                Some(axis) => DMat4::from_axis_angle(axis, angle.to_radians()),
                // Some exporters write rotations by 0 about no axis.
                None if angle == 0.0 => DMat4::IDENTITY,
                None => return Err(bad("the rotation's axis is zero".into(), "give x, y or z")),
            }
        }
        "lookat" | "lookAt" => {
            let point = |name: &str| {
                let text = need(name)?;
                match numbers(text).as_deref() {
                    Some([x, y, z]) => Ok(DVec3::new(*x, *y, *z)),
                    _ => Err(bad(format!("cannot read {name}=\"{text}\""), "write three finite numbers")),
                }
            };
            let (origin, target) = (point("origin")?, point("target")?);
            let up = if attributes.contains_key("up") { point("up")? } else { DVec3::ZERO };
            look_at(origin, target, up).ok_or_else(|| {
                bad("the look-at has no direction".into(), "move target away from origin, up off axis")
            })?
        }
        "matrix" => matrix(need("value")?, place)?,
        _ => {
            return Err(bad(
                format!("unknown transform <{tag}>"),
                "use translate, rotate, scale, lookat or matrix",
            ));
        }
    })
}

/// Parses a matrix of 9 or 16 numbers, row by row.
fn matrix(text: &str, place: &Location) -> Result<DMat4, SceneError> {
    match numbers(text).as_deref() {
        Some(v @ [_, _, _, _, _, _, _, _, _, _, _, _, _, _, _, _]) => {
            Ok(DMat4::from_cols_slice(v).transpose())
        }
        Some([a, b, c, d, e, f, g, h, i]) => Ok(DMat4::from_cols(
            DVec4::new(*a, *d, *g, 0.0),
            DVec4::new(*b, *e, *h, 0.0),
            DVec4::new(*c, *f, *i, 0.0),
            DVec4::W,
        )),
        _ => {
            Err(place
                .wrong(format!("cannot read the matrix \"{text}\""), "write 9 or 16 numbers, row by row"))
        }
    }
}

/// Returns a frame at `origin` with z towards `target` and x = up × z; `None` without a direction. Without an up
/// vector, up is the first tangent of Duff et al., *Building an Orthonormal Basis, Revisited*, 2017, as in Mitsuba 3.
fn look_at(origin: DVec3, target: DVec3, up: DVec3) -> Option<DMat4> {
    let forward = unit(target - origin)?;
    let up = if up == DVec3::ZERO { forward.any_orthonormal_pair().0 } else { up };
    let left = -right_of(forward, up)?;
    let new_up = forward.cross(left);
    Some(DMat4::from_cols(left.extend(0.0), new_up.extend(0.0), forward.extend(0.0), origin.extend(1.0)))
}

/// Converts a colour to the renderer's type.
pub(super) fn rgb(colour: DVec3) -> Rgb {
    colour.as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn attributes(pairs: &[(&str, &str)]) -> Attributes {
        pairs.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect()
    }

    fn value(tag: &str, text: &str) -> Result<PropertyValue, String> {
        let place = Location::line(Path::new("s.xml"), 3);
        parse(tag, &attributes(&[("value", text)]), &place).map_err(|e| e.to_string())
    }

    #[test]
    fn colours_come_as_one_number_three_or_hex() {
        assert_eq!(value("rgb", "0.5").unwrap(), PropertyValue::Rgb(DVec3::splat(0.5)));
        assert_eq!(value("rgb", "0.1, 0.2 0.3").unwrap(), PropertyValue::Rgb(DVec3::new(0.1, 0.2, 0.3)));
        assert_eq!(value("rgb", "#ff0080").unwrap(), PropertyValue::Rgb(DVec3::new(1.0, 0.0, 128.0 / 255.0)));
        let PropertyValue::Rgb(linear) = value("srgb", "0.5 0 1").unwrap() else { panic!() };
        assert!((linear - DVec3::new(0.214041, 0.0, 1.0)).length() < 1e-5);
        for bad in ["", "1 2", "#ff", "#gg0000", "nan", "inf 0 0", "1 2 3 4"] {
            assert!(value("rgb", bad).unwrap_err().contains("s.xml:3"), "{bad}");
        }
    }

    #[test]
    fn spectra_are_constants_or_samples() {
        assert_eq!(value("spectrum", "2").unwrap(), PropertyValue::Spectrum(2.0));
        assert_eq!(
            value("spectrum", "400:1, 700:2").unwrap(),
            PropertyValue::Samples(vec![(400., 1.), (700., 2.)])
        );
        assert!(value("spectrum", "400:").is_err());
        assert!(value("spectrum", "500:1 400:1").unwrap_err().contains("ascending"));
        for text in ["0.25 0.5 1", "0.25, 0.5, 1.0", "0.25,0.5,1"] {
            assert_eq!(
                value("spectrum", text).unwrap(),
                PropertyValue::Rgb(DVec3::new(0.25, 0.5, 1.0)),
                "{text}"
            );
        }
        assert_eq!(value("spectrum", "#ff0000").unwrap(), PropertyValue::Rgb(DVec3::X));
        assert_eq!(samples_of_file("# nm\n400 1\n\n700, 2 # end\n"), Ok(vec![(400.0, 1.0), (700.0, 2.0)]));
        assert_eq!(samples_of_file("400 1\n300 2\n"), Err(2));
        assert_eq!(samples_of_file(""), Err(1));
        assert!(value("spectrum", "").is_err());
    }

    #[test]
    fn transforms_apply_in_the_order_written() {
        let place = Location::line(Path::new("s.xml"), 3);
        let op = |tag: &str, pairs: &[(&str, &str)]| (tag.to_string(), attributes(pairs), place.clone());
        let operations = [
            op("scale", &[("value", "2")]),
            op("rotate", &[("z", "1"), ("angle", "90")]),
            op("translate", &[("x", "1")]),
        ];
        let PropertyValue::Transform(m) = transform(&operations).unwrap() else { panic!() };
        assert!((m[0].transform_point3(DVec3::X) - DVec3::new(1.0, 2.0, 0.0)).length() < 1e-12);
        let rows = "1 2 3 4 5 6 7 8 9 10 11 12 0 0 0 1";
        let PropertyValue::Transform(m) = transform(&[op("matrix", &[("value", rows)])]).unwrap() else {
            panic!()
        };
        assert_eq!(m[0].transform_point3(DVec3::X), DVec3::new(5.0, 13.0, 21.0));
        let at = op("lookat", &[("origin", "1 2 3"), ("target", "1 2 9"), ("up", "0 1 0")]);
        let PropertyValue::Transform(m) = transform(&[at]).unwrap() else { panic!() };
        assert_eq!(m[0], DMat4::from_translation(DVec3::new(1.0, 2.0, 3.0)));
        // Mitsuba 3.9 gives these frames without an up vector.
        for (origin, axis) in [("0 0 5", DVec3::Y), ("0 5 0", DVec3::NEG_Z), ("0 0 -5", DVec3::NEG_Y)] {
            let at = op("lookat", &[("origin", origin), ("target", "0 0 0")]);
            let PropertyValue::Transform(m) = transform(&[at]).unwrap() else { panic!() };
            assert!(m[0].transform_vector3(DVec3::X).distance(axis) < 1e-12, "{origin}");
        }
        let PropertyValue::Transform(m) = transform(&[op("rotate", &[("angle", "0")])]).unwrap() else {
            panic!()
        };
        assert_eq!(m[0], DMat4::IDENTITY);
        let degenerate = [
            op("lookat", &[("origin", "1 2 3"), ("target", "1 2 3")]),
            op("lookat", &[("origin", "0 0 0"), ("target", "0 1 0"), ("up", "0 1 0")]),
            op("rotate", &[("angle", "3")]),
            op("matrix", &[("value", "1 2 3")]),
            op("shear", &[]),
        ];
        for bad in degenerate {
            assert!(transform(&[bad]).is_err());
        }
    }
}
