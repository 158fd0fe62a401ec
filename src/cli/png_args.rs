//! Options of tone-mapped images.

use base::film::{Exposure, Tone, ToneCurve};
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// Options of the tone-mapped image beside an OpenEXR file.
#[derive(Clone, Debug, Default, Args)]
pub struct PngArgs {
    /// Tone-mapped image to write [default: the OpenEXR file with the extension .png]
    #[arg(long, value_name = "FILE.png")]
    png: Option<PathBuf>,
    /// Do not write a tone-mapped image
    #[arg(long, conflicts_with_all = ["png", "exposure", "view"])]
    no_png: bool,
    /// Exposure and view.
    #[command(flatten)]
    pub tone: ToneArgs,
}

/// Options of exposure and view.
#[derive(Clone, Copy, Debug, Default, Args)]
pub struct ToneArgs {
    /// Exposure of PNG files. `auto` maps the 90th percentile of luminance to 0.8. `auto+1` is one stop brighter,
    /// `auto-1` one stop darker. A number is absolute: radiance times 2^EV. For a walk, all frames count for the
    /// percentile
    #[arg(short, long, value_name = "auto|auto+STOPS|EV", default_value_t, allow_negative_numbers = true)]
    exposure: Exposure,
    /// Tone curve of PNG files
    #[arg(long, value_enum, value_name = "VIEW", default_value_t)]
    view: NamedView,
}

/// Curve from radiance to display values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum NamedView {
    /// Khronos PBR Neutral: keeps colours and compresses highlights
    #[default]
    Neutral,
    /// sRGB, clipped at 1
    Standard,
    /// Blender's AgX: soft contrast, bright colours turn white
    Agx,
    /// Blender's Filmic: strong contrast, bright colours keep their hue
    Filmic,
}

impl ToneArgs {
    /// Returns exposure and view.
    pub fn tone(self) -> Tone {
        let curve = match self.view {
            NamedView::Neutral => ToneCurve::Neutral,
            NamedView::Standard => ToneCurve::Standard,
            NamedView::Agx => ToneCurve::Agx,
            NamedView::Filmic => ToneCurve::Filmic,
        };
        Tone { exposure: self.exposure, curve }
    }
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
