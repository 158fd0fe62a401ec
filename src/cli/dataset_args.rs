//! Options of `dataset`. `--help` prints the doc comments of this file.

use super::exit;
use super::method_args::MethodArgs;
use super::picture_args::PictureArgs;
use super::plan_args::Quality;
use super::png_args::ToneArgs;
use super::values::{counted, range};
use clap::Args;
use readers::EnvironmentChoice;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use toml::Table;

/// Arguments that `dataset` itself has, by their ids. Others are options of `views`.
pub const OWN: [&str; 16] = [
    "models",
    "output",
    "views",
    "cameras",
    "light",
    "distances",
    "elevations",
    "jobs",
    "plan",
    "fov",
    "env",
    "resolution",
    "dry_run",
    "resume",
    "threads",
    "progress",
];

/// Options of `dataset`.
#[derive(Debug, Args)]
#[command(after_long_help = exit::HELP)]
pub struct DatasetArgs {
    /// Models or scenes: glTF (.glb, .gltf), mesh (.obj, .ply, .stl), lightsplat TOML (.toml) or Mitsuba (.xml)
    #[arg(required = true)]
    pub models: Vec<PathBuf>,
    /// Folder of the data set. Each model has a folder in it, with its images and transforms.json. metadata.json lists
    /// models, views and lights, and jobs.toml is the job file for lightsplat batch
    #[arg(short, long, value_name = "FOLDER")]
    pub output: PathBuf,
    /// Number of random cameras per model. All look at the middle of the model. --seed chooses them
    #[arg(long, value_name = "N", value_parser = counted, default_value = "100", conflicts_with = "cameras")]
    pub views: NonZeroUsize,
    /// List of cameras for all models instead of random ones, as for lightsplat views
    #[arg(long, value_name = "FILE")]
    pub cameras: Option<PathBuf>,
    /// Light of which each view has one at random: a value of --env. May be repeated [default: light of the model]
    #[arg(long, value_name = "FILE|COLOUR|sky", num_args = 1..)]
    pub light: Vec<EnvironmentChoice>,
    /// Range of the distances of random cameras. At 1, the model just fits into the image
    #[arg(long, value_name = "MIN,MAX", value_parser = range, default_value = "1,1.5", conflicts_with = "cameras")]
    pub distances: [f64; 2],
    /// Range of the elevations of random cameras above the horizon, in degrees
    #[arg(long, value_name = "MIN,MAX", value_parser = range, default_value = "-10,80", allow_hyphen_values = true,
        conflicts_with = "cameras")]
    pub elevations: [f64; 2],
    /// Number of images that are rendered at a time, each with an equal part of the threads. All images stay the same
    /// [default: number of threads]
    #[arg(short, long, value_name = "N", value_parser = counted)]
    pub jobs: Option<NonZeroUsize>,
    /// Write cameras, metadata.json and jobs.toml alone
    #[arg(long)]
    pub plan: bool,
    /// The method and its settings.
    #[command(flatten)]
    pub method: MethodArgs,
    /// Named settings. Settings given on the command line are not changed
    #[arg(long, value_enum)]
    quality: Option<Quality>,
    /// Options of all commands that render images.
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Do not write tone-mapped images
    #[arg(long, conflicts_with_all = ["exposure", "view", "exposure_per_view"])]
    no_png: bool,
    /// Expose each PNG file by itself. By default, all views of a model in one light have one exposure
    #[arg(long, conflicts_with = "exposure")]
    exposure_per_view: bool,
    /// Exposure and view of the PNG files.
    #[command(flatten)]
    tone: ToneArgs,
    /// Options of `views` on the command line, as a job file has them.
    #[arg(skip)]
    pub options: Table,
}
