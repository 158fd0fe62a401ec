//! Values of options.

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use render::session::Feature;
use scene::MAX_SIDE;
use std::num::NonZeroUsize;
use std::str::FromStr;

/// Form of the messages on stderr.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ProgressMode {
    /// Progress bar on a terminal; in log files, a line per 10 % or per 30 s
    Auto,
    /// JSON messages, one object per line, with the schema in docs/progress.md
    Ndjson,
    /// Additional lines for agents of Open Job Description
    Openjd,
    /// No progress
    None,
}

/// Format of an image on standard output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ImageFormat {
    /// Tone-mapped PNG
    #[default]
    Png,
    /// 32-bit float OpenEXR
    Exr,
}

/// Number of messages for people.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Loudness {
    /// Errors alone.
    Quiet,
    /// Warnings, notes and progress.
    #[default]
    Normal,
    /// A line per stage in addition.
    Verbose,
}

/// Returns the parser of names of features.
pub fn feature() -> impl TypedValueParser<Value = Feature> {
    let value = |feature: Feature| PossibleValue::new(feature.name()).help(about(feature));
    PossibleValuesParser::new(Feature::ALL.map(value)).try_map(|name| name.parse::<Feature>())
}

/// Describes a feature for `--help`.
fn about(feature: Feature) -> &'static str {
    match feature {
        Feature::Albedo => "Reflected share of light; for emitters, relative emission",
        Feature::Normal => "Shading normal in world space",
        Feature::GeometricNormal => "Normal of the triangle in world space",
        Feature::Position => "Position in the coordinates of the scene file",
        Feature::Depth => "Distance along the axis of the camera, in units of the scene",
        Feature::Material => "Number of the material, counted from 1",
        Feature::Object => "Number of the mesh, counted from 1",
        Feature::Alpha => "Share of the pixel that surfaces cover",
        Feature::CryptoObject => "Cryptomatte: the share of the pixel that each mesh covers, by name",
        Feature::CryptoMaterial => "Cryptomatte of materials",
    }
}

/// Parses a count, or a number that counts from 1.
pub fn counted(text: &str) -> Result<NonZeroUsize, String> {
    text.parse().map_err(|_| "expected a whole number, 1 or more".to_owned())
}

/// Parses a factor or a length.
pub fn scale(text: &str) -> Result<f32, String> {
    let scale = text.parse().ok().filter(|scale: &f32| scale.is_normal() && *scale > 0.0);
    scale.ok_or_else(|| "expected a number above 0".to_owned())
}

/// Parses a range of two numbers.
pub fn range(text: &str) -> Result<[f64; 2], String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[low, high]) if low.is_finite() && high.is_finite() && low <= high => Ok([low, high]),
        _ => Err("expected the lower and the higher number, like 1,1.5".to_owned()),
    }
}

/// Parses a quantisation scale.
pub fn q_scale(text: &str) -> Result<f32, String> {
    let scale = text.parse().ok().filter(|scale| *scale == 0.0 || (0.01..=1000.0).contains(scale));
    scale.ok_or_else(|| "expected 0 or a scale from 0.01 to 1000, like 4".to_owned())
}

/// Film size: exact, or relative to that of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resolution {
    /// Width and height in pixels.
    Exact([u32; 2]),
    /// Width; the aspect ratio is the scene's.
    Width(u32),
    /// Height; the aspect ratio is the scene's.
    Height(u32),
    /// Factor on width and height.
    Scale(f64),
}

impl Resolution {
    /// Returns the film size in pixels; `own` is that of the scene.
    pub fn pixels(self, own: [u32; 2]) -> [u32; 2] {
        let [width, height] = own.map(f64::from);
        let scaled = |scale: f64| {
            [width, height].map(|side| (side * scale).round().clamp(1.0, f64::from(MAX_SIDE)) as u32)
        };
        match self {
            Resolution::Exact(size) => size,
            Resolution::Width(pixels) => [pixels, scaled(f64::from(pixels) / width)[1]],
            Resolution::Height(pixels) => [scaled(f64::from(pixels) / height)[0], pixels],
            Resolution::Scale(scale) => scaled(scale),
        }
    }
}

