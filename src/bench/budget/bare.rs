//! Time of bare Embree queries for rays like those of the eye pass.
//!
//! Packets of a tile are made and stored, then traced, with nothing else between the queries. Making them has traced
//! the eye rays already, so that the hierarchy around them is in the caches. The times are lower bounds.

use super::packets::{Packets, Source, TileRays};
use crate::measure::Clock;
use embree::PreparedRays;
use std::hint::black_box;
use transport::eye::TILE;

/// Processor time and number of some rays.
#[derive(Clone, Copy, Default)]
pub struct Traced {
    /// Processor seconds.
    pub seconds: f64,
    /// Number of rays.
    pub rays: u64,
}

/// Bare queries of a picture's rays, by kind.
#[derive(Clone, Copy, Default)]
pub struct Bare {
    /// Rays from the eye.
    pub eye: Traced,
    /// Shadow rays of light samples.
    pub shadow: Traced,
    /// Rays along sampled directions.
    pub bsdf: Traced,
    /// Rays to all sides, which are no part of the eye pass.
    pub scattered: Traced,
}

impl Traced {
    /// Returns the seconds per ray; `None` without rays.
    pub fn price(&self) -> Option<f64> {
        (self.rays > 0).then(|| self.seconds / self.rays as f64)
    }

    fn add(&mut self, packets: &Packets, query: impl FnOnce() -> u64) {
        let rays = packets.rays();
        if rays == 0 {
            return;
        }
        let start = Clock::Thread.seconds();
        black_box(query());
        self.seconds += Clock::Thread.seconds() - start;
        self.rays += rays;
    }
}

impl Bare {
    /// Traces the rays of all tiles.
    pub fn measure(source: &Source) -> Bare {
        let mut bare = Bare::default();
        for tile in 0..source.view.window.tile_count(TILE) {
            bare.add(source, &TileRays::new(source, tile));
        }
        bare
    }

    fn add(&mut self, source: &Source, tile: &TileRays) {
        let (accel, emitters) = (&source.world.accel, &source.world.emitters);
        let kinds = [
            (&mut self.eye, &tile.eye, true),
            (&mut self.bsdf, &tile.bsdf, false),
            (&mut self.scattered, &tile.scattered, false),
        ];
        let shadow = PreparedRays::new(tile.shadow.each(), accel.widest());
        for (traced, packets, coherent) in kinds {
            let prepared = PreparedRays::for_hits(packets.each(), accel.widest());
            traced.add(packets, || prepared.hits(accel, coherent));
        }
        let coherent = emitters.send_from_few_directions();
        self.shadow.add(&tile.shadow, || shadow.occluded(accel, coherent));
    }

    /// Returns the seconds per shadow ray; 0 if there were none.
    pub fn shadow_price(&self) -> f64 {
        self.shadow.price().unwrap_or(0.0)
    }

    /// Returns the seconds per closest-hit ray that starts at a surface of the eye pass; 0 if there were none.
    pub fn bsdf_price(&self) -> f64 {
        self.bsdf.price().unwrap_or(self.scattered_price())
    }

    /// Returns the seconds per closest-hit ray in any direction; 0 if there were none.
    pub fn scattered_price(&self) -> f64 {
        self.scattered.price().unwrap_or(0.0)
    }
}
