//! Reads the scene of a command and prints the warnings.

use super::exit::Failure;
use super::outputs::Inputs;
use super::{interrupt, talk};
use base::stats::{Stage, Stats};
use readers::{Level, LoadOptions, Loaded, SceneError, Warning, load};
use render::session::{OpenError, Session};
use std::path::Path;

/// Reads the scene at `path`.
pub fn read(path: &Path, options: &LoadOptions) -> Result<Loaded, Failure> {
    let loaded = load(path, options).map_err(|error| match error {
        // The scene is valid. The command line asks for a camera that it lacks.
        SceneError::Camera { .. } => Failure::usage(error),
        _ => Failure::input(error),
    })?;
    for (warning, times) in grouped(&loaded.warnings) {
        let more = if times > 1 { format!(" (and at {} more places)", times - 1) } else { String::new() };
        match warning.level {
            Level::Note => talk::note(&format!("{warning}{more}")),
            Level::Warning => talk::warning(&format!("{warning}{more}")),
        }
    }
    if !loaded.repairs.is_clean() {
        talk::note(&format!("{}: {}", path.display(), loaded.repairs));
    }
    Ok(loaded)
}

/// A session with facts about its scene file.
pub struct Opened {
    /// The session.
    pub session: Session,
    /// Number of warnings of the reader.
    pub warnings: usize,
    /// Files that the scene consists of.
    pub inputs: Inputs,
}

/// Opens a session on the scene at `path`.
pub fn open(path: &Path, options: &LoadOptions) -> Result<Opened, Failure> {
    interrupt::while_opening(|| open_now(path, options))
}

fn open_now(path: &Path, options: &LoadOptions) -> Result<Opened, Failure> {
    let mut stats = Stats::new();
    let loaded = stats.time(Stage::Load, || read(path, options))?;
    let warnings = loaded.warnings.len();
    let inputs = Inputs::new(&loaded.scene.sources);
    let session = Session::of(loaded, path, stats).map_err(|error| match error {
        OpenError::Scene(_) => Failure::input(error),
        OpenError::Build { .. } => Failure::render(error),
    })?;
    Ok(Opened { session, warnings, inputs })
}

/// Groups warnings that differ in their place only. Returns the first of each group with the number of its members.
fn grouped(warnings: &[Warning]) -> Vec<(&Warning, usize)> {
    let mut groups: Vec<(&Warning, usize)> = Vec::new();
    for warning in warnings {
        let same = |known: &Warning| {
            (&known.what, &known.fallback, known.level) == (&warning.what, &warning.fallback, warning.level)
        };
        match groups.iter_mut().find(|(known, _)| same(known)) {
            Some((_, times)) => *times += 1,
            None => groups.push((warning, 1)),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use readers::Place;

    #[test]
    fn the_same_thing_at_many_places_is_said_once() {
        let at = |line, what: &str| Warning {
            place: Place::line(Path::new("a.xml"), line),
            level: Level::Warning,
            what: what.to_owned(),
            fallback: "ignored".to_owned(),
        };
        let warnings = [at(1, "bump"), at(2, "fog"), at(3, "bump"), at(9, "bump")];
        let groups = grouped(&warnings);
        assert_eq!(
            groups.iter().map(|(w, n)| (w.what.as_str(), *n)).collect::<Vec<_>>(),
            [("bump", 3), ("fog", 1)]
        );
        assert_eq!(groups[0].0.place.line, Some(1));
    }
}
