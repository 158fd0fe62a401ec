//! Foundation of all crates: what knows nothing of scenes.
//!
//! - [`math`]: colours, frames, lanes and real functions; [`sampling`]: random numbers;
//! - [`parallel`], [`progress`], [`stats`]: threads, cancellation, counters and times; [`live`]: images in the making;
//! - [`setting`]: settings, each declared once; [`kd_tree`]: search for near points;
//! - [`file_kind`]: what a file is by its first bytes; [`shown`]: text for terminals;
//! - [`exr_file`]: reader of OpenEXR files; [`film`]: images, their layers, files and error measures.

#![forbid(unsafe_code)]

pub mod exr_file;
pub mod file_kind;
pub mod film;
pub mod kd_tree;
pub mod live;
pub mod math;
pub mod parallel;
pub mod progress;
pub mod sampling;
pub mod setting;
pub mod shown;
pub mod stats;
