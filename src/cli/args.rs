//! What can be typed. Every option is documented here and nowhere else: `--help` is made of it.

use super::bench_args::BenchArgs;
use super::cache_args::{CacheArgs, Switch};
use super::exit;
use super::plan_args::PlanArgs;
use crate::film::Exposure;
use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use std::str::FromStr;

/// Global illumination by lightcuts over Intel Embree, with a path-traced reference.
#[derive(Debug, Parser)]
#[command(name = "lightsplat", version, about, after_help = exit::HELP, arg_required_else_help = true)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to OpenEXR and PNG
    Render(Box<RenderArgs>),
    /// Say what a scene holds and requires
    Info(InfoArgs),
    /// Measure how far a picture is from a reference, and show where
    Compare(CompareArgs),
    /// Measure how fast parts of the renderer are, ratios first
    Bench(BenchArgs),
}

/// Options of `render`.
#[derive(Debug, Args)]
#[command(after_help = exit::HELP)]
pub struct RenderArgs {
    /// Scene: native (.toml) or Mitsuba (.xml)
    pub scene: PathBuf,
    /// Picture to write: 32-bit float OpenEXR with variance and metadata where known
    #[arg(short, long, value_name = "FILE.exr")]
    pub output: PathBuf,
    /// How to render
    #[arg(long, value_enum, default_value_t = MethodName::Cache)]
    pub method: MethodName,
    /// Samples a pixel [default: 64 for path, 4 for all others]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub spp: Option<u32>,
    /// Threads to use [default: all processors]; the picture is the same for any number
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub threads: Option<u32>,
    /// Another seed, other noise
    #[arg(long, default_value_t = 0)]
    pub seed: u32,
    /// Longest path in edges from the eye (1: emitters in view, 2: direct light) [default: the scene's]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub max_depth: Option<u32>,
    /// Width and height in pixels instead of the scene's
    #[arg(long, value_name = "WxH")]
    pub resolution: Option<Resolution>,
    /// Render only this part of the film, in pixels from its top-left corner
    #[arg(long, value_name = "X,Y,W,H")]
    pub crop: Option<Crop>,
    /// Frame of the scene's camera path, counted from 0, instead of its still camera
    #[arg(long)]
    pub frame: Option<usize>,
    /// Tone-mapped picture to write [default: beside the OpenEXR file, named .png]
    #[arg(long, value_name = "FILE.png")]
    pub png: Option<PathBuf>,
    /// Do not write a tone-mapped picture
    #[arg(long, conflicts_with_all = ["png", "exposure"])]
    pub no_png: bool,
    /// Exposure of the PNG in stops, or `auto`: the 90th percentile of luminance becomes 0.8
    #[arg(long, value_name = "auto|EV", default_value_t, allow_negative_numbers = true)]
    pub exposure: Exposure,
    /// Print counters and stage times to standard output
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub stats: Option<StatsFormat>,
    /// How progress is told on standard error
    #[arg(long, value_enum, default_value_t = ProgressMode::Auto)]
    pub progress: ProgressMode,
    /// Fail on anything in the scene that is not modelled, instead of warning
    #[arg(long)]
    pub strict: bool,
    /// What is wanted instead of how.
    #[command(flatten)]
    pub plan: PlanArgs,
    /// Measuring the error.
    #[command(flatten)]
    pub verify: VerifyArgs,
    /// Options of one method.
    #[command(flatten)]
    pub lightcuts: LightcutArgs,
    /// Options of the radiance cache.
    #[command(flatten)]
    pub cache: CacheArgs,
    /// Options of the photon map.
    #[command(flatten)]
    pub photon: PhotonArgs,
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
    /// What the picture is held to be [default: what the method computes: pixels for path, else eye-samples]
    #[arg(long, value_enum, requires = "measured")]
    pub verify_against: Option<VerifyAgainst>,
    /// Most paths a pixel [default: 4096]; how many pixels would need more to be known to 1 % is reported
    #[arg(long, value_name = "SPP", requires = "measured", value_parser = clap::value_parser!(u32).range(64..))]
    pub verify_samples: Option<u32>,
}

/// What a pixel's value is meant to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum VerifyAgainst {
    /// The mean radiance over the pixel: an edge that few samples cannot resolve counts as error
    Pixels,
    /// The mean radiance through the picture's own eye samples: only wrong light counts as error
    EyeSamples,
}

