//! Atomic writing of files.
//!
//! The bytes go to a temporary file in the target's folder, which is flushed to the disk and then renamed to the
//! target. The folder is flushed last. So a full disk, an error or a kill at any moment leaves the former content of
//! the target. After a kill, a hidden `.NAME.*.tmp` may remain until the file is written again.

use super::ImageError;
use rustix::fs::{FlockOperation, flock};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Checks that a file at `path` is not write-protected.
///
/// # Errors
/// If the file exists and nobody may write to it.
pub fn check_unprotected(path: &Path) -> Result<(), ImageError> {
    let present = resolve(path).and_then(fs::metadata);
    if present.is_ok_and(|present| present.is_file() && present.permissions().readonly()) {
        let reason = "the file is write-protected; run chmod u+w on it, or name another file".to_owned();
        return Err(ImageError::Output { path: path.to_owned(), reason });
    }
    Ok(())
}

/// Checks that `path` can be written, by creating and removing a temporary file.
///
/// To be called before long work. Not guaranteed: that the disk still has room, or the folder its permissions, when the
/// work is done.
///
/// # Errors
/// If a file cannot be created there, or an existing file cannot be replaced.
///
/// Not guaranteed: that the disk still has room, or the folder its permissions, when the work is done.
pub fn check_writable(path: &Path) -> Result<(), ImageError> {
    check_place(path)?;
    check_unprotected(path)
}

/// Checks that a new file can be created at `path`, without checking the protection of an existing one.
///
/// # Errors
/// If a file cannot be created there.
pub fn check_place(path: &Path) -> Result<(), ImageError> {
    let refuse = |reason: String| Err(ImageError::Output { path: path.to_owned(), reason });
    if path.file_name().is_none() {
        return refuse("the path does not end in a file name".to_owned());
    }
    let target = match resolve(path) {
        Ok(target) => target,
        Err(error) => return refuse(error.to_string()),
    };
    let present = fs::metadata(&target).ok();
    match &present {
        Some(present) if present.is_dir() => return refuse("this is a folder; name a file in it".to_owned()),
        Some(present) if !present.is_file() => return refuse("this is not a regular file".to_owned()),
        _ => {}
    }
    let folder = folder_of(&target);
    match fs::metadata(&folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return refuse(format!("the folder {} does not exist; create it first", folder.display()));
        }
        Err(error) => return refuse(format!("the folder {}: {error}", folder.display())),
        Ok(present) if !present.is_dir() => return refuse(format!("{} is not a folder", folder.display())),
        Ok(_) => {}
    }
    if let Err(error) = fs::symlink_metadata(&target)
        && error.kind() != io::ErrorKind::NotFound
    {
        return refuse(format!("{error}; name another file"));
    }
    let removed_on_drop = match temporary(&target) {
        Ok(temporary) => temporary,
        Err(error) => return refuse(format!("no file can be created in {}: {error}", folder.display())),
    };
    #[cfg(unix)]
    if let Some(present) = present
        && let Some(reason) = irreplaceable(&target, &present, &folder, &removed_on_drop)
    {
        return refuse(reason.to_owned());
    }
    drop(removed_on_drop);
    Ok(())
}

/// Returns the reason why an existing file cannot be replaced, though its folder accepts new files.
#[cfg(unix)]
fn irreplaceable(
    target: &Path,
    present: &fs::Metadata,
    folder: &Path,
    own: &NamedTempFile,
) -> Option<&'static str> {
    use std::os::unix::fs::MetadataExt;
    const STICKY: u32 = 0o1000;
    const EPERM: i32 = 1;
    let (folder, own) = (fs::metadata(folder).ok()?, own.as_file().metadata().ok()?);
    let is_others = own.uid() != 0 && ![present.uid(), folder.uid()].contains(&own.uid());
    if folder.mode() & STICKY != 0 && is_others {
        return Some("another user owns the file, and only the owner may replace files in this folder");
    }
    // Lack of permission to write into the old file is another error, which does not prevent replacing it.
    let opened = File::options().append(true).open(target);
    opened
        .is_err_and(|error| error.raw_os_error() == Some(EPERM))
        .then_some("the file is marked as immutable")
}

