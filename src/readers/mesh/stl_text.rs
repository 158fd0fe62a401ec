//! Reader of text STL, as programs and hands write it: words in capitals, with decimal commas, in any lines.
//!
//! A facet that cannot be read is left out with a warning.

use super::stl_soup::SoupBuilder;
use super::wavefront::{lines, shown};
use crate::error::{Location, Severity, Warning};
use crate::statements::{note, table};
use std::iter::Peekable;
use std::path::Path;

/// Maximum number of unknown words that are reported.
const MAX_REPORTED: usize = 10;

/// Reads the triangles of a text. Names in `remarks` what is not read.
pub fn read(bytes: &[u8], path: &Path, builder: &mut SoupBuilder, remarks: &mut Vec<Warning>) {
    let mut reader =
        TextReader { builder, facet: Facet::default(), part: None, findings: Findings::default() };
    for (line, text) in (1..).zip(lines(bytes)) {
        reader.line(&String::from_utf8_lossy(text), line);
    }
    let (count, is_open) = (reader.builder.mesh.triangles.len(), reader.part.is_some());
    if !reader.facet.corners.is_empty() {
        reader.findings.leave_out(reader.facet.line, "the text ends within a facet".to_owned());
    }
    reader.findings.report(path, remarks);
    if let (Some(line), true) = (reader.part, is_open) {
        let fallback =
            format!("its {count} triangles are read; if some are missing, download or export it again");
        remarks.push(Warning::new(Location::line(path, line), "the text has no endsolid", fallback));
    }
}

struct TextReader<'a> {
    builder: &'a mut SoupBuilder,
    facet: Facet,
    /// Line of the part that has not ended.
    part: Option<u32>,
    findings: Findings,
}

/// The facet at hand.
#[derive(Default)]
struct Facet {
    corners: Vec<[f32; 3]>,
    line: u32,
    /// True if a corner cannot be read.
    is_spoilt: bool,
}

/// Findings about a text: parts that are not read.
#[derive(Default)]
struct Findings {
    /// Number of facets left out; line and reason of the first.
    left_out: usize,
    first: Option<(u32, String)>,
    /// Unknown words, with the line of each one's first use.
    unknown: Vec<(String, u32)>,
    /// Line of the first number with a comma.
    comma: Option<u32>,
    /// Line and number of corners of the first facet of more than three.
    polygon: Option<(u32, usize)>,
}

impl TextReader<'_> {
    fn line(&mut self, text: &str, line: u32) {
        let mut words = text.split_whitespace().peekable();
        while let Some(word) = words.next() {
            let mut word = word.to_ascii_lowercase();
            if word == "end"
                && let Some(next) = words.next()
            {
                word += &next.to_ascii_lowercase();
            }
            match word.as_str() {
                "vertex" => self.vertex(&mut words, line),
                "endloop" => self.close(line),
                "facet" | "outer" | "endfacet" => self.end_facet(line),
                "loop" | "end" => {}
                "normal" => {
                    while words.next_if(|word| number(word).is_some() || has_digit(word)).is_some() {}
                }
                "solid" => {
                    self.end_facet(line);
                    self.part = Some(line);
                    return;
                }
                "endsolid" => {
                    self.end_facet(line);
                    self.part = None;
                    return;
                }
                comment if comment.starts_with(['#', ';']) || comment.starts_with("//") => return,
                _ => {
                    self.findings.unknown(&word, line);
                    return;
                }
            }
        }
    }

    /// Reads a corner.
    fn vertex<'a>(&mut self, words: &mut Peekable<impl Iterator<Item = &'a str>>, line: u32) {
        let mut numbers = Vec::with_capacity(3);
        let mut said = Vec::new();
        while numbers.len() < 3
            && let Some(word) = words.next_if(|word| !word.starts_with(['#', ';']))
        {
            said.push(word);
            numbers.extend(number(word));
        }
        let mut comma = said.iter().any(|word| word.trim_end_matches(',').contains(','));
        if numbers.len() < said.len() {
            // Commas between numbers without white space.
            let parts = said.iter().flat_map(|word| word.split([',', ';'])).filter(|part| !part.is_empty());
            numbers = parts.map_while(number).collect();
            comma = false;
        }
        if comma {
            self.findings.comma.get_or_insert(line);
        }
        self.facet.line = line;
        match <[f32; 3]>::try_from(numbers) {
            Ok(corner) => self.facet.corners.push(corner),
            Err(_) => {
                if !self.facet.is_spoilt {
                    let what = format!(
                        "a vertex does not have three numbers: \"{}\"",
                        shown(said.join(" ").as_bytes())
                    );
                    self.findings.leave_out(line, what);
                }
                self.facet.is_spoilt = true;
            }
        }
    }

    /// Ends the corners of a facet.
    fn close(&mut self, line: u32) {
        let Facet { corners, is_spoilt, .. } = std::mem::take(&mut self.facet);
        match corners[..] {
            _ if is_spoilt => {}
            [a, b, c] => self.builder.triangle([a, b, c]),
            [first, _, _, ..] => {
                self.findings.polygon.get_or_insert((line, corners.len()));
                corners[1..].windows(2).for_each(|pair| self.builder.triangle([first, pair[0], pair[1]]));
            }
            _ => self.findings.leave_out(line, format!("a facet has {} corners, not three", corners.len())),
        }
    }

    /// Ends a facet whose corners may not have ended.
    fn end_facet(&mut self, line: u32) {
        if !self.facet.corners.is_empty() || self.facet.is_spoilt {
            self.close(line);
        }
    }
}

