//! The help of `-h`: the options that most people need, with one sentence each, and where the others are.

use clap::{Arg, Command};

/// Options that only `--help` shows, by the names of their fields.
const RARE: [&str; 33] = [
    "aov",
    "azimuth",
    "background",
    "chunk",
    "crop",
    "define",
    "dry_run",
    "elevation",
    "env_rotate",
    "error",
    "exposure_per_view",
    "fov",
    "frame",
    "look_at",
    "look_from",
    "lumens_per_watt",
    "max_depth",
    "no_default_light",
    "no_overwrite",
    "no_png",
    "png",
    "preview",
    "progress",
    "reproducible",
    "resume",
    "seed",
    "set",
    "stats",
    "tev",
    "thin_glass",
    "verbose",
    "verify",
    "view",
];

/// Leaves rare options of a command out of `-h`, which then counts them and names the help that has them. The other
/// options keep their first sentence there.
pub fn shortened(command: Command) -> Command {
    let is_rare = |arg: &Arg| RARE.contains(&arg.get_id().as_str());
    let command = command.mut_args(|arg| brief(if is_rare(&arg) { arg.hide_short_help(true) } else { arg }));
    let line = match command
        .get_arguments()
        .filter(|arg| arg.is_hide_short_help_set() && !arg.is_hide_set())
        .count()
    {
        0 => return command,
        1 => "1 more option".to_owned(),
        several => format!("{several} more options"),
    };
    let name = command.get_name().to_owned();
    command.after_help(format!("{line}: lightsplat {name} --help"))
}

/// Leaves the first sentence and the default in the short help of an option. The long help keeps all.
fn brief(arg: Arg) -> Arg {
    let Some(help) = arg.get_help().map(ToString::to_string) else { return arg };
    let Some((first, _)) = help.split_once(". ") else { return arg };
    let default = help.rfind(" [default: ").filter(|_| help.ends_with(']')).map_or("", |at| &help[at..]);
    let short = format!("{first}{default}");
    arg.help(short).long_help(help)
}

#[cfg(test)]
mod tests {
    use super::super::args::Cli;
    use super::*;

    /// Returns the short or the long help of `render`.
    fn help(long: bool) -> String {
        let mut cli = Cli::definition();
        let render = cli.find_subcommand_mut("render").unwrap();
        if long { render.render_long_help() } else { render.render_help() }.to_string()
    }

    /// Counts the options of a help: lines that begin with `-x` or `--long`, not with the `-` of a value.
    fn options(help: &str) -> usize {
        let is_option = |line: &&str| {
            let text = line.trim_start();
            line.len() - text.len() <= 6 && text.starts_with('-') && !text.starts_with("- ")
        };
        help.lines().filter(is_option).count()
    }

    #[test]
    fn the_short_help_counts_the_options_that_it_leaves_out() {
        let (short, long) = (help(false), help(true));
        let left_out = options(&long) - options(&short);
        assert!(left_out > 20, "{short}");
        assert!(short.contains(&format!("{left_out} more options: lightsplat render --help")), "{short}");
        assert!(!short.contains("--reproducible") && long.contains("--reproducible"));
        assert!(!short.contains("Exit codes") && long.contains("Exit codes"));
    }

    #[test]
    fn the_short_help_has_the_first_sentence_and_the_default() {
        let arg = brief(Arg::new("a").long("a").help("First f.exr. Second. Third [default: 1, 2.]"));
        let texts = [arg.get_help(), arg.get_long_help()].map(|text| text.unwrap().to_string());
        assert_eq!(texts, ["First f.exr [default: 1, 2.]", "First f.exr. Second. Third [default: 1, 2.]"]);
        let alone = brief(Arg::new("a").long("a").help("One sentence, as of f.exr"));
        assert!(alone.get_long_help().is_none());
        let lines = help(false).lines().count();
        assert!(lines <= 40, "{lines} lines:\n{}", help(false));
    }

    #[test]
    fn every_rare_option_exists() {
        let cli = Cli::definition();
        let ids: Vec<&str> = cli
            .get_subcommands()
            .flat_map(|sub| sub.get_arguments())
            .map(|arg| arg.get_id().as_str())
            .collect();
        for rare in RARE {
            assert!(ids.contains(&rare), "{rare}");
        }
    }
}
