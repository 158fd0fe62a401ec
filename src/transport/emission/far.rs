//! Emitters that are infinitely far: tiles of the environment, and directional lights.

use base::math::{Rgb, luminance};
use glam::{Vec2, Vec3};
use scene::DeltaLight;
use std::f32::consts::PI;
use world::World;
use world::light::{DiscreteDistribution, EnvironmentLight};

/// Sources of light from infinitely far: tiles, then directional lights.
pub(super) struct FarLights<'w> {
    sky: Option<&'w EnvironmentLight>,
    tiles: usize,
    /// Unit direction of each directional light, and irradiance on a surface across it.
    directional: Vec<(Vec3, Rgb)>,
    /// Sources by the irradiance on a surface that faces them.
    by_flux: DiscreteDistribution,
}

/// Sample of the light of a source.
#[derive(Clone, Copy, Debug)]
pub(super) struct FarSample {
    /// Unit vector to the source.
    pub towards: Vec3,
    /// Estimate of the source's irradiance on a surface that faces the light.
    pub irradiance: Rgb,
    /// Luminance of the radiance; infinite for directional lights.
    pub radiance: f32,
}

impl<'w> FarLights<'w> {
    /// Collects the sources of a scene; `None` if it has none.
    pub fn new(world: &'w World) -> Option<FarLights<'w>> {
        let sky = world.emitters.environment.as_ref();
        let directional: Vec<(Vec3, Rgb)> = world
            .emitters
            .deltas
            .iter()
            .filter_map(|delta| match &delta.light {
                DeltaLight::Directional { direction, irradiance } => Some((*direction, *irradiance)),
                _ => None,
            })
            .collect();
        let of_tiles = sky.into_iter().flat_map(|sky| {
            let whole = 4.0 * PI * sky.mean_luminance();
            (0..sky.tile_count()).map(move |tile| whole * sky.flux_of_tile(tile))
        });
        let of_lights = directional.iter().map(|(_, irradiance)| luminance(*irradiance));
        let by_flux = DiscreteDistribution::new(of_tiles.chain(of_lights));
        let tiles = sky.map_or(0, EnvironmentLight::tile_count);
        (!by_flux.is_empty()).then_some(FarLights { sky, tiles, directional, by_flux })
    }

    /// Number of sources.
    pub fn len(&self) -> usize {
        self.by_flux.len()
    }

    /// Samples a source in proportion to flux.
    pub fn source(&self, u: f32) -> usize {
        self.by_flux.sample(u).0
    }

    /// Probability with which [`FarLights::source`] returns a source.
    pub fn probability(&self, source: usize) -> f32 {
        self.by_flux.probability(source)
    }

    /// Samples a direction of a source; `None` if the source is dark there.
    pub fn sample(&self, source: usize, u: Vec2) -> Option<FarSample> {
        if let Some(sky) = self.sky.filter(|_| source < self.tiles) {
            let s = sky.sample_of_tile(source, u)?;
            let irradiance = s.radiance / s.pdf;
            return Some(FarSample { towards: s.direction, irradiance, radiance: luminance(s.radiance) });
        }
        let (direction, irradiance) = *self.directional.get(source - self.tiles)?;
        Some(FarSample { towards: -direction, irradiance, radiance: f32::INFINITY })
    }
}
