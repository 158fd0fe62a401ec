//! Distant discs before the environment.

use super::tiles::Tile;
use base::math::{Frame, Rgb, luminance};
use glam::{Vec2, Vec3};
use scene::DistantDisc;
use std::f32::consts::{PI, TAU};

/// The discs, each a tile.
#[derive(Clone, Debug)]
pub(super) struct Discs {
    discs: Vec<Disc>,
    /// Tile of the first.
    first: usize,
}

#[derive(Clone, Copy, Debug)]
struct Disc {
    direction: Vec3,
    /// 1 - cos of the angle to the rim: f32 has no cosine of the sun's.
    versine: f32,
    radiance: Rgb,
}

impl Disc {
    fn solid_angle(&self) -> f32 {
        TAU * self.versine
    }

    /// Mean luminance over the sphere.
    fn mean_luminance(&self) -> f32 {
        luminance(self.radiance) * self.solid_angle() / (4.0 * PI)
    }
}

impl Discs {
    /// Discs whose tiles follow `first` others.
    pub fn new(discs: &[DistantDisc], first: usize) -> Discs {
        let disc = |disc: &DistantDisc| {
            let sin = (0.5 * f64::from(disc.half_angle)).sin();
            let versine = (2.0 * sin * sin) as f32;
            Disc { direction: disc.direction, versine, radiance: disc.radiance }
        };
        Discs { discs: discs.iter().map(disc).collect(), first }
    }

    pub fn is_empty(&self) -> bool {
        self.discs.is_empty()
    }

    /// Mean luminance of all over the sphere.
    pub fn mean_luminance(&self) -> f32 {
        self.discs.iter().map(Disc::mean_luminance).sum()
    }

    /// Tiles of the discs, for a mean luminance `total` of discs and environment.
    pub fn tiles(&self, total: f32) -> impl Iterator<Item = Tile> + '_ {
        self.discs.iter().map(move |disc| Tile::apart(disc.mean_luminance() / total, disc.solid_angle()))
    }

    /// Returns true if a tile is a disc's.
    #[inline]
    pub fn has(&self, tile: usize) -> bool {
        tile >= self.first
    }

    /// Tiles and radiances of the discs that hold the unit direction `d`.
    #[inline]
    pub fn around(&self, d: Vec3) -> impl Iterator<Item = (usize, Rgb)> + '_ {
        let holds = move |disc: &Disc| d.distance_squared(disc.direction) <= 2.0 * disc.versine;
        let within = self.discs.iter().enumerate().filter(move |(_, disc)| holds(disc));
        within.map(|(i, disc)| (self.first + i, disc.radiance))
    }

    /// Unit direction drawn uniformly in the disc of a tile, and its radiance.
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
