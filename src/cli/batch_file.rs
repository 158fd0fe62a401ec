//! Job files of batches: pictures and walks in TOML, each with the options of its command by their names.
//!
//! A picture becomes the arguments of `render` or, where its file's name has a place for a number, of `walk`, so that
//! all that those know can stand in a job file, and means the same.

use super::args::{Cli, Command};
use super::exit::Failure;
use crate::scene::formats::LoadOptions;
use crate::scene::formats::read_regular;
use crate::walk::FileNames;
use anyhow::{Context, anyhow};
use clap::Parser;
use serde::Deserialize;
use std::ffi::OsString;
#[cfg(test)]
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use toml::{Spanned, Table, Value};

/// Options of the batch, not of a picture.
const OF_THE_BATCH: [&str; 2] = ["threads", "progress"];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct JobFile {
    /// Options of all pictures.
    #[serde(default)]
    options: Table,
    picture: Vec<PictureTable>,
}

/// Outputs alone, with their places, which are lost where options stand beside them.
#[derive(Deserialize)]
struct Outputs {
    picture: Vec<OutputTable>,
}

#[derive(Deserialize)]
struct OutputTable {
    output: Spanned<PathBuf>,
}

#[derive(Deserialize)]
struct PictureTable {
    scene: PathBuf,
    output: PathBuf,
    /// Options of the picture, before those of all.
    #[serde(flatten)]
    options: Table,
}

/// A picture or a walk of a batch.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The scene's file.
    pub scene: PathBuf,
    /// Reading of the scene.
    pub reading: LoadOptions,
    /// Files to write.
    pub output: PathBuf,
    /// Job file, and line of the output in it.
    pub place: String,
    arguments: Vec<OsString>,
}

impl Entry {
    /// The command of the entry.
    pub fn command(&self) -> Result<Command, Failure> {
        let parsed = Cli::try_parse_from(&self.arguments).map(|cli| cli.command);
        parsed.map_err(|error| {
            Failure::usage(anyhow!("{}: {}", self.output.display(), error.to_string().trim_end()))
        })
    }
}

/// Reads a job file. Paths in it are relative to its folder; `more` are arguments for every picture.
pub fn read(path: &Path, more: &[&str]) -> Result<Vec<Entry>, Failure> {
    let text = read_regular(path).and_then(|bytes| String::from_utf8(bytes).map_err(io::Error::other));
    let text = text.with_context(|| format!("cannot read {}", path.display())).map_err(Failure::input)?;
    let wrong = |error: toml::de::Error| {
        Failure::input(anyhow!("{}: {}", path.display(), error.to_string().trim_end()))
    };
    let file: JobFile = toml::from_str(&text).map_err(wrong)?;
    let outputs: Outputs = toml::from_str(&text).map_err(wrong)?;
    let places = outputs.picture.iter().map(|picture| {
        let before = text.get(..picture.output.span().start).unwrap_or_default();
        format!("{}, line {}", path.display(), 1 + before.matches('\n').count())
    });
    let folder = path.parent().unwrap_or(Path::new(""));
    file.picture
        .into_iter()
        .zip(places)
        .map(|(picture, place)| {
            let mut options = file.options.clone();
            options.extend(picture.options);
            entry(folder.join(picture.scene), folder.join(picture.output), &options, more)
                .map(|entry| Entry { place, ..entry })
                .map_err(|error| error.within(path))
        })
        .collect()
}

