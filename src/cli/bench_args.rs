//! Options of `bench`.

use super::values::Resolution;
use super::{exit, threads};
use bench::{Benchmark, REGISTRY};
use clap::Args;
use clap::builder::PossibleValuesParser;
use std::path::PathBuf;

/// The defaults are the benchmarks' own; a test holds the text to them.
#[derive(Debug, Args)]
#[command(after_help = list(), after_long_help = format!("{}\n{}", list(), exit::HELP))]
pub struct BenchArgs {
    /// Name of the benchmark [default: print the list of benchmarks]
    #[arg(value_parser = PossibleValuesParser::new(REGISTRY.iter().map(|b| b.name)), hide_possible_values = true)]
    pub benchmark: Option<String>,
    /// Scenes to measure: lightsplat TOML, Mitsuba or glTF. Studies also accept names of scenes in --scenes
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    /// Number of threads of multi-threaded cases [default: number of processors]
    #[arg(long, env = threads::VARIABLE, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub threads: Option<u32>,
    /// Number of samples per case. A study renders each image this often, and the fastest run counts
    /// [default: 7; studies: 1]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub repeats: Option<u32>,
    /// Approximate minimum duration of a sample in seconds [default: 0.05]
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    pub seconds: Option<f64>,
    /// Write all results, including every sample
    #[arg(long, value_name = "FILE")]
    pub export_json: Option<PathBuf>,
    /// Write the tables
    #[arg(long, value_name = "FILE")]
    pub export_markdown: Option<PathBuf>,
    /// Options of studies.
    #[command(flatten)]
    pub study: StudyArgs,
}

/// Options of benchmarks that render whole images.
#[derive(Clone, Debug, Default, Args, PartialEq)]
#[command(next_help_heading = "Studies")]
pub struct StudyArgs {
    /// Folder for the tables, plots and images. Images that are already there are not rendered again [default:
    /// out/NAME]
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
    /// Folder of the scenes that are given by name [default: scenes]
    #[arg(long = "scenes", value_name = "FOLDER")]
    pub scene_folder: Option<PathBuf>,
    /// Width and height of images [default: from the study]
    #[arg(long, value_name = "WxH")]
    pub resolution: Option<Resolution>,
    /// Paths per pixel of a reference, half of them in each of two independent images [default: 1024]
    #[arg(long, value_name = "SPP", value_parser = clap::value_parser!(u32).range(2..))]
    pub reference_spp: Option<u32>,
    /// Maximum seconds of path tracing per reference [default: 1800]
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    pub reference_seconds: Option<f64>,
    /// Vary only this setting, in `trade`, `growth` or `calibrate`. May be repeated. A wrong name prints the list
    #[arg(long = "knob", value_name = "NAME")]
    pub knobs: Vec<String>,
    /// Figures of other programs for the chart of `race`, a JSON object per line (see docs/benchmarks.md)
    #[arg(long, value_name = "FILE")]
    pub with: Option<PathBuf>,
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=1e6).contains(&value) => Ok(value),
        _ => Err("expected seconds from 0 to 1000000".to_owned()),
    }
}

/// Returns the list of benchmarks.
pub fn list() -> String {
    let line = |b: &Benchmark| format!("  {:<18}{}\n", format!("{}{}", b.name, b.operand()), b.about);
    format!("Benchmarks:\n{}", REGISTRY.iter().map(line).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::super::args::Cli;
    use super::*;
    use bench::Settings;
    use bench::study::ReferenceSettings;
    use clap::CommandFactory;

    #[test]
    fn help_states_the_benchmarks_defaults_and_lists_them() {
        let cli = Cli::command();
        let bench = cli.find_subcommand("bench").unwrap();
        let defaults = Settings::default();
        let reference = ReferenceSettings::default();
        for (option, default) in [
            ("repeats", format!("{}; studies: 1", defaults.repeats)),
            ("seconds", defaults.seconds.to_string()),
            ("reference-spp", reference.spp.to_string()),
            ("reference-seconds", reference.seconds.to_string()),
        ] {
            let argument = bench.get_arguments().find(|a| a.get_long() == Some(option)).unwrap();
            let stated = argument.get_help().unwrap().to_string();
            assert!(stated.contains(&format!("[default: {default}]")), "{stated}");
        }
        let listed = bench.get_after_help().unwrap().to_string();
        assert!(REGISTRY.iter().all(|b| listed.contains(b.name)), "{listed}");
        assert!(parse_seconds("-1").is_err() && parse_seconds("nan").is_err());
    }
}
