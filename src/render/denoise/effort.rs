//! Quality of denoising that suits the work on the image.
//!
//! The best network takes as long as a simple scene's image itself, and more samples would use that time better. So a
//! smaller network is used if it saves enough of all the work. It has to save more where all light is sampled. There,
//! more noise is left to the network, and more samples gain less. The work is counted, not timed: the same image is
//! denoised alike on every machine.
//!
//! Units: as in [`crate::cost`].

use super::Quality;
use crate::calibration::PRICES;

/// Light of an image that is sampled, and so has noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampled {
    /// All light.
    All,
    /// Part of the light, for instance direct light.
    Part,
}

impl Sampled {
    /// Returns the lower qualities, and the minimum share of all work that each has to save.
    fn lower(self) -> [(Quality, f64); 2] {
        match self {
            Sampled::All => [(Quality::Balanced, 0.2), (Quality::Fast, 0.3)],
            Sampled::Part => [(Quality::Balanced, 0.09), (Quality::Fast, 0.15)],
        }
    }
}

/// Returns the quality for an image of so many pixels on which so much work was spent.
pub fn for_image(pixels: u64, work: f64, sampled: Sampled) -> Quality {
    for_work(work, PRICES.denoised_pixel * pixels as f64, sampled)
}

/// Returns the quality for an image that takes `work`, if the best denoising takes `best`, in any unit.
pub fn for_work(work: f64, best: f64, sampled: Sampled) -> Quality {
    let mut quality = Quality::High;
    for (lower, min_share) in sampled.lower() {
        let price = best * PRICES.denoising(quality);
        let saved = price - best * PRICES.denoising(lower);
        if !(saved > min_share * (work.max(0.0) + price)) {
            break;
        }
        quality = lower;
    }
    quality
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the quality for a thousand pixels.
    fn quality(work: f64, sampled: Sampled) -> Quality {
        for_image(1000, work, sampled)
    }

    #[test]
    fn quality_rises_with_the_work_on_a_pixel() {
        let by_work: Vec<Quality> = [0.0, 1.0, 4.0, 6.0, 8.0, 16.0, 20.0, 100.0]
            .map(|work| quality(1000.0 * work, Sampled::Part))
            .into();
        assert!(by_work.is_sorted(), "{by_work:?}");
        assert_eq!((by_work[0], by_work[5], by_work[7]), (Quality::Fast, Quality::Balanced, Quality::High));
    }

    #[test]
    fn images_of_sampled_light_alone_get_better_networks() {
        let works = (0..40).map(|k| 1000.0 * f64::from(k));
        let better = works.filter(|work| {
            let [all, part] = [Sampled::All, Sampled::Part].map(|sampled| quality(*work, sampled));
            assert!(all >= part, "{work}: {all:?} {part:?}");
            all > part
        });
        assert!(better.count() > 10);
    }

    #[test]
    fn no_pixels_and_endless_work_get_the_best() {
        assert_eq!(for_image(0, 0.0, Sampled::Part), Quality::High);
        assert_eq!(for_work(f64::INFINITY, 1.0, Sampled::All), Quality::High);
    }
}
