//! The renderers compared, one folder each; they share every stage they can.
