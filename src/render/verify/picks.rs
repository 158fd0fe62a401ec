//! Choice of the pixels to verify.
//!
//! Every pixel may be picked. One half of its probability is uniform. The other half is proportional to its contrast
//! with its neighbours, since errors of caches and of aliasing are largest in creases and at edges, and squares of
//! noise in single bright pixels. Uniform sampling would miss the pixels that dominate the root mean square. Weights
//! undo the preference (Horvitz-Thompson).
//!
//! Picks are systematic. Pixels are ordered block by block along the Morton curve, in random order within blocks, and
//! picked at equal steps of the cumulative probability.

use base::film::Image;
use base::math::morton;
use base::sampling::hash;

/// A pixel to verify.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// Index into the image's pixels, row by row.
    pub index: usize,
    /// Number of pixels that it represents.
    pub weight: f64,
}

/// Share of the probability that is proportional to contrast.
const BY_CONTRAST: f64 = 0.5;

/// Difference of radiances, over the mean radiance, that does not count as contrast.
const CONTRAST_FLOOR: f64 = 0.1;

/// Side of a block, within which the order is random, in pixels.
const BLOCK: u32 = 8;

/// Picks `count` pixels, or every pixel once if there are no more.
pub fn choose(image: &Image, count: usize, seed: u32) -> Vec<Pick> {
    let mut order: Vec<usize> = (0..image.pixels.len()).collect();
    let block = |i: usize| {
        let (x, y) = (i as u32 % image.width, i as u32 / image.width);
        morton(x / BLOCK, y / BLOCK)
    };
    order.sort_by_cached_key(|&i| (block(i), hash(i as u32, hash(seed, 1)), i));
    if count >= order.len() {
        return order.into_iter().map(|index| Pick { index, weight: 1.0 }).collect();
    }
    let inclusion = inclusion(image, count);
    let mut picks: Vec<Pick> = Vec::with_capacity(count);
    let mut next = (f64::from(hash(seed, 2)) + 0.5) / 4294967296.0;
    let mut reached = 0.0;
    for index in order {
        reached += inclusion[index];
        if next < reached {
            picks.push(Pick { index, weight: 1.0 / inclusion[index] });
            next += 1.0;
        }
    }
    picks
}

/// Returns the probability of each pixel to be picked. The probabilities sum to `count`.
fn inclusion(image: &Image, count: usize) -> Vec<f64> {
    let contrast = contrasts(image);
    let total: f64 = contrast.iter().sum();
    let even = 1.0 / contrast.len() as f64;
    let share = if total > 0.0 { BY_CONTRAST } else { 0.0 };
    let by_contrast = |c: f64| if total > 0.0 { share * c / total } else { 0.0 };
    let mut inclusion: Vec<f64> =
        contrast.into_iter().map(|c| count as f64 * ((1.0 - share) * even + by_contrast(c))).collect();
    // Probability in excess of 1 is redistributed to the others, until none exceeds it.
    loop {
        let certain = inclusion.iter().filter(|&&p| p >= 1.0).count() as f64;
        let rest: f64 = inclusion.iter().filter(|&&p| p < 1.0).sum();
        let factor = (count as f64 - certain) / rest;
        if !(factor > 1.0 + 1e-9) {
            inclusion.iter_mut().for_each(|p| *p = p.min(1.0));
            return inclusion;
        }
        inclusion.iter_mut().for_each(|p| *p = if *p >= 1.0 { 1.0 } else { *p * factor });
    }
}

/// Returns the contrast of each pixel: its relative difference from the median around it, plus the largest relative
/// difference from a neighbour, at most 1.
fn contrasts(image: &Image) -> Vec<f64> {
    let value = |i: usize| f64::from(image.pixels[i].element_sum());
    let mean = (0..image.pixels.len()).map(value).sum::<f64>() / image.pixels.len().max(1) as f64;
    let floor = (CONTRAST_FLOOR * mean).max(f64::MIN_POSITIVE);
    let (width, height) = (image.width as usize, image.height as usize);
    let mut around = Vec::with_capacity(9);
    let at = |i: usize| {
        let (x, y, here) = (i % width, i / width, value(i));
        let mut most: f64 = 0.0;
        around.clear();
        for v in y.saturating_sub(1)..(y + 2).min(height) {
            for u in x.saturating_sub(1)..(x + 2).min(width) {
                let there = value(v * width + u);
                most = most.max((here - there).abs() / (here.abs() + there.abs() + floor));
                around.push(there);
            }
        }
        around.sort_by(f64::total_cmp);
        let median = around[around.len() / 2];
        let outlier = (here - median).abs() / (median.abs() + floor);
        if outlier.is_finite() { most + outlier } else { 1.0 }
    };
    (0..image.pixels.len()).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::Rgb;

    /// Creates a smooth ramp with a bright stripe.
    fn image() -> Image {
        let mut image = Image::new(60, 40);
        for (i, pixel) in image.pixels.iter_mut().enumerate() {
            let x = i % 60;
            *pixel = Rgb::splat(if x == 33 { 5.0 } else { 1.0 + 0.01 * x as f32 });
        }
        image
    }

    #[test]
    fn weights_undo_the_preference() {
        let image = image();
        let truth: f64 = image.pixels.iter().map(|p| f64::from(p.x)).sum();
        let seeds = 200;
        let (mut sum, mut pixels) = (0.0, 0.0);
        for seed in 0..seeds {
            for pick in choose(&image, 100, seed) {
                sum += pick.weight * f64::from(image.pixels[pick.index].x);
                pixels += pick.weight;
            }
        }
        assert!((sum / truth / f64::from(seeds) - 1.0).abs() < 0.01, "{}", sum / truth / f64::from(seeds));
        assert!((pixels / 2400.0 / f64::from(seeds) - 1.0).abs() < 0.01);
    }

    #[test]
    fn edges_are_preferred_and_pixels_picked_once() {
        let picks = choose(&image(), 300, 7);
        let edge = picks.iter().filter(|p| (32..=34).contains(&(p.index % 60))).count();
        assert!(edge as f64 > 0.25 * picks.len() as f64, "{edge} of {}", picks.len());
        let mut indices: Vec<usize> = picks.iter().map(|p| p.index).collect();
        indices.sort();
        indices.dedup();
        assert_eq!(indices.len(), picks.len());
    }

    #[test]
    fn outliers_are_not_missed() {
        let mut image = image();
        image.pixels[700] = Rgb::splat(200.0);
        for seed in 0..20 {
            let picks = choose(&image, 100, seed);
            assert!(picks.contains(&Pick { index: 700, weight: 1.0 }) && picks.len() == 100);
        }
    }

    #[test]
    fn small_and_black_images_are_no_trouble() {
        assert_eq!(choose(&Image::new(3, 2), 6, 0).len(), 6);
        assert_eq!(choose(&Image::new(3, 2), 100, 0).len(), 6);
        let picks = choose(&Image::new(50, 50), 25, 0);
        assert!((picks.iter().map(|p| p.weight).sum::<f64>() - 2500.0).abs() < 1e-6);
    }
}
