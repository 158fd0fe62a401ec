//! Final gathering: rays into all strata of a point's hemisphere. Rays of sixteen neighbouring strata are traced as a
//! coherent packet.
//!
//! Papers: Ward and Heckbert 1992; Krivanek et al. 2005.

use super::indirect_light::{GatherCounts, IndirectLight};
use super::radiance::IncomingRadiance;
use super::strata::{BLOCK, Strata, StrataHits};
use base::math::{Frame, Rgb};
use base::sampling::hash;
use embree::Rays16;
use glam::{Mat3, Vec2};
use world::SurfacePoint;
use world::shadow;

/// Irradiance gathered at a point.
#[derive(Clone, Copy, Debug)]
pub struct GatheredIrradiance {
    /// Irradiance.
    pub irradiance: Rgb,
    /// Irradiance vector by channel, in world space.
    pub vector: Mat3,
    /// Gradient of the irradiance by channel, in the tangent plane.
    pub gradient: Mat3,
    /// Harmonic mean distance of the surfaces hit; infinite if there are none.
    pub distance: f32,
}

/// Point at which light is gathered.
#[derive(Clone, Copy, Debug)]
pub struct GatherPoint {
    /// Position and normals.
    pub point: SurfacePoint,
    /// Coat of the surface; 0 for none.
    pub coat: u32,
    /// Seed of the directions within the strata.
    pub seed: u32,
    /// Inverse of the minimum distance of surfaces in the gradient.
    pub max_nearness: f32,
}

/// Gathers irradiance at a point; stores the surfaces that the rays hit in `met`.
pub fn gather(
    light: &IndirectLight,
    strata: &Strata,
    at: &GatherPoint,
    met: &mut StrataHits,
    counts: &mut GatherCounts,
) -> GatheredIrradiance {
    let GatherPoint { point, coat, seed, max_nearness } = *at;
    met.clear(strata.len());
    let frame = Frame::from_normal(point.normal);
    for first_ring in (0..strata.rings).step_by(BLOCK) {
        for first_sector in (0..strata.sectors).step_by(BLOCK) {
            let mut rays = Rays16::default();
            let stratum = |lane: usize| (first_ring + lane / BLOCK, first_sector + lane % BLOCK);
            let block_seed = hash(strata.place(first_ring, first_sector) as u32, seed);
            for lane in 0..BLOCK * BLOCK {
                let (ring, sector) = stratum(lane);
                let bits = hash(lane as u32, block_seed);
                let u = Vec2::new((bits >> 16) as f32, (bits & 0xffff) as f32) * (1.0 / 65536.0);
                let local = strata.direction(ring, sector, u);
                met.direction[strata.place(ring, sector)] = local;
                let direction = frame.to_world(local);
                rays.set(lane, &shadow::ray_from(point.position, point.geometric_normal, direction));
            }
            let incoming = light.along16(&rays, u16::MAX, true, block_seed, counts);
            for (lane, IncomingRadiance { radiance, distance, normal }) in incoming.into_iter().enumerate() {
                let (ring, sector) = stratum(lane);
                let place = strata.place(ring, sector);
                let passed = match coat {
                    0 => 1.0,
                    coat => light.world.materials.coat_transmittance(coat, met.direction[place].z),
                };
                met.radiance[place] = if radiance.is_finite() { radiance * passed } else { Rgb::ZERO };
                met.nearness[place] = 1.0 / distance;
                met.normal[place] = frame.to_local(normal);
            }
        }
    }
    counts.record_rays += strata.len() as u64;
    let vector = strata.vector(met);
    let gradient = strata.gradient(met, max_nearness);
    let to_world = Mat3::from_cols(frame.tangent, frame.bitangent, frame.normal);
    let mean_nearness = met.nearness.iter().sum::<f32>() / strata.len() as f32;
    GatheredIrradiance {
        irradiance: Rgb::new(vector.x_axis.z, vector.y_axis.z, vector.z_axis.z),
        vector: to_world * vector,
        gradient: to_world * gradient,
        distance: 1.0 / mean_nearness,
    }
}
