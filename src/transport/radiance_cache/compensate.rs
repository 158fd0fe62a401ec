//! Compensation at records for the light clamped from nearby virtual lights (see [`crate::bias_compensation`]).
//!
//! Deviations: series are clamped and not compensated.

use super::candidate::Candidate;
use super::gather::GatheredLayer;
use crate::bias_compensation::Compensation;
use crate::bias_compensation::points::{Compensator, Lacking};
use crate::bias_compensation::short_rays::ClampedPoint;
use crate::lights::{DirectIndirect, Origin};
use base::math::{Rgb, luminance};

/// Adds the compensation for clamped virtual lights to the direct and indirect light of a task's records.
pub fn add(
    c: &Compensation,
    compensator: &mut Compensator,
    task: &[Candidate],
    gathered: &mut [&mut DirectIndirect<GatheredLayer>],
) {
    let clamped = |(candidate, gathered): (&Candidate, &&mut DirectIndirect<GatheredLayer>)| ClampedPoint {
        point: candidate.point,
        bound: if candidate.missing.indirect { gathered.indirect.bound } else { f32::INFINITY },
        direct: candidate.missing.direct,
        edges: candidate.edges,
    };
    let points: Vec<ClampedPoint> = task.iter().zip(gathered.iter()).map(clamped).collect();
    let irradiances = gathered.iter().map(|g| luminance(g.direct.irradiance + g.indirect.irradiance));
    let mean = irradiances.sum::<f32>() / task.len().max(1) as f32;
    compensator.lacking(c, &points, mean, None, |record, Lacking { near, reflected, emitted }| {
        let candidate = &task[record];
        let passed = match candidate.coat {
            0 => 1.0,
            coat => c.world.materials.coat_transmittance(coat, near.cos),
        };
        for (origin, light) in [(Origin::Direct, emitted), (Origin::Indirect, reflected)] {
            if light != Rgb::ZERO {
                gathered[record][origin].compensate(candidate.point.normal, light * passed, near.distance);
            }
        }
    });
}
