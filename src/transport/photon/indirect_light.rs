//! Indirect light that surfaces reflect along the rays that hit them.
//!
//! A surface reflects the irradiance of the map, unless it is nearer than the map resolves (see [`super::near`]).
//! Surfaces behind thin sheets and gaps count as well, if the number of edges allows it. Photons count there as if they
//! had come along one edge. Light by mirrors, glass and other sharp lobes does not count,
//! since eye samples find it. Emission does not count, since it is direct light.
//!
//! Units: radiance.

use crate::irradiance::IrradianceMap;
use base::math::Rgb;
use base::sampling::Sampler;
use base::stats::add_fields;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;
use world::shadow;
use world::{Interior, Surface, World};

/// Maximum number of surfaces that a ray is followed through.
const MAX_EDGES: u16 = 8;

/// Counts of the work of gathering.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GatherCounts {
    /// Number of rays from records.
    pub record_rays: u64,
    /// Number of rays from single samples.
    pub own_rays: u64,
    /// Number of rays continued behind sheets and gaps.
    pub followed: u64,
    /// Number of surfaces too near for the map.
    pub near: u64,
}
add_fields!(GatherCounts { record_rays, own_rays, followed, near });

/// Indirect light of a scene.
#[derive(Clone, Copy)]
pub struct IndirectLight<'w> {
    /// The scene.
    pub world: &'w World,
    /// Irradiance on its surfaces.
    pub map: &'w IrradianceMap,
    /// Maximum number of edges that light may take to the points at which it is gathered; `u16::MAX` if no light passes
    /// sheets.
    pub edges: u16,
}

impl IndirectLight<'_> {
    /// Returns the light for points to which light may take `edges` edges.
    pub(super) fn within(&self, edges: u16) -> Self {
        IndirectLight { edges, ..*self }
    }

    /// Returns the radiance that a surface, hit along `direction` at `distance`, reflects back. Also returns the albedo
    /// of the reflection that is still missing because the surface is too near for the map; 0 if none is. Calls
    /// `behind` with every surface that the ray meets behind sheets, or with nothing, and with the share of the light
    /// from there.
    #[inline]
    pub(super) fn sent(
        &self,
        first: &Surface,
        mut direction: Vec3,
        distance: f32,
        sampler: &mut Sampler,
        counts: &mut GatherCounts,
        mut behind: impl FnMut(Option<&Surface>, Rgb),
    ) -> (Rgb, Rgb) {
        let (mut radiance, mut throughput, mut near) = (Rgb::ZERO, Rgb::ONE, Rgb::ZERO);
        let (mut surface, mut interior) = (*first, Interior::NONE);
        if self.world.absorbs() {
            throughput = self.world.edge_shares(interior, first, direction, 0.0)[1];
        }
        for edge in 0..MAX_EDGES.min(self.edges.saturating_sub(1)) {
            let bsdf = self.world.bsdf(&surface);
            let out = surface.frame.to_local(-direction);
            let albedo = bsdf.diffuse_albedo(out);
            if albedo != Rgb::ZERO {
                match self.map.at(surface.position, facing(&surface, direction)) {
                    Some((_, radius)) if edge == 0 && distance < radius => near = albedo,
                    Some((irradiance, _)) => radiance += throughput * albedo * irradiance * FRAC_1_PI,
                    None => {}
                }
            }
            if !bsdf.has_delta() {
                break;
            }
            let sample = bsdf.sample(out, sampler.next_1d(), sampler.next_2d());
            let Some(s) = sample.filter(|s| s.straight) else { break };
            throughput *= s.weight;
            direction = surface.frame.to_world(s.wi);
            counts.followed += 1;
            let ray = shadow::ray_from(surface.position, surface.normal, direction);
            let next = self.world.intersect(&ray);
            interior = self.world.interior_after(interior, &surface, direction, true);
            let [of_emission, of_rest] = match &next {
                Some(next) if self.world.absorbs() => self.world.edge_shares(interior, next, direction, 0.0),
                _ => [Rgb::ONE; 2],
            };
            behind(next.as_ref(), throughput * of_emission);
            throughput *= of_rest;
            let Some(next) = next else { break };
            surface = next;
        }
        (radiance, near)
    }
}

/// Returns the geometric normal on the side that a ray along `direction` hits.
#[inline]
pub(super) fn facing(surface: &Surface, direction: Vec3) -> Vec3 {
    if surface.normal.dot(direction) < 0.0 { surface.normal } else { -surface.normal }
}
