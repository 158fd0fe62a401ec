//! Scenes and settings at extremes, a module for each of them: pictures are right, or refused with a reason.
//!
//! `cargo test --test extremes chains::` runs those of a module.

#[path = "../behaviour/common.rs"]
mod common;

mod all_methods;
mod brightness;
mod chains;
mod distances;
mod memory;
mod numbers;
mod random;
mod random_scenes;
mod settings;
mod units;
