//! Parser of Wavefront MTL, the classic materials of an OBJ file. The module `native::mtl` converts them.
//!
//! The extension for physically based rendering is that of exocortex, which Blender writes.
//!
//! Reason against `tobj` 4.0.5: a colour of one or two numbers makes its MTL reader panic, and its errors name no line.

use super::encodings;
use super::faults::{MAX_CODE, are_codes, note_of_codes};
use super::wavefront::{self, numbers, shown, split_word, statements, values, words};
use crate::colour_profile::srgb_to_linear;
use crate::error::{Location, SceneError, Warning};
use crate::statements::{Fate, Statement, listed, table};
use base::math::Rgb;
use glam::{DMat3, DVec3};
use std::collections::BTreeMap;
use std::path::Path;

/// Returns the statements of MTL files.
pub(crate) fn mtl() -> &'static [Statement] {
    table("MTL")
}

/// A map statement: its text with options, and its line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MapStatement {
    pub text: String,
    pub line: u32,
}

/// A feature of a material that is not supported.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Unmodelled {
    pub what: String,
    /// Replacement.
    pub fallback: String,
    pub line: u32,
}

/// A material (`newmtl`) with its statements.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ClassicMaterial {
    pub name: String,
    /// Name with what may be a comment behind it, or a part of it.
    pub text: String,
    pub place: Location,
    /// Ka.
    pub ambient: Option<Rgb>,
    /// Kd.
    pub diffuse: Rgb,
    /// Ks.
    pub specular: Option<Rgb>,
    /// Ke.
    pub emissive: Rgb,
    /// Tf.
    pub filter: Option<Rgb>,
    /// Ns.
    pub exponent: f32,
    /// d.
    pub dissolve: Option<f32>,
    /// Tr, and its line.
    pub transparency: Option<(f32, u32)>,
    /// Ni.
    pub ior: Option<f32>,
    /// illum, from 0 to 10.
    pub model: u32,
    /// Numbers of the extension, by keyword.
    pub principled: BTreeMap<&'static str, f32>,
    /// Maps by keyword. `map_bump` is `bump`.
    pub maps: BTreeMap<&'static str, MapStatement>,
    pub unmodelled: Vec<Unmodelled>,
    /// Line of the last statement of each keyword.
    lines: BTreeMap<&'static str, u32>,
}

/// Reads the MTL text `bytes`; `path` is for messages.
pub fn read(bytes: &[u8], path: &Path) -> Result<Vec<ClassicMaterial>, SceneError> {
    let mut materials: Vec<ClassicMaterial> = Vec::new();
    for (line, statement) in statements(bytes) {
        let place = Location::line(path, line);
        let (word, rest) = split_word(&statement);
        if word.is_empty() || word[0] == b'#' {
            continue;
        }
        if word.eq_ignore_ascii_case(b"newmtl") {
            materials.push(ClassicMaterial::new(rest, place));
        } else if let Some(material) = materials.last_mut() {
            material.read(word, rest, line).map_err(|what| SceneError::mesh(place, what))?;
        }
    }
    Ok(materials)
}

/// Returns the line of the first statement of a library, if it is in front of all materials.
pub(crate) fn before_materials(bytes: &[u8]) -> Option<u32> {
    let mut all = statements(bytes).filter(|(_, text)| !text.is_empty() && text[0] != b'#');
    let (line, text) = all.next()?;
    let word = text.split(u8::is_ascii_whitespace).next()?;
    (!word.eq_ignore_ascii_case(b"newmtl")).then_some(line)
}

/// Decodes the colours of a keyword that are whole numbers up to 255 in all of a library; returns notes about them.
pub(crate) fn decode_codes(materials: &mut [ClassicMaterial]) -> Vec<Warning> {
    type Colour = fn(&mut ClassicMaterial) -> Option<&mut Rgb>;
    let keywords: [(&str, Colour); 4] = [
        ("Kd", |material| Some(&mut material.diffuse)),
        ("Ks", |material| material.specular.as_mut()),
        ("Ka", |material| material.ambient.as_mut()),
        ("Tf", |material| material.filter.as_mut()),
    ];
    let mut notes = Vec::new();
    for (keyword, colour) in keywords {
        let colours =
            materials.iter_mut().filter_map(|material| Some((material.place.clone(), *colour(material)?)));
        let colours: Vec<(Location, Rgb)> = colours.collect();
        let most = |colour: &Rgb| f64::from(colour.max_element());
        let greatest = colours.iter().map(|(_, colour)| most(colour)).fold(0.0, f64::max);
        let are_whole =
            colours.iter().all(|(_, colour)| colour.fract() == Rgb::ZERO && colour.min_element() >= 0.0);
        let Some((place, _)) = colours.into_iter().find(|(_, colour)| most(colour) == greatest) else {
            continue;
        };
        if !are_codes(greatest, are_whole) {
            continue;
        }
        let note = note_of_codes(place);
        notes.push(Warning { what: format!("{keyword}: {}", note.what), ..note });
        let decode = |code: f32| srgb_to_linear(code / MAX_CODE as f32);
        materials
            .iter_mut()
            .filter_map(colour)
            .for_each(|colour| *colour = Rgb::from(colour.to_array().map(decode)));
    }
    notes
}