fn entry(scene: PathBuf, output: PathBuf, options: &Table, more: &[&str]) -> Result<Entry, Failure> {
    let is_walk = output.to_str().is_some_and(|name| name.parse::<FileNames>().is_ok());
    let command = if is_walk { "walk" } else { "render" };
    let mut arguments: Vec<OsString> = ["lightsplat", command].map(OsString::from).into();
    arguments.extend([scene.clone().into(), "-o".into(), output.clone().into()]);
    for (name, value) in options {
        if OF_THE_BATCH.contains(&name.as_str()) {
            let remedy = format!("`{name}` is not a picture's: lightsplat batch --{name}");
            return Err(Failure::usage(anyhow!("{}: {remedy}", output.display())));
        }
        let refuse = || Failure::usage(anyhow!("{}: `{name}` cannot be {value}", output.display()));
        arguments.extend(option(name, value).ok_or_else(refuse)?.into_iter().map(OsString::from));
    }
    arguments.extend(more.iter().map(OsString::from));
    let mut entry = Entry { scene, reading: LoadOptions::default(), output, place: String::new(), arguments };
    entry.reading = match entry.command()? {
        Command::Render(args) => args.picture.reading.options(),
        Command::Walk(args) => args.picture.reading.options(),
        _ => LoadOptions::default(),
    };
    Ok(entry)
}

/// Arguments of an option: true stands for a flag, words in a list for the option as many times, numbers in a list for
/// one value.
fn option(name: &str, value: &Value) -> Option<Vec<String>> {
    let with = |value: String| Some(vec![format!("--{name}={value}")]);
    match value {
        Value::Boolean(true) => Some(vec![format!("--{name}")]),
        Value::Boolean(false) => Some(Vec::new()),
        Value::Array(values) if values.iter().all(Value::is_str) => {
            Some(values.iter().filter_map(Value::as_str).map(|value| format!("--{name}={value}")).collect())
        }
        Value::Array(values) => {
            let numbers: Option<Vec<String>> = values.iter().map(scalar).collect();
            with(numbers?.join(","))
        }
        value => with(scalar(value)?),
    }
}

fn scalar(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.clone()),
        Value::Integer(number) => Some(number.to_string()),
        Value::Float(number) => Some(number.to_string()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(text: &str) -> Result<Vec<Entry>, Failure> {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("job.toml"), text).unwrap();
        read(&folder.path().join("job.toml"), &["--resume"])
    }

    #[test]
    fn pictures_become_commands_with_the_options_of_all_under_their_own() {
        let found = entries(
            r#"
            options = { spp = 8, resolution = "64x32", denoise = true, strict = false }
            [[picture]]
            scene = "a.toml"
            output = "a.exr"
            spp = 2
            accuracy = [0.5, 0.25]
            [[picture]]
            scene = "b.xml"
            output = "out/b.##.exr"
            frames = "1-4"
            define = ["X=1", "Y=2"]
            "#,
        )
        .unwrap();
        let Command::Render(still) = found[0].command().unwrap() else { panic!("{found:?}") };
        assert_eq!(still.method.method().unwrap().spp(), 2);
        assert_eq!(still.method.method().unwrap().text("accuracy").as_deref(), Some("0.5,0.25"));
        assert!(still.picture.resume && still.picture.denoise.denoise() == Some(true));
        let Command::Walk(walk) = found[1].command().unwrap() else { panic!("{found:?}") };
        assert_eq!((walk.method.method().unwrap().spp(), walk.frames.unwrap().last()), (8, 4));
        assert_eq!(found[1].reading.parameters.len(), 2);
        assert!(found[1].scene.is_absolute() && found[1].scene.ends_with("b.xml"));
    }

    #[test]
    fn wrong_files_are_errors_that_name_what_is_wrong() {
        let error = |text: &str| entries(text).unwrap_err().to_string();
        let with = |line: &str| error(&format!("[[picture]]\nscene = 'a.toml'\noutput = 'a.exr'\n{line}"));
        assert!(error("[[picture]]\nscene = 'a.toml'").contains("output"));
        assert!(error("[[picture]\n").contains("line 1"));
        assert!(error("[[pictures]]\nscene = 'a.toml'").contains("pictures"));
        assert!(with("spq = 3").contains("--spq") && with("spp = 'many'").contains("many"));
        assert!(with("spp = { a = 1 }").contains("`spp` cannot be"));
        assert!(with("threads = 3").contains("batch --threads"));
        assert!(with("frames = '1-4'").contains("--frames"));
    }
}
