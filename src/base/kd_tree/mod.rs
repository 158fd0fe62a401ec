//! Hierarchies over points on surfaces, in an order in which neighbours in space are neighbours in memory.
//!
//! - [`balanced`]: a kd-tree without pointers, which gives the order;
//! - [`wide`]: the same with sixteen children a node, for many small queries.

mod balanced;
mod wide;

pub use balanced::KdTree;
pub use wide::WideKdTree;
