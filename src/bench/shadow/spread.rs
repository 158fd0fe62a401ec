//! When packets towards one light pay: by how many rays they hold, and by how far apart the rays are.

use super::MRAYS;
use super::trace::{Packet, Traces, count};
use crate::bench::measure::Case;
use crate::bench::setting::Setting;
use crate::bench::{Clock, Settings, Table};
use crate::embree::{Prepared, Width};
use crate::math::lanes_in;
use std::hint::black_box;

/// Upper limits of the spreads told apart.
const SPREADS: [f32; 6] = [0.01, 0.03, 0.1, 0.3, 1.0, f32::INFINITY];
/// Upper limits of the numbers of rays told apart.
const LANES: [u32; 4] = [2, 4, 8, 16];
/// Fewer rays than this say nothing.
const LEAST: u64 = 1000;

pub fn table(setting: &Setting, traces: &Traces, settings: &Settings) -> Table {
    let accel = &setting.world.accel;
    let mut cases = Vec::new();
    for [_, trace] in &traces.refined {
        for (l, &lanes) in LANES.iter().enumerate() {
            for (s, &spread) in SPREADS.iter().enumerate() {
                let fewest = if l == 0 { 0 } else { LANES[l - 1] };
                let least = if s == 0 { 0.0 } else { SPREADS[s - 1] };
                let inside = |p: &&Packet| {
                    let (n, at) = (p.valid.count_ones(), spread_of(p));
                    n > fewest && n <= lanes && at >= least && at < spread
                };
                let chosen: Vec<&Packet> = trace.bundles().filter(inside).collect();
                let rays = count(chosen.iter().copied());
                if rays < LEAST {
                    continue;
                }
                let against = cases.len();
                for (width, coherent) in
                    [(Width::One, false), (Width::Sixteen, false), (Width::Sixteen, true)]
                {
                    let prepared = Prepared::new(chosen.iter().map(|p| (&p.rays, p.valid)), width);
                    let how = format!("{}{}", width.rays(), if coherent { " coherent" } else { "" });
                    let labels = [trace.name, &format!("up to {lanes}"), &format!("below {spread}"), &how];
                    let mut case = Case::new(&labels, against, rays as f64, move || {
                        black_box(prepared.occluded(accel, coherent));
                    });
                    case.figures = vec![Some(100.0 * rays as f64 / trace.rays() as f64)];
                    cases.push(case);
                }
            }
        }
    }
    Table::measured(
        (
            "Packets by size and spread",
            "Packets that shared cuts ask for. The spread is the distance of the furthest receiver from the first over \
             the length of the shortest ray. Ratio to single rays of the same packets.",
        ),
        (&["order", "rays", "spread", "traced"], "Mrays/s", &["share of rays %"]),
        (Clock::Thread, settings, MRAYS),
        cases,
    )
}

fn spread_of(packet: &Packet) -> f32 {
    let Some(first) = lanes_in(packet.valid).next() else { return 0.0 };
    let first = packet.rays.get(first).origin;
    let rays = || lanes_in(packet.valid).map(|lane| packet.rays.get(lane));
    let furthest = rays().map(|r| r.origin.distance_squared(first)).fold(0.0, f32::max);
    let shortest = rays().map(|r| r.direction.length_squared()).fold(f32::INFINITY, f32::min);
    (furthest / shortest).sqrt()
}