impl ClassicMaterial {
    /// True if another definition gives an equal material.
    pub fn is_like(&self, other: &ClassicMaterial) -> bool {
        self.content() == other.content()
    }

    /// Returns the material without its name and its lines.
    fn content(&self) -> ClassicMaterial {
        let mut content = ClassicMaterial { name: String::new(), text: String::new(), ..self.clone() };
        content.place = Location::file(Path::new(""));
        content.transparency = content.transparency.map(|(share, _)| (share, 0));
        content.maps.values_mut().for_each(|map| map.line = 0);
        content.unmodelled.iter_mut().for_each(|lack| lack.line = 0);
        content.lines.clear();
        content
    }

    /// Returns what the statements that are read give, without lines.
    fn values(&self) -> ClassicMaterial {
        ClassicMaterial { unmodelled: Vec::new(), ..self.content() }
    }

    fn new(name: &[u8], place: Location) -> ClassicMaterial {
        ClassicMaterial {
            name: wavefront::name(name),
            text: encodings::text(name.trim_ascii()),
            place,
            ambient: None,
            diffuse: Rgb::ZERO,
            specular: None,
            emissive: Rgb::ZERO,
            filter: None,
            exponent: 0.0,
            dissolve: None,
            transparency: None,
            ior: None,
            model: 2,
            principled: BTreeMap::new(),
            maps: BTreeMap::new(),
            unmodelled: Vec::new(),
            lines: BTreeMap::new(),
        }
    }

    fn read(&mut self, word: &[u8], rest: &[u8], line: u32) -> Result<(), String> {
        let spelled = |statement: &&Statement| statement.name.as_bytes().eq_ignore_ascii_case(word);
        let exact = listed(mtl(), &String::from_utf8_lossy(word));
        let Some(statement) = exact.or_else(|| mtl().iter().find(spelled)) else {
            self.lacks(format!("the unknown statement \"{}\"", shown(word)), "it is left out", line);
            return Ok(());
        };
        let keyword = if statement.name == "map_bump" { "bump" } else { statement.name };
        let Some(earlier) = self.lines.insert(keyword, line) else {
            return self.read_listed((statement, keyword), rest, line);
        };
        let before = self.values();
        self.read_listed((statement, keyword), rest, line)?;
        if self.values() != before {
            let what = format!("{keyword} twice, in line {earlier} and here,");
            self.lacks(what, "the later one is used; leave one of them out", line);
        }
        Ok(())
    }

