//! Parser of MTL: materials with the values of their statements.
//!
//! The extension for physically based rendering is that of exocortex, which Blender writes.
//!
//! Reason against `tobj` 4.0.5: a colour of one or two numbers makes its MTL reader panic, and its errors name no line.

use crate::colour_profile::{XYZ_TO_RGB, srgb_to_linear};
use crate::error::{Location, SceneError, Warning};
use crate::mesh::encodings;
use crate::mesh::faults::{MAX_CODE, are_codes, note_of_codes};
use crate::mesh::wavefront::{self, numbers, shown, split_word, values, words};
use crate::statements::{Fate, Statement, table};
use base::math::Rgb;
use glam::DVec3;
use std::collections::BTreeMap;
use std::path::Path;

/// Returns the statements of MTL files.
pub fn statements() -> &'static [Statement] {
    table("MTL")
}

/// Value of a statement that is read.
#[derive(Clone, Debug, PartialEq)]
enum Value {
    Number(f32),
    Colour(Rgb),
    /// Text of a map: its options and the name of its file.
    Map(String),
}

/// A feature that is not supported.
#[derive(Clone, Debug, PartialEq)]
pub struct Unsupported {
    pub what: String,
    /// Replacement.
    pub fallback: String,
    pub line: u32,
}

/// A material (`newmtl`) with its statements.
#[derive(Clone, Debug)]
pub struct SourceMaterial {
    pub name: String,
    /// Name with what may be a comment behind it, or a part of it.
    pub text: String,
    pub place: Location,
    pub unsupported: Vec<Unsupported>,
    /// Values by keyword, with their lines. `map_bump` is `bump`.
    values: BTreeMap<&'static str, (Value, u32)>,
}

/// Reads the MTL text `bytes`; `path` is for messages.
pub fn read(bytes: &[u8], path: &Path) -> Result<Vec<SourceMaterial>, SceneError> {
    let mut materials: Vec<SourceMaterial> = Vec::new();
    for (line, statement) in wavefront::statements(bytes) {
        let place = Location::line(path, line);
        let (word, rest) = split_word(&statement);
        if word.is_empty() || word[0] == b'#' {
            continue;
        }
        if word.eq_ignore_ascii_case(b"newmtl") {
            materials.push(SourceMaterial {
                name: wavefront::name(rest),
                text: encodings::text(rest.trim_ascii()),
                place,
                unsupported: Vec::new(),
                values: BTreeMap::new(),
            });
        } else if let Some(material) = materials.last_mut() {
            material.read(word, rest, line).map_err(|what| SceneError::mesh(place, what))?;
        }
    }
    Ok(materials)
}

/// Returns the line of the first statement of a library, if it is in front of all materials.
pub fn before_materials(bytes: &[u8]) -> Option<u32> {
    let mut all = wavefront::statements(bytes).filter(|(_, text)| !text.is_empty() && text[0] != b'#');
    let (line, text) = all.next()?;
    (!split_word(&text).0.eq_ignore_ascii_case(b"newmtl")).then_some(line)
}

/// Decodes the colours of a keyword that are whole numbers up to 255 in all of a library; returns notes about them.
pub fn decode_codes(materials: &mut [SourceMaterial]) -> Vec<Warning> {
    let mut notes = Vec::new();
    for keyword in ["Kd", "Ks", "Ka", "Tf"] {
        let colours = || materials.iter().filter_map(|m| Some((&m.place, m.colour(keyword)?)));
        let are_whole = colours().all(|(_, c)| c.fract() == Rgb::ZERO && c.min_element() >= 0.0);
        let brightest = colours().reduce(|a, b| if b.1.max_element() > a.1.max_element() { b } else { a });
        let Some((place, brightest)) = brightest else { continue };
        if !are_codes(brightest.max_element().into(), are_whole) {
            continue;
        }
        let note = note_of_codes(place.clone());
        notes.push(Warning { what: format!("{keyword}: {}", note.what), ..note });
        for material in materials.iter_mut() {
            if let Some((Value::Colour(colour), _)) = material.values.get_mut(keyword) {
                *colour = colour.map(|code| srgb_to_linear(code / MAX_CODE as f32));
            }
        }
    }
    notes
}

