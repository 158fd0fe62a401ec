//! Job files of batches: images, walks and views in TOML, each with the options of its command.
//!
//! An entry becomes the arguments of `views` if it names a list of views, and of `walk` if the name of its file has a
//! placeholder for a number and no `frame` is given. Other entries become arguments of `render`. So a job file may hold
//! every option of these commands, with the same meaning. `look_from` and `look-from` are one key. Views in chunks are
//! one entry per chunk.

use super::args::{Cli, Command};
use super::exit::Failure;
use super::{set_args, walk_job};
use anyhow::{Context, anyhow, bail};
use base::file_kind::file_kind;
use clap::error::{ContextKind, ContextValue};
use readers::{EnvironmentChoice, LoadOptions, ViewList, read_regular, text_of};
use render::walk::FileNames;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ffi::OsString;
#[cfg(test)]
use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use toml::{Spanned, Table, Value};

/// Options of the batch, which entries cannot have.
const OF_THE_BATCH: [&str; 3] = ["jobs", "threads", "progress"];

/// Options that name a file.
const FILES: [&str; 4] = ["png", "preview", "env", "movie"];

/// Options whose list of two numbers is a size.
const SIZES: [&str; 2] = ["resolution", "size"];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct JobFile {
    /// Options of all entries.
    #[serde(default)]
    options: Table,
    picture: Vec<PictureTable>,
}

/// Keys of a job file with their places. Values of any type lose them.
#[derive(Deserialize)]
struct Keys {
    #[serde(default)]
    options: BTreeMap<Spanned<String>, Value>,
    picture: Vec<BTreeMap<Spanned<String>, Value>>,
}

#[derive(Deserialize)]
struct PictureTable {
    scene: PathBuf,
    output: PathBuf,
    /// Options of the entry, which override those of all entries.
    #[serde(flatten)]
    options: Table,
}

/// Option that names a list of views.
const VIEWS: &str = "views";

/// An image, a walk or the views of a batch.
#[derive(Clone, Debug)]
pub struct JobEntry {
    /// Scene file.
    pub scene: PathBuf,
    /// Options of the scene reader.
    pub reading: LoadOptions,
    /// Files to write.
    pub output: PathBuf,
    /// Job file, and the line of the output in it.
    pub place: String,
    /// Views of a chunk, first and last, if the entry is one.
    pub part: Option<String>,
    /// Lines of the keys in the job file.
    lines: BTreeMap<String, usize>,
    file: PathBuf,
    arguments: Vec<OsString>,
}

impl JobEntry {
    /// Parses the command of the entry.
    ///
    /// # Errors
    /// If its options are wrong. The error names their place in the job file.
    pub fn command(&self) -> Result<Command, Failure> {
        Cli::read(&self.arguments).map(|cli| cli.command).map_err(|error| {
            let argument = match error.get(ContextKind::InvalidArg) {
                Some(ContextValue::String(argument)) => argument.as_str(),
                Some(ContextValue::Strings(arguments)) => arguments.first().map_or("", String::as_str),
                _ => "",
            };
            let key = argument
                .trim_start_matches("--")
                .trim_start_matches("set ")
                .split([' ', '='])
                .next()
                .unwrap_or_default();
            self.wrong(key, &of_command_line(&error))
        })
    }

    /// Returns the error of an option with its place.
    fn wrong(&self, key: &str, what: &str) -> Failure {
        let place = match self.lines.get(key) {
            Some(line) => format!("{}, line {line}", self.file.display()),
            None => self.place.clone(),
        };
        Failure::usage(anyhow!("{place}: {}: {what}", self.output.display()))
    }
}

/// Returns the message of the parser without the lines about the usage of the program.
fn of_command_line(error: &clap::Error) -> String {
    let text = error.to_string();
    let lines = text.strip_prefix("error: ").unwrap_or(&text).lines().map(str::trim);
    let own =
        lines.take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more information"));
    own.filter(|line| !line.is_empty()).collect::<Vec<_>>().join("; ")
}

/// Reads a text, which is in UTF-8 or UTF-16.
fn text_file(path: &Path) -> anyhow::Result<String> {
    let bytes = read_regular(path)?;
    if let Some(kind) = file_kind(&bytes) {
        bail!("this is {}; {}", kind.what, kind.remedy);
    }
    text_of(bytes).map_err(|line| anyhow!("line {line} is not UTF-8; save the file as text in UTF-8"))
}

