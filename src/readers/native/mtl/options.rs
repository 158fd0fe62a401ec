//! Options of a map statement of MTL, and the file that it names.
//!
//! Options stand before or behind the name. Both the numbers of an option and the words of a name vary in number, so
//! that reading counts of which the file exists.

use crate::decode::Channel;
use crate::mesh::wavefront::{name, readings};
use crate::statements::{Fate, Statement, table};
use glam::Vec2;
use std::path::PathBuf;

/// Options of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct MapOptions {
    /// Added to u and v, behind the factors.
    pub offset: Vec2,
    /// Factors on u and v.
    pub scale: Vec2,
    pub clamp: bool,
    /// True if texels are interpolated along u, and along v.
    pub blend: [bool; 2],
    /// Base and gain of texels.
    pub levels: [f32; 2],
    /// Factor on a relief.
    pub bump: f32,
    /// Channel of the image that a number comes from.
    pub channel: Option<Channel>,
    /// Options that are not supported, with what is used instead.
    pub unsupported: Vec<(String, &'static str)>,
}

impl Default for MapOptions {
    fn default() -> MapOptions {
        MapOptions {
            offset: Vec2::ZERO,
            scale: Vec2::ONE,
            clamp: false,
            blend: [true; 2],
            levels: [0.0, 1.0],
            bump: 1.0,
            channel: None,
            unsupported: Vec::new(),
        }
    }
}

/// A map: its file, or the name of one that does not exist, and options.
pub type Map = (Result<PathBuf, String>, MapOptions);

/// Maximum number of ends of a name that are tried.
const MAX_ENDS: usize = 8;

/// Returns the map of a statement's text; `find` returns the path of a file that exists. `None` if it names no file.
///
/// # Errors
/// If a number is not finite.
pub fn parse(text: &str, find: impl Fn(&str) -> Option<PathBuf>) -> Result<Option<Map>, String> {
    if let Some(path) = find(text) {
        return Ok(Some((Ok(path), MapOptions::default())));
    }
    let mut readings = readings(text.as_bytes()).into_iter().map(|text| reading(&text, &find));
    let existing = |map: &Result<Option<Map>, String>| matches!(map, Ok(Some((Ok(_), _))));
    readings.find(existing).unwrap_or_else(|| reading(&name(text.as_bytes()), &find))
}

/// Returns the map of a text whose options may have a comment behind them.
fn reading(text: &str, find: impl Fn(&str) -> Option<PathBuf>) -> Result<Option<Map>, String> {
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    let part = |from: usize, to: usize| {
        let start = words[from].as_ptr() as usize - text.as_ptr() as usize;
        let last = words[to - 1];
        &text[start..last.as_ptr() as usize - text.as_ptr() as usize + last.len()]
    };
    let (start, least) = end_of_options(&words);
    let behind = (start..words.len()).filter(|&i| option(words[i]).is_some());
    let options: Vec<usize> = behind.take(MAX_ENDS).collect();
    let ends = || std::iter::once(words.len()).chain(options.iter().copied());
    // Numbers may belong to the last option or to the name.
    let mut readings = (least..=start).rev().flat_map(|from| ends().map(move |to| (from, to)));
    let existing =
        readings.find_map(|(from, to)| Some((from, to, find((from < to).then(|| part(from, to))?)?)));
    let (from, to, file) = match existing {
        Some((from, to, path)) => (from, to, Ok(path)),
        None => {
            let to = options.first().copied().unwrap_or(words.len());
            if start >= to {
                return Ok(None);
            }
            (start, to, Err(part(start, to).to_owned()))
        }
    };
    let mut read = MapOptions::default();
    read.take(&words[..from])?;
    let comment = words[to..].iter().position(|word| word.starts_with('#'));
    read.take(&words[to..comment.map_or(words.len(), |at| to + at)])?;
    Ok(Some((file, read)))
}

/// Returns the options of maps.
pub fn options() -> &'static [Statement] {
    table("Options of MTL maps")
}

