//! Arguments of the command line. Every option is documented here and nowhere else: `--help` is made of it.

use super::bench_args::BenchArgs;
use super::denoise_args::{DenoiseArgs, DenoiseFileArgs};
use super::exit;
use super::method_args::MethodArgs;
use super::plan_args::{PlanArgs, Quality};
use super::values::{Bytes, Crop, ProgressMode, Resolution, counted, feature, q_scale};
use base::film::Exposure;
use clap::{Arg, ArgGroup, Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
use readers::LoadOptions;
use render::session::Feature;
use render::walk::{FileNames, FrameList, Q_SCALE, RetentionLimits};
use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// Global illumination by lightcuts over Intel Embree, with a path-traced reference.
#[derive(Debug, Parser)]
#[command(name = "lightsplat", version, about, after_help = exit::HELP, arg_required_else_help = true)]
pub struct Cli {
    /// The command.
    #[command(subcommand)]
    pub command: Command,
}

impl Cli {
    /// Parses `arguments`, the program's name first. Negative numbers are values, which are refused with the range of
    /// those expected, and not options.
    pub fn of(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Result<Cli, clap::Error> {
        let has_no_value = |arg: &Arg| {
            !arg.get_action().takes_values()
                || arg.get_num_args().is_some_and(|range| range.max_values() == 0)
        };
        let negative = |arg: Arg| match arg.is_positional() || has_no_value(&arg) {
            true => arg,
            false => arg.allow_negative_numbers(true),
        };
        let mut command = Cli::command().mut_subcommands(|command| command.mut_args(negative));
        let matches = command.try_get_matches_from_mut(arguments)?;
        Cli::from_arg_matches(&matches).map_err(|error| error.format(&mut command))
    }
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to OpenEXR and PNG
    Render(Box<RenderArgs>),
    /// Render the frames of a walk-through along the scene's camera path
    Walk(Box<WalkArgs>),
    /// Render the pictures and walks of job files, reading each scene once
    Batch(BatchArgs),
    /// Say what a scene holds and requires
    Info(InfoArgs),
    /// Take the noise off a picture that is there
    Denoise(DenoiseFileArgs),
    /// Merge pictures of the same view by different seeds into one with less noise
    Merge(MergeArgs),
    /// Put frames of a walk side by side on a contact sheet
    Sheet(SheetArgs),
    /// Measure how far a picture is from a reference, and show where
    Compare(CompareArgs),
    /// Measure how fast parts of the renderer are, ratios first
    Bench(BenchArgs),
}

/// Options of `render`.
#[derive(Debug, Args)]
#[command(after_help = exit::HELP)]
pub struct RenderArgs {
    /// Scene: native (.toml), Mitsuba (.xml) or glTF (.glb, .gltf)
    pub scene: PathBuf,
    /// Picture to write: 32-bit float OpenEXR with variance and metadata where known
    #[arg(short, long, value_name = "FILE.exr")]
    pub output: PathBuf,
    /// The method and its settings.
    #[command(flatten)]
    pub method: MethodArgs,
    /// Options of pictures in general.
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Frame of the scene's camera path, counted from 1, instead of its still camera
    #[arg(long, value_name = "N", value_parser = counted)]
    pub frame: Option<NonZeroUsize>,
    /// The tone-mapped picture.
    #[command(flatten)]
    pub png: PngArgs,
    /// Print counters and stage times to standard output
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub stats: Option<StatsFormat>,
    /// The goal: quality, time or error.
    #[command(flatten)]
    pub plan: PlanArgs,
    /// Measuring the error.
    #[command(flatten)]
    pub verify: VerifyArgs,
}

/// Options that all commands have that render pictures.
#[derive(Debug, Args)]
pub struct PictureArgs {
    /// Threads to use [default: all processors]; the picture is the same for any number
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub threads: Option<u32>,
    /// Width and height in pixels instead of the scene's
    #[arg(long, value_name = "WxH")]
    pub resolution: Option<Resolution>,
    /// Render only this part of the film, in pixels from its top-left corner: the whole picture's own pixels by path
    /// and lightcuts; other methods share light between pixels, and differ from those by a per cent or so
    #[arg(long, value_name = "X,Y,W,H")]
    pub crop: Option<Crop>,
    /// Layers to write beside the colour, about the surfaces seen, through mirrors and glass
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = feature())]
    pub aov: Vec<Feature>,
    /// Denoising.
    #[command(flatten)]
    pub denoise: DenoiseArgs,
    /// Leave out pictures whose files are whole and come of the same scene, settings and version of the program; go on
    /// with pictures of paths that were stopped
    #[arg(long)]
    pub resume: bool,
    /// Keep times and the number of threads out of the files: equal renders are equal bytes
    #[arg(long)]
    pub reproducible: bool,
    /// How progress is told on standard error
    #[arg(long, value_enum, default_value_t = ProgressMode::Auto)]
    pub progress: ProgressMode,
    /// Reading of the scene.
    #[command(flatten)]
    pub reading: ReadingArgs,
}

