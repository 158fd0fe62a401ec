//! Arguments of the command line. `--help` prints the doc comments of this file.

use super::bench_args::BenchArgs;
use super::dataset_args::{self, DatasetArgs};
use super::denoise_args::DenoiseFileArgs;
use super::develop::DevelopArgs;
use super::exit;
use super::generate_args::GenerateArgs;
use super::method_args::MethodArgs;
use super::picture_args::{PictureArgs, StatsFormat};
use super::plan_args::{PlanArgs, Quality};
use super::png_args::{PngArgs, ToneArgs};
use super::reading_args::ReadingArgs;
use super::short_help::shortened;
use super::values::{Bytes, ImageFormat, ProgressMode, counted, q_scale};
use super::views_args::ViewsArgs;
use super::{set_args, talk, threads, version};
use clap::{Arg, ArgGroup, Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
use render::walk::{FileNames, FrameList};
use std::env;
use std::ffi::{OsStr, OsString};
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Render glTF, mesh, TOML and Mitsuba scenes with global illumination to OpenEXR and PNG.
#[derive(Debug, Parser)]
#[command(name = "lightsplat", version, about, after_long_help = exit::HELP, arg_required_else_help = true)]
pub struct Cli {
    /// The command.
    #[command(subcommand)]
    pub command: Command,
}

impl Cli {
    /// Parses `words`, the program's name first.
    ///
    /// Negative numbers are values, not options. Their parsers refuse them with the expected range.
    ///
    /// # Errors
    /// If the arguments are wrong, or ask for help or the version.
    pub fn read(words: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Result<Cli, clap::Error> {
        let arguments: Vec<OsString> = words.into_iter().map(Into::into).collect();
        let mut command = Cli::definition();
        if arguments.get(1).is_some_and(|first| first == "--version") {
            command = command.long_version(version::text());
        }
        let matches = command.try_get_matches_from_mut(set_args::joined(arguments)?)?;
        let mut cli = Cli::from_arg_matches(&matches).map_err(|error| error.format(&mut command))?;
        if let Command::Dataset(args) = &mut cli.command
            && let Some((name, matches)) = matches.subcommand()
            && let Some(command) = command.find_subcommand(name)
        {
            args.options = set_args::typed(command, matches, &dataset_args::OWN);
        }
        Ok(cli)
    }

    /// Returns the definition of all commands and options.
    pub fn definition() -> clap::Command {
        let has_no_value = |arg: &Arg| {
            !arg.get_action().takes_values()
                || arg.get_num_args().is_some_and(|range| range.max_values() == 0)
        };
        let negative = |arg: Arg| match arg.is_positional() || has_no_value(&arg) {
            true => arg,
            false => arg.allow_negative_numbers(true),
        };
        // An empty variable counts as no variable, as scripts write it.
        let is_empty = |variable: &OsStr| env::var_os(variable).is_some_and(|value| value.is_empty());
        let set = |arg: Arg| match arg.get_env().is_some_and(is_empty) {
            true => arg.env(None::<&'static str>),
            false => arg,
        };
        // Help names environment variables, and does not depend on their values.
        let parsed = |arg: Arg| negative(set(arg).hide_env_values(true));
        Cli::command().mut_subcommands(|command| shortened(set_args::with_settings(command.mut_args(parsed))))
    }
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to OpenEXR and PNG
    Render(Box<RenderArgs>),
    /// Render the frames of a walk, the camera animation of a scene
    Walk(Box<WalkArgs>),
    /// Render many cameras of one scene, which share what does not depend on the camera
    Views(Box<ViewsArgs>),
    /// Render many models from random cameras, as a data set
    Dataset(Box<DatasetArgs>),
    /// Render the images, walks and views that job files list
    Batch(BatchArgs),
    /// Print what a scene contains and requires
    Info(InfoArgs),
    /// Denoise an existing image
    Denoise(DenoiseFileArgs),
    /// Convert an OpenEXR image to PNG, with another exposure or view
    Develop(DevelopArgs),
    /// Merge images of different seeds into one image with less noise
    Merge(MergeArgs),
    /// Make a contact sheet of the frames of a walk
    Sheet(SheetArgs),
    /// Measure how an image differs from a reference, and show where
    Compare(CompareArgs),
    /// Benchmark the speed and the error of the renderer
    Bench(BenchArgs),
    /// Render a built-in scene to lightsplat-demo.exr and lightsplat-demo.png in the current folder
    Demo,
    /// Print shell completions or the man page
    Generate(GenerateArgs),
}

/// Options of `render`.
#[derive(Debug, Args)]
#[command(after_long_help = exit::HELP)]
pub struct RenderArgs {
    /// Scene file: glTF (.glb, .gltf), mesh (.obj, .ply, .stl), lightsplat TOML (.toml) or Mitsuba (.xml). The name of
    /// a built-in scene works, too: apartment, cornell, furnace, glass, hall, kitchen, knot, nave,
    /// plaza, terrace
    pub scene: PathBuf,
    /// Image to write. FILE.exr holds 32-bit float radiance, and FILE.png is written with it. FILE.png alone is
    /// tone-mapped. `-` is standard output. `####` or `%04d` stands for the number of --frame [default: the name of the
    /// scene with .exr, in the current folder]
    #[arg(short, long, value_name = "FILE.exr|FILE.png|-")]
    pub output: Option<PathBuf>,
    /// Format of the image on standard output
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t)]
    pub format: ImageFormat,
    /// The method and its settings.
    #[command(flatten)]
    pub method: MethodArgs,
    /// Options of all commands that render images.
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Frame of the camera path to render, counted from 1. A glTF model takes its pose at this frame, at 24 frames per
    /// second
    #[arg(short, long, value_name = "N", value_parser = counted)]
    pub frame: Option<NonZeroUsize>,
    /// The tone-mapped image.
    #[command(flatten)]
    pub png: PngArgs,
    /// Print counters and stage times to standard output
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub stats: Option<StatsFormat>,
    /// The goal: quality, time or error.
    #[command(flatten)]
    pub plan: PlanArgs,
    /// Measurement of the error.
    #[command(flatten)]
    pub verify: VerifyArgs,
}

/// Options of `walk`.
#[derive(Debug, Args)]
#[command(after_long_help = exit::HELP)]
pub struct WalkArgs {
    /// Scene with a camera path: lightsplat TOML (.toml), or glTF (.glb, .gltf) with an animation. Each frame shows the
    /// model in its pose of the animation, at 24 frames per second
    pub scene: PathBuf,
    /// Images to write. `####` or `%04d` stands for the number of the frame: f.####.exr or f.%04d.exr. f.####.png means
    /// PNG files alone
    #[arg(short, long, value_name = "NAME.####.exr")]
    pub output: FileNames,
    /// Turn the camera once around the scene in N frames, instead of following a path. The camera is the camera of a
    /// still
    #[arg(long, value_name = "N", value_parser = counted)]
    pub turntable: Option<NonZeroUsize>,
    /// Movie of the frames, which ffmpeg encodes from their PNG files
    #[arg(long, value_name = "FILE.mp4", conflicts_with = "no_png")]
    pub movie: Option<PathBuf>,
    /// Frames to render, counted from 1: 7, 1-10, 1-100x5 (every fifth), or a list of ranges. 1..10, 1:10
    /// and 1-100:5 are read, too [default: all]
    #[arg(short, long, value_name = "LIST")]
    pub frames: Option<FrameList>,
    /// Render the frames in chunks of N. Each chunk starts without records. Several machines may render one chunk each,
    /// and the images stay the same [default: one chunk]
    #[arg(long, value_name = "N", value_parser = counted)]
    pub chunk: Option<NonZeroUsize>,
    /// Number of frames for which a record is kept while it lights nothing in view [default: 48]
    #[arg(long, value_name = "FRAMES")]
    pub idle_frames: Option<u32>,
    /// Memory limit of the records kept between frames, like 512M or 2G. Records unused for the longest time are
    /// removed first [default: 1G]
    #[arg(long, value_name = "BYTES", allow_hyphen_values = true)]
    pub memory_limit: Option<Bytes>,
    /// Sample the direct light of every pixel in every frame, instead of reprojecting it from the previous frame.
    /// Errors are smaller, and frames take longer
    #[arg(long)]
    pub no_reprojection: bool,
    /// Quantisation scale of the visibility model. Records may differ more where contrasts of the previous frame hide
    /// the difference. 4 allows about 2 % on plain surfaces. 0 allows 2 % everywhere [default: 4]
    #[arg(long, value_name = "SCALE", value_parser = q_scale)]
    pub q_scale: Option<f32>,
    /// The method and its settings.
    #[command(flatten)]
    pub method: MethodArgs,
    /// Named settings. Settings given on the command line are not changed
    #[arg(long, value_enum)]
    pub quality: Option<Quality>,
    /// Options of all commands that render images.
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Do not write tone-mapped images
    #[arg(long, conflicts_with_all = ["exposure", "view"])]
    pub no_png: bool,
    /// Exposure and view of the PNG files.
    #[command(flatten)]
    pub tone: ToneArgs,
    /// Print counters and stage times to standard output: a table of the frames, or one JSON object per frame
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub stats: Option<StatsFormat>,
}

/// Options of `batch`.
#[derive(Debug, Args)]
#[command(after_long_help = exit::HELP)]
pub struct BatchArgs {
    /// Job files (.toml). Each lists images, walks and lists of views, with the options of their commands
    #[arg(required = true)]
    pub jobs: Vec<PathBuf>,
    /// Print the number, scene and output of each entry, and render nothing
    #[arg(long, conflicts_with = "only")]
    pub list: bool,
    /// Print files, resolution, method and memory of each entry, and write nothing
    #[arg(long)]
    pub dry_run: bool,
    /// Render only these entries, counted from 1 over all job files: 7, 1-10, or a list of ranges
    #[arg(long, value_name = "LIST")]
    pub only: Option<FrameList>,
    /// Skip complete images and frames of the same scene, settings and program version
    #[arg(long)]
    pub resume: bool,
    /// Number of entries that are rendered at a time, each with an equal part of the threads. All images stay the same.
    /// Many small images take less time so
    #[arg(short = 'j', long = "jobs", value_name = "N", value_parser = counted, default_value = "1")]
    pub at_once: NonZeroUsize,
    /// Number of threads. The images do not depend on it [default: number of processors]
    #[arg(long, env = threads::VARIABLE, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub threads: Option<u32>,
    /// Form of progress and messages on standard error
    #[arg(long, value_enum, env = talk::VARIABLE, default_value_t = ProgressMode::Auto)]
    pub progress: ProgressMode,
}

/// Options of `merge`.
#[derive(Debug, Args)]
#[command(after_long_help = exit::HELP)]
pub struct MergeArgs {
    /// OpenEXR images of one scene, view, method and settings, with different seeds. Images are weighted by their
    /// number of samples, interrupted images by the samples of each pixel. If images are denoised, their layers `noisy`
    /// are merged
    #[arg(required = true, num_args = 2..)]
    pub inputs: Vec<PathBuf>,
    /// Image to write
    #[arg(short, long, value_name = "FILE.exr")]
    pub output: PathBuf,
    /// The tone-mapped image.
    #[command(flatten)]
    pub png: PngArgs,
}

/// Options of `sheet`.
#[derive(Debug, Args)]
#[command(after_long_help = exit::HELP)]
pub struct SheetArgs {
    /// Names of the frames, as in --output of walk. The sheet shows their PNG files
    #[arg(value_name = "NAME.####.exr")]
    pub names: FileNames,
    /// Frames to show: 7, 1-10, 1-100x5 (every fifth), or a list of ranges. All of them must exist
    #[arg(long, value_name = "LIST")]
    pub frames: FrameList,
    /// Contact sheet to write
    #[arg(short, long, value_name = "FILE.png")]
    pub output: PathBuf,
    /// Number of frames per row [default: chosen so that the sheet is about 16:9]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub columns: Option<u32>,
    /// Width of a frame on the sheet, in pixels. Frames are not enlarged
    #[arg(long, default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..))]
    pub width: u32,
}

/// Options of the measurement of the error.
#[derive(Clone, Debug, Default, Args, PartialEq)]
#[command(
    next_help_heading = "Measured error",
    group(ArgGroup::new("measured").args(["verify", "error"]).multiple(true))
)]
pub struct VerifyArgs {
    /// Report the error of the image, measured by path tracing about this many pixels. The report gives bias, RMS error
    /// and 95th percentile, each with a 95 % confidence interval
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(16..))]
    pub verify: Option<u32>,
    /// Value that counts as correct for a pixel [default: pixels for path and for cache with sampled direct light,
    /// otherwise eye-samples]
    #[arg(long, value_enum, requires = "measured")]
    pub verify_against: Option<VerifyAgainst>,
    /// Maximum number of paths per measured pixel. The report says how many pixels need more paths for an uncertainty
    /// of 1 % [default: 4096]
    #[arg(long, value_name = "SPP", requires = "measured", value_parser = clap::value_parser!(u32).range(64..))]
    pub verify_samples: Option<u32>,
}