impl SourceMaterial {
    /// True if another definition gives an equal material.
    pub fn is_like(&self, other: &SourceMaterial) -> bool {
        fn content(material: &SourceMaterial) -> (Vec<(&str, &Value)>, Vec<[&str; 2]>) {
            let SourceMaterial { values, unsupported, .. } = material;
            let values = values.iter().map(|(keyword, (value, _))| (*keyword, value));
            let lacks = unsupported.iter().map(|lack| [&*lack.what, &*lack.fallback]);
            (values.collect(), lacks.collect())
        }
        content(self) == content(other)
    }

    /// Returns the number of a keyword.
    pub fn number(&self, keyword: &str) -> Option<f32> {
        match self.values.get(keyword)?.0 {
            Value::Number(number) => Some(number),
            _ => None,
        }
    }

    /// Returns the colour of a keyword.
    pub fn colour(&self, keyword: &str) -> Option<Rgb> {
        match self.values.get(keyword)?.0 {
            Value::Colour(colour) => Some(colour),
            _ => None,
        }
    }

    /// Returns the text of a map.
    pub fn map(&self, keyword: &str) -> Option<&str> {
        match &self.values.get(keyword)?.0 {
            Value::Map(text) => Some(text),
            _ => None,
        }
    }

    /// True if there is a statement of the keyword.
    pub fn has(&self, keyword: &str) -> bool {
        self.values.contains_key(keyword)
    }

    /// Returns the line of a keyword's statement; the line of the material if there is none.
    pub fn line(&self, keyword: &str) -> u32 {
        self.values.get(keyword).map(|(_, line)| *line).or(self.place.line).unwrap_or_default()
    }

    /// Returns the kind of surface: `illum`, from 0 to 10.
    pub fn model(&self) -> u32 {
        self.number("illum").map_or(2, |number| number as u32)
    }

    /// Returns the opacity: d, or 1 - Tr where there is no d, whichever comes first.
    pub fn opacity(&self) -> f32 {
        self.number("d").or(self.number("Tr").map(|share| 1.0 - share)).unwrap_or(1.0)
    }

    fn lacks(&mut self, what: String, fallback: &str, line: u32) {
        self.unsupported.push(Unsupported { what, fallback: fallback.to_owned(), line });
    }

    fn read(&mut self, word: &[u8], rest: &[u8], line: u32) -> Result<(), String> {
        let spelled = |statement: &&Statement| statement.name.as_bytes().eq_ignore_ascii_case(word);
        let Some(statement) = statements().iter().find(spelled) else {
            self.lacks(format!("the unknown statement \"{}\"", shown(word)), "it is left out", line);
            return Ok(());
        };
        match (statement.fate, statement.name) {
            // The image of map_Ka decides.
            (Fate::Named, keyword) if keyword != "map_Ka" => {
                self.lacks(keyword.to_owned(), statement.note, line);
            }
            (Fate::NoEffect, _) => {}
            (_, "map_bump") => self.set("bump", rest, line)?,
            (_, keyword) => self.set(keyword, rest, line)?,
        }
        Ok(())
    }

    /// Reads the value of a statement, which replaces an earlier one.
    fn set(&mut self, keyword: &'static str, rest: &[u8], line: u32) -> Result<(), String> {
        let value = match keyword {
            "Kd" | "Ks" | "Ke" | "Ka" | "Tf" => Value::Colour(self.parse_colour(keyword, rest, line)?),
            "illum" => Value::Number(self.illumination(number(rest)?, line)),
            "d" if words(rest).next() == Some(b"-halo") => {
                self.lacks("d -halo".to_owned(), "the opacity is the same from all sides", line);
                Value::Number(number(split_word(rest.trim_ascii_start()).1)?)
            }
            _ if !keyword.starts_with("map_") && !matches!(keyword, "norm" | "bump") => {
                Value::Number(number(rest)?)
            }
            _ if wavefront::name(rest).is_empty() => return Ok(()),
            _ => Value::Map(encodings::text(rest.trim_ascii())),
        };
        let earlier = self.values.insert(keyword, (value.clone(), line));
        if let Some((_, earlier)) = earlier.filter(|(earlier, _)| *earlier != value) {
            let what = format!("{keyword} twice, in line {earlier} and here,");
            self.lacks(what, "the later one is used; leave one of them out", line);
        }
        Ok(())
    }

