//! Build qualities: cost and gain of better hierarchies.

use super::MRAYS;
use super::trace::{Traces, count};
use crate::measure::Case;
use crate::setting::Setting;
use crate::{Clock, Settings, Table};
use base::math::lanes_in;
use base::stats::Stopwatch;
use embree::{Accel, BuildQuality};
use std::hint::black_box;
use world::triangle_meshes;

pub fn table(setting: &Setting, traces: &Traces, settings: &Settings) -> Table {
    let meshes = triangle_meshes(&setting.world.scene, &setting.world.materials);
    let mut warnings = Vec::new();
    let mut built = Vec::new();
    for quality in [
        BuildQuality::Medium,
        BuildQuality::Low,
        BuildQuality::High,
        BuildQuality::Compact,
        BuildQuality::Robust,
    ] {
        let watch = Stopwatch::start();
        match Accel::build_with(setting.world.accel.device(), &meshes, quality) {
            Ok(accel) => built.push((quality, accel, watch.elapsed().cpu_seconds)),
            Err(error) => warnings.push(format!("{quality:?}: {error}")),
        }
    }
    let mut cases = Vec::new();
    for (trace, coherent) in [(&traces.pixels()[0], false), (&traces.pixels()[1], true)] {
        let against = cases.len();
        let occluded = move |accel: &Accel| -> Vec<u16> {
            let query = |p: &super::trace::SegmentPacket| {
                if coherent {
                    accel.occluded16(&p.rays, p.valid, true)
                } else {
                    lanes_in(p.valid)
                        .filter(|&i| accel.occluded(&p.rays.get(i)))
                        .fold(0, |mask, i| mask | 1 << i)
                }
            };
            trace.bundles().map(query).collect()
        };
        let Some((_, reference, _)) = built.first() else { break };
        let reference = occluded(reference);
        for (quality, accel, seconds) in &built {
            let differ: u32 = occluded(accel).iter().zip(&reference).map(|(a, b)| (a ^ b).count_ones()).sum();
            let per_million = 1e6 * f64::from(differ) / count(trace.bundles()).max(1) as f64;
            let labels = [trace.name, &format!("{quality:?}").to_lowercase()];
            let mut case = Case::new(&labels, against, count(trace.bundles()) as f64, move || {
                black_box(occluded(accel));
            });
            case.figures = vec![Some(*seconds), Some(per_million)];
            cases.push(case);
        }
    }
    let mut table = Table::measured(
        (
            "Build qualities",
            "Single rays in the order of single points, and coherent packets of shared cuts. Ratio to medium quality.",
        ),
        (&["order", "quality"], "Mrays/s", &["build CPU s", "answers differ, per million"]),
        (Clock::Thread, settings, MRAYS),
        cases,
    );
    table.warnings.extend(warnings);
    table
}
