//! Options of denoising.

use super::exit::{self, Failure};
use super::png_args::PngArgs;
use super::threads;
use anyhow::anyhow;
use clap::{Args, ValueEnum};
use render::denoise::Quality;
use std::path::PathBuf;

/// Options of `render` and `walk` for denoising.
#[derive(Clone, Copy, Debug, Default, Args)]
pub struct DenoiseArgs {
    /// Denoise with Open Image Denoise 2, guided by albedo and normals. This is the default of methods that leave
    /// noise. If the library is missing, lightsplat prints a warning and the image stays noisy
    #[arg(long, overrides_with = "no_denoise")]
    denoise: bool,
    /// Do not denoise
    #[arg(long, overrides_with = "denoise")]
    no_denoise: bool,
    /// Quality of denoising. For stills, the default is lower if high would take a large part of the work [default:
    /// high]
    #[arg(long, value_enum, value_name = "QUALITY")]
    denoise_quality: Option<NamedQuality>,
    /// Keep the noisy image in the layer `noisy`
    #[arg(long)]
    pub keep_noisy: bool,
}

/// Quality of denoising.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum NamedQuality {
    /// Best quality
    #[default]
    High,
    /// Between high and fast
    Balanced,
    /// Fastest
    Fast,
}

impl From<NamedQuality> for Quality {
    fn from(quality: NamedQuality) -> Quality {
        match quality {
            NamedQuality::High => Quality::High,
            NamedQuality::Balanced => Quality::Balanced,
            NamedQuality::Fast => Quality::Fast,
        }
    }
}

impl DenoiseArgs {
    /// True if the image is to be denoised; `None` if the method decides.
    pub fn denoise(&self) -> Option<bool> {
        (self.denoise || self.no_denoise).then_some(self.denoise)
    }

    /// Returns the quality of denoising; `None` if the work on the image decides.
    pub fn quality(&self) -> Option<Quality> {
        self.denoise_quality.map(Quality::from)
    }

    /// Refuses options that have no effect on an image that is not denoised.
    pub fn check(&self, denoises: bool) -> Result<(), Failure> {
        let idle = [
            ("--set keep-noisy", self.keep_noisy),
            ("--set denoise-quality", self.denoise_quality.is_some()),
        ];
        match idle.iter().find(|(_, is_there)| *is_there && !denoises) {
            Some((option, _)) => {
                Err(Failure::usage(anyhow!("{option} needs --denoise; this image is not denoised")))
            }
            None => Ok(()),
        }
    }
}

/// Options of `denoise`.
#[derive(Debug, Args)]
#[command(after_long_help = exit::HELP)]
pub struct DenoiseFileArgs {
    /// OpenEXR image to denoise. Layers of albedo and normals guide the denoiser. Names of lightsplat, Blender,
    /// Mitsuba, pbrt and Arnold are known
    pub input: PathBuf,
    /// Image to write, with denoised colour [default: the input with the extension .denoised.exr]
    #[arg(short, long, value_name = "FILE.exr")]
    pub output: Option<PathBuf>,
    /// Quality of denoising. The levels differ only if the guides are free of noise
    #[arg(long, value_enum, value_name = "QUALITY", default_value_t)]
    quality: NamedQuality,
    /// Keep the noisy colour in the layer `noisy`
    #[arg(long)]
    pub keep_noisy: bool,
    /// Number of threads. The image does not depend on it [default: number of processors]
    #[arg(long, env = threads::VARIABLE, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub threads: Option<u32>,
    /// The tone-mapped image.
    #[command(flatten)]
    pub png: PngArgs,
}

impl DenoiseFileArgs {
    /// Returns the quality of denoising.
    pub fn quality(&self) -> Quality {
        self.quality.into()
    }
}
