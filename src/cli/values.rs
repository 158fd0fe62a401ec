//! Values of options.

use clap::ValueEnum;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use render::session::Feature;
use scene::MAX_SIDE;
use std::num::NonZeroUsize;
use std::str::FromStr;

/// Form of the messages on stderr.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ProgressMode {
    /// A progress bar on a terminal, no progress otherwise
    Auto,
    /// All messages as JSON, one object per line, by the schema in docs/progress.md
    Ndjson,
    /// Additional lines for agents of Open Job Description
    Openjd,
    /// No progress
    None,
}

/// Returns the parser of names of features.
pub fn feature() -> impl TypedValueParser<Value = Feature> {
    PossibleValuesParser::new(Feature::ALL.map(Feature::name)).try_map(|name| name.parse::<Feature>())
}

/// Parses a count, or a number that counts from 1.
pub fn counted(text: &str) -> Result<NonZeroUsize, String> {
    text.parse().map_err(|_| "expected a whole number, 1 or more".to_owned())
}

/// Parses a quantisation scale.
pub fn q_scale(text: &str) -> Result<f32, String> {
    let scale = text.parse().ok().filter(|scale| *scale == 0.0 || (0.01..=1000.0).contains(scale));
    scale.ok_or_else(|| "expected 0 or a scale from 0.01 to 1000, like 4".to_owned())
}

/// Film size, parsed from `WxH`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resolution(pub [u32; 2]);

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
}