fn option(word: &str) -> Option<&'static Statement> {
    options().iter().find(|option| option.name.eq_ignore_ascii_case(word))
}

fn is_number(word: &str) -> bool {
    word.parse::<f64>().is_ok()
}

/// Returns the number of words behind an option that belong to it: at least, and at most.
fn arguments(option: &Statement, behind: &[&str]) -> (usize, usize) {
    let numbers = |most: usize| behind.iter().take(most).take_while(|word| is_number(word)).count();
    match option.name {
        "-s" | "-o" | "-t" => (numbers(1), numbers(3)),
        "-mm" => (numbers(1), numbers(2)),
        "-bm" | "-boost" => (numbers(1), numbers(1)),
        "-clamp" | "-blendu" | "-blendv" | "-cc" => {
            let is_switch = behind.first().is_some_and(|word| is_switch(word));
            (usize::from(is_switch), usize::from(is_switch))
        }
        _ => (behind.len().min(1), behind.len().min(1)),
    }
}

fn is_switch(word: &str) -> bool {
    word.eq_ignore_ascii_case("on") || word.eq_ignore_ascii_case("off")
}

/// Returns the number of words that options before a name take at most, and the number if the last takes as few as it
/// may.
fn end_of_options(words: &[&str]) -> (usize, usize) {
    let (mut at, mut least) = (0, 0);
    while let Some(word) = words.get(at) {
        match option(word) {
            Some(option) => {
                let (few, most) = arguments(option, &words[at + 1..]);
                (at, least) = (at + 1 + most, at + 1 + few);
            }
            // An unknown option stands alone.
            None if word.starts_with('-') && !is_number(word) && at + 1 < words.len() => {
                (at, least) = (at + 1, at + 1);
            }
            None => break,
        }
    }
    (at, least)
}

impl MapOptions {
    /// Reads options that follow each other.
    fn take(&mut self, mut words: &[&str]) -> Result<(), String> {
        while let Some((word, behind)) = words.split_first() {
            words = behind;
            let Some(option) = option(word) else {
                self.unsupported.push((format!("the unknown option \"{word}\""), "it is left out"));
                continue;
            };
            let (arguments, behind) = behind.split_at(arguments(option, behind).1);
            words = behind;
            self.set(option, arguments)?;
        }
        Ok(())
    }

    fn set(&mut self, option: &'static Statement, arguments: &[&str]) -> Result<(), String> {
        let Some(first) = arguments.first() else {
            self.unsupported.push((format!("the option {} without a value", option.name), "it is left out"));
            return Ok(());
        };
        let number = |i: usize, default: f32| match arguments.get(i).and_then(|word| word.parse::<f32>().ok())
        {
            Some(number) if !number.is_finite() => Err(format!("the number {number} is not finite")),
            number => Ok(number.unwrap_or(default)),
        };
        let is_on = !first.eq_ignore_ascii_case("off");
        match option.name {
            "-s" => self.scale = Vec2::new(number(0, 1.0)?, number(1, 1.0)?),
            "-o" => self.offset = Vec2::new(number(0, 0.0)?, number(1, 0.0)?),
            "-mm" => self.levels = [number(0, 0.0)?, number(1, 1.0)?],
            "-bm" => self.bump = number(0, 1.0)?,
            "-clamp" => self.clamp = is_on,
            "-blendu" => self.blend[0] = is_on,
            "-blendv" => self.blend[1] = is_on,
            "-imfchan" => self.channel = channel(first),
            _ => {}
        }
        let has_effect = match option.name {
            "-t" => [number(0, 0.0)?, number(1, 0.0)?, number(2, 0.0)?] != [0.0; 3],
            "-cc" => is_on,
            "-boost" => number(0, 0.0)? != 0.0,
            "-imfchan" => self.channel.is_none(),
            _ => option.fate == Fate::Named,
        };
        if has_effect {
            let fallback = if option.fate == Fate::Named { option.note } else { "it is left out" };
            self.unsupported.push((format!("the option {} {}", option.name, arguments.join(" ")), fallback));
        }
        Ok(())
    }
}