    /// Returns the kind of surface, which is 2 instead of a number that names none.
    fn illumination(&mut self, number: f32, line: u32) -> f32 {
        let known = (0.0..=10.0).contains(&number) && number.fract() == 0.0;
        match number {
            0.0 => self.lacks("illum 0, a colour without light".to_owned(), "the surface is matte", line),
            10.0 => self.lacks(
                "illum 10, shadows without a surface".to_owned(),
                "the surface is as with illum 2",
                line,
            ),
            _ if !known => self.lacks(format!("illum {number}"), "the surface is as with illum 2", line),
            _ => {}
        }
        if known { number } else { 2.0 }
    }

    /// Parses three numbers, one number as a grey, or a colour by CIE XYZ.
    fn parse_colour(&mut self, keyword: &str, rest: &[u8], line: u32) -> Result<Rgb, String> {
        match values(rest).next() {
            Some(b"spectral") => {
                self.lacks(format!("{keyword} by a spectrum"), "a grey of 0.5 is used instead", line);
                Ok(Rgb::splat(0.5))
            }
            Some(b"xyz") => {
                let xyz = finite(split_word(rest.trim_ascii_start()).1)?;
                Ok((XYZ_TO_RGB * DVec3::from(xyz)).as_vec3().max(Rgb::ZERO))
            }
            _ if values(rest).count() == 1 => number(rest).map(Rgb::splat),
            _ => finite(rest).map(|colour| DVec3::from(colour).as_vec3()),
        }
    }
}

/// Parses the first number of a line.
fn number(rest: &[u8]) -> Result<f32, String> {
    finite(rest).map(|[number]| number as f32)
}

