//! Directions of a final gathering: rings by sectors of the hemisphere, all of equal projected solid angle.
//!
//! Papers: Ward and Heckbert 1992; Krivanek et al. 2005 for the translational gradient ([`Strata::gradient`]). The
//! boundaries between strata move as the point moves, at a rate in inverse proportion to the distance of the nearer of
//! the two surfaces. Light of one stratum is replaced by light of the other.

use base::math::Rgb;
use glam::{Mat3, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Side in strata of a block whose rays are traced together.
pub const BLOCK: usize = 4;

/// Partition of the hemisphere.
#[derive(Clone, Debug)]
pub struct Strata {
    /// Number of rings from the pole to the horizon; a multiple of [`BLOCK`].
    pub rings: usize,
    /// Number of sectors around the pole; a multiple of [`BLOCK`].
    pub sectors: usize,
    /// Length of the tangential part of the directions, integrated over each ring.
    tangential: Vec<f32>,
    /// Unit vector of the azimuth, integrated over each sector.
    azimuth: Vec<Vec2>,
}

/// Surfaces hit by the rays of a final gathering, ring by ring.
#[derive(Clone, Debug, Default)]
pub struct StrataHits {
    /// Radiance from each stratum.
    pub radiance: Vec<Rgb>,
    /// Inverse distance of the surface hit; 0 if there is none.
    pub nearness: Vec<f32>,
    /// Unit direction of the ray, in the frame of the hemisphere.
    pub direction: Vec<Vec3>,
    /// Unit normal of the surface hit, in the frame of the hemisphere; zero if there is none.
    pub normal: Vec<Vec3>,
}

impl StrataHits {
    /// Resets to `count` strata without hits.
    pub fn clear(&mut self, count: usize) {
        self.radiance.clear();
        self.radiance.resize(count, Rgb::ZERO);
        self.nearness.clear();
        self.nearness.resize(count, 0.0);
        for vectors in [&mut self.direction, &mut self.normal] {
            vectors.clear();
            vectors.resize(count, Vec3::ZERO);
        }
    }
}

impl Strata {
    /// Creates about `rays` strata, at least 16.
    pub fn new(rays: u32) -> Strata {
        // Strata are about as wide as long: sectors = π · rings (Ward and Heckbert).
        let blocks = |x: f64| ((x / BLOCK as f64).round() as usize).max(1) * BLOCK;
        let rings = blocks((f64::from(rays) / std::f64::consts::PI).sqrt());
        let sectors = blocks(f64::from(rays) / rings as f64);
        let edge = |j: usize| (j as f64 / rings as f64).sqrt().asin();
        // Antiderivative of sin²θ.
        let primitive = |theta: f64| 0.5 * theta - 0.25 * (2.0 * theta).sin();
        let tangential = (0..rings).map(|j| (primitive(edge(j + 1)) - primitive(edge(j))) as f32).collect();
        let width = TAU / sectors as f32;
        let integral = |k: usize| {
            let [a, b] = [k as f32 * width, (k + 1) as f32 * width];
            Vec2::new(b.sin() - a.sin(), a.cos() - b.cos())
        };
        Strata { rings, sectors, tangential, azimuth: (0..sectors).map(integral).collect() }
    }

    /// Number of strata.
    pub fn len(&self) -> usize {
        self.rings * self.sectors
    }

    /// Returns the index of a stratum in [`StrataHits`].
    #[inline]
    pub fn place(&self, ring: usize, sector: usize) -> usize {
        ring * self.sectors + sector
    }

    /// Returns a direction of a stratum, about +z, at `u` within it.
    #[inline]
    pub fn direction(&self, ring: usize, sector: usize, u: Vec2) -> Vec3 {
        let sin_sq = (ring as f32 + u.x) / self.rings as f32;
        let (sin_phi, cos_phi) = ((sector as f32 + u.y) * (TAU / self.sectors as f32)).sin_cos();
        let sin = sin_sq.sqrt();
        Vec3::new(sin * cos_phi, sin * sin_phi, (1.0 - sin_sq).max(0.0).sqrt())
    }

    /// Projected solid angle of each stratum.
    pub fn measure(&self) -> f32 {
        PI / self.len() as f32
    }

    /// Returns the irradiance vector by channel (column), in the frame of the hemisphere; z is the irradiance.
    pub fn vector(&self, met: &StrataHits) -> Mat3 {
        let mut vector = Mat3::ZERO;
        for ring in 0..self.rings {
            for sector in 0..self.sectors {
                let flat = self.azimuth[sector] * self.tangential[ring];
                let mean = flat.extend(self.measure());
                let radiance = met.radiance[self.place(ring, sector)];
                vector += Mat3::from_cols(mean * radiance.x, mean * radiance.y, mean * radiance.z);
            }
        }
        vector
    }

    /// Returns the gradient of the irradiance as the point moves in its plane, by channel (column). Surfaces nearer
    /// than 1 / `max_nearness` count as at this distance.
    pub fn gradient(&self, met: &StrataHits, max_nearness: f32) -> Mat3 {
        let (rings, sectors) = (self.rings, self.sectors);
        let width = TAU / sectors as f32;
        let sin = |ring: usize| (ring as f32 / rings as f32).sqrt();
        let mut gradient = [Vec2::ZERO; 3];
        for sector in 0..sectors {
            let before = if sector == 0 { sectors - 1 } else { sector - 1 };
            let (mut along, mut across) = (Rgb::ZERO, Rgb::ZERO);
            for ring in 0..rings {
                let here = self.place(ring, sector);
                let moved = |other: usize| {
                    let nearness = met.nearness[here].max(met.nearness[other]).min(max_nearness);
                    (met.radiance[here] - met.radiance[other]) * nearness
                };
                if ring > 0 {
                    let cos_sq = 1.0 - ring as f32 / rings as f32;
                    along += moved(self.place(ring - 1, sector)) * (width * sin(ring) * cos_sq);
                }
                across += moved(self.place(ring, before)) * (sin(ring + 1) - sin(ring));
            }
            let middle = Vec2::from_angle((sector as f32 + 0.5) * width);
            let edge = Vec2::from_angle(sector as f32 * width).perp();
            for c in 0..3 {
                gradient[c] += middle * along[c] + edge * across[c];
            }
        }
        let [x, y, z] = gradient.map(|g| g.extend(0.0));
        Mat3::from_cols(x, y, z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(strata: &Strata, mut see: impl FnMut(Vec3) -> (f32, f32)) -> StrataHits {
        let mut met = StrataHits::default();
        met.clear(strata.len());
        for ring in 0..strata.rings {
            for sector in 0..strata.sectors {
                let (radiance, distance) = see(strata.direction(ring, sector, Vec2::splat(0.5)));
                let place = strata.place(ring, sector);
                (met.radiance[place], met.nearness[place]) = (Rgb::splat(radiance), 1.0 / distance);
            }
        }
        met
    }

    #[test]
    fn the_number_is_about_what_is_asked_for() {
        for rays in [1, 16, 100, 2000, 5000] {
            let strata = Strata::new(rays);
            assert!(strata.rings.is_multiple_of(BLOCK) && strata.sectors.is_multiple_of(BLOCK));
            let ratio = strata.len() as f64 / f64::from(rays);
            assert!(rays < 100 || (0.85..1.15).contains(&ratio), "{rays}: {}", strata.len());
        }
    }

    #[test]
    fn uniform_light_gives_pi_and_no_gradient() {
        let strata = Strata::new(1000);
        let met = all(&strata, |_| (1.0, 2.0));
        let vector = strata.vector(&met);
        assert!((vector.x_axis - Vec3::Z * PI).length() < 1e-4, "{vector}");
        assert!(strata.gradient(&met, f32::INFINITY).x_axis.length() < 1e-4);
    }

    #[test]
    fn vectors_tilt_as_light_does() {
        // Light from one half of the hemisphere: the vector's horizontal part is ∫ sin²θ dθ ∫ cosφ dφ = π/4 · 2.
        let strata = Strata::new(2000);
        let vector = strata.vector(&all(&strata, |d| (if d.x > 0.0 { 1.0 } else { 0.0 }, 1.0))).x_axis;
        assert!((vector - Vec3::new(0.5 * PI, 0.0, 0.5 * PI)).length() < 0.01, "{vector}");
    }

    #[test]
    fn gradients_are_those_of_the_irradiance() {
        // A ceiling at height 1 with a bright rectangle; the point moves under it.
        let strata = Strata::new(20_000);
        let irradiance = |at: Vec2| {
            let met = all(&strata, |d| {
                let p = at + d.truncate() / d.z.max(1e-6);
                let inside = (0.1..1.1).contains(&p.x) && (-0.6..0.9).contains(&p.y);
                (if inside { 3.0 } else { 0.5 }, 1.0 / d.z.max(1e-6))
            });
            (strata.vector(&met).x_axis.z, strata.gradient(&met, f32::INFINITY).x_axis)
        };
        for at in [Vec2::ZERO, Vec2::new(0.5, 0.3), Vec2::new(-0.7, -0.4)] {
            let gradient = irradiance(at).1;
            let step = 0.1;
            let along =
                |axis: Vec2| (irradiance(at + axis * step).0 - irradiance(at - axis * step).0) / (2.0 * step);
            let expected = Vec2::new(along(Vec2::X), along(Vec2::Y));
            let error = (gradient.truncate() - expected).length();
            assert!(error < 0.06 * expected.length() + 0.03, "{at}: {gradient} against {expected}");
        }
    }
}
