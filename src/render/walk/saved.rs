//! Records in a file beside the frames, so that an interrupted walk resumes with the same records.
//!
//! Long walks have hundreds of megabytes of records. They are saved so often that saving takes a small part of the
//! time. Frames after the last save are rendered again for their records.
//!
//! Layout: the key of the last frame before the save, a hash of the records (both sixteen digits), and the records.

use base::film::{ImageError, atomic};
use readers::fnv1a;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant};

/// Number of digits of a key, and of a hash.
const DIGITS: usize = 16;

/// Minimum time between saves, over the time of a save.
const BETWEEN: u32 = 20;

/// The pace at which records are saved.
#[derive(Default)]
pub struct Pace {
    /// End of the last save, and the time that it took.
    last: Option<(Instant, Duration)>,
}

impl Pace {
    /// True if it is time to save.
    pub fn is_due(&self, now: Instant) -> bool {
        self.last.is_none_or(|(end, took)| now.duration_since(end) >= took * BETWEEN)
    }

    /// Records the times of a save.
    pub fn saved(&mut self, begun: Instant, end: Instant) {
        self.last = Some((end, end.duration_since(begun)));
    }
}

/// Writes records that were saved after the frame of `key`, completely or not at all.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, key: &str, records: &[u8]) -> Result<(), ImageError> {
    let written = atomic::write_atomically(path, |file| {
        write!(file, "{key}{:0DIGITS$x}", fnv1a(records))?;
        file.write_all(records)
    });
    written.map_err(|error| ImageError::Write { path: path.to_owned(), error })
}

/// Reads records and their key; `None` if there is no file, or if it is damaged.
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
    fn saving_takes_a_twentieth_of_the_time() {
        let mut pace = Pace::default();
        let start = Instant::now();
        let at = |seconds| start + Duration::from_secs(seconds);
        assert!(pace.is_due(start));
        pace.saved(start, at(2));
        assert!(!pace.is_due(at(41)) && pace.is_due(at(42)));
    }

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