impl Findings {
    fn leave_out(&mut self, line: u32, what: String) {
        self.left_out += 1;
        self.first.get_or_insert((line, what));
    }

    fn unknown(&mut self, word: &str, line: u32) {
        let word = shown(word.as_bytes());
        if self.unknown.len() <= MAX_REPORTED && !self.unknown.iter().any(|(known, _)| *known == word) {
            self.unknown.push((word, line));
        }
    }

    fn report(self, path: &Path, remarks: &mut Vec<Warning>) {
        let mut warn = |line: u32, what: String, fallback: String| {
            remarks.push(Warning::new(Location::line(path, line), what, fallback));
        };
        for (i, (word, line)) in self.unknown.iter().enumerate() {
            if i == MAX_REPORTED {
                warn(*line, "further statements are unknown".to_owned(), "they are left out".to_owned());
                break;
            }
            warn(
                *line,
                format!("the statement \"{word}\" is not supported"),
                note(table("STL"), word).to_owned(),
            );
        }
        if let Some((line, what)) = self.first {
            let others = self.left_out - 1;
            let fallback = match others {
                0 => "the facet is left out; repair or re-export the mesh".to_owned(),
                _ => format!("the facet and {others} others are left out; repair or re-export the mesh"),
            };
            warn(line, what, fallback);
        }
        if let Some((line, corners)) = self.polygon {
            let what = format!("a facet has {corners} corners, not three");
            warn(line, what, "facets of more corners are divided into triangles".to_owned());
        }
        if let Some(line) = self.comma {
            let what = "numbers have a comma";
            let fallback = "it is the decimal point; write points if it divides thousands";
            remarks.push(Warning {
                severity: Severity::Note,
                ..Warning::new(Location::line(path, line), what, fallback)
            });
        }
    }
}

/// Parses a finite number: with a decimal comma, a typographic minus, or an exponent of Fortran, too.
fn number(word: &str) -> Option<f32> {
    if let Ok(value) = word.parse::<f32>() {
        return value.is_finite().then_some(value);
    }
    let plain =
        word.trim_end_matches([',', ';']).replace(['\u{2212}', '\u{2013}'], "-").replace(['d', 'D'], "e");
    let is_decimal = plain.matches(',').count() == 1 && !plain.contains('.');
    let plain = if is_decimal { plain.replace(',', ".") } else { plain };
    plain.parse().ok().filter(|value: &f32| value.is_finite())
}

/// True for a word that stands for a number which is none, such as `-nan(ind)`.
fn has_digit(word: &str) -> bool {
    let word = word.to_ascii_lowercase();
    word.contains(|char: char| char.is_ascii_digit()) || word.contains("nan") || word.contains("inf")
}

#[cfg(test)]
mod tests {
    use super::super::stl::tests::read;
    use crate::statements::{Fate, Statement, table};

    const SQUARE: &str = "solid square\n facet normal 0 0 1\n  outer loop\n   vertex -1 -1 0\n   vertex 1 -1 0\n   \
        vertex 1 1 0\n  endloop\n endfacet\n facet normal 0 0 1\n  outer loop\n   vertex -1 -1 0\n   vertex 1 1 0\n   \
        vertex -1 1 0\n  endloop\n endfacet\nendsolid square\n";