/// Options of `--method lightcuts` and `cache`. The defaults are the method's own; a test holds the text to them.
#[derive(Clone, Debug, Default, Args, PartialEq)]
#[command(next_help_heading = "Lightcuts")]
pub struct LightcutArgs {
    /// Largest error to expect of a cluster, relative to the sample's luminance [default: 0.02]
    #[arg(long, value_parser = parse_fraction)]
    pub epsilon: Option<f32>,
    /// Most clusters in a cut [default: 5000]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub max_cut: Option<u32>,
    /// Virtual point lights where light is reflected, about; 0: direct light only [default: 300000]
    #[arg(long)]
    pub vpls: Option<u32>,
    /// Virtual point lights on area lights and directions of the environment, about [default: 4096]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub direct_vpls: Option<u32>,
    /// Most that one indirect virtual point light may give, relative to the sample's luminance; 0 does not
    /// clamp [default: 0.02]
    #[arg(long, value_parser = parse_fraction)]
    pub clamp: Option<f32>,
    /// Whether short rays find again what clamping takes away, in creases most of all [default: on]
    #[arg(long, value_enum)]
    pub compensation: Option<Switch>,
    /// How light trees are built [default: divisive]
    #[arg(long, value_enum)]
    pub tree: Option<TreeFamily>,
    /// Whether neighbours share cuts, for speed [default: on]
    #[arg(long, value_enum)]
    pub share: Option<Switch>,
    /// Whether shadow rays of points with cuts of their own ask a cache of occluders first, for speed
    /// [default: on for samples if cuts are not shared, else off]
    #[arg(long, value_enum)]
    pub occluder_cache: Option<Switch>,
    /// Slots of that cache, rounded up to a power of two [default: 4096]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    pub occluder_slots: Option<u32>,
    /// Occluders in a slot: 1, 2, 4 or 8 [default: 4]
    #[arg(long, value_parser = parse_ways)]
    pub occluder_ways: Option<u32>,
}

fn parse_ways(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(ways @ (1 | 2 | 4 | 8)) => Ok(ways),
        _ => Err("expected 1, 2, 4 or 8".to_owned()),
    }
}

/// Options of `--method photon-cache` alone.
#[derive(Clone, Debug, Default, Args, PartialEq)]
#[command(next_help_heading = "Photon map")]
pub struct PhotonArgs {
    /// Photons on diffuse surfaces, about [default: 600000]
    #[arg(long)]
    pub photons: Option<u32>,
    /// Photons in an estimate of irradiance, at least 16 [default: 64]
    #[arg(long, value_parser = clap::value_parser!(u32).range(16..))]
    pub nearest: Option<u32>,
    /// Rays of a record's final gathering, about [default: 2000]
    #[arg(long, value_parser = clap::value_parser!(u32).range(16..=1_000_000))]
    pub gather_rays: Option<u32>,
    /// Rays of a sample that records do not serve [default: 64]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub sample_rays: Option<u32>,
}

/// The builders of light trees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TreeFamily {
    /// Top-down: binned splits in position and normal
    Divisive,
    /// Bottom-up: locally-ordered clustering
    Agglomerative,
}

/// Options of `info`.
#[derive(Debug, Args)]
pub struct InfoArgs {
    /// Scene: native (.toml) or Mitsuba (.xml)
    pub scene: PathBuf,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Fail on anything in the scene that is not modelled, instead of warning
    #[arg(long)]
    pub strict: bool,
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

/// The methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// Unbiased path tracing: slow to converge, the reference
    Path,
    /// The radiance cache: lightcuts at a few thousand points, splatted onto all pixels
    Cache,
    /// The same cache, its indirect light by final gathering over a photon map, for comparison
    PhotonCache,
    /// Lightcuts per pixel: virtual point lights, clustered as far as the expected error allows
    Lightcuts,
}

/// Formats of the statistics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StatsFormat {
    /// A table for people
    Text,
    /// One object for programs
    Json,
}

/// Ways of telling progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ProgressMode {
    /// A bar on a terminal, nothing elsewhere
    Auto,
    /// All talk as one JSON object a line
    Ndjson,
    /// None
    None,
}

/// What a heatmap may show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum HeatmapError {
    /// Perceived difference, 0 to 1
    Flip,
    /// Relative error of radiance, clipped at 1
    Relative,
}

/// `WxH`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resolution(pub [u32; 2]);

/// Most pixels along a side: what OpenEXR and PNG readers commonly accept.
const MAX_SIDE: u32 = 1 << 20;

impl FromStr for Resolution {
    type Err = String;

    fn from_str(text: &str) -> Result<Resolution, String> {
        let sides: Option<Vec<u32>> = text.split(['x', 'X', '×']).map(|s| s.trim().parse().ok()).collect();
        match sides.as_deref() {
            Some(&[w, h]) if (1..=MAX_SIDE).contains(&w) && (1..=MAX_SIDE).contains(&h) => {
                Ok(Resolution([w, h]))
            }
            _ => Err(format!("expected two sizes from 1 to {MAX_SIDE} like 640x480")),
        }
    }
}

