//! Outputs of a batch: no two entries may write the same file.

use super::args::Command;
use super::batch_file::JobEntry;
use super::exit::Failure;
use super::still_files::StillFiles;
use super::views;
use anyhow::anyhow;
use base::film::atomic;
use render::walk::FileNames;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Refuses two entries that would write the same file. Walks with different frames may share a name.
pub fn check_apart(entries: &[JobEntry]) -> Result<(), Failure> {
    let mut written: BTreeMap<PathBuf, &JobEntry> = BTreeMap::new();
    // Walks by the name pattern of their files: the first walk of the whole path, and the first walk of listed frames.
    let mut walks: BTreeMap<PathBuf, [Option<&JobEntry>; 2]> = BTreeMap::new();
    for entry in entries {
        // The check of an entry reports its other errors.
        let Ok(command) = entry.command() else { continue };
        if let Command::Views(args) = &command {
            for file in views::files(args).unwrap_or_default() {
                let Ok(file) = atomic::resolve(&file) else { continue };
                if let Some(other) = written.insert(file, entry) {
                    return Err(shared(other, entry));
                }
            }
            continue;
        }
        let output = match &command {
            Command::Render(args) => StillFiles::new(args).map(|files| files.main().to_owned()).ok(),
            _ => Some(entry.output.clone()),
        };
        let Some(Ok(target)) = output.map(|path| atomic::resolve(&path)) else { continue };
        let mut files = vec![target.clone()];
        if let Command::Walk(args) = command {
            let Some(Ok(names)) = target.to_str().map(str::parse::<FileNames>) else { continue };
            let [all, some] = walks.entry(target).or_default();
            files =
                args.frames.iter().flat_map(|frames| frames.iter()).map(|frame| names.file(frame)).collect();
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

fn shared(first: &JobEntry, second: &JobEntry) -> Failure {
    Failure::usage(anyhow!(
        "{}: {} and {} would write the same file; change the name or the frames of one",
        second.output.display(),
        first.place,
        second.place
    ))
}
