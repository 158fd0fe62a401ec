//! A render command that has been checked as far as it can be without the scene.

use super::args::{Crop, ProgressMode, RenderArgs, StatsFormat};
use super::exit::Failure;
use super::plan::{Wish, method, wish};
use super::verify;
use crate::film::Window;
use crate::film::{Exposure, atomic};
use crate::method::Method;
use crate::scene::{Camera, Cameras};
use crate::stats::available_bytes;
use crate::verify::Settings as VerifySettings;
use crate::view::View;
use anyhow::anyhow;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// Most pixels rendered at once: 16384 by 65536. More would exhaust the memory of most machines.
const MAX_PIXELS: u64 = 1 << 30;

/// What to render, how, and where to.
#[derive(Debug)]
pub struct RenderJob {
    /// Scene file.
    pub scene: PathBuf,
    /// Whether what is not modelled is an error.
    pub strict: bool,
    /// OpenEXR file; its folder has been found writable.
    pub output: PathBuf,
    /// PNG file and its exposure.
    pub png: Option<(PathBuf, Exposure)>,
    /// How.
    pub method: Method,
    /// What the settings are to be planned for.
    pub wish: Option<Wish>,
    /// How to measure the picture's error, if wanted.
    pub verify: Option<VerifySettings>,
    /// Number of threads.
    pub threads: usize,
    /// Film size instead of the scene's.
    pub resolution: Option<[u32; 2]>,
    /// Part of the film.
    pub crop: Option<Crop>,
    /// Frame of the camera path.
    pub frame: Option<usize>,
    /// Statistics on stdout.
    pub stats: Option<StatsFormat>,
    /// Progress on stderr.
    pub progress: ProgressMode,
}

impl RenderJob {
    /// Checks what was typed, and that the results can be written where they are wanted.
    pub fn new(args: RenderArgs) -> Result<RenderJob, Failure> {
        let method = method(&args)?;
        let verify = verify::settings(&args.verify, &method, args.max_depth, args.plan.error.is_some());
        let wish = wish(&args, &method)?;
        named(&args.output, "exr", "--output")?;
        let png = match (args.no_png, args.png) {
            (true, _) => None,
            (false, Some(path)) => Some(path),
            (false, None) => Some(args.output.with_extension("png")),
        };
        if let Some(path) = &png {
            named(path, "png", "--png")?;
        }
        for path in std::iter::once(&args.output).chain(&png) {
            atomic::check_writable(path).map_err(Failure::output)?;
        }
        let processors = || std::thread::available_parallelism().map_or(1, |n| n.get());
        Ok(RenderJob {
            scene: args.scene,
            strict: args.strict,
            output: args.output,
            png: png.map(|path| (path, args.exposure)),
            method,
            wish,
            verify,
            threads: args.threads.map_or_else(processors, |n| n as usize),
            resolution: args.resolution.map(|r| r.0),
            crop: args.crop,
            frame: args.frame,
            stats: args.stats,
            progress: args.progress,
        })
    }

    /// The camera of the frame asked for, and the part of its film to render.
    pub fn view(&self, cameras: &Cameras) -> Result<View, Failure> {
        let window = self.window(cameras.resolution)?;
        Ok(View { camera: self.camera(cameras)?, window })
    }

    fn window(&self, resolution: [u32; 2]) -> Result<Window, Failure> {
        let film = self.resolution.unwrap_or(resolution);
        let mut window = Window::whole(film);
        if let Some(crop) = self.crop {
            window = Window { film, offset: crop.offset, width: crop.size[0], height: crop.size[1] };
        }
        if !window.is_valid() {
            let [w, h] = film;
            return Err(Failure::usage(anyhow!("--crop must lie within the film of {w}x{h} pixels")));
        }
        if window.pixel_count() > MAX_PIXELS {
            return Err(Failure::usage(anyhow!(
                "{} pixels are more than {MAX_PIXELS}: render the film in parts with --crop",
                window.pixel_count()
            )));
        }
        if let (Some(needed), Some(available)) = (self.method.expected_bytes(&window), available_bytes()) {
            fits(needed, available)?;
        }
        Ok(window)
    }

    fn camera(&self, cameras: &Cameras) -> Result<Camera, Failure> {
        let Some(frame) = self.frame else { return Ok(cameras.still) };
        cameras.path.get(frame).copied().ok_or_else(|| {
            let frames = cameras.path.len();
            let remedy =
                if frames == 0 { "leave --frame out".to_owned() } else { format!("at most {}", frames - 1) };
            Failure::usage(anyhow!("--frame {frame}: the scene has {frames} frames; {remedy}"))
        })
    }
}

/// Refuses what would exhaust the memory.
fn fits(needed: u64, available: u64) -> Result<(), Failure> {
    if needed <= available {
        return Ok(());
    }
    let [needed, available] = [needed, available].map(|bytes| bytes as f64 / f64::from(1 << 30));
    Err(Failure::usage(anyhow!(
        "the cache would keep about {needed:.1} GiB of eye samples, and {available:.1} GiB of memory are available: \
         take a smaller --spp, render the film in parts with --crop, or use --method lightcuts"
    )))
}

fn named(path: &Path, extension: &str, option: &str) -> Result<(), Failure> {
    let right = path.extension().and_then(OsStr::to_str).is_some_and(|e| e.eq_ignore_ascii_case(extension));
    if right {
        return Ok(());
    }
    Err(Failure::usage(anyhow!("{option} {}: the file's name must end in .{extension}", path.display())))
}