/// `X,Y,W,H`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// First column and row.
    pub offset: [u32; 2],
    /// Columns and rows.
    pub size: [u32; 2],
}

impl FromStr for Crop {
    type Err = String;

    fn from_str(text: &str) -> Result<Crop, String> {
        let numbers: Option<Vec<u32>> = text.split(',').map(|s| s.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[x, y, w, h]) if w > 0 && h > 0 => Ok(Crop { offset: [x, y], size: [w, h] }),
            _ => Err("expected first column, first row, width and height like 100,50,64,64".to_owned()),
        }
    }
}

pub(super) fn parse_fraction(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(value) if (0.0..=1.0).contains(&value) => Ok(value),
        _ => Err("expected a number from 0 to 1".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::{cache, lightcuts, path, photon_cache};
    use crate::radiance_cache::FoundBy;
    use crate::verify;
    use clap::CommandFactory;

    #[test]
    fn the_definition_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn sizes_and_crops_are_parsed_and_refused() {
        assert_eq!("640x480".parse(), Ok(Resolution([640, 480])));
        assert_eq!("1X1".parse(), Ok(Resolution([1, 1])));
        for bad in ["", "640", "0x5", "5x0", "-1x5", "1x2x3", "9999999x1", "axb", "99999999999x1"] {
            assert!(bad.parse::<Resolution>().is_err(), "{bad}");
        }
        assert_eq!("1, 2,3,4".parse(), Ok(Crop { offset: [1, 2], size: [3, 4] }));
        for bad in ["", "1,2,3", "1,2,0,4", "1,2,3,-4", "1,2,3,4,5"] {
            assert!(bad.parse::<Crop>().is_err(), "{bad}");
        }
    }

    #[test]
    fn fractions_are_finite_and_in_range() {
        assert_eq!(parse_fraction("0.02"), Ok(0.02));
        for bad in ["-0.1", "1.5", "nan", "inf", "two"] {
            assert!(parse_fraction(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn help_states_the_methods_own_defaults() {
        let path = path::Settings::default();
        let cuts = lightcuts::Settings::default();
        let cached = cache::Settings::default().cache;
        let photon = photon_cache::Settings::default();
        let render = Cli::command().find_subcommand("render").unwrap().clone();
        let stated = |option: &str| {
            let argument = render.get_arguments().find(|a| a.get_long() == Some(option)).unwrap();
            argument.get_help().unwrap().to_string()
        };
        let found = |by| if by == FoundBy::Records { "records" } else { "samples" }.to_owned();
        let expected = [
            ("spp", format!("{} for path, {} for all others", path.spp, cuts.spp)),
            ("epsilon", cuts.cut.epsilon.to_string()),
            ("max-cut", cuts.cut.max_cut.to_string()),
            ("vpls", cuts.light.indirect.to_string()),
            ("direct-vpls", cuts.light.direct.to_string()),
            ("clamp", cuts.cut.clamp.unwrap_or(0.0).to_string()),
            ("record-epsilon", cached.cut.epsilon.to_string()),
            ("gradients", if cached.gradients { "on" } else { "off" }.to_owned()),
            ("probe-rays", cached.probe_rays.to_string()),
            ("mu", cached.mu.to_string()),
            ("series-alpha", cached.series.min_alpha.to_string()),
            ("series-error", cached.series.max_error.to_string()),
            ("direct", found(cached.direct)),
            ("indirect", found(cached.indirect)),
            ("compensation", if cuts.compensation { "on" } else { "off" }.to_owned()),
            ("passes", cached.passes.to_string()),
            ("threshold", cached.threshold.to_string()),
            ("patches", cached.patches.to_string()),
            ("least-cell", format!("{}, {} for photon-cache", cached.least_cell, photon.cache.least_cell)),
            ("accuracy", format!("{},{}", cached.layers[0].accuracy, cached.layers[1].accuracy)),
            ("share", if cuts.share && cached.share { "on" } else { "off" }.to_owned()),
            ("occluder-slots", cuts.shadows.cache.slots.to_string()),
            ("occluder-ways", cuts.shadows.cache.ways.to_string()),
            ("tree", format!("{:?}", cuts.family).to_lowercase()),
            ("photons", photon.photons.to_string()),
            ("nearest", photon.nearest.to_string()),
            ("gather-rays", photon.rays.to_string()),
            ("sample-rays", photon.own_rays.to_string()),
            ("verify-samples", verify::Settings::default().most_samples.to_string()),
        ];
        for (option, default) in expected {
            assert!(stated(option).contains(&format!("[default: {default}]")), "--{option}: {default}");
        }
    }
}
