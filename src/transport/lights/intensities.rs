//! Intensities of indirect VPLs, by region of the scene.
//!
//! The light that a limit takes away depends on them: a few bright VPLs lose more than many faint VPLs of the same
//! flux. Intensities differ with the albedo and with the density of photons.

use super::{Origin, Profiles, Vpl, VplKind, VplSet};
use base::math::{Rgb, luminance};
use glam::Vec3;
use rayon::prelude::*;
use world::light::Regions;

/// Maximum number of VPLs that regions are made of.
const MAX_SAMPLES: usize = 1 << 15;

/// Maximum number of VPLs in a region.
const MAX_IN_REGION: usize = 32;

/// Maximum intensity of a VPL that counts, relative to the geometric mean of its region. A brighter VPL is that of a
/// stray photon.
const MAX_TO_MEAN: f64 = 3.0;

/// Mean intensities of indirect virtual lights.
#[derive(Clone, Debug)]
pub struct Intensities {
    regions: Regions,
    /// Mean luminance of the intensities per cosine by region, weighted by flux, without stray photons.
    means: Vec<f32>,
}

/// Places and intensities of some indirect VPLs.
pub struct IntensitySamples {
    places: Vec<Vec3>,
    intensities: Vec<f64>,
}

impl IntensitySamples {
    /// Collects the intensities of indirect VPLs among `sets`. A VPL with a lobe counts as a diffuse VPL of the same
    /// flux.
    pub fn new(sets: &[VplSet], profiles: &Profiles) -> IntensitySamples {
        let indirect = || sets.iter().filter(|set| set.origin == Origin::Indirect);
        let stride = indirect().map(VplSet::len).sum::<usize>().div_ceil(MAX_SAMPLES).max(1);
        let mut found: Vec<(Vec3, f64)> = Vec::new();
        for set in indirect() {
            let sample = |(vpl, intensity): (&Vpl, &Rgb)| {
                let as_diffuse = match set.kind {
                    VplKind::Lobed => profiles.lobes[vpl.lobe()].diffuse_equivalent(),
                    _ => 1.0,
                };
                let intensity = f64::from(luminance(*intensity)) * f64::from(as_diffuse);
                (intensity > 0.0).then_some((vpl.position, intensity))
            };
            let samples = set.vpls.par_iter().zip(&set.intensities).step_by(stride);
            found.par_extend(samples.filter_map(sample));
        }
        let (places, intensities) = found.into_iter().unzip();
        IntensitySamples { places, intensities }
    }
}

impl Intensities {
    /// Returns the means of intensities; `None` if there are none.
    pub fn new(samples: &IntensitySamples) -> Option<Intensities> {
        let IntensitySamples { places, intensities } = samples;
        let (regions, members) = Regions::new(places, MAX_IN_REGION);
        let mean = |members: &Vec<u32>| {
            let of_members = || members.iter().map(|i| intensities[*i as usize]);
            let middle = (of_members().map(f64::ln).sum::<f64>() / members.len() as f64).exp();
            let counted = || of_members().filter(|intensity| *intensity <= MAX_TO_MEAN * middle);
            let squares: f64 = counted().map(|intensity| intensity * intensity).sum();
            (squares / counted().sum::<f64>()) as f32
        };
        (!places.is_empty()).then(|| Intensities { means: members.iter().map(mean).collect(), regions })
    }

    /// Mean luminance of the intensities per cosine around a point, W/sr.
    #[inline]
    pub fn around(&self, x: Vec3) -> f32 {
        self.means[self.regions.of(x)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::owen_sobol_2d;

    /// Few bright lights left of the origin, and many faint ones right of it.
    fn set(scale: f32) -> VplSet {
        let mut set = VplSet::new(VplKind::Oriented, Origin::Indirect);
        for i in 0..100_000 {
            let u = owen_sobol_2d(i, 7);
            let (side, intensity) = if i % 100 == 0 { (-1.0, 8.0) } else { (1.0, 0.02) };
            let place = Vec3::new(side * (1.0 + u.x), u.y, 0.0);
            set.push(Vpl::oriented(place, Vec3::Z), Rgb::splat(intensity * scale));
        }
        set
    }

    #[test]
    fn intensities_are_those_of_the_lights_around() {
        for scale in [1e-25f32, 1.0, 1e25] {
            let found = Intensities::new(&IntensitySamples::new(&[set(scale)], &Profiles::default()))
                .expect("there are lights");
            for (x, expected) in [(-1.5, 8.0), (1.5, 0.02)] {
                let around = found.around(Vec3::new(x, 0.5, 0.3)) / scale;
                assert!((around / expected - 1.0).abs() < 1e-4, "{around} for {expected} at scale {scale}");
            }
        }
    }

    /// Lights of 1 and 3 W/sr have (1² + 3²) / (1 + 3).
    #[test]
    fn bright_lights_count_by_their_flux() {
        let mut set = VplSet::new(VplKind::Oriented, Origin::Indirect);
        for intensity in [1.0, 3.0] {
            set.push(Vpl::oriented(Vec3::ZERO, Vec3::Z), Rgb::splat(intensity));
        }
        let found =
            Intensities::new(&IntensitySamples::new(&[set], &Profiles::default())).expect("there are lights");
        assert!((found.around(Vec3::ZERO) - 2.5).abs() < 1e-6);
    }

    #[test]
    fn stray_lights_do_not_count() {
        let mut set = VplSet::new(VplKind::Oriented, Origin::Indirect);
        for i in 0..20 {
            set.push(Vpl::oriented(Vec3::ZERO, Vec3::Z), Rgb::splat(if i == 7 { 500.0 } else { 1.0 }));
        }
        let found =
            Intensities::new(&IntensitySamples::new(&[set], &Profiles::default())).expect("there are lights");
        assert!((found.around(Vec3::ZERO) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn direct_lights_are_not_limited() {
        let mut direct = VplSet::new(VplKind::Oriented, Origin::Direct);
        direct.push(Vpl::oriented(Vec3::ZERO, Vec3::Z), Rgb::ONE);
        assert!(Intensities::new(&IntensitySamples::new(&[direct], &Profiles::default())).is_none());
    }
}
