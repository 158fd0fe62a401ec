//! Quality of denoising that goes with the work on the picture.
//!
//! The best network takes as long as a simple scene's picture itself, and what time it takes would gain quality as
//! samples, too. So a smaller network is taken where it spares enough of all the work, counted and not timed: the same
//! picture is denoised alike wherever it is made.
//!
//! Measured on six scenes by others at 512x512: a smaller network costs 0 to .4 dB, of noisy paths 1 and the smallest
//! 2, where a tenth of the time, spent on samples, gains .3 (rooms with textures) to 1 dB (a box).
//!
//! Units: microseconds of one core of the machine on which the prices were measured.

use super::Quality;

/// Lower qualities, and the share of all work that each has to spare.
const LOWER: [(Quality, f64); 2] = [(Quality::Balanced, 0.09), (Quality::Fast, 0.15)];

/// Price of a pixel by the best network.
const HIGH: f64 = 3.4;

/// Price of `quality` over that of the best.
pub fn relative_price(quality: Quality) -> f64 {
    match quality {
        Quality::Fast => 0.24,
        Quality::Balanced => 0.44,
        Quality::High => 1.0,
    }
}

/// Quality for a picture of so many pixels on which so much work has been spent.
pub fn for_picture(pixels: u64, work: f64) -> Quality {
    for_work(work, HIGH * pixels as f64)
}

/// Quality for a picture that takes `work`, where the best denoising takes `high`, in any unit.
pub fn for_work(work: f64, high: f64) -> Quality {
    let mut quality = Quality::High;
    for (lower, worth) in LOWER {
        let price = high * relative_price(quality);
        let spared = price - high * relative_price(lower);
        if !(spared > worth * (work.max(0.0) + price)) {
            break;
        }
        quality = lower;
    }
    quality
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quality_rises_with_the_work_on_a_pixel() {
        let by_work: Vec<Quality> =
            [0.0, 1.0, 4.0, 6.0, 8.0, 16.0, 20.0, 100.0].map(|work| for_picture(1000, 1000.0 * work)).into();
        assert!(by_work.is_sorted(), "{by_work:?}");
        assert_eq!((by_work[0], by_work[5], by_work[7]), (Quality::Fast, Quality::Balanced, Quality::High));
    }

    #[test]
    fn no_pixels_and_endless_work_get_the_best() {
        assert_eq!(for_picture(0, 0.0), Quality::High);
        assert_eq!(for_work(f64::INFINITY, 1.0), Quality::High);
    }
}
