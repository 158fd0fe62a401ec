//! Converged references, of pixels or of the points of eye samples: path-traced in two independent halves, in
//! rounds each of which is stored when it is finished.
//!
//! Half the halves' difference estimates the noise of their mean, pixel by pixel; and as the halves' errors
//! are independent, a picture's mean square error against the truth is the mean of the product of its
//! differences from either, without the reference's noise in it.

use super::store::Kept;
use super::{Study, StudyError, Subject};
use base::film::metrics::{flip_map, psnr, rel_mse_of_variance};
use base::film::{Image, tone};
use base::math::Rgb;
use base::stats::Stopwatch;
use render::method::path;
use render::method::render;
use serde::Serialize;
use serde_json::json;
use transport::paths::Estimand;

/// Maximum number of samples a pixel that each half takes in a round.
const ROUND: u32 = 64;

/// Limits at which a reference is good enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceSettings {
    /// Samples a pixel, both halves together.
    pub spp: u32,
    /// No round begins after this many elapsed seconds, those of earlier runs included.
    pub seconds: f64,
}

impl Default for ReferenceSettings {
    fn default() -> ReferenceSettings {
        ReferenceSettings { spp: 1024, seconds: 1800.0 }
    }
}

/// A reference picture with its noise.
pub struct Reference {
    /// Mean of the halves.
    pub mean: Image,
    /// The two halves: independent, of equal numbers of samples.
    pub halves: [Image; 2],
    /// Noise of the mean.
    pub noise: Noise,
    /// Exposure for display.
    pub exposure: f32,
}

/// Estimates of a reference's own error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Noise {
    /// Samples a pixel, both halves together.
    pub spp: u32,
    /// Processor seconds spent on both halves.
    pub cpu_seconds: f64,
    /// Standard error of a pixel's mean over the mean of the picture, root mean square over pixels and
    /// channels.
    pub standard_error: f64,
    /// Part of a picture's relMSE that is due to the reference's noise.
    pub rel_mse: f64,
    /// PSNR of the truth against the reference, dB.
    pub psnr: Option<f64>,
    /// FLIP between the halves, whose difference is twice the noise of their mean.
    pub flip_of_halves: f64,
}

/// Renders the missing rounds of the subject's reference.
pub(super) fn reference(
    study: &Study,
    subject: &Subject,
    estimand: Estimand,
) -> Result<Reference, StudyError> {
    let (of, cycle) = match estimand {
        Estimand::Pixels => ("", 1),
        Estimand::EyeSamples { spp, .. } => (" of eye samples", spp.max(1)),
    };
    let name = format!("{}, reference{of}", subject.name);
    let key = json!({
        "scene": format!("{:016x}", subject.hash),
        "film": study.plan.resolution,
        "version": env!("CARGO_PKG_VERSION"),
        "method": "path",
        "look": format!("{estimand:?}"),
    });
    let mut progress = match study.store.load(&name, &key, &["a", "b"]) {
        Some(kept) => Progress::resume(kept),
        None => None,
    }
    .unwrap_or_else(|| Progress::new(study.plan.resolution));
    while progress.each * 2 < study.plan.reference.spp
        && (progress.rounds == 0 || progress.seconds < study.plan.reference.seconds)
    {
        let spp = (study.plan.reference.spp.div_ceil(2) - progress.each).min(ROUND);
        // A cycle of samples takes each position of a sample equally often.
        progress.round(study, subject, estimand, spp.next_multiple_of(cycle))?;
        study.store.save(&name, &key, &progress.kept())?;
        (study.say)(&format!("{name}: {} samples a pixel, {:.0} s", progress.each * 2, progress.seconds));
    }
    Ok(progress.finish())
}

struct Progress {
    halves: [Image; 2],
    /// Number of samples a pixel of each half.
    each: u32,
    rounds: u32,
    seconds: f64,
    cpu_seconds: f64,
}

impl Progress {
    fn new([width, height]: [u32; 2]) -> Progress {
        let blank = || Image::new(width, height);
        Progress { halves: [blank(), blank()], each: 0, rounds: 0, seconds: 0.0, cpu_seconds: 0.0 }
    }

    fn resume(kept: Kept) -> Option<Progress> {
        let number = |name: &str| kept.facts[name].as_f64();
        let (each, rounds) = (number("each")? as u32, number("rounds")? as u32);
        let (seconds, cpu_seconds) = (number("seconds")?, number("cpu_seconds")?);
        let halves: Vec<Image> = kept.layers.into_iter().map(|(_, image)| image).collect();
        Some(Progress { halves: halves.try_into().ok()?, each, rounds, seconds, cpu_seconds })
    }

