//! Hierarchies over points on surfaces. Neighbours in space are neighbours in memory.
//!
//! - [`balanced`]: a kd-tree without pointers, which determines the order;
//! - [`wide`]: the same tree with sixteen children per node, for small queries.

mod balanced;
mod wide;

pub use balanced::KdTree;
pub use wide::{WideKdTree, least_lane};
