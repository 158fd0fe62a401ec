//! The option `--set KEY=VALUE`: settings of the paper and of tuning.
//!
//! A setting is an option of its own, hidden from help, whose long name is `set KEY`. The words `--set epsilon=0.1` and
//! `--set=epsilon=0.1` become the word `--set epsilon=0.1`. So settings have the parsers and the errors of options.

use super::method_args;
use clap::builder::{PossibleValuesParser, Resettable};
use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command};
use std::ffi::{OsStr, OsString};
use toml::{Table, Value};

/// Settings besides those of the paper and of tuning, by the names of their fields.
const OTHERS: [&str; 17] = [
    "aov_mode",
    "aperture",
    "denoise_quality",
    "depth_png",
    "every",
    "focus",
    "format",
    "hide",
    "idle_frames",
    "inspect",
    "max_copied",
    "memory_limit",
    "q_scale",
    "show",
    "up",
    "verify_against",
    "verify_samples",
];

/// Settings that are on or off, and off by default.
const FLAGS: [&str; 4] = ["clay", "half", "keep_noisy", "no_reprojection"];

/// Commands with settings.
const COMMANDS: [&str; 5] = ["render", "walk", "views", "dataset", "info"];

/// Returns the key of the setting that an argument is; `None` for an option.
fn key(arg: &Arg) -> Option<&str> {
    arg.get_long().and_then(|long| long.strip_prefix("set "))
}

/// Returns true if an argument of a command is to be a setting.
fn is_setting(id: &str) -> bool {
    OTHERS.contains(&id) || FLAGS.contains(&id) || method_args::is_tuning(id)
}

/// Makes settings of the arguments of a command that are no options, and adds the option `--set`.
pub fn with_settings(command: Command) -> Command {
    if !COMMANDS.contains(&command.get_name()) {
        return command;
    }
    let command = command.mut_args(|arg| match is_setting(arg.get_id().as_str()) {
        true => {
            let key = arg.get_long().unwrap_or_default().to_owned();
            let is_flag = FLAGS.contains(&arg.get_id().as_str());
            let arg = arg.long(format!("set {key}")).hide(true);
            if is_flag { arg } else { arg.num_args(1).require_equals(true) }
        }
        false => arg,
    });
    let set = Arg::new("set").long("set").value_name("KEY=VALUE").action(ArgAction::Append);
    let set = set.help_heading(None::<&str>);
    let set = set
        .help("Value of a setting of the paper or of tuning. `lightsplat help settings` lists the settings");
    command.arg(set.value_parser(unknown))
}

/// Returns a command for completion scripts: its settings are values of `--set`, since their long names have spaces.
pub fn for_completion(command: &Command) -> Command {
    let keys: Vec<String> = command.get_arguments().filter_map(key).map(|key| format!("{key}=")).collect();
    let option = |arg: &Arg| {
        // Settings are among what options exclude and require.
        let arg = arg.clone().conflicts_with(Resettable::Reset).requires(Resettable::Reset);
        let is_set = arg.get_id() == "set";
        if is_set { arg.value_parser(PossibleValuesParser::new(keys.clone())) } else { arg }
    };
    let options = command.get_arguments().filter(|arg| key(arg).is_none()).map(option);
    let about = command.get_about().cloned().unwrap_or_default();
    let plain = Command::new(command.get_name().to_owned()).about(about).args(options);
    let plain = plain.subcommands(command.get_subcommands().map(for_completion));
    command.get_version().map_or(plain.clone(), |version| plain.version(version.to_owned()))
}

/// Refuses a setting that no argument takes.
fn unknown(text: &str) -> Result<String, String> {
    let remedy = "`lightsplat help settings` lists the settings";
    Err(match text.split_once('=') {
        Some((key, _)) => format!("there is no setting {key} here; {remedy}"),
        None => format!("write --set KEY=VALUE; {remedy}"),
    })
}

/// Returns the word of the command line for a setting or an option of a job file.
pub fn word(name: &str) -> String {
    match is_setting(&name.replace('-', "_")) {
        true => format!("--set {name}"),
        false => format!("--{name}"),
    }
}

