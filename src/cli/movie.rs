//! Movie of the frames of a walk, which ffmpeg encodes.

use super::exit::Failure;
use super::outputs::check_name;
use super::{files, talk};
use anyhow::{Context, anyhow};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Frames per second.
const RATE: &str = "24";

/// Arguments of ffmpeg between the frames on standard input and the file. Players want even sizes and 4:2:0.
const ENCODING: [&str; 10] = [
    "-vf",
    "pad=ceil(iw/2)*2:ceil(ih/2)*2",
    "-c:v",
    "libx264",
    "-crf",
    "16",
    "-pix_fmt",
    "yuv420p",
    "-f",
    "mp4",
];

/// A movie that a command will write.
#[derive(Clone, Debug)]
pub struct Movie(PathBuf);

impl Movie {
    /// Checks the name, and that ffmpeg is there.
    ///
    /// # Errors
    /// If not.
    pub fn new(file: PathBuf) -> Result<Movie, Failure> {
        check_name(&file, "mp4", "--movie", "for a movie")?;
        let found =
            Command::new("ffmpeg").arg("-version").stdout(Stdio::null()).stderr(Stdio::null()).status();
        match found {
            Ok(status) if status.success() => Ok(Movie(file)),
            _ => Err(Failure::usage(anyhow!(
                "--movie needs ffmpeg, which is not there; install it (apt-get install ffmpeg), or leave --movie out"
            ))),
        }
    }

    /// Returns the file.
    pub fn file(&self) -> &Path {
        &self.0
    }

    /// Writes the movie of frames, whose PNG files lie beside their main files.
    ///
    /// # Errors
    /// If a frame cannot be read, or ffmpeg fails.
    pub fn write(&self, frames: impl Iterator<Item = PathBuf>) -> Result<(), Failure> {
        let folder =
            tempfile::tempdir().context("cannot make a temporary folder").map_err(Failure::output)?;
        let part = folder.path().join("movie.mp4");
        let mut ffmpeg = Command::new("ffmpeg");
        ffmpeg.args([
            "-y",
            "-loglevel",
            "error",
            "-f",
            "image2pipe",
            "-framerate",
            RATE,
            "-c:v",
            "png",
            "-i",
            "-",
        ]);
        ffmpeg.args(ENCODING).arg(&part).stdin(Stdio::piped()).stdout(Stdio::null());
        let encoded = encode(ffmpeg, frames).and_then(|()| fs::read(&part));
        let encoded = encoded.with_context(|| format!("cannot write {}", self.0.display()));
        files::save(&self.0, &encoded.map_err(Failure::output)?)?;
        talk::wrote(&format!("wrote {}", self.0.display()), std::slice::from_ref(&self.0));
        Ok(())
    }
}

/// Runs an encoder with the PNG files of frames on its standard input.
fn encode(mut encoder: Command, frames: impl Iterator<Item = PathBuf>) -> io::Result<()> {
    let mut running = encoder.spawn()?;
    let mut fed = Ok(());
    if let Some(mut input) = running.stdin.take() {
        fed = frames.map(|frame| frame.with_extension("png")).try_for_each(|png| {
            let named =
                |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", png.display()));
            input.write_all(&fs::read(&png).map_err(named)?)
        });
    }
    let status = running.wait()?;
    match status.success() {
        true => fed,
        false => Err(io::Error::other(format!("ffmpeg failed ({status})"))),
    }
}
