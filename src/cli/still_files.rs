//! Files of a still: OpenEXR, PNG, or both, or one of them on standard output.

use super::args::RenderArgs;
use super::exit::Failure;
use super::outputs::{self, OutputCheck, check_name};
use super::values::ImageFormat;
use super::{picture, talk};
use anyhow::{Context, anyhow};
use base::film::Tone;
use render::walk::names;
use std::ffi::OsStr;
use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Files of a still. At least one of both is written.
#[derive(Debug)]
pub struct StillFiles {
    /// OpenEXR file.
    pub exr: Option<PathBuf>,
    /// PNG file, with its exposure and view.
    pub png: Option<(PathBuf, Tone)>,
    /// Folder that holds the file until it is copied to standard output.
    piped: Option<TempDir>,
}

impl StillFiles {
    /// Returns the files that the arguments ask for.
    ///
    /// # Errors
    /// If a name has a wrong extension, or options exclude each other.
    pub fn new(args: &RenderArgs) -> Result<StillFiles, Failure> {
        let tone = args.png.tone.tone();
        let Some(output) = &args.output else {
            let exr = Path::new(args.scene.file_stem().unwrap_or(OsStr::new("image"))).with_extension("exr");
            let png = args.png.file(&exr).map(|path| (path, tone));
            return Ok(StillFiles { exr: Some(exr), png, piped: None });
        };
        let alone = |what: &str| match args.png.names_a_file() || args.png.leaves_out() {
            true => Err(Failure::usage(anyhow!("{what} excludes --png and --no-png; leave them out"))),
            false => Ok(()),
        };
        if output.as_os_str() == "-" {
            alone("-o -")?;
            if args.stats.is_some() {
                return Err(Failure::usage(anyhow!(
                    "-o - and --stats both write to standard output; leave one out"
                )));
            }
            let folder =
                tempfile::tempdir().context("cannot make a temporary folder").map_err(Failure::output)?;
            let (exr, png) = match args.format {
                ImageFormat::Exr => (Some(folder.path().join("image.exr")), None),
                ImageFormat::Png => (None, Some((folder.path().join("image.png"), tone))),
            };
            return Ok(StillFiles { exr, png, piped: Some(folder) });
        }
        let output = &numbered("--output", output, args.frame)?;
        let extension = output.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        if extension.as_deref() == Some("png") {
            alone("a PNG alone")?;
            return Ok(StillFiles { exr: None, png: Some((output.clone(), tone)), piped: None });
        }
        check_name(output, "exr", "--output", "for OpenEXR, or in .png for a PNG alone")?;
        let png = args.png.file(output).map(|path| numbered("--png", &path, args.frame)).transpose()?;
        let png = png.map(|path| (path, tone));
        Ok(StillFiles { exr: Some(output.clone()), png, piped: None })
    }

    /// Returns the files of a frame named `main`: a PNG file alone if it is one, otherwise an OpenEXR file, and a PNG
    /// file if there is a `tone`.
    pub fn of_frame(main: PathBuf, tone: Option<Tone>) -> StillFiles {
        let is_png = main.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
        let png = tone.map(|tone| (main.with_extension("png"), tone));
        StillFiles { exr: (!is_png).then_some(main), png, piped: None }
    }

    /// Returns true if the files have names of their own, and do not go to standard output.
    pub fn is_named(&self) -> bool {
        self.piped.is_none()
    }

    /// Returns the file that stands for all in messages.
    pub fn main(&self) -> &Path {
        let png = self.png.as_ref().map(|(path, _)| path.as_path());
        self.exr.as_deref().or(png).unwrap_or(Path::new("-"))
    }

    /// Lists the files.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.exr.as_deref().into_iter().chain(self.png.as_ref().map(|(path, _)| path.as_path()))
    }

    /// Checks that the files can be written, and with `no_overwrite` that they do not exist.
    pub fn check(&self, check: OutputCheck, no_overwrite: bool) -> Result<(), Failure> {
        let png = self.png.as_ref().map(|(path, _)| path.as_path());
        outputs::check_outputs(self.exr.as_deref(), png, check)?;
        // A partial image does not replace a file, and its name is longer.
        for path in self.paths().filter(|path| path.exists()) {
            let partial = picture::beside(path);
            outputs::check_output(&partial, OutputCheck { may_stay: true, ..check })?;
        }
        if no_overwrite { outputs::check_new(self.paths()) } else { Ok(()) }
    }

    /// Returns the names for users: `-` for standard output.
    pub fn names(&self) -> Vec<String> {
        match self.piped {
            Some(_) => vec!["-".to_owned()],
            None => self.paths().map(|path| path.display().to_string()).collect(),
        }
    }

    /// Returns the file of a preview of the image of `scene`, beside the others.
    pub fn preview(&self, scene: &Path) -> PathBuf {
        let main =
            if self.piped.is_some() { Path::new(scene.file_name().unwrap_or_default()) } else { self.main() };
        main.with_extension("preview.png")
    }

    /// Returns the files of an image. A partial image gets files beside them if these may be complete.
    pub fn of_image(&self, is_complete: bool) -> StillFiles {
        let main = self.main();
        let stays = !is_complete && main.exists() && !picture::is_partial(main);
        let place = |path: &PathBuf| if stays { picture::beside(path) } else { path.clone() };
        StillFiles {
            exr: self.exr.as_ref().map(place),
            png: self.png.as_ref().map(|(path, tone)| (place(path), *tone)),
            piped: None,
        }
    }

    /// Reports the written files, or copies the image to standard output.
    ///
    /// # Errors
    /// If standard output cannot be written.
    pub fn deliver(&self, said: &str, files: &[PathBuf]) -> Result<(), Failure> {
        if self.piped.is_none() {
            talk::wrote(said, files);
            return Ok(());
        }
        let bytes = fs::read(self.main()).context("cannot read the image").map_err(Failure::output)?;
        talk::print_bytes(&bytes)
    }
}

/// Returns a path with the number of the frame where it has a place for it; `option` names it in messages.
fn numbered(option: &str, path: &Path, frame: Option<NonZeroUsize>) -> Result<PathBuf, Failure> {
    let frame = frame.map(NonZeroUsize::get);
    names::numbered(path, frame)
        .map_err(|what| Failure::usage(anyhow!("{option} {}: {what}", path.display())))
}
