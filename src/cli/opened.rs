//! Reads the scene of a command and prints the warnings.

use super::exit::Failure;
use super::{interrupt, talk};
use readers::{LoadOptions, Loaded, SanitizeReport, SceneError, Severity, Warning, load};
use render::session::{OpenError, Opened, Session};
use render::walk::posed::cameras_in;
use std::path::Path;

/// Opens a session on the scene at `path`, and prints the warnings.
pub fn open(path: &Path, options: &LoadOptions) -> Result<Opened, Failure> {
    let opened = interrupt::while_opening(|| Session::open(path, options)).map_err(unopened)?;
    report(path, &opened.warnings, &opened.repairs);
    Ok(opened)
}

/// Opens a session on another frame of the model that moves in `first`, whose cameras see it. Prints warnings that
/// `first` lacks.
pub fn posed(path: &Path, options: &LoadOptions, first: &Opened) -> Result<Session, Failure> {
    let opened = Session::open(path, options).map_err(unopened)?;
    let is_known = |warning: &Warning| {
        let mut known = first.warnings.iter();
        known.any(|other| (&other.what, &other.fallback) == (&warning.what, &warning.fallback))
    };
    let new: Vec<Warning> = opened.warnings.into_iter().filter(|warning| !is_known(warning)).collect();
    report(path, &new, &SanitizeReport::default());
    let mut session = opened.session;
    session.cameras = cameras_in(&session.world.scene, &first.session.cameras, &first.session.world.scene);
    Ok(session)
}

/// Reads the scene at `path` without preparing it for rendering, and prints the warnings.
pub fn read(path: &Path, options: &LoadOptions) -> Result<Loaded, Failure> {
    let loaded = load(path, options).map_err(unreadable)?;
    report(path, &loaded.warnings, &loaded.repairs);
    Ok(loaded)
}

/// Returns the failure of a session that cannot be opened.
fn unopened(error: OpenError) -> Failure {
    match error {
        OpenError::Scene(error) => unreadable(error),
        OpenError::Build { .. } => Failure::render(error),
    }
}

/// Returns the failure of a scene that cannot be read.
fn unreadable(error: SceneError) -> Failure {
    match error {
        // The scene is valid. The command line asks for a camera that it lacks.
        SceneError::Camera { .. } => Failure::usage(error),
        _ => Failure::input(error),
    }
}

/// Prints warnings and repairs.
fn report(path: &Path, warnings: &[Warning], repairs: &SanitizeReport) {
    print_warnings(warnings);
    if !repairs.is_clean() {
        talk::note(&format!("{}: {repairs}", path.display()));
    }
}

/// Prints warnings.
pub fn print_warnings(warnings: &[Warning]) {
    for (warning, times) in grouped(warnings) {
        let more = if times > 1 { format!(" (and at {} more places)", times - 1) } else { String::new() };
        match warning.severity {
            Severity::Note => talk::note(&format!("{warning}{more}")),
            Severity::Warning => talk::warning(&format!("{warning}{more}")),
        }
    }
}

/// Groups warnings that differ in their place only. Returns the first of each group with the number of its members.
pub fn grouped(warnings: &[Warning]) -> Vec<(&Warning, usize)> {
    let mut groups: Vec<(&Warning, usize)> = Vec::new();
    for warning in warnings {
        let same = |known: &Warning| {
            (&known.what, &known.fallback, known.severity)
                == (&warning.what, &warning.fallback, warning.severity)
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
    use readers::Location;

    #[test]
    fn the_same_thing_at_many_places_is_said_once() {
        let at = |line, what: &str| Warning {
            place: Location::line(Path::new("a.xml"), line),
            severity: Severity::Warning,
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