/// Options of reading a scene.
#[derive(Clone, Debug, Default, Args)]
pub struct ReadingArgs {
    /// Camera of the scene, by its number, counted from 1, or its name [default: the first]
    #[arg(long, value_name = "N|NAME")]
    camera: Option<String>,
    /// Value of `$NAME` in a Mitsuba scene, in place of its `<default>`; may be given again
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE", value_parser = definition)]
    define: Vec<(String, String)>,
    /// Fail on anything in the scene that is not modelled, and on a black picture, instead of warning
    #[arg(long)]
    pub strict: bool,
}

impl ReadingArgs {
    /// The options of the scene's reader.
    pub fn options(self) -> LoadOptions {
        LoadOptions { strict: self.strict, camera: self.camera, parameters: self.define }
    }
}

fn definition(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("write NAME=VALUE")?;
    if name.is_empty() { Err("the name is empty".into()) } else { Ok((name.to_owned(), value.to_owned())) }
}

/// Options of `walk`.
#[derive(Debug, Args)]
#[command(after_help = exit::HELP)]
pub struct WalkArgs {
    /// Scene with a camera path: native (.toml), or glTF (.glb, .gltf) with an animated camera
    pub scene: PathBuf,
    /// Pictures to write, with a place for the frame's number: f.####.exr or f.%04d.exr
    #[arg(short, long, value_name = "NAME.####.exr")]
    pub output: FileNames,
    /// Frames, counted from 1: 7, 1-10, 1-100x5 (every fifth), or a list of those [default: all]
    #[arg(long, value_name = "LIST")]
    pub frames: Option<FrameList>,
    /// Begin without records at frames 1, N+1, 2N+1 and so on: chunks so long may be rendered by runs of their own, on
    /// many machines, with the same pictures [default: one chunk]
    #[arg(long, value_name = "N", value_parser = counted)]
    pub chunk: Option<NonZeroUsize>,
    /// Most frames for which a record that lights nothing in view is kept
    #[arg(long, value_name = "FRAMES", default_value_t = RetentionLimits::default().idle_frames)]
    pub idle_frames: u32,
    /// Most memory for records between frames, like 512M or 2G [default: 1G]; the longest unused go first
    #[arg(long, value_name = "BYTES", allow_hyphen_values = true)]
    pub memory_limit: Option<Bytes>,
    /// Draw the direct light of every pixel anew in every frame, instead of mixing in that of the frame before: errors
    /// are less, and a frame takes longer
    #[arg(long)]
    pub no_reprojection: bool,
    /// Quantisation scale of the contrasts in the frame before that hide differences between records: 4 for about 2 %
    /// on plain surfaces, 0 for 2 % everywhere
    #[arg(long, value_name = "SCALE", value_parser = q_scale, default_value_t = Q_SCALE)]
    pub q_scale: f32,
    /// The method and its settings.
    #[command(flatten)]
    pub method: MethodArgs,
    /// Settings by name; those that are typed are held
    #[arg(long, value_enum)]
    pub quality: Option<Quality>,
    /// Options of pictures in general.
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Do not write tone-mapped pictures
    #[arg(long, conflicts_with = "exposure")]
    pub no_png: bool,
    /// Exposure of the PNGs in stops, or `auto`: the 90th percentile of luminance over the whole path becomes 0.8
    #[arg(long, value_name = "auto|EV", default_value_t, allow_negative_numbers = true)]
    pub exposure: Exposure,
    /// Print counters and stage times to standard output: a table of the frames, or an object a line and frame
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub stats: Option<StatsFormat>,
}

/// Options of `batch`.
#[derive(Debug, Args)]
#[command(after_help = exit::HELP)]
pub struct BatchArgs {
    /// Job files (.toml): pictures and walks, each with the options of its command
    #[arg(required = true)]
    pub jobs: Vec<PathBuf>,
    /// Leave out pictures and frames whose files are whole and come of the same scene, settings and program version
    #[arg(long)]
    pub resume: bool,
    /// Threads to use [default: all processors]; the pictures are the same for any number
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub threads: Option<u32>,
    /// How progress is told on standard error
    #[arg(long, value_enum, default_value_t = ProgressMode::Auto)]
    pub progress: ProgressMode,
}

/// Options of the tone-mapped picture beside an OpenEXR file.
#[derive(Clone, Debug, Default, Args)]
pub struct PngArgs {
    /// Tone-mapped picture to write [default: beside the OpenEXR file, named .png]
    #[arg(long, value_name = "FILE.png")]
    png: Option<PathBuf>,
    /// Do not write a tone-mapped picture
    #[arg(long, conflicts_with_all = ["png", "exposure"])]
    no_png: bool,
    /// Exposure of the PNG in stops, or `auto`: the 90th percentile of luminance becomes 0.8
    #[arg(long, value_name = "auto|EV", default_value_t, allow_negative_numbers = true)]
    pub exposure: Exposure,
}

