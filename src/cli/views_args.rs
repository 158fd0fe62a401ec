//! Options of `views`. `--help` prints the doc comments of this file.

use super::exit;
use super::method_args::MethodArgs;
use super::picture_args::{PictureArgs, StatsFormat};
use super::plan_args::Quality;
use super::png_args::ToneArgs;
use super::values::{Bytes, counted};
use clap::Args;
use render::walk::FrameList;
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Options of `views`.
#[derive(Debug, Args)]
#[command(after_long_help = exit::HELP)]
pub struct ViewsArgs {
    /// Scene file: glTF (.glb, .gltf), mesh (.obj, .ply, .stl), lightsplat TOML (.toml) or Mitsuba (.xml), or the name
    /// of a built-in scene
    pub scene: PathBuf,
    /// Cameras in the coordinates of the scene: the transforms.json of a NeRF data set, or a TOML list. A glTF model
    /// (.glb, .gltf) or a Mitsuba scene (.xml) stands for all of its cameras
    pub cameras: PathBuf,
    /// Folder of the images. The name of an image is its `file_path` in the list, or the name of its camera
    #[arg(short, long, value_name = "FOLDER")]
    pub output: PathBuf,
    /// Views to render, counted from 1: 7, 1-10, 1-100x5 (every fifth), or a list of ranges [default: all]
    #[arg(long, value_name = "LIST")]
    pub only: Option<FrameList>,
    /// Render the views in chunks of N. Each chunk starts without records. Several machines may render one chunk each,
    /// and the images stay the same. In a job file, each chunk is an entry [default: one chunk]
    #[arg(long, value_name = "N", value_parser = counted)]
    pub chunk: Option<NonZeroUsize>,
    /// Number of chunks that are rendered at a time, each with an equal part of the threads. All images stay the same.
    /// A view by paths is a chunk of its own. Many small images take less time so
    #[arg(short, long, value_name = "N", value_parser = counted, default_value = "1",
        conflicts_with_all = ["preview", "tev"])]
    pub jobs: NonZeroUsize,
    /// Memory limit of the records kept between views, like 512M or 2G. Records unused for the longest time are
    /// removed first [default: 1G]
    #[arg(long, value_name = "BYTES", allow_hyphen_values = true)]
    pub memory_limit: Option<Bytes>,
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
    #[arg(long, conflicts_with_all = ["exposure", "view", "exposure_per_view"])]
    pub no_png: bool,
    /// Expose each PNG file by itself. By default, all views of the list have one exposure
    #[arg(long, conflicts_with = "exposure")]
    pub exposure_per_view: bool,
    /// Exposure and view of the PNG files.
    #[command(flatten)]
    pub tone: ToneArgs,
    /// Print counters and stage times to standard output: a table of the views, or one JSON object per view
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub stats: Option<StatsFormat>,
}