impl FromStr for Resolution {
    type Err = String;

    /// Parses `WxH`, `W`, `xH` or `N%`.
    fn from_str(text: &str) -> Result<Resolution, String> {
        let side = |text: &str| text.trim().parse().ok().filter(|side| (1..=MAX_SIDE).contains(side));
        let parsed = match (text.strip_suffix('%'), text.split_once(['x', 'X', '×'])) {
            (Some(percent), _) => {
                let percent = percent.trim().parse().ok();
                let percent = percent.filter(|percent: &f64| (0.1..=10_000.0).contains(percent));
                percent.map(|percent| Resolution::Scale(percent / 100.0))
            }
            (None, Some(("", height))) => side(height).map(Resolution::Height),
            (None, Some((width, height))) => {
                side(width).zip(side(height)).map(|(width, height)| Resolution::Exact([width, height]))
            }
            (None, None) => side(text).map(Resolution::Width),
        };
        parsed.ok_or_else(|| format!("expected sizes from 1 to {MAX_SIDE} like 640x480, 640 or x480, or 50%"))
    }
}

/// Rectangle of the film, parsed from `X,Y,W,H`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// First column and first row.
    pub offset: [u32; 2],
    /// Number of columns and of rows.
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

/// Number of bytes, parsed from `512M` or `2G`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bytes(pub u64);

impl FromStr for Bytes {
    type Err = String;

    fn from_str(text: &str) -> Result<Bytes, String> {
        let upper = text.trim().to_ascii_uppercase();
        let number = upper.trim_end_matches("IB").trim_end_matches('B');
        let units = [('K', 10), ('M', 20), ('G', 30), ('T', 40)];
        let unit = units.iter().find_map(|(unit, shift)| Some((number.strip_suffix(*unit)?, *shift)));
        let (number, shift) = unit.unwrap_or((number, 0));
        match number.trim().parse::<f64>() {
            Ok(number) if number > 0.0 && number < f64::from(1 << 20) * f64::from(1 << 20) => {
                Ok(Bytes((number * (1u64 << shift) as f64) as u64))
            }
            _ => Err("expected a number of bytes like 512M or 2G".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_bytes_are_parsed_and_refused() {
        for (text, bytes) in
            [("100", 100), ("1.5K", 1536), ("512 MiB", 512 << 20), ("2g", 2 << 30), ("1TB", 1 << 40)]
        {
            assert_eq!(text.parse(), Ok(Bytes(bytes)), "{text}");
        }
        for bad in ["", "G", "-1M", "0", "nan", "inf", "1e300G", "2X"] {
            assert!(bad.parse::<Bytes>().is_err(), "{bad}");
        }
    }

    #[test]
    fn sizes_and_crops_are_parsed_and_refused() {
        let own = |text: &str| text.parse::<Resolution>().map(|size| size.pixels([960, 540]));
        assert_eq!((own("640x480"), own("1X1")), (Ok([640, 480]), Ok([1, 1])));
        assert_eq!(
            (own("480"), own("x1080"), own("50%")),
            (Ok([480, 270]), Ok([1920, 1080]), Ok([480, 270]))
        );
        assert_eq!((own("1"), own("0.1%")), (Ok([1, 1]), Ok([1, 1])));
        for bad in ["", "0", "0x5", "5x0", "-1x5", "1x2x3", "9999999x1", "axb", "x", "%", "0%", "nan%"] {
            assert!(bad.parse::<Resolution>().is_err(), "{bad}");
        }
        assert_eq!("1, 2,3,4".parse(), Ok(Crop { offset: [1, 2], size: [3, 4] }));
        for bad in ["", "1,2,3", "1,2,0,4", "1,2,3,-4", "1,2,3,4,5"] {
            assert!(bad.parse::<Crop>().is_err(), "{bad}");
        }
    }
}