impl PngArgs {
    /// File of the tone-mapped picture beside `exr`, if it is wanted.
    pub fn file(&self, exr: &Path) -> Option<PathBuf> {
        if self.no_png {
            return None;
        }
        Some(self.png.clone().unwrap_or_else(|| exr.with_extension("png")))
    }
}

/// Options of `merge`.
#[derive(Debug, Args)]
#[command(after_help = exit::HELP)]
pub struct MergeArgs {
    /// Pictures (OpenEXR) of the same scene, view, method and settings by different seeds; each counts as much as it
    /// has samples, pixel by pixel where paths were stopped. Of denoised ones, their layer `noisy`
    #[arg(required = true, num_args = 2..)]
    pub inputs: Vec<PathBuf>,
    /// Picture to write
    #[arg(short, long, value_name = "FILE.exr")]
    pub output: PathBuf,
    /// The tone-mapped picture.
    #[command(flatten)]
    pub png: PngArgs,
}

/// Options of `sheet`.
#[derive(Debug, Args)]
#[command(after_help = exit::HELP)]
pub struct SheetArgs {
    /// Frames as walk's --output names them; their PNG files are shown
    #[arg(value_name = "NAME.####.exr")]
    pub names: FileNames,
    /// Frames to show: 7, 1-10, 1-100x5 (every fifth), or a list of those; all have to be there
    #[arg(long, value_name = "LIST")]
    pub frames: FrameList,
    /// Sheet to write
    #[arg(short, long, value_name = "FILE.png")]
    pub output: PathBuf,
    /// Frames in a row [default: so many that the sheet is about 16:9]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub columns: Option<u32>,
    /// Width of a frame in pixels, at most its own
    #[arg(long, default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..))]
    pub width: u32,
}

/// Options that measure the picture's error.
#[derive(Clone, Debug, Default, Args, PartialEq)]
#[command(
    next_help_heading = "Measured error",
    group(ArgGroup::new("measured").args(["verify", "error"]).multiple(true))
)]
pub struct VerifyArgs {
    /// Path-trace about this many pixels and report the picture's error: bias, RMS and 95th percentile, each with
    /// the interval that covers it in 95 of 100 cases
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(16..))]
    pub verify: Option<u32>,
    /// Meaning of a pixel's value [default: that of the method: pixels for path and for cache with direct
    /// light drawn, else eye-samples]
    #[arg(long, value_enum, requires = "measured")]
    pub verify_against: Option<VerifyAgainst>,
    /// Most paths a pixel [default: 4096]; how many pixels would need more to be known to 1 % is reported
    #[arg(long, value_name = "SPP", requires = "measured", value_parser = clap::value_parser!(u32).range(64..))]
    pub verify_samples: Option<u32>,
}

/// Meaning of a pixel's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum VerifyAgainst {
    /// The mean radiance over the pixel: an edge that few samples cannot resolve counts as error
    Pixels,
    /// The mean radiance through the picture's own eye samples: only wrong light counts as error
    EyeSamples,
}

/// Options of `info`.
#[derive(Debug, Args)]
#[command(after_help = exit::HELP)]
pub struct InfoArgs {
    /// Scene: native (.toml), Mitsuba (.xml) or glTF (.glb, .gltf)
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
#[command(after_help = exit::HELP)]
pub struct CompareArgs {
    /// Picture to judge (OpenEXR)
    pub test: PathBuf,
    /// Reference of the same scene and size (OpenEXR); it also sets the exposure
    pub reference: PathBuf,
    /// Write test, reference and error next to each other
    #[arg(long, value_name = "FILE.png")]
    pub heatmap: Option<PathBuf>,
    /// The error that the heatmap shows
    #[arg(long, value_enum, default_value_t = HeatmapError::Flip, requires = "heatmap")]
    pub heatmap_of: HeatmapError,
    /// Variance of the test's pixel means [default: its layer `variance`, if it has one]
    #[arg(long, value_name = "FILE.exr")]
    pub variance_a: Option<PathBuf>,
    /// Variance of the reference's pixel means [default: its layer `variance`, if it has one]
    #[arg(long, value_name = "FILE.exr")]
    pub variance_b: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Formats of the statistics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StatsFormat {
    /// A table for people
    Text,
    /// One object for programs
    Json,
}

/// Errors that a heatmap can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum HeatmapError {
    /// Perceived difference, 0 to 1
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
    fn help_states_the_defaults_of_verifying() {
        let cli = Cli::command();
        let render = cli.find_subcommand("render").unwrap();
        let samples = render.get_arguments().find(|a| a.get_long() == Some("verify-samples")).unwrap();
        let default = format!("[default: {}]", verify::Settings::default().most_samples);
        assert!(samples.get_help().unwrap().to_string().contains(&default));
    }
}
