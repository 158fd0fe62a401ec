//! Scenes and settings at extremes, a module for each of them: pictures are right, or refused with a reason.
//!
//! `cargo test --test extremes numbers::` runs those of a module.

#[path = "../behaviour/common.rs"]
mod common;
mod numbers;
