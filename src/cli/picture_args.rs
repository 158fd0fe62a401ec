//! Options of all commands that render images. `--help` prints the doc comments of this file.

use super::denoise_args::DenoiseArgs;
use super::live_args::LiveArgs;
use super::picture::Forms;
use super::reading_args::ReadingArgs;
use super::values::{Crop, Loudness, ProgressMode, Resolution, feature, scale};
use super::{talk, threads};
use clap::{Args, ValueEnum};
use render::session::{Averaging, Feature, Features};

/// Options of all commands that render images.
#[derive(Debug, Args)]
pub struct PictureArgs {
    /// Number of threads. The image does not depend on it [default: number of processors]
    #[arg(short, long, env = threads::VARIABLE, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub threads: Option<u32>,
    /// Image size in pixels. W or xH alone keeps the aspect ratio of the scene, N% scales its size [default: from the
    /// scene]
    #[arg(short, long, visible_alias = "size", value_name = "WxH|W|N%")]
    pub resolution: Option<Resolution>,
    /// Render only this rectangle, in pixels from the top-left corner. With path and lightcuts, the pixels equal the
    /// pixels of the full image. With other methods, they differ by about 1 %
    #[arg(long, value_name = "X,Y,W,H")]
    pub crop: Option<Crop>,
    /// Additional layers that describe the visible surfaces. At mirrors and glass, they describe the reflected or
    /// refracted surface
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = feature())]
    pub aov: Vec<Feature>,
    /// Samples that these layers describe. Alpha is always a mean
    #[arg(long, value_enum, value_name = "MODE", default_value_t)]
    aov_mode: AovMode,
    /// Write colours, albedos and normals as half floats, and no variances. Depth, positions, ids and masks stay 32-bit
    #[arg(long)]
    half: bool,
    /// Write depth as NAME.depth.png with 16 bits, as the number of steps of 1/STEPS. With 1000, a scene in metres has
    /// depth in millimetres. 0 is no surface, and 65535 is the maximum
    #[arg(long, value_name = "STEPS", value_parser = scale)]
    depth_png: Option<f32>,
    /// Denoising.
    #[command(flatten)]
    pub denoise: DenoiseArgs,
    /// Previews.
    #[command(flatten)]
    pub live: LiveArgs,
    /// Skip complete images of the same scene, settings and program version. Continue interrupted images of --method
    /// path
    #[arg(long)]
    pub resume: bool,
    /// Fail before rendering if an output file already exists
    #[arg(long, conflicts_with = "resume")]
    pub no_overwrite: bool,
    /// Print the files that would be written, the resolution, the method and the memory, and write nothing. The command
    /// ends with the error that the run would have before rendering
    #[arg(long)]
    pub dry_run: bool,
    /// Leave times and the number of threads out of all files, so that equal renders give equal files
    #[arg(long)]
    pub reproducible: bool,
    /// Form of progress and messages on standard error
    #[arg(long, value_enum, env = talk::VARIABLE, default_value_t = ProgressMode::Auto)]
    pub progress: ProgressMode,
    /// Print only errors
    #[arg(short, long, conflicts_with = "verbose")]
    quiet: bool,
    /// Print a line with the seconds of each stage
    #[arg(short, long)]
    verbose: bool,
    /// Reading of the scene.
    #[command(flatten)]
    pub reading: ReadingArgs,
}

impl PictureArgs {
    /// Returns the samples that additional layers describe.
    pub fn averaging(&self) -> Averaging {
        match self.aov_mode {
            AovMode::Mean => Averaging::Mean,
            AovMode::First => Averaging::First,
        }
    }

    /// Returns the features that are kept as layers.
    pub fn features(&self) -> Features {
        self.aov.iter().copied().chain(self.depth_png.map(|_| Feature::Depth)).collect()
    }

    /// Returns the forms of the files.
    pub fn forms(&self) -> Forms {
        Forms { half: self.half, depth: self.depth_png }
    }

    /// Returns how much is to be said.
    pub fn loudness(&self) -> Loudness {
        match (self.quiet, self.verbose) {
            (true, _) => Loudness::Quiet,
            (false, true) => Loudness::Verbose,
            (false, false) => Loudness::Normal,
        }
    }
}

/// Samples that layers describe.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum AovMode {
    /// Albedo, normals and position are means over the pixel; depth and ids belong to its nearest surface
    #[default]
    Mean,
    /// The first surface that the ray through the middle of the pixel hits, also if it is a mirror or glass
    First,
}

/// Format of statistics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StatsFormat {
    /// A table for people
    Text,
    /// One JSON object for programs
    Json,
}