/// Reads a job file. Its paths are relative to its folder. `more` are arguments of every entry.
///
/// # Errors
/// If the file cannot be read or is invalid.
pub fn read(path: &Path, more: &[&str]) -> Result<Vec<JobEntry>, Failure> {
    let text =
        text_file(path).with_context(|| format!("cannot read {}", path.display())).map_err(Failure::input)?;
    let wrong = |error: toml::de::Error| {
        Failure::input(anyhow!("{}: {}", path.display(), error.to_string().trim_end()))
    };
    let file: JobFile = toml::from_str(&text).map_err(wrong)?;
    let keys: Keys = toml::from_str(&text).map_err(wrong)?;
    let line_of =
        |key: &Spanned<String>| 1 + text.get(..key.span().start).unwrap_or_default().matches('\n').count();
    let lines_of = |keys: &BTreeMap<Spanned<String>, Value>| -> BTreeMap<String, usize> {
        keys.keys().map(|key| (spelled(key.get_ref()), line_of(key))).collect()
    };
    let of_all = lines_of(&keys.options);
    let folder = path.parent().unwrap_or(Path::new(""));
    file.picture
        .into_iter()
        .zip(&keys.picture)
        .map(|(picture, keys)| {
            let mut lines = of_all.clone();
            lines.extend(lines_of(keys));
            let line = lines.get("output").copied().unwrap_or_default();
            let own = file.options.iter().chain(&picture.options);
            let options = own.map(|(key, value)| (spelled(key), value.clone())).collect();
            let file = folder.join(&picture.scene);
            let is_built_in = readers::is_built_in(&picture.scene) && !file.is_file();
            let entry = JobEntry {
                scene: if is_built_in { picture.scene } else { file },
                reading: LoadOptions::default(),
                output: folder.join(picture.output),
                place: format!("{}, line {line}", path.display()),
                part: None,
                lines,
                file: path.to_owned(),
                arguments: Vec::new(),
            };
            entry.with(folder, &options, more)?.in_chunks()
        })
        .collect::<Result<Vec<_>, Failure>>()
        .map(|entries| entries.concat())
}

impl JobEntry {
    /// Adds options to the entry. Those that name files are relative to `folder`.
    fn with(mut self, folder: &Path, options: &Table, more: &[&str]) -> Result<JobEntry, Failure> {
        let has_place = self.output.to_str().is_some_and(|name| name.parse::<FileNames>().is_ok());
        let views = match options.get(VIEWS) {
            None => None,
            Some(Value::String(list)) => Some(folder.join(list)),
            Some(other) => return Err(self.wrong(VIEWS, &format!("`{VIEWS}` cannot be {other}"))),
        };
        let command = match &views {
            Some(_) => "views",
            None if has_place && !options.contains_key("frame") => "walk",
            None => "render",
        };
        let mut arguments: Vec<OsString> = ["lightsplat", command].map(OsString::from).into();
        arguments.push(self.scene.clone().into());
        arguments.extend(views.map(OsString::from));
        arguments.extend(["-o".into(), self.output.clone().into()]);
        for (name, value) in options.iter().filter(|(name, _)| *name != VIEWS) {
            if OF_THE_BATCH.contains(&name.as_str()) {
                let remedy = format!("`{name}` is an option of the batch: use lightsplat batch --{name}");
                return Err(self.wrong(name, &remedy));
            }
            match value {
                Value::String(file) if FILES.contains(&name.as_str()) && is_file(name, file) => {
                    let mut argument = OsString::from(format!("--{name}="));
                    argument.push(folder.join(file));
                    arguments.push(argument);
                }
                _ => {
                    let refuse = || self.wrong(name, &format!("`{name}` cannot be {value}"));
                    let option = option(name, value).ok_or_else(refuse)?;
                    arguments.extend(option.into_iter().map(OsString::from));
                }
            }
        }
        arguments.extend(more.iter().map(OsString::from));
        self.arguments = arguments;
        self.reading = match self.command()? {
            Command::Render(args) => {
                args.picture.reading.options_at(&args.scene, args.frame.map(NonZeroUsize::get))
            }
            Command::Walk(args) => walk_job::reading(&args),
            Command::Views(args) => args.picture.reading.options_at(&args.scene, None),
            _ => LoadOptions::default(),
        };
        Ok(self)
    }
}

impl JobEntry {
    /// Returns an entry per chunk of views, if the entry has chunks of all its views.
    fn in_chunks(self) -> Result<Vec<JobEntry>, Failure> {
        let Command::Views(args) = self.command()? else { return Ok(vec![self]) };
        let (Some(size), None) = (args.chunk, args.only) else { return Ok(vec![self]) };
        // The check of the entry reports a list that cannot be read.
        let Ok(list) = ViewList::read(&args.cameras, &args.picture.reading.clone().options()) else {
            return Ok(vec![self]);
        };
        let (count, size) = (list.numbers().last().copied().unwrap_or(0), size.get());
        let chunk = |first: usize| {
            let part = format!("{first}-{}", first.saturating_add(size - 1).min(count));
            let mut arguments = self.arguments.clone();
            arguments.push(format!("--only={part}").into());
            JobEntry { arguments, part: Some(part), ..self.clone() }
        };
        Ok((1..=count).step_by(size).map(chunk).collect())
    }
}

