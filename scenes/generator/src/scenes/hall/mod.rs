//! `hall`: an industrial hall with a sawtooth roof, a travelling crane, a turbine set, pumps, tanks, pipework
//! and a catwalk. Most of the light comes from bowls that are aimed at the roof, so that it reaches the
//! machines only indirectly; about a tenth of the area is glossy.
//!
//! Units: metres; 40 m long, 24 m wide, 13 m to the ridges.

mod access;
mod crane;
mod envelope;
mod lamps;
mod machines;
mod pipework;
mod plan;
mod services;
mod steel;
mod stores;
mod structure;
mod tanks;

use crate::shapes::Part;
use crate::shapes::{at, turned};
use glam::Vec3;

/// The parts of the hall.
pub fn parts() -> Vec<Part> {
    let [mut frame, mut rails] = [Part::default(), Part::default()];
    structure::build(&mut frame, &mut rails);
    let mut envelope = envelope::Parts::default();
    envelope::build(&mut envelope);
    let mut access = access::Parts::default();
    access::build(&mut access);
    let mut crane = crane::Parts::default();
    crane::build(&mut crane);
    let mut machines = machines::Parts::default();
    machinery(&mut machines);
    let mut tanks = tanks::Parts::default();
    vessels(&mut tanks);
    let mut services = services::Parts::default();
    services::build(&mut services);
    let mut stores = stores::Parts::default();
    stores::build(&mut stores);
    let mut lamps = lamps::Parts::default();
    lamps::build(&mut lamps);
    [
        ("frame", frame),
        ("crane_rails", rails),
        ("floor", envelope.floor),
        ("floor_joints", envelope.joints),
        ("floor_marks", envelope.floor_marks),
        ("concrete_wall", envelope.concrete),
        ("cladding", envelope.cladding),
        ("roof_sheets", envelope.roof),
        ("window_frames", envelope.frames),
        ("sky_panes", envelope.sky),
        ("shutter", envelope.shutter),
        ("walkway_steel", access.steel),
        ("gratings", access.grating),
        ("railings", access.railing),
        ("crane_paint", crane.paint),
        ("crane_steel", crane.bare),
        ("machine_casings", machines.casing),
        ("machine_gloss", machines.gloss),
        ("machined_steel", machines.bare),
        ("machine_pipes", machines.pipes),
        ("machine_guards", machines.red),
        ("foundations", machines.concrete),
        ("tank_shells", tanks.shells),
        ("tank_frames", tanks.frames),
        ("tank_pipes", tanks.pipes),
        ("tank_handwheels", tanks.red),
        ("rack_pipes", services.pipes),
        ("rack_pipes_bright", services.bright),
        ("duct", services.duct),
        ("brackets", services.brackets),
        ("cables", services.cables),
        ("cabinets", services.cabinets),
        ("rack_handwheels", services.red),
        ("timber", stores.timber),
        ("drums_blue", stores.drums_blue),
        ("drums_rust", stores.drums_rust),
        ("gas_cylinders", stores.cylinders),
        ("bench_steel", stores.steel),
        ("drum_cable", stores.cable),
        ("lamp_housings", lamps.housings),
        ("lamp_rods", lamps.rods),
        ("uplights", lamps.uplights),
        ("work_lights", lamps.work_lights),
    ]
    .map(|(name, part)| Part { name: name.to_owned(), ..part })
    .into()
}

fn machinery(parts: &mut machines::Parts) {
    machines::turbine_set(parts, Vec3::new(-4.3, 0.0, -8.5));
    for k in 0..4 {
        machines::pump(parts, &turned(90.0, Vec3::new(-10.0, 0.0, -15.5 - 2.6 * k as f32)));
    }
    machines::compressor(parts, &turned(-20.0, Vec3::new(3.6, 0.0, -31.0)));
    machines::compressor(parts, &turned(-20.0, Vec3::new(-1.2, 0.0, -32.5)));
}

fn vessels(parts: &mut tanks::Parts) {
    for (k, z) in [-13.2, -17.6, -22.0].into_iter().enumerate() {
        tanks::standing(parts, &turned(-12.0 + 9.0 * k as f32, Vec3::new(7.0, 0.0, z)), 1.45, 3.4);
    }
    tanks::lying(parts, &at(7.4, 0.0, -34.6), 1.2, 4.6);
}
