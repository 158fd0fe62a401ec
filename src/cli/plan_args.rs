//! Options of `render` that set a goal instead of settings.

use super::exit::Failure;
use anyhow::anyhow;
use base::stats::Stopwatch;
use clap::{Args, ValueEnum};
use render::method::Method;
use render::plan::{DRAFT, FINAL, Ladder, PREVIEW, REFERENCE};
use render::session::Wanted;

/// Default of the maximum number of paths a pixel where its error is measured.
const MAX_SAMPLES: u32 = 1 << 16;

/// Named settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Quality {
    /// To see whether the scene is right
    Draft,
    /// To judge the light
    Preview,
    /// To keep
    Final,
    /// To hold others to
    Reference,
}

impl Quality {
    /// Level of its settings on the quality scale.
    pub fn height(self) -> f64 {
        match self {
            Quality::Draft => DRAFT,
            Quality::Preview => PREVIEW,
            Quality::Final => FINAL,
            Quality::Reference => REFERENCE,
        }
    }
}

/// Options that plan the settings.
#[derive(Clone, Debug, Default, Args, PartialEq)]
#[command(next_help_heading = "Planned settings")]
pub struct PlanArgs {
    /// Settings by name; those that are typed are held
    #[arg(long, value_enum, conflicts_with_all = ["time", "error"])]
    pub quality: Option<Quality>,
    /// Plan the settings so that the whole run, from start to written files, takes about this long (10s,
    /// 500ms, 2m); only --verify comes on top. Settings that are typed are held. They depend on the machine;
    /// the run says which they are
    #[arg(long, value_name = "TIME", value_parser = parse_time, allow_hyphen_values = true, conflicts_with = "error")]
    pub time: Option<f64>,
    /// Find the cheapest settings whose measured relative RMS error is this or less (like 2%), known in 95 of
    /// 100 cases; settings that are typed are held. --verify says how many pixels are measured [default:
    /// 1000]
    #[arg(long, value_name = "PERCENT", value_parser = parse_percent, allow_hyphen_values = true)]
    pub error: Option<f64>,
}

impl PlanArgs {
    /// Returns `method` with the settings of a quality, except those pinned in `held`.
    pub fn method(&self, method: Method, held: &[&'static str]) -> Result<Method, Failure> {
        let Some(quality) = self.quality else { return Ok(method) };
        let ladder = Ladder::new(method, held).ok_or_else(|| unplannable("--quality has"))?;
        Ok(ladder.at(quality.height()))
    }

    /// Returns the goal that settings of `method` are planned for, except those pinned in `held`;
    /// `max_samples` as given. The run began with `run`.
    pub fn wanted(
        &self,
        method: &Method,
        held: Vec<&'static str>,
        max_samples: Option<u32>,
        run: Stopwatch,
    ) -> Result<Wanted, Failure> {
        let max_samples = max_samples.unwrap_or(MAX_SAMPLES);
        let wanted = match (self.time, self.error) {
            (Some(seconds), _) => Wanted::Time { seconds, run, held },
            (None, Some(error)) => Wanted::Error { error, max_samples, held },
            (None, None) => return Ok(Wanted::AsSet),
        };
        if method.ladder().is_empty() {
            return Err(unplannable("--time and --error plan"));
        }
        Ok(wanted)
    }
}

/// Error of a method without a scale of settings, with those that have one.
fn unplannable(options: &str) -> Failure {
    let planned = Method::all().filter(|method| !method.ladder().is_empty());
    let planned: Vec<_> = planned.map(|method| method.name()).collect();
    Failure::usage(anyhow!("{options} settings of --method {}", planned.join(", ")))
}

/// Seconds.
fn parse_time(text: &str) -> Result<f64, String> {
    let units = [("ms", 1e-3), ("s", 1.0), ("m", 60.0), ("h", 3600.0), ("", 1.0)];
    let seconds = units.iter().find_map(|&(unit, factor)| {
        let number: f64 = text.strip_suffix(unit)?.trim().parse().ok()?;
        Some(number * factor)
    });
    match seconds {
        Some(seconds) if seconds > 0.0 && seconds <= 1e7 => Ok(seconds),
        _ => Err("expected a time like 10s, 500ms or 2m".to_owned()),
    }
}

/// A fraction.
fn parse_percent(text: &str) -> Result<f64, String> {
    match text.strip_suffix('%').and_then(|number| number.trim().parse::<f64>().ok()) {
        Some(percent) if percent > 0.0 && percent <= 1000.0 => Ok(percent / 100.0),
        _ => Err("expected a percentage above 0 like 2%".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_percentages_are_parsed_and_refused() {
        for (text, seconds) in [("10s", 10.0), ("2.5", 2.5), ("500ms", 0.5), ("2 m", 120.0), ("1h", 3600.0)] {
            assert!((parse_time(text).unwrap() - seconds).abs() < 1e-12, "{text}");
        }
        for bad in ["", "s", "0s", "-1s", "nan", "inf", "10x", "1e9"] {
            assert!(parse_time(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_percent("2%"), Ok(0.02));
        for bad in ["", "2", "%", "0%", "-2%", "nan%", "inf%"] {
            assert!(parse_percent(bad).is_err(), "{bad}");
        }
    }
}
