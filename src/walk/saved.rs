//! Records in a file beside the frames, so that a walk that was stopped goes on with the same.
//!
//! Layout: the key of the frame after which they were saved, a hash of the rest, both sixteen digits, and the records.

use crate::film::{ImageError, atomic};
use crate::scene::formats::fnv1a;
use std::fs;
use std::io::Write;
use std::path::Path;

/// Digits of a key and of a hash.
const DIGITS: usize = 16;

/// Writes records, saved after the frame of `key`, whole or not at all.
pub fn write(path: &Path, key: &str, records: &[u8]) -> Result<(), ImageError> {
    let written = atomic::write_atomically(path, |file| {
        write!(file, "{key}{:0DIGITS$x}", fnv1a(records))?;
        file.write_all(records)
    });
    written.map_err(|error| ImageError::Write { path: path.to_owned(), error })
}

/// Reads records and the key that they were saved with; `None` where there are none, or the file is damaged.
pub fn read(path: &Path) -> Option<(String, Vec<u8>)> {
    let mut file = fs::read(path).ok()?;
    let records = (file.len() >= 2 * DIGITS).then(|| file.split_off(2 * DIGITS))?;
    let (key, hash) = std::str::from_utf8(&file).ok()?.split_at_checked(DIGITS)?;
    (hash == format!("{:0DIGITS$x}", fnv1a(&records))).then(|| (key.to_owned(), records))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_are_read_as_they_were_written_and_damaged_ones_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.records");
        assert_eq!(read(&path), None);
        write(&path, "0123456789abcdef", b"records").unwrap();
        assert_eq!(read(&path), Some(("0123456789abcdef".to_owned(), b"records".to_vec())));
        let whole = fs::read(&path).unwrap();
        for length in 0..whole.len() {
            fs::write(&path, &whole[..length]).unwrap();
            assert_eq!(read(&path), None, "{length}");
        }
        let mut changed = whole;
        changed[2 * DIGITS + 1] ^= 1;
        fs::write(&path, changed).unwrap();
        assert_eq!(read(&path), None);
    }
}
