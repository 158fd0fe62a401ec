//! Options of `render` that set a goal instead of settings.

use super::exit::Failure;
use anyhow::anyhow;
use base::stats::Stopwatch;
use clap::{Args, ValueEnum};
use render::method::Method;
use render::plan::{DRAFT, FINAL, Ladder, PREVIEW, REFERENCE};
use render::session::{ErrorLimit, PlanGoal, TimeGoal};

/// Default of the maximum number of paths per pixel whose error is measured.
const MAX_SAMPLES: u32 = 1 << 16;

/// Named settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Quality {
    /// Check of the scene
    Draft,
    /// Preview of the lighting
    Preview,
    /// Final image
    Final,
    /// Reference for other images
    Reference,
}

impl Quality {
    /// Returns the level of the settings on the quality scale.
    pub fn level(self) -> f64 {
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
    /// Named settings. Settings given on the command line are not changed
    #[arg(long, value_enum, conflicts_with_all = ["time", "error"])]
    pub quality: Option<Quality>,
    /// Choose settings so that the run takes about this long: 10s, 500ms, 2m. Reading the scene and writing files are
    /// included, --verify is not. Settings given on the command line are not changed. The chosen settings depend on the
    /// machine and are printed
    #[arg(long, value_name = "TIME", value_parser = parse_time, allow_hyphen_values = true, conflicts_with = "error")]
    pub time: Option<f64>,
    /// Choose the cheapest settings with at most this relative RMS error, like 2%, with 95 % confidence. Paths measure
    /// the error at some pixels; --verify sets their number [default: 1000]. Settings given on the command line are not
    /// changed
    #[arg(long, value_name = "PERCENT", value_parser = parse_percent, allow_hyphen_values = true)]
    pub error: Option<f64>,
}

impl PlanArgs {
    /// Returns `method` with the settings of a quality, except the pinned ones.
    pub fn method(&self, method: Method, pinned: &[&'static str]) -> Result<Method, Failure> {
        let Some(quality) = self.quality else { return Ok(method) };
        let ladder = Ladder::new(method, pinned).ok_or_else(|| unplannable("--quality has"))?;
        Ok(ladder.at(quality.level()))
    }

    /// Returns the goal for which settings of `method` are planned, except the pinned ones. The run began with `run`.
    ///
    /// # Errors
    /// If the method has no scale of settings.
    pub fn goal(
        &self,
        method: &Method,
        pinned: Vec<&'static str>,
        max_samples: Option<u32>,
        run: Stopwatch,
    ) -> Result<PlanGoal, Failure> {
        let max_samples = max_samples.unwrap_or(MAX_SAMPLES);
        let goal = match (self.time, self.error) {
            (Some(seconds), _) => PlanGoal::Time(TimeGoal { seconds, run, pinned }),
            (None, Some(error)) => PlanGoal::Error(ErrorLimit { error, max_samples, pinned }),
            (None, None) => return Ok(PlanGoal::AsSet),
        };
        if method.moves().is_empty() {
            return Err(unplannable("--time and --error plan"));
        }
        Ok(goal)
    }
}

/// Returns the error of a method without a scale of settings, which names the methods that have one.
fn unplannable(options: &str) -> Failure {
    let planned = Method::all().filter(|method| !method.moves().is_empty());
    let planned: Vec<_> = planned.map(|method| method.name()).collect();
    Failure::usage(anyhow!("{options} settings of --method {} only", planned.join(", ")))
}

/// Parses a duration; returns seconds.
pub fn parse_time(text: &str) -> Result<f64, String> {
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

/// Parses a percentage; returns a fraction.
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
