//! The command line: arguments (`args`) become a validated job (`job`), which a command runs.
//!
//! Data (statistics, reports) goes to stdout, messages (progress, warnings, errors) go to stderr. `exit` defines the
//! exit codes.

#![forbid(unsafe_code)]

mod args;
mod batch;
mod batch_file;
mod batch_outputs;
mod bench;
mod bench_args;
mod beside;
mod chart;
#[cfg(test)]
mod cli_page;
mod compare;
mod course;
mod dataset;
mod dataset_args;
mod demo;
mod denoise;
mod denoise_args;
mod develop;
#[cfg(test)]
mod doc_links;
mod dry_run;
mod exit;
mod files;
mod generate;
mod generate_args;
mod ids;
mod info;
mod info_lists;
mod interrupt;
mod job;
mod job_key;
mod live;
mod live_args;
mod merge;
mod method_args;
mod movie;
mod opened;
mod outputs;
mod picture;
mod picture_args;
mod plan_args;
mod png_args;
mod progress;
mod reading_args;
mod render;
mod set_args;
mod sheet;
mod shell;
mod short_help;
mod shots;
mod side_by_side;
mod still_files;
mod study;
mod talk;
mod tev;
mod threads;
mod values;
mod verify;
mod version;
mod views;
mod views_args;
mod walk;
mod walk_job;
mod walk_report;

use args::{Cli, Command};
use base::shown::shown;
use exit::Failure;
use std::ffi::OsString;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

/// Parses `arguments` (the program's name first), runs the command and returns its exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    if arguments.iter().skip(1).eq(["help", "settings"]) {
        let printed = talk::print(&set_args::list(&Cli::definition()));
        return printed.map_or_else(|failure| ExitCode::from(failure.code()), |()| ExitCode::SUCCESS);
    }
    let cli = match Cli::read(arguments) {
        Ok(cli) => cli,
        Err(error) => {
            let text = error.render().to_string();
            if error.use_stderr() && shown(&text) != text {
                talk::line(text.trim_end());
                return ExitCode::from(exit::USAGE);
            }
            // Help and version go to stdout with code 0, errors to stderr with code 2.
            let printed = error.print();
            return ExitCode::from(match printed {
                _ if error.use_stderr() => exit::USAGE,
                Err(error) if error.kind() != io::ErrorKind::BrokenPipe => exit::OUTPUT,
                _ => exit::SUCCESS,
            });
        }
    };
    if let Err(error) = interrupt::keep_running_at_size_limit() {
        talk::warning(&format!("cannot catch signals: {error}"));
    }
    let outcome = catch_unwind(AssertUnwindSafe(|| match cli.command {
        Command::Render(args) => render::run(*args),
        Command::Walk(args) => walk::run(*args),
        Command::Views(args) => views::run(*args),
        Command::Dataset(args) => dataset::run(*args),
        Command::Batch(args) => batch::run(args),
        Command::Info(args) => info::run(args),
        Command::Denoise(args) => denoise::run(args),
        Command::Develop(args) => develop::run(args),
        Command::Merge(args) => merge::run(args),
        Command::Sheet(args) => sheet::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Bench(args) => bench::run(args),
        Command::Demo => demo::run(),
        Command::Generate(args) => generate::run(args),
    }));
    let code = match outcome {
        Ok(Ok(())) => exit::SUCCESS,
        Ok(Err(failure)) => {
            talk::error(&failure);
            failure.code()
        }
        // The panic hook has printed the message and its place.
        Err(_) => {
            talk::error(&Failure::render(anyhow::anyhow!(
                "an internal error stopped the run; please report it with the lines above"
            )));
            exit::RENDER
        }
    };
    talk::end(code);
    ExitCode::from(code)
}
