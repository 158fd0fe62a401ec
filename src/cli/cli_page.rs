//! The page `docs/cli.md`: all commands and options, from the definition of the command line.

use super::args::Cli;
use super::set_args;
use clap::builder::PossibleValue;
use clap::{Arg, Command};
use std::fs;

const HEAD: &str = "\
# Command line

This page lists every command and option. `lightsplat COMMAND -h` shows the options that most people need. `--help` shows
all options, `lightsplat help settings` the settings of the paper and of tuning. To update the page, run `UPDATE_DOCS=1 cargo test -p cli --lib cli_page`.

| exit code | meaning |
|--:|---|
| 0 | success |
| 1 | rendering failed |
| 2 | the arguments are invalid, or the scene lacks what they ask for |
| 3 | a scene or an image is invalid |
| 4 | the result cannot be written |
| 5 | some images of a batch failed; the others are complete |
| 75 | a signal stopped the run, which may be started again |
| 130 | a second signal stopped the run at once |

| environment variable | meaning |
|---|---|
| `LIGHTSPLAT_THREADS` | number of threads, if `--threads` is not given |
| `LIGHTSPLAT_PROGRESS` | form of the messages, if `--progress` is not given |
| `OIDN_DIR` | folder of Open Image Denoise |
| `EMBREE_DIR` | folder of Embree, for the build |
| `LIGHTSPLAT_ISA` | largest instruction set that a wheel or tarball uses: `x86-64-v3` or `x86-64-v4` |
";

/// Returns the page.
fn page() -> String {
    let mut command = Cli::definition();
    command.build();
    let commands = command.get_subcommands().filter(|sub| sub.get_name() != "help");
    let commands: String = commands.map(|sub| section(sub, "lightsplat", "##")).collect();
    format!("{HEAD}{commands}{}", settings(&command))
}

/// Returns the section of the settings.
fn settings(command: &Command) -> String {
    let mut text = "\n## Settings\n\n`--set KEY=VALUE` sets a setting of the paper or of tuning. `lightsplat help settings` \
                    lists the settings. In job files, settings are keys like options.\n"
        .to_owned();
    for (heading, settings) in set_args::groups(command) {
        text += &format!("\n**{heading}**\n");
        for arg in settings {
            let help = set_args::help(arg).trim_end_matches('.').replace('\n', " ").replace('|', "\\|");
            text += &format!("\n- `{}`: {help}.{}\n", set_args::usage(arg), values(arg));
        }
    }
    text
}

/// Returns the section of a command, with its own commands.
fn section(command: &Command, parent: &str, level: &str) -> String {
    let name = format!("{parent} {}", command.get_name());
    let about = command.get_about().map(|about| about.to_string()).unwrap_or_default();
    let mut text = format!("\n{level} `{name}`\n\n{about}.\n");
    for arg in command.get_positionals() {
        let [value, ..] = arg.get_value_names().unwrap_or_default() else { continue };
        text += &format!("\n- `{value}`: {}.{}\n", help(arg), values(arg));
    }
    let mut headings: Vec<Option<&str>> = Vec::new();
    let options =
        || command.get_arguments().filter(|arg| !arg.is_positional() && !arg.is_hide_set() && is_own(arg));
    for heading in options().map(Arg::get_help_heading) {
        if !headings.contains(&heading) {
            headings.push(heading);
        }
    }
    // Options that most people need come first.
    let is_rare = |heading: &Option<&str>| {
        options().filter(|arg| arg.get_help_heading() == *heading).all(Arg::is_hide_short_help_set)
    };
    headings.sort_by_key(is_rare);
    for heading in headings {
        text += &format!("\n**{}**\n", heading.unwrap_or("Options"));
        text.extend(options().filter(|arg| arg.get_help_heading() == heading).map(option));
    }
    let subs = command.get_subcommands().filter(|sub| sub.get_name() != "help");
    text + &subs.map(|sub| section(sub, &name, &format!("{level}#"))).collect::<String>()
}

/// Returns true if an option is not the same for every command.
fn is_own(arg: &Arg) -> bool {
    !["help", "version"].contains(&arg.get_id().as_str())
}

/// Returns the entry of an option.
fn option(arg: &Arg) -> String {
    let short = arg.get_short().map_or(String::new(), |short| format!("`-{short}`, "));
    let long = arg.get_long().unwrap_or_default();
    let takes =
        arg.get_action().takes_values() && arg.get_num_args().is_none_or(|range| range.max_values() > 0);
    let value = arg.get_value_names().filter(|_| takes).and_then(|names| names.first());
    let value = value.map_or(String::new(), |value| format!(" {value}"));
    let aliases = arg.get_visible_aliases().unwrap_or_default();
    let aliases: String = aliases.iter().map(|alias| format!(", `--{alias}`")).collect();
    format!("\n- {short}`--{long}{value}`{aliases}: {}.{}\n", help(arg), values(arg))
}

/// Returns the help of an argument, without its full stop.
fn help(arg: &Arg) -> String {
    let text = arg.get_long_help().or(arg.get_help()).map(|help| help.to_string()).unwrap_or_default();
    let default =
        arg.get_default_values().iter().map(|value| value.to_string_lossy()).collect::<Vec<_>>().join(",");
    let is_flag = !arg.get_action().takes_values();
    let said = if default.is_empty() || is_flag { String::new() } else { format!(" [default: {default}]") };
    text.trim_end_matches('.').replace('\n', " ").replace('|', "\\|") + &said
}

/// Returns the possible values of an argument.
fn values(arg: &Arg) -> String {
    let is_shown = |value: &PossibleValue| !value.is_hide_set();
    let values = arg.get_possible_values();
    let listed =
        values.iter().filter(|value| is_shown(value) && arg.get_action().takes_values()).map(|value| {
            match value.get_help() {
                Some(help) => format!("\n  - `{}`: {help}", value.get_name()),
                None => format!("\n  - `{}`", value.get_name()),
            }
        });
    listed.collect()
}

#[test]
fn the_page_lists_every_command_and_option() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/cli.md");
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(path, page()).unwrap();
    }
    let found = fs::read_to_string(path).unwrap_or_default();
    assert!(found == page(), "out of date: run UPDATE_DOCS=1 cargo test -p cli --lib cli_page");
}