/// Replaces the file at `path` by the output of `write`, completely or not at all.
///
/// Symbolic links are followed. The permissions of an existing file are kept. If the new file cannot be renamed to the
/// target, it stays beside it, and the error names it.
///
/// # Errors
/// If `write` fails, or the operating system does. The former content is then unchanged.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> io::Result<()> {
    let target = resolve(path)?;
    let temporary = temporary(&target)?;
    let mut buffered = BufWriter::new(temporary.as_file());
    write(&mut buffered)?;
    buffered.flush()?;
    drop(buffered);
    if let Ok(present) = fs::metadata(&target) {
        temporary.as_file().set_permissions(present.permissions())?;
    }
    temporary.as_file().sync_all()?;
    temporary.persist(&target).map_err(|failed| match keep(failed.file) {
        Ok(kept) => io::Error::new(
            failed.error.kind(),
            format!("{}; the new data is in {}", failed.error, kept.display()),
        ),
        Err(_) => failed.error,
    })?;
    let folder = folder_of(&target);
    remove_leftovers(&target, &folder);
    sync_folder(&folder)
}

/// Renames a temporary file to a permanent name.
fn keep(file: NamedTempFile) -> io::Result<PathBuf> {
    let (_, temporary) = file.keep()?;
    let kept = temporary.with_extension("kept");
    fs::rename(&temporary, &kept).map(|()| kept)
}

fn temporary(target: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    let prefix = prefix_of(target);
    builder.prefix(&prefix).suffix(SUFFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Permissions of new files with the umask applied. The default would be private to the user.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let file = builder.tempfile_in(folder_of(target)).map_err(without_path)?;
    lock(file.as_file());
    Ok(file)
}

/// Returns the error without the name of the temporary file.
fn without_path(error: io::Error) -> io::Error {
    let text = error.to_string();
    let reason = text.split_once(" at path ").map_or(text.as_str(), |(reason, _)| reason);
    io::Error::new(error.kind(), reason)
}

/// Returns the file behind symbolic links. The file need not exist.
pub fn resolve(path: &Path) -> io::Result<PathBuf> {
    const MAX_LINKS: usize = 40;
    let mut target = path.to_owned();
    for _ in 0..MAX_LINKS {
        match fs::read_link(&target) {
            Ok(next) => target = folder_of(&target).join(next),
            Err(_) => {
                // The file and its folder need not exist.
                let folder = folder_of(&target);
                let folder = fs::canonicalize(&folder).unwrap_or(folder);
                return Ok(target.file_name().map_or(target.clone(), |name| folder.join(name)));
            }
        }
    }
    Err(io::Error::other("its symbolic links form a cycle"))
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => PathBuf::from("."),
    }
}

fn sync_folder(folder: &Path) -> io::Result<()> {
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        // Some file systems cannot flush folders, and some folders cannot be opened. The file is in place anyway.
        Err(error) if error.kind() == io::ErrorKind::InvalidInput => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::Unsupported => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::PermissionDenied => Ok(()),
        other => other,
    }
}

/// Suffix of the names of temporary files.
const SUFFIX: &str = ".tmp";

/// Returns the prefix of the names of a file's temporary files.
fn prefix_of(target: &Path) -> String {
    // File names have at most 255 bytes.
    let name: String = target.file_name().unwrap_or_default().to_string_lossy().chars().take(40).collect();
    format!(".{name}.")
}

/// Locks a temporary file until it is closed; returns false if another process has locked it.
fn lock(file: &File) -> bool {
    flock(file, FlockOperation::NonBlockingLockExclusive).is_ok()
}

