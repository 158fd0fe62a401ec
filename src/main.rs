//! The `lightsplat` command.
fn main() {}