/// Returns the options of a command on the command line, besides those with the ids `own`, as a job file has them.
pub fn typed(command: &Command, matches: &ArgMatches, own: &[&str]) -> Table {
    let is_typed = |arg: &&Arg| {
        let id = arg.get_id().as_str();
        !own.contains(&id) && matches.value_source(id) == Some(ValueSource::CommandLine)
    };
    let option = |arg: &Arg| {
        let long = key(arg).or(arg.get_long())?;
        let values = matches.get_raw(arg.get_id().as_str()).filter(|_| arg.get_action().takes_values());
        let words = values.map(|values| values.map(|value| value.to_string_lossy().into_owned()));
        let value = match words.map(Iterator::collect::<Vec<String>>) {
            None => Value::Boolean(true),
            Some(mut words) if words.len() == 1 => words.swap_remove(0).into(),
            Some(words) => words.into(),
        };
        Some((long.to_owned(), value))
    };
    command.get_arguments().filter(is_typed).filter_map(option).collect()
}

/// Joins the words of settings.
///
/// # Errors
/// If a setting is written as an option. The error has the right words.
pub fn joined(words: Vec<OsString>) -> Result<Vec<OsString>, clap::Error> {
    if !words.get(1).is_some_and(|command| COMMANDS.iter().any(|known| command == known)) {
        return Ok(words);
    }
    let mut joined = Vec::with_capacity(words.len());
    let mut rest = words.into_iter().peekable();
    while let Some(word) = rest.next() {
        let text = word.to_str().unwrap_or_default();
        if text == "--" {
            joined.push(word);
            joined.extend(rest);
            break;
        }
        let pair = match text.strip_prefix("--set=") {
            Some(pair) => Some(pair.to_owned()),
            None if text == "--set" => {
                rest.next_if(|next| is_pair(next)).and_then(|next| next.into_string().ok())
            }
            None => None,
        };
        if let Some(pair) = pair {
            joined.extend(setting(&pair).unwrap_or_else(|| vec!["--set".into(), pair.into()]));
            continue;
        }
        if let Some((key, value)) = written_as_option(text) {
            let next =
                || rest.peek().filter(|_| takes_value(key)).and_then(|next| next.to_str()).map(str::to_owned);
            let value = value.or_else(next).filter(|value| !value.starts_with("--"));
            let value = value.unwrap_or_else(|| if takes_value(key) { "VALUE" } else { "on" }.to_owned());
            let said = format!("--{key} is a setting now: write --set {key}={value}\n");
            return Err(clap::Error::raw(ErrorKind::UnknownArgument, said));
        }
        joined.push(word);
    }
    Ok(joined)
}

fn is_pair(word: &OsStr) -> bool {
    word.to_str().is_some_and(|text| !text.starts_with('-'))
}

/// Returns true for a setting with a value, which flags of the command line have not.
pub fn takes_value(name: &str) -> bool {
    let id = name.replace('-', "_");
    is_setting(&id) && !FLAGS.contains(&&*id)
}

/// Returns the words of a setting; `None` if there is no such setting. A flag is the word alone, or no word.
fn setting(pair: &str) -> Option<Vec<OsString>> {
    let (key, value) = pair.split_once('=').map_or((pair, None), |(key, value)| (key, Some(value.trim())));
    let id = key.trim().replace('-', "_");
    let word = format!("--set {}", id.replace('_', "-"));
    let is_flag = FLAGS.contains(&&*id);
    is_setting(&id).then(|| match value {
        Some("on") if is_flag => vec![word.into()],
        Some("off") if is_flag => Vec::new(),
        Some(value) => vec![format!("{word}={value}").into()],
        None => vec![word.into()],
    })
}

/// Returns key and value of a setting that is written as an option.
fn written_as_option(text: &str) -> Option<(&str, Option<String>)> {
    let name = text.strip_prefix("--")?;
    let (key, value) =
        name.split_once('=').map_or((name, None), |(key, value)| (key, Some(value.to_owned())));
    is_setting(&key.replace('-', "_")).then_some((key, value))
}

/// Lists the settings of all commands for `lightsplat help settings`.
pub fn list(cli: &Command) -> String {
    let mut text =
        "Settings of the paper and of tuning, for render, walk, views and job files: --set KEY=VALUE\n"
            .to_owned();
    for (heading, settings) in groups(cli) {
        text += &format!("\n{heading}:\n");
        for arg in settings {
            text += &format!("  {}\n      {}\n", usage(arg), help(arg));
        }
    }
    text
}

