//! The renderers compared, one folder each; they share every stage they can.

pub mod cache;
mod chosen;
mod counts;
pub mod lightcuts;
pub mod lights;
pub mod output;
pub mod path;
pub mod photon_cache;

pub use chosen::Method;
pub use output::Output;
