//! Images stored on disk under a key of all that they depend on.
//!
//! An image is an OpenEXR file with its key and its statistics as attributes. The file appears whole or not at all and
//! is flushed to the disk before it takes its name (see [`base::film::atomic`]), so that a crash loses only the image
//! being written. Files that cannot be read, or that have another key, count as missing.

use super::StudyError;
use base::film::{ExrFile, Film, Image, Layer, write_exr};
use readers::fnv1a;
use serde_json::Value;
use std::fmt::{self, Write};
use std::hash::{DefaultHasher, Hasher};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A folder of images.
pub(super) struct Store {
    folder: PathBuf,
}

/// An image with layers and statistics.
pub(super) struct Stored {
    /// The image.
    pub color: Image,
    /// Further images by name.
    pub layers: Vec<(String, Image)>,
    /// Statistics.
    pub facts: Value,
}

impl Store {
    /// Opens the folder `pictures` of `folder`, after creating both if they are missing.
    pub fn open(folder: &Path) -> Result<Store, StudyError> {
        let folder = folder.join("pictures");
        match std::fs::create_dir_all(&folder) {
            Ok(()) => Ok(Store { folder }),
            Err(source) => Err(StudyError::write(&folder, source)),
        }
    }

    /// Loads the image of that key, if there is one, with the named layers.
    pub fn load(&self, name: &str, key: &Value, layers: &[&str]) -> Option<Stored> {
        let file = ExrFile::read(&self.file(name, key)).ok()?;
        let metadata = file.metadata();
        let written = key.to_string();
        if metadata.text("key") != Some(written.as_str()) {
            return None;
        }
        let facts = serde_json::from_str(metadata.text("facts")?).ok()?;
        let layer = |name: &&str| Some(((*name).to_owned(), file.layer(name).ok()?));
        Some(Stored {
            color: file.color().ok()?,
            layers: layers.iter().map(layer).collect::<Option<_>>()?,
            facts,
        })
    }

    /// Stores an image.
    pub fn save(&self, name: &str, key: &Value, stored: &Stored) -> Result<(), StudyError> {
        let mut film = Film::new(stored.color.clone());
        film.layers.extend(stored.layers.iter().map(|(name, image)| Layer::color(name, image.clone())));
        film.remove_nonfinite();
        film.metadata.set("key", key.to_string());
        film.metadata.set("facts", stored.facts.to_string());
        write_exr(&self.file(name, key), &film).map_err(|error| StudyError::Output(error.to_string()))
    }

    fn file(&self, name: &str, key: &Value) -> PathBuf {
        let plain = |c: char| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' };
        let name: String = name.chars().map(plain).collect();
        self.folder.join(format!("{name}-{:016x}.exr", hash_debug(&key)))
    }
}

/// Returns a hash of this program's file, which tells its times from those of another build.
pub fn program() -> String {
    static PROGRAM: OnceLock<String> = OnceLock::new();
    let read = || std::env::current_exe().and_then(std::fs::read);
    let hash = |bytes: Vec<u8>| format!("{:016x}", fnv1a(&bytes));
    PROGRAM.get_or_init(|| read().map_or_else(|_| env!("CARGO_PKG_VERSION").to_owned(), hash)).clone()
}

/// Hash of a text in pieces.
#[derive(Default)]
struct HashedText(DefaultHasher);

impl Write for HashedText {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.write(text.as_bytes());
        Ok(())
    }
}

/// Returns the hash of a value's debug text, which holds every field and writes numbers exactly.
pub(super) fn hash_debug(value: &dyn fmt::Debug) -> u64 {
    let mut text = HashedText::default();
    // Hashing cannot fail.
    let _ = write!(text, "{value:?}");
    text.0.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::Rgb;
    use serde_json::json;

    #[test]
    fn images_are_found_by_their_whole_key_and_damaged_ones_are_missing() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).unwrap();
        // Inexact parsers read some of these as their neighbours.
        let numbers: Vec<f64> = (1..100).map(|n| f64::from(n).sqrt() / 7.0).collect();
        let mut color = Image::new(3, 2);
        color.pixels[4] = Rgb::new(1.0, 0.5, 7.25);
        let stored = Stored {
            color: color.clone(),
            layers: vec![("a".to_owned(), color.clone())],
            facts: json!({ "n": numbers }),
        };
        let key = json!({ "scene": 1, "method": "cache" });
        store.save("knot, cache", &key, &stored).unwrap();
        let found = store.load("knot, cache", &key, &["a"]).unwrap();
        assert_eq!((&found.color, &found.layers[0].1, &found.facts["n"]), (&color, &color, &json!(numbers)));
        assert!(store.load("knot, cache", &json!({ "scene": 2, "method": "cache" }), &[]).is_none());
        assert!(store.load("knot, cache", &key, &["b"]).is_none());

        let file = store.file("knot, cache", &key);
        let bytes = std::fs::read(&file).unwrap();
        std::fs::write(&file, &bytes[..bytes.len() / 2]).unwrap();
        assert!(store.load("knot, cache", &key, &[]).is_none());
    }
}
