//! Outputs of a batch: no two of its pictures and walks write the same file.

use super::args::Command;
use super::batch_file::Entry;
use super::exit::Failure;
use anyhow::anyhow;
use base::film::atomic;
use render::walk::FileNames;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Refuses two entries that would write the same file. Walks may share names if their frames differ.
pub fn check_apart(entries: &[Entry]) -> Result<(), Failure> {
    let mut written: BTreeMap<PathBuf, &Entry> = BTreeMap::new();
    // Those of walks by the names of all their files: the first of all frames of the path, and the first of some.
    let mut walks: BTreeMap<PathBuf, [Option<&Entry>; 2]> = BTreeMap::new();
    for entry in entries {
        // What else is wrong with an entry is found where it is checked on its own.
        let (Ok(command), Ok(target)) = (entry.command(), atomic::resolve(&entry.output)) else { continue };
        let mut files = vec![target.clone()];
        if let Command::Walk(args) = command {
            let Some(Ok(names)) = target.to_str().map(str::parse::<FileNames>) else { continue };
            let [all, some] = walks.entry(target).or_default();
            files =
                args.frames.iter().flat_map(|frames| frames.iter()).map(|frame| names.of(frame)).collect();
            let other = if args.frames.is_none() { all.or(*some) } else { *all };
            if let Some(other) = other {
                return Err(shared(other, entry));
            }
            (if args.frames.is_none() { all } else { some }).get_or_insert(entry);
        }
        for file in files {
            if let Some(other) = written.insert(file, entry) {
                return Err(shared(other, entry));
            }
        }
    }
    Ok(())
}

fn shared(first: &Entry, second: &Entry) -> Failure {
    Failure::usage(anyhow!(
        "{}: {} and {} would write the same file: name another, or other frames",
        second.output.display(),
        first.place,
        second.place
    ))
}