/// Returns the settings of all commands by heading, each once.
pub fn groups(cli: &Command) -> Vec<(String, Vec<&Arg>)> {
    let mut groups: Vec<(String, Vec<&Arg>)> = Vec::new();
    for arg in cli.get_subcommands().flat_map(|sub| sub.get_arguments()).filter(|arg| key(arg).is_some()) {
        let of_method = method_args::is_tuning(arg.get_id().as_str());
        let heading = arg.get_help_heading().filter(|_| of_method).unwrap_or("Others").to_owned();
        if groups.iter().any(|(_, settings)| settings.iter().any(|other| other.get_id() == arg.get_id())) {
            continue;
        }
        match groups.iter_mut().find(|(other, _)| *other == heading) {
            Some((_, settings)) => settings.push(arg),
            None => groups.push((heading, vec![arg])),
        }
    }
    groups.sort_by_key(|(heading, _)| heading == "Others");
    groups
}

/// Returns key and values of a setting.
pub fn usage(arg: &Arg) -> String {
    let id = arg.get_id().as_str();
    let values: Vec<String> =
        arg.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect();
    let name = arg.get_value_names().and_then(|names| names.first()).map(ToString::to_string);
    let values = match (FLAGS.contains(&id) || id == "inspect", values.is_empty()) {
        (true, _) => "on|off".to_owned(),
        (_, false) => values.join("|"),
        _ => name.unwrap_or_default(),
    };
    format!("{}={values}", key(arg).unwrap_or_default())
}

/// Returns the help of a setting with its range.
pub fn help(arg: &Arg) -> String {
    let text = arg.get_long_help().or(arg.get_help()).map(ToString::to_string).unwrap_or_default();
    let default = arg.get_default_values().first().filter(|_| arg.get_action().takes_values());
    let default = default.map_or(String::new(), |value| format!(" [default: {}]", value.to_string_lossy()));
    let text = text + &default;
    let range =
        method_args::range(arg.get_id().as_str()).map_or(String::new(), |range| format!(" [{range}]"));
    match text.find(" [") {
        Some(at) => format!("{}{range}{}", &text[..at], &text[at..]),
        None => text + &range,
    }
}

#[cfg(test)]
mod tests {
    use super::super::args::Cli;
    use super::*;

    fn error(words: &str) -> String {
        Cli::read(words.split(' ')).map(|_| ()).unwrap_err().to_string()
    }

    #[test]
    fn settings_are_set_and_checked_and_old_spellings_name_the_new_ones() {
        let render = |words: &str| format!("lightsplat render a.toml {words}");
        for good in [
            "--set epsilon=0.1 --set=record_epsilon=0.2 --set max-copied=0",
            "--set keep-noisy=on",
            "--set inspect=on",
        ] {
            assert!(Cli::read(render(good).split(' ')).is_ok(), "{good}");
        }
        for (bad, said) in [
            ("--set epsilon=2", "'--set epsilon=<EPSILON>': expected from 0 to 1"),
            ("--set epsilon", "--set epsilon"),
            ("--set epsilonn=2", "there is no setting epsilonn here; `lightsplat help settings`"),
            ("--set footprints=oak", "anisotropic"),
            ("--epsilon 0.1", "--epsilon is a setting now: write --set epsilon=0.1"),
            ("--epsilon=0.1", "write --set epsilon=0.1"),
            ("--keep-noisy -q", "write --set keep-noisy=on"),
            ("--memory-limit 1G", "write --set memory-limit=1G"),
        ] {
            let found = error(&render(bad));
            assert!(found.contains(said), "{bad}: {found}");
        }
    }

    #[test]
    fn every_setting_exists_and_is_listed_with_range_and_default() {
        let cli = Cli::definition();
        let listed = list(&cli);
        for id in OTHERS.iter().chain(&FLAGS) {
            assert!(listed.contains(&format!("\n  {}=", id.replace('_', "-"))), "{id}: {listed}");
        }
        assert!(listed.contains("\n  epsilon=EPSILON\n") && listed.contains(" [0 to 1] "), "{listed}");
        for (command, most) in [("render", 45), ("walk", 45), ("views", 45)] {
            let command = cli.find_subcommand(command).unwrap();
            let options = command.get_arguments().filter(|arg| !arg.is_positional() && !arg.is_hide_set());
            assert!(options.count() <= most, "{}", command.get_name());
        }
    }
}
