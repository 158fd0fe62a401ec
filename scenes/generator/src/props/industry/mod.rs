//! Plant of an industrial hall: machines, vessels, pipework, ways to walk, a crane, stores.

mod cabinet;
mod compressor;
mod crane;
mod lamps;
mod pipework;
mod pump;
mod steel;
mod stores;
mod tanks;
mod turbine;
mod ways;

pub use cabinet::cabinet;
pub use compressor::compressor;
pub use crane::crane;
pub use lamps::{uplight, work_light};
pub use pipework::{flange, hanger, joint, valve};
pub use pump::pump;
pub use steel::{angle_section, bar, bolt, channel_section, i_section};
pub use stores::{bench, cable_drum, crate_box, drum, gas_cylinder, pallet};
pub use tanks::{lying_tank, standing_tank};
pub use turbine::turbine_set;
pub use ways::{grating, ladder, railing, stairs};

/// Dull grey-green casings.
const CASING: &str = "machine_casings";
/// Machines painted in gloss.
const GLOSS: &str = "machine_gloss";
/// Shafts, couplings, bolts.
const BARE: &str = "machined_steel";
/// Pipes of the machines.
const PIPES: &str = "machine_pipes";
/// Handwheels and guards.
const RED: &str = "machine_guards";
/// Foundations.
const CONCRETE: &str = "foundations";
