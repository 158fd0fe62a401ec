//! Pictures stored on disk under a key of all that they depend on.
//!
//! A picture is an OpenEXR file with its key and its statistics as attributes. It appears whole or not at all
//! and is flushed to the disk before it takes its name (see [`base::film::atomic`]), so that a crash loses
//! only the picture being written. Files that cannot be read, or whose key is not the one asked for, count as
//! missing.

use super::StudyError;
use base::film::{ExrFile, Film, Image, Layer, write_exr};
use serde_json::Value;
use std::fmt::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A folder of pictures.
pub(super) struct Store {
    folder: PathBuf,
}

/// A picture with layers and statistics.
pub(super) struct Kept {
    /// The picture.
    pub color: Image,
    /// Further images by name.
    pub layers: Vec<(String, Image)>,
    /// Statistics.
    pub facts: Value,
}

impl Store {
    /// Opens the folder `pictures` of `folder`; creates both if they are missing.
    pub fn open(folder: &Path) -> Result<Store, StudyError> {
        let folder = folder.join("pictures");
        match std::fs::create_dir_all(&folder) {
            Ok(()) => Ok(Store { folder }),
            Err(source) => Err(StudyError::Folder { path: folder, source }),
        }
    }

    /// Loads the picture of that key, if stored, with the layers named.
    pub fn load(&self, name: &str, key: &Value, layers: &[&str]) -> Option<Kept> {
        let file = ExrFile::read(&self.file(name, key)).ok()?;
        let metadata = file.metadata();
        let written = key.to_string();
        if metadata.text("key") != Some(written.as_str()) {
            return None;
        }
        let facts = serde_json::from_str(metadata.text("facts")?).ok()?;
        let layer = |name: &&str| Some(((*name).to_owned(), file.layer(name).ok()?));
        Some(Kept {
            color: file.color().ok()?,
            layers: layers.iter().map(layer).collect::<Option<_>>()?,
            facts,
        })
    }

    /// Stores a picture.
    pub fn save(&self, name: &str, key: &Value, kept: &Kept) -> Result<(), StudyError> {
        let mut film = Film::new(kept.color.clone());
        film.layers.extend(kept.layers.iter().map(|(name, image)| Layer::color(name, image.clone())));
        film.remove_nonfinite();
        film.metadata.set("key", key.to_string());
        film.metadata.set("facts", kept.facts.to_string());
        write_exr(&self.file(name, key), &film).map_err(StudyError::Write)
    }

    fn file(&self, name: &str, key: &Value) -> PathBuf {
        let plain = |c: char| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' };
        let name: String = name.chars().map(plain).collect();
        self.folder.join(format!("{name}-{:016x}.exr", hash(&key)))
    }
}

/// Returns a hash of this program's file, so that times of another build are not taken for its own.
pub fn program() -> String {
    static PROGRAM: OnceLock<String> = OnceLock::new();
    let read = || std::env::current_exe().and_then(std::fs::read);
    PROGRAM
        .get_or_init(|| match read() {
            Ok(bytes) => {
                let mut fnv = Fnv::default();
                fnv.eat(&bytes);
                format!("{:016x}", fnv.0)
            }
            Err(_) => env!("CARGO_PKG_VERSION").to_owned(),
        })
        .clone()
}

/// Returns the hash of a value's text.
pub(super) fn hash(value: &dyn fmt::Display) -> u64 {
    let mut fnv = Fnv::default();
    // Hashing cannot fail.
    let _ = write!(fnv, "{value}");
    fnv.0
}

/// Returns the hash of a value's debug text, which holds every field and writes numbers exactly.
pub(super) fn hash_debug(value: &dyn fmt::Debug) -> u64 {
    let mut fnv = Fnv::default();
    let _ = write!(fnv, "{value:?}");
    fnv.0
}

/// 64-bit FNV-1a hash of text in pieces.
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Fnv {
        Fnv(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    fn eat(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

impl Write for Fnv {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.eat(text.as_bytes());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::Rgb;
    use serde_json::json;

    #[test]
    fn pictures_are_found_by_their_whole_key_and_damaged_ones_are_missing() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).unwrap();
        // Inexact parsers read some of these as their neighbours.
        let numbers: Vec<f64> = (1..100).map(|n| f64::from(n).sqrt() / 7.0).collect();
        let mut color = Image::new(3, 2);
        color.pixels[4] = Rgb::new(1.0, 0.5, 7.25);
        let kept = Kept {
            color: color.clone(),
            layers: vec![("a".to_owned(), color.clone())],
            facts: json!({ "n": numbers }),
        };
        let key = json!({ "scene": 1, "method": "cache" });
        store.save("knot, cache", &key, &kept).unwrap();
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