/// Estimand of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum VerifyAgainst {
    /// Mean radiance over the pixel: aliasing counts as an error
    Pixels,
    /// Mean radiance at the sample positions of the image: only wrong light counts as an error
    EyeSamples,
}

/// Options of `info`.
#[derive(Debug, Args)]
#[command(after_long_help = exit::HELP)]
pub struct InfoArgs {
    /// Scene file: glTF (.glb, .gltf), mesh (.obj, .ply, .stl), lightsplat TOML (.toml) or Mitsuba (.xml). The name of
    /// a built-in scene works, too: apartment, cornell, furnace, glass, hall, kitchen, knot, nave,
    /// plaza, terrace
    pub scene: PathBuf,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Reading of the scene.
    #[command(flatten)]
    pub reading: ReadingArgs,
}

/// Options of `compare`.
#[derive(Debug, Args)]
#[command(after_long_help = exit::HELP)]
pub struct CompareArgs {
    /// OpenEXR image to judge
    pub test: PathBuf,
    /// OpenEXR reference of the same scene and size. Both images are shown with the exposure of the reference
    pub reference: PathBuf,
    /// PNG file to write, with the image, the reference and their difference side by side
    #[arg(long, value_name = "FILE.png")]
    pub heatmap: Option<PathBuf>,
    /// Error measure of the heatmap
    #[arg(long, value_enum, default_value_t = HeatmapError::Flip, requires = "heatmap")]
    pub heatmap_of: HeatmapError,
    /// OpenEXR file with the variance of the image [default: the layer `variance` of the image, if present]
    #[arg(long, value_name = "FILE.exr")]
    pub variance_a: Option<PathBuf>,
    /// OpenEXR file with the variance of the reference [default: the layer `variance` of the reference, if present]
    #[arg(long, value_name = "FILE.exr")]
    pub variance_b: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Error measure of a heatmap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum HeatmapError {
    /// Perceived difference (FLIP), 0 to 1
    Flip,
    /// Relative error of radiance, clipped at 1
    Relative,
}

#[cfg(test)]
mod tests {
    use super::*;
    use render::verify;

    #[test]
    fn the_definition_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn help_lists_the_built_in_scenes() {
        let cli = Cli::command();
        for command in ["render", "info"] {
            let sub = cli.find_subcommand(command).unwrap();
            let scene = sub.get_arguments().find(|a| a.get_id() == "scene").unwrap();
            assert!(scene.get_help().unwrap().to_string().contains(&readers::built_in_scenes()));
        }
    }

    #[test]
    fn help_states_the_defaults_of_verifying() {
        let cli = Cli::command();
        let render = cli.find_subcommand("render").unwrap();
        let samples = render.get_arguments().find(|a| a.get_long() == Some("verify-samples")).unwrap();
        let default = format!("[default: {}]", verify::VerifySettings::default().max_samples);
        assert!(samples.get_help().unwrap().to_string().contains(&default));
    }
}
