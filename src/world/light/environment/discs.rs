//! Distant discs before the environment.

use super::tiles::Tile;
use base::math::{Frame, Rgb, luminance};
use glam::{Vec2, Vec3};
use scene::DistantDisc;
use std::f32::consts::{PI, TAU};

/// Distant discs, each of them a tile.
#[derive(Clone, Debug)]
pub(super) struct Discs {
    discs: Vec<Disc>,
    /// Tile of the first disc.
    first: usize,
}

/// A distant disc of constant radiance.
#[derive(Clone, Copy, Debug)]
struct Disc {
    direction: Vec3,
    /// 1 - cos of the angle to the rim. The cosine itself is not precise enough in f32 for the sun.
    versine: f32,
    radiance: Rgb,
}

impl Disc {
    /// Returns the solid angle of the disc, sr.
    fn solid_angle(&self) -> f32 {
        TAU * self.versine
    }

    /// Returns the mean luminance over the sphere.
    fn mean_luminance(&self) -> f32 {
        luminance(self.radiance) * self.solid_angle() / (4.0 * PI)
    }
}

impl Discs {
    /// Prepares the discs, whose tiles follow `first` others.
    pub fn new(discs: &[DistantDisc], first: usize) -> Discs {
        let disc = |disc: &DistantDisc| {
            let sin = (0.5 * f64::from(disc.half_angle)).sin();
            let versine = (2.0 * sin * sin) as f32;
            Disc { direction: disc.direction, versine, radiance: disc.radiance }
        };
        Discs { discs: discs.iter().map(disc).collect(), first }
    }

    /// Returns true if there are no discs.
    pub fn is_empty(&self) -> bool {
        self.discs.is_empty()
    }

    /// Returns the mean luminance of all discs over the sphere.
    pub fn mean_luminance(&self) -> f32 {
        self.discs.iter().map(Disc::mean_luminance).sum()
    }

    /// Lists the tiles of the discs, for a mean luminance `total` of discs and environment.
    pub fn tiles(&self, total: f32) -> impl Iterator<Item = Tile> + '_ {
        self.discs.iter().map(move |disc| Tile::apart(disc.mean_luminance() / total, disc.solid_angle()))
    }

    /// Returns true if a tile is a disc.
    #[inline]
    pub fn has(&self, tile: usize) -> bool {
        tile >= self.first
    }

    /// Lists tiles and radiances of the discs that contain the unit direction `d`.
    #[inline]
    pub fn around(&self, d: Vec3) -> impl Iterator<Item = (usize, Rgb)> + '_ {
        let holds = move |disc: &Disc| d.distance_squared(disc.direction) <= 2.0 * disc.versine;
        let within = self.discs.iter().enumerate().filter(move |(_, disc)| holds(disc));
        within.map(|(i, disc)| (self.first + i, disc.radiance))
    }

    /// Samples a unit direction uniformly in the disc of a tile. Returns the direction and its radiance.
    #[inline]
    pub fn sample(&self, tile: usize, u: Vec2) -> Option<(Vec3, Rgb)> {
        let disc = self.discs.get(tile.checked_sub(self.first)?)?;
        let versine = u.x * disc.versine;
        let sin = (versine * (2.0 - versine)).max(0.0).sqrt();
        let (sin_phi, cos_phi) = (TAU * u.y).sin_cos();
        let local = Vec3::new(sin * cos_phi, sin * sin_phi, 1.0 - versine);
        Some((Frame::from_normal(disc.direction).to_world(local).normalize(), disc.radiance))
    }
}
