//! Files that appear whole or not at all.
//!
//! The bytes go to a temporary file in the target's folder, are flushed to the disk, and only then take the
//! target's name; the folder is flushed last. A full disk, an error half-way or a kill at any moment leaves
//! the target's former content. After a kill, a hidden `.NAME.*.tmp` may remain beside it.

use super::ImageError;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Checks, by creating and removing a temporary file, that `path` can be written; call it before hours of work.
///
/// Not guaranteed: that the disk still has room, or the folder its permissions, when the work is done.
pub fn check_writable(path: &Path) -> Result<(), ImageError> {
    let refuse = |reason: String| Err(ImageError::Output { path: path.to_owned(), reason });
    if path.file_name().is_none() {
        return refuse("the path does not end in a file name".to_owned());
    }
    let target = resolve(path);
    match fs::metadata(&target) {
        Ok(present) if present.is_dir() => return refuse("it is a folder; name a file in it".to_owned()),
        Ok(present) if !present.is_file() => return refuse("it is not a regular file".to_owned()),
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
    match temporary(&target) {
        Ok(_removed_on_drop) => Ok(()),
        Err(error) => refuse(format!("no file can be created in {}: {error}", folder.display())),
    }
}

/// Replaces the file at `path` by the output of `write`, whole or not at all.
///
/// A symbolic link is followed; the permissions of a file already there are kept.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> io::Result<()> {
    let target = resolve(path);
    let temporary = temporary(&target)?;
    let mut buffered = BufWriter::new(temporary.as_file());
    write(&mut buffered)?;
    buffered.flush()?;
    drop(buffered);
    if let Ok(present) = fs::metadata(&target) {
        temporary.as_file().set_permissions(present.permissions())?;
    }
    temporary.as_file().sync_all()?;
    temporary.persist(&target).map_err(|error| error.error)?;
    sync_folder(&folder_of(&target))
}

fn temporary(target: &Path) -> io::Result<NamedTempFile> {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    let mut builder = tempfile::Builder::new();
    let prefix = format!(".{name}.");
    builder.prefix(&prefix).suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Permissions of any newly created file, the umask applied; the default would be private to the user.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder_of(target))
}

/// Returns the file behind a symbolic link, so that the link itself stays.
fn resolve(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => PathBuf::from("."),
    }
}

fn sync_folder(folder: &Path) -> io::Result<()> {
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        // Some file systems cannot flush folders; there is no remedy.
        Err(error) if error.kind() == io::ErrorKind::InvalidInput => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::Unsupported => Ok(()),
        other => other,
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
        assert_eq!(fs::read_to_string(&file).unwrap(), "kept");
        assert_eq!(names(folder.path()), ["file"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn devices_and_kernel_folders_are_refused() {
        assert!(check_writable(Path::new("/dev/null")).is_err());
        assert!(check_writable(Path::new("/proc/picture.exr")).is_err());
    }
}
