//! Options of tone-mapped images.

use base::film::Exposure;
use clap::Args;
use std::path::{Path, PathBuf};

/// Options of the tone-mapped image beside an OpenEXR file.
#[derive(Clone, Debug, Default, Args)]
pub struct PngArgs {
    /// Tone-mapped image to write [default: the OpenEXR file with the extension .png]
    #[arg(long, value_name = "FILE.png")]
    png: Option<PathBuf>,
    /// Do not write a tone-mapped image
    #[arg(long, conflicts_with_all = ["png", "exposure"])]
    no_png: bool,
    /// Exposure of the PNG file in stops; `auto` maps the 90th percentile of luminance to 0.8
    #[arg(long, value_name = "auto|EV", default_value_t, allow_negative_numbers = true)]
    pub exposure: Exposure,
}

impl PngArgs {
    /// Returns true if the arguments name a file.
    pub fn names_a_file(&self) -> bool {
        self.png.is_some()
    }

    /// Returns true if there is to be no tone-mapped image.
    pub fn leaves_out(&self) -> bool {
        self.no_png
    }

    /// Returns the file of the tone-mapped image beside `exr`; `None` if there is to be none.
    pub fn file(&self, exr: &Path) -> Option<PathBuf> {
        if self.no_png {
            return None;
        }
        Some(self.png.clone().unwrap_or_else(|| exr.with_extension("png")))
    }
}