    fn round(
        &mut self,
        study: &Study,
        subject: &Subject,
        estimand: Estimand,
        spp: u32,
    ) -> Result<(), StudyError> {
        let watch = Stopwatch::start();
        let mut more = Vec::with_capacity(2);
        for half in 0..2 {
            // Seed 0 is the default of all methods, none of which should share random numbers with its
            // reference.
            let settings =
                path::Settings { spp, seed: 1 + 2 * self.rounds + half, estimand, ..Default::default() };
            let output = render(&subject.session.world, &subject.view, &settings, study.control);
            if !output.complete {
                return Err(StudyError::Interrupted);
            }
            more.push(output.color);
        }
        let share = spp as f32 / (self.each + spp) as f32;
        for (half, more) in self.halves.iter_mut().zip(&mut more) {
            more.remove_nonfinite();
            half.pixels.iter_mut().zip(&more.pixels).for_each(|(mean, more)| *mean += (more - *mean) * share);
        }
        let time = watch.elapsed();
        self.each += spp;
        self.rounds += 1;
        self.seconds += time.wall_seconds;
        self.cpu_seconds += time.cpu_seconds;
        Ok(())
    }

    fn kept(&self) -> Kept {
        let [a, b] = self.halves.clone();
        Kept {
            color: mean(&self.halves),
            layers: vec![("a".to_owned(), a), ("b".to_owned(), b)],
            facts: json!({
                "each": self.each,
                "rounds": self.rounds,
                "seconds": self.seconds,
                "cpu_seconds": self.cpu_seconds,
            }),
        }
    }

    fn finish(self) -> Reference {
        Reference::of_halves(self.halves, self.each * 2, self.cpu_seconds)
    }
}

impl Reference {
    /// Combines independent halves, of `spp` samples a pixel together.
    pub(super) fn of_halves(halves: [Image; 2], spp: u32, cpu_seconds: f64) -> Reference {
        let mean = mean(&halves);
        let exposure = tone::auto_factor(&mean);
        let noise = Noise::of(&mean, &halves, exposure, spp, cpu_seconds);
        Reference { mean, halves, noise, exposure }
    }
}

impl Noise {
    fn of(mean: &Image, halves: &[Image; 2], exposure: f32, spp: u32, cpu_seconds: f64) -> Noise {
        let [a, b] = halves;
        let variance = Image {
            pixels: a.pixels.iter().zip(&b.pixels).map(|(a, b)| (a - b) * (a - b) * 0.25).collect(),
            ..*mean
        };
        let average = |image: &Image| {
            let sum: f64 = image.pixels.iter().map(|p| p.as_dvec3().element_sum() / 3.0).sum();
            sum / image.pixels.len().max(1) as f64
        };
        let flips = flip_map(a, b, exposure);
        Noise {
            spp,
            cpu_seconds,
            standard_error: average(&variance).sqrt() / average(mean).max(f64::MIN_POSITIVE),
            rel_mse: rel_mse_of_variance(&variance, mean),
            // The halves' difference has four times the square of the mean's error.
            psnr: psnr(a, b, exposure).map(|db| db + 20.0 * 2f64.log10()),
            flip_of_halves: flips.iter().map(|&e| f64::from(e)).sum::<f64>() / flips.len().max(1) as f64,
        }
    }
}

fn mean([a, b]: &[Image; 2]) -> Image {
    let pixels: Vec<Rgb> = a.pixels.iter().zip(&b.pixels).map(|(a, b)| (a + b) * 0.5).collect();
    Image { width: a.width, height: a.height, pixels }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::hash;

    /// Halves of a given standard deviation around 1 have the expected noise of the mean.
    #[test]
    fn noise_is_that_of_the_mean() {
        let deviation = 0.02f32;
        let uniform = |i: usize, seed: u32| hash(i as u32, seed) as f32 / u32::MAX as f32 - 0.5;
        let half = |seed: u32| {
            let mut image = Image::new(64, 64);
            let pixels = image.pixels.iter_mut().enumerate();
            pixels.for_each(|(i, p)| *p = Rgb::splat(1.0 + deviation * 12f32.sqrt() * uniform(i, seed)));
            image
        };
        let halves = [half(1), half(2)];
        let noise = Noise::of(&mean(&halves), &halves, 0.5, 8, 1.0);
        let expected = f64::from(deviation) / 2f64.sqrt();
        assert!((noise.standard_error / expected - 1.0).abs() < 0.05, "{noise:?}");
        assert!((noise.rel_mse / (expected * expected / 1.01) - 1.0).abs() < 0.1, "{noise:?}");
    }
}