    /// Reads a statement by its keyword, which may be another spelling of it.
    fn read_listed(
        &mut self,
        (statement, keyword): (&Statement, &'static str),
        rest: &[u8],
        line: u32,
    ) -> Result<(), String> {
        let number = || finite::<1>(rest).map(|[v]| v as f32);
        match (statement.fate, keyword) {
            // The image of map_Ka decides.
            (Fate::Named, keyword) if keyword != "map_Ka" => {
                self.lacks(keyword.to_owned(), statement.note, line);
            }
            (_, "Kd") => self.diffuse = self.colour("Kd", rest, line)?,
            (_, "Ks") => self.specular = Some(self.colour("Ks", rest, line)?),
            (_, "Ke") => self.emissive = self.colour("Ke", rest, line)?,
            (_, "Ka") => self.ambient = Some(self.colour("Ka", rest, line)?),
            (_, "Tf") => self.filter = Some(self.colour("Tf", rest, line)?),
            (_, "Ns") => self.exponent = number()?,
            (_, "d") => {
                let mut rest = rest;
                if words(rest).next() == Some(b"-halo") {
                    self.lacks("d -halo".to_owned(), "the opacity is the same from all sides", line);
                    rest = split_word(rest.trim_ascii_start()).1;
                }
                self.dissolve = Some(finite::<1>(rest).map(|[v]| v as f32)?);
            }
            (_, "Tr") => self.transparency = Some((number()?, line)),
            (_, "Ni") => self.ior = Some(number()?),
            (_, "illum") => self.illumination(number()?, line),
            (_, keyword @ ("Pr" | "Pm" | "Ps" | "Pc" | "Pcr" | "aniso" | "anisor")) => {
                self.principled.insert(keyword, number()?);
            }
            (_, keyword) if keyword.starts_with("map_") || matches!(keyword, "norm" | "bump") => {
                let text = encodings::text(rest.trim_ascii());
                if !wavefront::name(rest).is_empty() {
                    self.maps.insert(keyword, MapStatement { text, line });
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Returns the opacity: d, or 1 - Tr where there is no d, whichever comes first.
    pub fn opacity(&self) -> f32 {
        self.dissolve.or(self.transparency.map(|(share, _)| 1.0 - share)).unwrap_or(1.0)
    }

    /// Adds a feature that is not supported.
    pub fn lacks(&mut self, what: String, fallback: &str, line: u32) {
        self.unmodelled.push(Unmodelled { what, fallback: fallback.to_owned(), line });
    }

    fn illumination(&mut self, number: f32, line: u32) {
        self.model = if (0.0..=10.0).contains(&number) && number.fract() == 0.0 { number as u32 } else { 2 };
        match number {
            0.0 => self.lacks("illum 0, a colour without light".to_owned(), "the surface is matte", line),
            10.0 => self.lacks(
                "illum 10, shadows without a surface".to_owned(),
                "the surface is as with illum 2",
                line,
            ),
            _ if self.model as f32 != number => {
                self.lacks(format!("illum {number}"), "the surface is as with illum 2", line);
            }
            _ => {}
        }
    }

    /// Parses three numbers, one number as a grey, or a colour by CIE XYZ.
    fn colour(&mut self, keyword: &str, rest: &[u8], line: u32) -> Result<Rgb, String> {
        match values(rest).next() {
            Some(b"spectral") => {
                self.lacks(format!("{keyword} by a spectrum"), "a grey of 0.5 is used instead", line);
                return Ok(Rgb::splat(0.5));
            }
            Some(b"xyz") => {
                let xyz = finite::<3>(split_word(rest.trim_ascii_start()).1)?;
                return Ok((RGB_OF_XYZ * DVec3::from(xyz)).as_vec3().max(Rgb::ZERO));
            }
            _ => {}
        }
        let three = finite::<3>(rest).map(|c| DVec3::from(c).as_vec3());
        three.or_else(|e| match values(rest).count() {
            1 => finite::<1>(rest).map(|[v]| Rgb::splat(v as f32)),
            _ => Err(e),
        })
    }
}

/// Linear Rec. 709 from CIE XYZ (IEC 61966-2-1).
const RGB_OF_XYZ: DMat3 = DMat3::from_cols_array(&[
    3.2406, -0.9689, 0.0557, //
    -1.5372, 1.8758, -0.2040, //
    -0.4986, 0.0415, 1.0570,
]);

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

    fn read_text(text: &str) -> Vec<ClassicMaterial> {
        read(text.as_bytes(), Path::new("t.mtl")).unwrap()
    }

    #[test]
    fn statements_are_read_and_errors_name_their_line() {
        let text = "# made by hand\nnewmtl a b # oak\nKd 0.1 0.2 \\\n 0.3\r\nKs 0.5 # grey\nTr 0.25\nNs 10\nNi 1.4\n\
            illum 7\nmap_Kd -s 2 2 1 wood.png # x\nmap_Bump x.png\nPr 0.3\nnewmtl c\nmap_kd my wood.png\nmap_d\n\
            map_Ke # none\nKd xyz 0.9505 1 1.089\n";
        let [a, c] = &read_text(text)[..] else { panic!() };
        assert_eq!(
            (a.name.as_str(), a.diffuse, a.specular),
            ("a b", Rgb::new(0.1, 0.2, 0.3), Some(Rgb::splat(0.5)))
        );
        assert_eq!((a.opacity(), a.exponent, a.ior, a.model), (0.75, 10.0, Some(1.4), 7));
        assert_eq!(a.maps["map_Kd"], MapStatement { text: "-s 2 2 1 wood.png # x".to_owned(), line: 10 });
        assert_eq!((a.maps["bump"].line, a.principled["Pr"], a.unmodelled.len()), (11, 0.3, 0));
        assert_eq!((c.maps.len(), c.maps["map_Kd"].text.as_str()), (1, "my wood.png"));
        assert!((c.diffuse - Rgb::ONE).abs().max_element() < 1e-3, "{}", c.diffuse);
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
                materials[0].unmodelled.iter().map(|u| format!("{}: {}", u.line, u.what)).collect();
            assert_eq!(named.join("; "), expected, "{text}");
        }
        assert_eq!(read_text("newmtl a\nKd 1 0 0\nKd 0 1 0")[0].diffuse, Rgb::Y);
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
    fn statements_and_illuminations_that_are_not_modelled_are_named() {
        let named = |text: &str| -> Vec<String> {
            let of = |u: Unmodelled| format!("{}: {}", u.line, u.what);
            read_text(&format!("newmtl a\n{text}\n")).remove(0).unmodelled.into_iter().map(of).collect()
        };
        for statement in mtl() {
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
