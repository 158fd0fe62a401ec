//! Machinery: a turbine set on its foundation, motor-driven pumps, a flywheel compressor.

mod driven;
mod turbine;

use crate::shapes::Part;
use glam::Vec2;

pub use driven::{compressor, pump};
pub use turbine::turbine_set;

/// What machines are made of.
#[derive(Default)]
pub struct Parts {
    /// Dull grey-green casings.
    pub casing: Part,
    /// Machines painted in gloss.
    pub gloss: Part,
    /// Bare machined steel: shafts, couplings, flanges.
    pub bare: Part,
    /// Pipes of the machines.
    pub pipes: Part,
    /// Handwheels and guards.
    pub red: Part,
    /// Foundations.
    pub concrete: Part,
}

fn profile(points: &[(f32, f32)]) -> Vec<Vec2> {
    points.iter().map(|&(x, y)| Vec2::new(x, y)).collect()
}
