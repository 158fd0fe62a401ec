//! Options of `--method cache`.

use clap::{Args, ValueEnum};
use std::str::FromStr;

/// The defaults are the method's own; a test holds the text to them.
#[derive(Clone, Debug, Default, Args, PartialEq)]
#[command(next_help_heading = "Radiance cache")]
pub struct CacheArgs {
    /// Largest error bound of a cluster in a record's cut, relative to its luminance [default: 0.01]
    #[arg(long, value_parser = super::args::parse_fraction)]
    pub record_epsilon: Option<f32>,
    /// Where direct light is found [default: samples]
    #[arg(long, value_enum)]
    pub direct: Option<LightBy>,
    /// Where indirect light is found [default: samples]
    #[arg(long, value_enum)]
    pub indirect: Option<LightBy>,
    /// Shape of footprints [default: occlusion]
    #[arg(long, value_enum)]
    pub footprints: Option<FootprintShape>,
    /// Rays that find the edges of occluders around a record, in rings of sixteen [default: 128]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub probe_rays: Option<u32>,
    /// Radius of footprints relative to the distance of what casts light and shadow, for direct and
    /// for indirect light [default: 0.3,0.2]
    #[arg(long, value_name = "DIRECT,INDIRECT")]
    pub accuracy: Option<Pair>,
    /// Least and largest radius of footprints, in spacings of eye samples
    #[arg(long, value_name = "LEAST,LARGEST")]
    pub reach: Option<Pair>,
    /// Roughness α from which lobes are lit by records, 2 for none: sharper ones have cuts of their own [default: 0.25]
    #[arg(long, value_name = "ALPHA")]
    pub series_alpha: Option<f32>,
    /// Largest error of a lobe's series for which it is lit by records, relative to the whole reflection [default: 0.12]
    #[arg(long, value_name = "ERROR")]
    pub series_error: Option<f64>,
    /// Whether the light of records is extrapolated by their gradients, for comparison [default: on]
    #[arg(long, value_enum)]
    pub gradients: Option<Switch>,
    /// Relative change of luminance across a footprint that halves it along the gradient [default: 0.5]
    #[arg(long)]
    pub mu: Option<f32>,
    /// Write what the cache did as further layers of the OpenEXR file, and as PNG files beside the picture
    #[arg(long)]
    pub inspect: bool,
    /// Most passes that shrink footprints at visible seams [default: 1]
    #[arg(long)]
    pub passes: Option<u32>,
    /// Smallest relative difference of luminance that counts as visible [default: 0.02]
    #[arg(long, value_parser = super::args::parse_fraction)]
    pub threshold: Option<f32>,
    /// Patches of eye samples without records, about: sixteen of each share a cut, which is lent to the
    /// others [default: 4096]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub patches: Option<u32>,
    /// Cells of fewer eye samples get no record; their samples have cuts or gatherings of their own
    /// [default: 256, 32 for photon-cache]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub least_cell: Option<u32>,
}

impl CacheArgs {
    /// Whether something is typed about records though none are asked for.
    pub fn without_records(&self) -> bool {
        let about_light = CacheArgs {
            direct: self.direct,
            indirect: self.indirect,
            patches: self.patches,
            inspect: self.inspect,
            ..CacheArgs::default()
        };
        ![self.direct, self.indirect].contains(&Some(LightBy::Records)) && *self != about_light
    }
}

/// Ways of finding light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LightBy {
    /// By a layer of records, splatted onto the eye samples
    Records,
    /// By cuts that neighbouring eye samples share and lend each other
    Samples,
}

/// On or off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Switch {
    /// Do
    On,
    /// Do not
    Off,
}

/// Shapes of footprints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FootprintShape {
    /// Circles
    Isotropic,
    /// Ellipses, short along the gradient of the light
    Anisotropic,
    /// Ellipses by second derivatives, gradients corrected at the edges of occluders
    Occlusion,
}

/// Two positive numbers, `A,B`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair(pub [f32; 2]);

impl FromStr for Pair {
    type Err = String;

    fn from_str(text: &str) -> Result<Pair, String> {
        let numbers: Option<Vec<f32>> = text.split(',').map(|s| s.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[a, b]) if a > 0.0 && b > 0.0 && a.is_finite() && b.is_finite() => Ok(Pair([a, b])),
            _ => Err("expected two positive numbers like 0.3,0.5".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_parsed_and_refused() {
        assert_eq!("0.3, 2".parse(), Ok(Pair([0.3, 2.0])));
        for bad in ["", "1", "1,2,3", "0,1", "-1,2", "nan,1", "a,b", "inf,1"] {
            assert!(bad.parse::<Pair>().is_err(), "{bad}");
        }
    }
}
