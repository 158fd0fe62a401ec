//! Bias compensation: light lost by clamping virtual lights close to a point, found by short rays.
//!
//! Papers: Kollig and Keller, *Illumination in the Presence of Weak Singularities*, 2004; Herzog et al. 2009,
//! section 6.3 and Eq. 13. Virtual lights count with min(G, b) of their geometry term G = cosθ_x cosθ_y / r²;
//! the rest, max(0, G - b), is integrated over directions instead: E = π/N Σ max(0, 1 - b/G) L over N
//! directions distributed by the cosine. G exceeds b only if r < b^(-1/2), so rays end there and are
//! cheap.
//!
//! [`crate::lightcut::Clamps`] limits virtual lights by the bound. [`short_rays`] traces the rays from the same points
//! with the same bound, and [`points`] gathers the light at the surfaces that they meet.
//!
//! Virtual lights on area lights count with cosθ_x cosθ_y / max(r², A). A is the area that they represent, to
//! within a factor of 2 (see [`crate::lights::size_of_area`]). Rays that hit the light at r find max(0, 1 -
//! r²/A) of its radiance.
//!
//! Deviations: the paper does not limit direct light, hence not its second kind above. b comes from the mean intensity
//! of the indirect virtual lights ([`crate::lights::Intensities`]) around the point. Virtual lights much brighter than
//! the mean are limited more, and the difference stays lost. Every
//! point is compensated, even if no light of its cut is clamped: the two parts complement each other on average only.
//! All points of an image share the directions, in frames of their own, so that their errors are similar and no noise
//! is visible between them. Surfaces that rays meet reflect diffusely, as most virtual lights do; those of rough metals
//! radiate by their lobes. If the path length is limited, paths over surfaces that rays hit may have a further edge.
//!
//! Units: b in 1/m².

pub mod near_surface;
pub mod points;
pub mod short_rays;

use crate::lightcut::Transfer;
use crate::lights::Lights;
use world::World;

/// Compensation at all points of a scene.
#[derive(Clone, Copy)]
pub struct Compensation<'a> {
    /// The scene.
    pub world: &'a World,
    /// Transfer from its virtual lights, with their patches.
    pub transfer: Transfer<'a>,
    lights: &'a Lights,
    /// Maximum of the lights' `near_sq` over all meshes.
    max_near_sq: f32,
}

impl<'a> Compensation<'a> {
    /// Creates the compensation for points lit by the virtual lights of a scene. The lights' seed determines the
    /// directions of short rays.
    pub fn new(world: &'a World, lights: &'a Lights) -> Compensation<'a> {
        let max_near_sq = lights.near_sq.iter().copied().fold(0.0, f32::max);
        Compensation { world, transfer: Transfer::of(lights, true), lights, max_near_sq }
    }
}

/// Chooses items by systematic sampling: evenly along the sum of their weights, in `strata` equal parts of the `total`.
/// Calls `chosen` with each item and the sum of the parts that it represents.
pub fn choose_evenly(
    weights: impl IntoIterator<Item = f32>,
    total: f32,
    strata: usize,
    mut chosen: impl FnMut(usize, f32),
) {
    let stratum = total / strata as f32;
    let (mut reached, mut next) = (0.0, 0.5 * stratum);
    for (item, weight) in weights.into_iter().enumerate() {
        reached += weight;
        let mut share = 0.0;
        while next < reached {
            share += stratum;
            next += stratum;
        }
        if share > 0.0 {
            chosen(item, share);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::choose_evenly;

    #[test]
    fn each_stratum_is_given_to_one_item() {
        let chosen = |weights: &[f32], strata| {
            let mut all = Vec::new();
            let total = weights.iter().sum();
            choose_evenly(weights.iter().copied(), total, strata, |item, share| all.push((item, share)));
            all
        };
        assert_eq!(chosen(&[1.0, 1.0, 1.0, 1.0], 2), [(1, 2.0), (3, 2.0)]);
        assert_eq!(chosen(&[0.0, 8.0, 0.5], 4), [(1, 8.5)], "one item may stand for several strata");
        assert_eq!(chosen(&[0.0, 0.0], 4), [], "nothing to choose");
    }
}
