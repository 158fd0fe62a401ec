//! Hemispherical harmonics: virtual lights added to a series per second, and evaluations of the reflected radiance.

use super::lit_scene::Dice;
use super::measure::{Case, Clock, measure};
use super::{Benchmark, Context, Kind, Table};
use base::math::Rgb;
use glam::Vec3;
use std::hint::black_box;
use transport::gradient::{Incidence, LocalVpl};
use transport::hsh::{Accumulator, Kernel, Reflected};

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "hsh",
    about: "Hemispherical harmonics: lights added to a series per second, and look-ups",
    kind: Kind::Parts { needs_scene: false, run },
};

/// Number of lights.
const LIGHTS: usize = 1000;

fn run(context: &Context) -> Vec<Table> {
    let mut dice = Dice(5);
    let sources: Vec<LocalVpl> = (0..LIGHTS).map(|_| source(&mut dice)).collect();
    let incidences: Vec<Incidence> = sources.iter().filter_map(|s| s.incidence(1e-9)).collect();
    let (incidences, lights) = (&incidences, incidences.len() as f64);
    let mut cases = vec![Case::new(&["geometry and gradient", ""], 0, LIGHTS as f64, || {
        sources.iter().for_each(|s| {
            black_box(s.incidence(1e-9));
        });
    })];
    for bands in 1..=8 {
        let mut accumulator = Accumulator::new(bands);
        cases.push(Case::new(&["add a light", &bands.to_string()], 1, lights, move || {
            incidences.iter().for_each(|i| accumulator.add(i, Rgb::ONE));
            black_box(accumulator.finish());
        }));
    }
    for bands in 1..=8 {
        let mut accumulator = Accumulator::new(bands);
        incidences.iter().for_each(|i| accumulator.add(i, Rgb::ONE));
        let (radiance, kernel) = (accumulator.finish(), Kernel::cosine(bands));
        cases.push(Case::new(&["look up", &bands.to_string()], 9, LIGHTS as f64, move || {
            for _ in 0..LIGHTS {
                black_box::<Reflected>(black_box(&radiance).reflected(black_box(&kernel)));
            }
        }));
    }
    let table = Table {
        title: "Hemispherical harmonics",
        about: "Ratio to one band.",
        labels: &["what", "bands"],
        unit: "M/s",
        ..Table::default()
    };
    vec![measure(table, Clock::Thread, cases, &context.settings)]
}

/// Returns a random light above the receiver that roughly faces it.
fn source(dice: &mut Dice) -> LocalVpl {
    let mut part = || dice.unit();
    let offset = Vec3::new(part() - 0.5, part() - 0.5, part());
    let normal = (Vec3::new(part() - 0.5, part() - 0.5, part() - 0.5) - offset).normalize();
    LocalVpl::Oriented { offset: offset.to_array(), normal: normal.to_array() }
}