/// Parses the first `N` numbers of a line.
fn finite<const N: usize>(rest: &[u8]) -> Result<[f64; N], String> {
    let numbers = numbers(rest)?;
    match numbers.iter().find(|number| !(**number as f32).is_finite()) {
        Some(number) => Err(format!("the number {number} is not finite")),
        None => Ok(numbers),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Vec<SourceMaterial> {
        read(text.as_bytes(), Path::new("t.mtl")).unwrap()
    }

    #[test]
    fn statements_are_read_and_errors_name_their_line() {
        let text = "# made by hand\nnewmtl a b # oak\nKd 0.1 0.2 \\\n 0.3\r\nKs 0.5 # grey\nTr 0.25\nNs 10\nNi 1.4\n\
            illum 7\nmap_Kd -s 2 2 1 wood.png # x\nmap_Bump x.png\nPr 0.3\nnewmtl c\nmap_kd my wood.png\nmap_d\n\
            map_Ke # none\nKd xyz 0.9505 1 1.089\n";
        let [a, c] = &read_text(text)[..] else { panic!() };
        assert_eq!(
            (a.name.as_str(), a.colour("Kd"), a.colour("Ks")),
            ("a b", Some(Rgb::new(0.1, 0.2, 0.3)), Some(Rgb::splat(0.5)))
        );
        assert_eq!(
            (a.opacity(), a.number("Ns"), a.number("Ni"), a.model()),
            (0.75, Some(10.0), Some(1.4), 7)
        );
        assert_eq!((a.map("map_Kd"), a.line("map_Kd")), (Some("-s 2 2 1 wood.png # x"), 10));
        assert_eq!((a.line("bump"), a.number("Pr"), a.unsupported.len()), (11, Some(0.3), 0));
        assert_eq!((c.values.len(), c.map("map_Kd")), (2, Some("my wood.png")));
        let white = c.colour("Kd").unwrap();
        assert!((white - Rgb::ONE).abs().max_element() < 1e-3, "{white}");
        for bad in ["Kd 0.1 0.2", "Kd a b c", "Ns", "d x", "Ks nan", "d nan", "Ni inf", "Ke 1 2 1e39", "Pr x"]
        {
            let message =
                read(format!("newmtl a\n{bad}\n").as_bytes(), Path::new("t.mtl")).unwrap_err().to_string();
            assert!(message.starts_with("t.mtl:2:"), "{message}");
        }
    }

    #[test]
    fn statements_given_twice_are_named_with_both_lines_if_they_differ() {
        for (text, expected) in [
            ("Kd 1 0 0\nNs 5\nKd 0 1 0", "4: Kd twice, in line 2 and here,"),
            ("Ns 5\nNs 6", "3: Ns twice, in line 2 and here,"),
            ("illum 2\nillum 1", "3: illum twice, in line 2 and here,"),
            ("Pr .5\nPr .6", "3: Pr twice, in line 2 and here,"),
            ("map_Kd a.png\nmap_kd b.png", "3: map_Kd twice, in line 2 and here,"),
            ("bump a.png\nmap_Bump b.png", "3: bump twice, in line 2 and here,"),
            ("bump a.png\nmap_bump a.png", ""),
            ("d -halo .5\nd -halo .5", "2: d -halo; 3: d -halo"),
            ("sharpness 1\nsharpness 2", "2: sharpness; 3: sharpness"),
            ("Kd 1 0 0\nKd 1.0 0 0 # red\nillum 2\nillum 2", ""),
            ("Kd 1 0 0\nnewmtl b\nKd 0 1 0", ""),
        ] {
            let materials = read_text(&format!("newmtl a\n{text}\n"));
            let named: Vec<String> =
                materials[0].unsupported.iter().map(|u| format!("{}: {}", u.line, u.what)).collect();
            assert_eq!(named.join("; "), expected, "{text}");
        }
        assert_eq!(read_text("newmtl a\nKd 1 0 0\nKd 0 1 0")[0].colour("Kd"), Some(Rgb::Y));
    }

    #[test]
    fn d_counts_before_tr_whichever_comes_first() {
        let opacity = |text: &str| read_text(&format!("newmtl a\n{text}\n"))[0].opacity();
        for (text, expected) in [
            ("d 1\nTr 1", 1.0),
            ("Tr 1\nd 0.5", 0.5),
            ("Tr 0.75", 0.25),
            ("d 0.5", 0.5),
            ("d -halo 0.5", 0.5),
        ] {
            assert_eq!(opacity(text), expected, "{text}");
        }
    }

    #[test]
    fn statements_and_illuminations_that_are_not_supported_are_named() {
        let named = |text: &str| -> Vec<String> {
            let of = |u: Unsupported| format!("{}: {}", u.line, u.what);
            read_text(&format!("newmtl a\n{text}\n")).remove(0).unsupported.into_iter().map(of).collect()
        };
        for statement in statements() {
            let said = named(&format!("{} 0.5", statement.name));
            let is_named = statement.fate == Fate::Named && statement.name != "map_Ka";
            let expected = if is_named { vec![format!("2: {}", statement.name)] } else { vec![] };
            let expected = if statement.name == "illum" { vec!["2: illum 0.5".to_owned()] } else { expected };
            assert_eq!(said, expected, "{}", statement.name);
        }
        assert_eq!(named("Km 0.3"), ["2: the unknown statement \"Km\""]);
        assert_eq!(named("Kd spectral a.rfl 1"), ["2: Kd by a spectrum"]);
        assert_eq!(named("d -halo 0.5"), ["2: d -halo"]);
        for illum in -1..13 {
            assert_eq!(named(&format!("illum {illum}")).is_empty(), (1..10).contains(&illum), "{illum}");
        }
    }
}
