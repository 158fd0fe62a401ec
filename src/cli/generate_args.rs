//! Options of `generate`.

use clap::{Args, ValueEnum};

/// Options of `generate`.
#[derive(Debug, Args)]
pub struct GenerateArgs {
    /// Text to print
    #[arg(value_enum)]
    pub what: Artefact,
}

/// Text about the options.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Artefact {
    /// Completions for bash
    Bash,
    /// Completions for zsh
    Zsh,
    /// Completions for fish
    Fish,
    /// The man page, with one section per command
    Man,
}
