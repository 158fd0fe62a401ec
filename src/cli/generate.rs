//! `lightsplat generate`: prints completion scripts and the man page, from the definition of the options.

use super::args::Cli;
use super::exit::Failure;
use super::generate_args::{Artefact, GenerateArgs};
use super::{set_args, talk};
use anyhow::Context;
use clap_complete::{Shell, generate};
use clap_mangen::Man;

/// Name of the program.
const NAME: &str = "lightsplat";

/// Runs the command.
pub fn run(args: GenerateArgs) -> Result<(), Failure> {
    let shell = match args.what {
        Artefact::Bash => Shell::Bash,
        Artefact::Zsh => Shell::Zsh,
        Artefact::Fish => Shell::Fish,
        Artefact::Man => {
            let page = man_page().context("cannot format the man page").map_err(Failure::output)?;
            return talk::print_bytes(&page);
        }
    };
    talk::print_bytes(&completions(shell))
}

fn completions(shell: Shell) -> Vec<u8> {
    let mut bytes = Vec::new();
    generate(shell, &mut set_args::for_completion(&Cli::definition()), NAME, &mut bytes);
    bytes
}

/// Returns the man page: the program, then the options of each command.
fn man_page() -> std::io::Result<Vec<u8>> {
    let mut command = Cli::definition();
    command.build();
    let mut page = Vec::new();
    Man::new(command.clone()).render(&mut page)?;
    for sub in command.get_subcommands().filter(|sub| sub.get_name() != "help") {
        let name = format!("{NAME} {}", sub.get_name());
        let man = Man::new(sub.clone().name(name.clone()).bin_name(name.clone()));
        page.extend(format!(".SH \"{}\"\n", name.to_uppercase()).bytes());
        man.render_description_section(&mut page)?;
        man.render_options_section(&mut page)?;
    }
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_man_page_and_completions_know_every_command() {
        let page = String::from_utf8(man_page().unwrap()).unwrap();
        for sub in Cli::definition().get_subcommands() {
            let name = sub.get_name();
            assert!(page.contains(&format!("LIGHTSPLAT {}", name.to_uppercase())), "{name}");
            for shell in [Shell::Bash, Shell::Zsh, Shell::Fish] {
                let script = String::from_utf8(completions(shell)).unwrap();
                assert!(script.contains(name), "{shell} {name}");
                assert!(script.contains("epsilon=") && !script.contains("set epsilon"), "{shell}");
            }
        }
        assert!(page.contains("env") && page.contains("no\\-overwrite"));
    }
}