    #[test]
    fn texts_of_programs_and_hands_give_one_mesh() {
        let (right, said) = read(SQUARE.as_bytes());
        assert_eq!((right.triangles.len(), right.positions.len(), said.len()), (2, 4, 0));
        for text in [
            SQUARE.to_uppercase(),
            SQUARE.replace('\n', "\r\n"),
            SQUARE.replace('\n', "\r"),
            SQUARE.replace("\n   vertex", " vertex").replace("solid square\n", "solid square\n\n"),
            format!("\u{feff}{SQUARE}"),
            format!("# by hand\n{}", SQUARE.replace("outer loop", "outer loop ; corners")),
            SQUARE.replace("end", "end "),
            SQUARE.replace("end", "END "),
            SQUARE.replace('-', "\u{2212}"),
            SQUARE.replace(" 1 1 0\n", " +1.000E+00 1,000 0.0d0\n").replace("1,000", "1.000"),
            SQUARE.replace("normal 0 0 1", "normal -nan(ind) nan 1.#QNAN"),
            SQUARE.replace("-1 -1 0", "-1, -1, 0").replace(" 1 1 0", " 1,1,0"),
            SQUARE.replace("  endloop\n", ""),
            SQUARE.replace("endsolid square", "endsolid a\nsolid b\nendsolid b"),
        ] {
            let (mesh, said) = read(text.as_bytes());
            assert_eq!((&mesh.positions, &mesh.triangles), (&right.positions, &right.triangles), "{text}");
            assert_eq!(said, [""; 0], "{text}");
        }
        let (mesh, said) = read(SQUARE.replace("1 0\n", "1,000 0,000\n").as_bytes());
        assert_eq!((&mesh.positions, &mesh.triangles), (&right.positions, &right.triangles));
        assert!(said.len() == 1 && said[0].starts_with("m.stl:4: numbers have a comma"), "{said:?}");
    }

    #[test]
    fn statements_are_named_as_the_page_says() {
        let words = table("STL").iter().filter(|row| row.name.len() < 9 && row.name != "COLOR=");
        for Statement { name, fate, .. } in words {
            let facet = "facet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
            let line = if *name == "vertex" { "" } else { name };
            let (mesh, said) = read(format!("solid a\n{facet}{line}\n{facet}endsolid\n").as_bytes());
            assert_eq!(mesh.triangles.len(), 2, "{name}");
            // A lone end of corners has none.
            let is_said = *fate == Fate::Named || *name == "endloop";
            assert_eq!(said.len(), usize::from(is_said), "{name}: {said:?}");
        }
    }

    #[test]
    fn what_cannot_be_read_is_left_out_and_named_with_its_line() {
        for (from, to, count, said) in [
            ("vertex 1 -1 0", "vertex 1 -1", 1, "m.stl:5: a vertex does not have three numbers"),
            ("vertex 1 -1 0", "vertex 1 nan 0", 1, "m.stl:5: a vertex does not have three numbers"),
            ("   vertex 1 -1 0\n", "", 1, "m.stl:6: a facet has 2 corners"),
            ("   vertex 1 -1 0\n", "vertex 1 -1 0\nvertex 2 0 0\n", 3, "m.stl:8: a facet has 4 corners"),
            (" facet", "color 1 0 0\n facet", 2, "m.stl:2: the statement \"color\" is not supported"),
            (" facet", "zz 1\n facet", 2, "m.stl:2: the statement \"zz\" is not supported"),
            ("endsolid square\n", "", 2, "m.stl:1: the text has no endsolid"),
        ] {
            let (mesh, found) = read(SQUARE.replacen(from, to, 1).as_bytes());
            assert_eq!(mesh.triangles.len(), count, "{to}");
            assert!(found.len() == 1 && found[0].starts_with(said), "{found:?}");
        }
    }

    #[test]
    fn a_text_that_is_cut_off_anywhere_has_a_warning_unless_only_the_name_is_cut() {
        let end = SQUARE.find("endsolid").unwrap() + "endsolid".len();
        for length in "solid ".len()..SQUARE.len() {
            let (mesh, said) = read(&SQUARE.as_bytes()[..length]);
            assert_eq!(said.is_empty(), length >= end, "{length}: {said:?}");
            assert!(mesh.triangles.len() < 2 || length > SQUARE.rfind("endloop").unwrap());
        }
    }
}
