//! Packings, widths and the coherent flag, by bare loops.

use super::MRAYS;
use super::trace::{Traces, count};
use crate::measure::Case;
use crate::setting::Setting;
use crate::{Clock, Settings, Table};
use embree::{PreparedRays, Width};
use std::hint::black_box;

pub fn table(setting: &Setting, traces: &Traces, settings: &Settings) -> Table {
    let accel = &setting.world.accel;
    let mut cases = Vec::new();
    for trace in traces.all().filter(|t| count(t.bundles()) > 0) {
        let against = cases.len();
        let rays = count(trace.bundles()) as f64;
        for width in Width::ALL {
            let packets = || trace.bundles().map(|p| (&p.rays, p.valid));
            for coherent in [false, true] {
                if width == Width::One && coherent {
                    continue;
                }
                let prepared = PreparedRays::new(packets(), width);
                let occluded = 100.0 * prepared.occluded(accel, coherent) as f64 / rays;
                let lanes = rays / prepared.queries().max(1) as f64;
                let labels = [trace.name, &width.rays().to_string(), if coherent { "coherent" } else { "" }];
                let work = move || {
                    black_box(prepared.occluded(accel, coherent));
                };
                let mut case = Case::new(&labels, against, rays, work);
                case.figures = vec![Some(lanes), Some(occluded)];
                cases.push(case);
            }
        }
    }
    Table::measured(
        (
            "Packings and widths",
            "Bare loops over Embree's queries. Ratio to single rays of the same packing.",
        ),
        (&["packing", "width", "flag"], "Mrays/s", &["rays a query", "occluded %"]),
        (Clock::Thread, settings, MRAYS),
        cases,
    )
}
