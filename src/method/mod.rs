//! The renderers compared, one folder each; they share every stage they can.

pub mod cache;
pub mod control;
pub mod lightcuts;
pub mod output;
pub mod path;

pub use control::{Control, Progress};
pub use output::Output;