/// Returns a channel of an image by its letter.
fn channel(letter: &str) -> Option<Channel> {
    let position = "rgbm".find(&letter.to_ascii_lowercase()).filter(|_| letter.len() == 1);
    position.map(Channel::One).or(letter.eq_ignore_ascii_case("l").then_some(Channel::Data))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Option<Map> {
        let exist = ["tile.png", "my tile.png", "2 tiles.png", "a #1.png"];
        parse(text, |name| exist.contains(&name).then(|| PathBuf::from(name))).unwrap()
    }

    #[test]
    fn options_stand_before_and_behind_names_with_spaces() {
        for (text, file, scale, offset) in [
            ("tile.png", "tile.png", [1.0, 1.0], [0.0, 0.0]),
            ("-s 4 2 1 tile.png", "tile.png", [4.0, 2.0], [0.0, 0.0]),
            ("tile.png -s 4 2", "tile.png", [4.0, 2.0], [0.0, 0.0]),
            ("-s 4 my tile.png -o .5 -0.25 0 # red", "my tile.png", [4.0, 1.0], [0.5, -0.25]),
            ("-o 0.5 -s 3 5 2 tiles.png", "2 tiles.png", [3.0, 5.0], [0.5, 0.0]),
            ("-s 3 2 tiles.png", "2 tiles.png", [3.0, 1.0], [0.0, 0.0]),
            ("a #1.png", "a #1.png", [1.0, 1.0], [0.0, 0.0]),
            ("-s 4 2 a #1.png -o 0.5 # red", "a #1.png", [4.0, 2.0], [0.5, 0.0]),
            ("-s 4 2 tile.png #red", "tile.png", [4.0, 2.0], [0.0, 0.0]),
        ] {
            let (found, options) = read(text).unwrap();
            assert_eq!(found, Ok(PathBuf::from(file)), "{text}");
            assert_eq!((options.scale.to_array(), options.offset.to_array()), (scale, offset), "{text}");
            assert!(options.unsupported.is_empty(), "{options:?}");
        }
    }

    #[test]
    fn a_file_that_does_not_exist_keeps_its_name_and_options() {
        let (file, options) = read("-clamp on -s 2 2 no such.png -mm 0.1 0.5 -imfchan g # x").unwrap();
        assert_eq!(file, Err("no such.png".to_owned()));
        assert_eq!(
            (options.clamp, options.levels, options.channel),
            (true, [0.1, 0.5], Some(Channel::One(1)))
        );
        for empty in ["", " # none", "-s 1 1 1"] {
            assert_eq!(read(empty), None, "{empty}");
        }
    }

    #[test]
    fn options_that_are_not_supported_are_named_unless_they_change_nothing() {
        let value = |name: &str| match name {
            "-clamp" | "-blendu" | "-blendv" | "-cc" => "on",
            "-imfchan" => "r",
            "-type" => "sphere",
            _ => "2",
        };
        for option in super::options() {
            let (file, options) = read(&format!("{} {} tile.png", option.name, value(option.name))).unwrap();
            assert!(file.is_ok());
            assert_eq!(
                options.unsupported.is_empty(),
                option.fate != Fate::Named,
                "{}: {options:?}",
                option.name
            );
        }
        for nothing in ["-t 0 0 0", "-cc off", "-boost 0", "-clamp off", "-blendu on"] {
            let (_, options) = read(&format!("{nothing} tile.png")).unwrap();
            assert_eq!(options, MapOptions::default(), "{nothing}");
        }
        for named in ["-imfchan q tile.png", "-wild tile.png", "-s tile.png", "tile.png -t 1"] {
            assert_eq!(read(named).unwrap().1.unsupported.len(), 1, "{named}");
        }
        assert!(parse("-s 1e99 tile.png", |_| None).is_err());
    }
}