/// Returns the name of an option in the spelling of the command line, which has hyphens.
fn spelled(key: &str) -> String {
    key.replace('_', "-")
}

/// Returns true if the value of an option that may name a file does.
fn is_file(name: &str, value: &str) -> bool {
    name != "env" || matches!(value.parse(), Ok(EnvironmentChoice::Map(_)))
}

/// Returns the arguments of an option.
///
/// `true` stands for a flag. A list of words repeats the option, a list of numbers is one value.
fn option(name: &str, value: &Value) -> Option<Vec<String>> {
    let word = set_args::word(name);
    let with = |value: String| Some(vec![format!("{word}={value}")]);
    match value {
        Value::Boolean(value) if set_args::takes_value(name) => {
            with(if *value { "on" } else { "off" }.to_owned())
        }
        Value::Boolean(true) => Some(vec![word]),
        Value::Boolean(false) => Some(Vec::new()),
        Value::Array(values) if values.iter().all(Value::is_str) => {
            Some(values.iter().filter_map(Value::as_str).map(|value| format!("{word}={value}")).collect())
        }
        Value::Array(values) => {
            let numbers: Option<Vec<String>> = values.iter().map(scalar).collect();
            with(numbers?.join(if SIZES.contains(&name) { "x" } else { "," }))
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
    use crate::still_files::StillFiles;
    use render::method::Method;

    fn entries(text: &str) -> Result<Vec<JobEntry>, Failure> {
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
            png = "shown.png"
            accuracy = [0.5, 0.25]
            resolution = [32, 16]
            look_from = [1, 2.5, -3]
            look-at = "0,1,0"
            [[picture]]
            scene = "b.xml"
            output = "out/b.##.exr"
            frames = "1-4"
            define = ["X=1", "Y=2"]
            [[picture]]
            scene = "b.xml"
            output = "out/still.##.exr"
            frame = 3
            "#,
        )
        .unwrap();
        let Command::Render(frame) = found[2].command().unwrap() else { panic!("{found:?}") };
        let files = StillFiles::new(&frame).unwrap();
        let png = files.png.unwrap().0;
        assert!(files.exr.unwrap().ends_with("out/still.03.exr") && png.ends_with("out/still.03.png"));
        let Command::Render(still) = found[0].command().unwrap() else { panic!("{found:?}") };
        assert_eq!(still.method.method().unwrap().spp(), 2);
        let Method::Vpl(settings) = still.method.method().unwrap() else { panic!("{still:?}") };
        assert_eq!(settings.cache.accuracy, [0.5, 0.25]);
        assert_eq!(still.picture.resolution, Some("32x16".parse().unwrap()));
        let viewpoint = found[0].reading.viewpoint.clone();
        assert_eq!((viewpoint.from.unwrap().y, viewpoint.at.unwrap().y), (2.5, 1.0));
        assert!(still.picture.resume && still.picture.denoise.denoise() == Some(true));
        let Command::Walk(walk) = found[1].command().unwrap() else { panic!("{found:?}") };
        assert_eq!((walk.method.method().unwrap().spp(), walk.frames.unwrap().last()), (8, 4));
        assert_eq!(found[1].reading.parameters.len(), 2);
        // Files are relative to the job file.
        let folder = found[0].output.parent().unwrap();
        assert_eq!(still.png.file(&found[0].output), Some(folder.join("shown.png")));
        assert!(found[1].scene.is_absolute() && found[1].scene.ends_with("b.xml"));
    }

    #[test]
    fn wrong_files_are_errors_that_name_what_is_wrong() {
        let error = |text: &str| entries(text).unwrap_err().to_string();
        let with = |line: &str| error(&format!("[[picture]]\nscene = 'a.toml'\noutput = 'a.exr'\n{line}"));
        assert!(error("[[picture]]\nscene = 'a.toml'").contains("output"));
        assert!(error("[[picture]\n").contains("line 1"));
        assert!(error("[[pictures]]\nscene = 'a.toml'").contains("pictures"));
        let unknown = with("spq = 3");
        assert!(unknown.contains("job.toml, line 4: ") && unknown.contains("'--spq'"), "{unknown}");
        assert!(!unknown.contains("error:") && !unknown.contains("Usage"), "{unknown}");
        let of_all = error("options = {\n spp = 'many' }\n[[picture]]\nscene = 'a.toml'\noutput = 'a.exr'");
        assert!(of_all.contains("line 2: ") && of_all.contains("many"), "{of_all}");
        assert!(with("look_from = 'x'").contains("job.toml, line 4: "));
        assert!(with("spp = { a = 1 }").contains("`spp` cannot be"));
        assert!(with("threads = 3").contains("batch --threads"));
        assert!(with("frames = '1-4'").contains("--frames"));
    }
}