/// Removes the temporary files of `target` in `folder` that nobody writes. Failures are ignored.
fn remove_leftovers(target: &Path, folder: &Path) {
    let prefix = prefix_of(target);
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let is_temporary =
            name.to_str().is_some_and(|name| name.starts_with(&prefix) && name.ends_with(SUFFIX));
        if is_temporary && File::open(entry.path()).is_ok_and(|file| lock(&file)) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_failing_writer_leaves_the_old_file_and_no_litter() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.exr");
        fs::write(&path, "old").unwrap();
        let result = write_atomically(&path, |file| {
            file.write_all(&[7; 100_000])?;
            Err(io::Error::new(io::ErrorKind::StorageFull, "no room"))
        });
        assert_eq!(result.unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(names(folder.path()), ["picture.exr"]);
    }

    #[test]
    fn leftovers_of_the_same_file_go_and_what_others_write_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for name in [".a.exr.Xyz123.tmp", ".b.exr.Xyz123.tmp", ".a.exr.Xyz123.kept"] {
            fs::write(path(name), "").unwrap();
        }
        let other = temporary(&path("a.exr")).unwrap();
        write_atomically(&path("a.exr"), |file| file.write_all(b"new")).unwrap();
        assert!(other.path().exists());
        drop(other);
        assert_eq!(names(folder.path()), [".a.exr.Xyz123.kept", ".b.exr.Xyz123.tmp", "a.exr"]);
    }

    #[test]
    fn the_old_file_is_whole_until_the_new_one_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.exr");
        fs::write(&path, "old").unwrap();
        write_atomically(&path, |file| {
            file.write_all(b"new")?;
            file.flush()?;
            assert_eq!(fs::read_to_string(&path)?, "old");
            Ok(())
        })
        .unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(names(folder.path()), ["picture.exr"]);
    }

    #[cfg(unix)]
    #[test]
    fn links_and_permissions_survive_and_new_files_are_not_private() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let [real, link, plain, new] = ["real", "link", "plain", "new"].map(|name| folder.path().join(name));
        fs::write(&real, "old").unwrap();
        fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        write_atomically(&link, |file| file.write_all(b"new")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&real).unwrap(), "new");
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&real), 0o640);
        fs::write(&plain, "").unwrap();
        write_atomically(&new, |file| file.write_all(b"new")).unwrap();
        assert_eq!(mode(&new), mode(&plain));
    }

    #[cfg(unix)]
    #[test]
    fn links_to_nothing_are_followed_and_circles_of_links_refused() {
        let folder = tempfile::tempdir().unwrap();
        let [new, link, circle] = ["new", "link", "circle"].map(|name| folder.path().join(name));
        std::os::unix::fs::symlink("new", &link).unwrap();
        std::os::unix::fs::symlink("circle", &circle).unwrap();
        check_writable(&link).unwrap();
        write_atomically(&link, |file| file.write_all(b"new")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&new).unwrap(), "new");
        assert!(check_writable(&circle).unwrap_err().to_string().contains("circle"));
        assert!(write_atomically(&circle, |_| Ok(())).is_err());
    }

    #[test]
    fn names_as_long_as_they_may_be_are_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x".repeat(255));
        check_writable(&path).unwrap();
        write_atomically(&path, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        for longer in ["x".repeat(256), "é".repeat(128), format!("{}/a.exr", "x".repeat(256))] {
            let refused = check_place(&folder.path().join(longer)).unwrap_err().to_string();
            assert!(refused.contains("too long"), "{refused}");
        }
    }

    #[test]
    fn content_that_cannot_take_its_name_is_kept_and_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.exr");
        let failed = write_atomically(&path, |file| {
            // A folder takes the name meanwhile.
            fs::create_dir(&path)?;
            file.write_all(b"new")
        });
        let message = failed.unwrap_err().to_string();
        let kept = names(folder.path()).into_iter().find(|name| name.ends_with(".kept")).unwrap();
        assert!(message.contains(&kept), "{message}");
        assert_eq!(fs::read_to_string(folder.path().join(kept)).unwrap(), "new");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn folders_that_cannot_be_opened_take_files_all_the_same() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let set = |mode| fs::set_permissions(folder.path(), fs::Permissions::from_mode(mode)).unwrap();
        set(0o300);
        let written = write_atomically(&folder.path().join("new"), |file| file.write_all(b"new"));
        set(0o700);
        written.unwrap();
    }

    #[test]
    fn unwritable_places_are_refused_beforehand_with_the_reason() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "kept").unwrap();
        let reason = |path: &Path| check_writable(path).unwrap_err().to_string();
        assert!(reason(&folder.path().join("none/a.exr")).contains("does not exist"));
        assert!(reason(folder.path()).contains("is a folder"));
        assert!(reason(&file.join("a.exr")).contains("file"));
        assert!(reason(Path::new("..")).contains("file name"));
        check_writable(&file).unwrap();
        check_writable(&folder.path().join("new.exr")).unwrap();
        let mut permissions = fs::metadata(&file).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&file, permissions).unwrap();
        check_place(&file).unwrap();
        assert!(reason(&file).contains("chmod u+w"));
        assert_eq!(fs::read_to_string(&file).unwrap(), "kept");
        assert_eq!(names(folder.path()), ["file"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn devices_and_kernel_folders_are_refused() {
        assert!(check_writable(Path::new("/dev/null")).is_err());
        let refused = check_writable(Path::new("/proc/picture.exr")).unwrap_err().to_string();
        assert!(!refused.contains(".tmp"), "{refused}");
    }
}
