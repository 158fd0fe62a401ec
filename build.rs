//! Finds Embree.
fn main() {}
