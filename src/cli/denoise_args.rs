//! Arguments of denoising.

use super::args::PngArgs;
use super::exit;
use super::exit::Failure;
use anyhow::anyhow;
use clap::{Args, ValueEnum};
use render::denoise::Quality;
use std::path::PathBuf;

/// Options of `render` that denoise the picture.
#[derive(Clone, Copy, Debug, Default, Args)]
pub struct DenoiseArgs {
    /// Take the noise off the picture by Open Image Denoise 2, guided by albedo and normals through mirrors and glass;
    /// a picture without it and a warning where the library is missing. The default where the method is meant for it
    #[arg(long, overrides_with = "no_denoise")]
    denoise: bool,
    /// Leave the noise in the picture
    #[arg(long, overrides_with = "denoise")]
    no_denoise: bool,
    /// Quality of denoising against its time [default: lower ones where the best takes a good part of all the work on a
    /// still picture, as counted, which is better spent on samples; walks, whose frames are to be alike, have the best]
    #[arg(long, value_enum, value_name = "QUALITY")]
    denoise_quality: Option<NamedQuality>,
    /// Keep the picture as it was before denoising as layer `noisy`
    #[arg(long)]
    pub keep_noisy: bool,
}

/// Quality of denoising.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum NamedQuality {
    #[default]
    High,
    Balanced,
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
    /// True if the picture is to be denoised; `None` by default.
    pub fn denoise(&self) -> Option<bool> {
        (self.denoise || self.no_denoise).then_some(self.denoise)
    }

    /// Quality of denoising; `None` if it is to go with the work on the picture.
    pub fn quality(&self) -> Option<Quality> {
        self.denoise_quality.map(Quality::from)
    }

    /// Refuses options that would have no effect on a picture that is not denoised.
    pub fn check(&self, denoises: bool) -> Result<(), Failure> {
        let idle = [("--keep-noisy", self.keep_noisy), ("--denoise-quality", self.denoise_quality.is_some())];
        match idle.iter().find(|(_, is_there)| *is_there && !denoises) {
            Some((option, _)) => {
                Err(Failure::usage(anyhow!("{option} goes with --denoise; the picture is not denoised here")))
            }
            None => Ok(()),
        }
    }
}

/// Options of `denoise`.
#[derive(Debug, Args)]
#[command(after_help = exit::HELP)]
pub struct DenoiseFileArgs {
    /// Picture to denoise (OpenEXR), guided by its layers of albedo and normals where it has them, by the names that
    /// this program, Blender, Mitsuba, pbrt or Arnold give them
    pub input: PathBuf,
    /// Picture to write: all that the other holds, its colour denoised [default: named .denoised.exr]
    #[arg(short, long, value_name = "FILE.exr")]
    pub output: Option<PathBuf>,
    /// Quality against time; it matters where the guides are free of noise
    #[arg(long, value_enum, value_name = "QUALITY", default_value_t)]
    quality: NamedQuality,
    /// Keep the colour as it was as layer `noisy`
    #[arg(long)]
    pub keep_noisy: bool,
    /// Threads to use [default: all processors]; the picture is the same for any number
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub threads: Option<u32>,
    /// The tone-mapped picture.
    #[command(flatten)]
    pub png: PngArgs,
}

impl DenoiseFileArgs {
    /// Quality of denoising.
    pub fn quality(&self) -> Quality {
        self.quality.into()
    }
}
