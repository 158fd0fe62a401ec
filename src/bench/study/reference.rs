//! Converged references, of pixels or of eye samples: two independent halves of path tracing, rendered in rounds each
//! of which is stored when it is finished.
//!
//! Half the difference of the halves estimates the noise of their mean in each pixel. As the errors of the halves are
//! independent, the mean product of an image's differences from both is its mean square error against the truth,
//! without the noise of the reference.

use super::cell::{figure, optional, seconds};
use super::store::Stored;
use super::{Study, StudyError, Subject};
use base::film::metrics::{flip_map, psnr, rel_mse_of_variance};
use base::film::{Image, tone};
use base::stats::Stopwatch;
use render::method::path;
use render::method::render;
use serde::{Deserialize, Serialize};
use serde_json::json;
use transport::paths::Estimand;

/// Maximum number of samples per pixel that each half takes in a round.
const ROUND: u32 = 64;

/// A reference image with its noise.
pub struct Reference {
    /// Mean of the halves.
    pub mean: Image,
    /// Independent halves of equal numbers of samples.
    pub halves: [Image; 2],
    /// Noise of the mean.
    pub noise: Noise,
    /// Exposure for display.
    pub exposure: f32,
}

/// Estimates of a reference's own error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Noise {
    /// Samples per pixel, both halves together.
    pub spp: u32,
    /// Processor seconds spent on both halves.
    pub cpu_seconds: f64,
    /// Standard error of a pixel's mean over the mean of the image, root mean square over pixels and channels.
    pub standard_error: f64,
    /// Part of an image's relMSE that is due to the reference's noise.
    pub rel_mse: f64,
    /// PSNR of the truth against the reference, dB.
    pub psnr: Option<f64>,
    /// FLIP between the halves, whose difference is twice the noise of their mean.
    pub flip_of_halves: f64,
}

impl Study<'_> {
    /// Returns the subject's reference, after rendering the missing rounds.
    pub fn reference(&self, subject: &Subject, estimand: Estimand) -> Result<Reference, StudyError> {
        let (of, cycle) = match estimand {
            Estimand::Pixels => ("", 1),
            Estimand::EyeSamples { spp, .. } => (" of eye samples", spp.max(1)),
        };
        let wanted = self.plan.reference;
        let name = format!("{}, reference{of}", subject.name);
        let key = json!({
            "scene": format!("{:016x}", subject.hash),
            "film": self.plan.resolution,
            "version": env!("CARGO_PKG_VERSION"),
            "method": "path",
            "look": format!("{estimand:?}"),
        });
        let stored = self.store.load(&name, &key, &["a", "b"]).and_then(Rounds::resume);
        let mut rounds = stored.unwrap_or_else(|| Rounds::new(self.plan.resolution));
        while rounds.done.each * 2 < wanted.spp
            && (rounds.done.rounds == 0 || rounds.done.seconds < wanted.seconds)
        {
            let spp = (wanted.spp.div_ceil(2) - rounds.done.each).min(ROUND);
            // Each position of an eye sample is taken equally often.
            rounds.render(self, subject, estimand, spp.next_multiple_of(cycle))?;
            self.store.save(&name, &key, &rounds.stored())?;
            let Done { each, seconds, .. } = rounds.done;
            (self.say)(&format!("{name}: {} samples per pixel, {seconds:.0} s", each * 2));
        }
        Ok(Reference::of_halves(rounds.halves, rounds.done.each * 2, rounds.done.cpu_seconds))
    }
}

impl Noise {
    /// Describes a reference of pixels.
    pub fn about(&self) -> String {
        format!(
            "Reference: {} paths per pixel, {} s; standard error {:.2} % of the mean radiance, relMSE {}, PSNR {} dB. FLIP \
             between its halves, which differ by twice its noise, is {}.",
            self.spp,
            seconds(self.cpu_seconds),
            100.0 * self.standard_error,
            figure(self.rel_mse),
            optional(self.psnr),
            figure(self.flip_of_halves)
        )
    }
}

/// Rounds of a reference.
struct Rounds {
    halves: [Image; 2],
    done: Done,
}

/// Work done so far.
#[derive(Clone, Copy, Default, Serialize, Deserialize)]
struct Done {
    /// Samples per pixel of each half.
    each: u32,
    rounds: u32,
    seconds: f64,
    cpu_seconds: f64,
}

impl Rounds {
    fn new([width, height]: [u32; 2]) -> Rounds {
        Rounds { halves: [Image::new(width, height), Image::new(width, height)], done: Done::default() }
    }

    fn resume(stored: Stored) -> Option<Rounds> {
        let done = serde_json::from_value(stored.facts).ok()?;
        let halves: Vec<Image> = stored.layers.into_iter().map(|(_, image)| image).collect();
        Some(Rounds { halves: halves.try_into().ok()?, done })
    }

    fn render(
        &mut self,
        study: &Study,
        subject: &Subject,
        estimand: Estimand,
        spp: u32,
    ) -> Result<(), StudyError> {
        let watch = Stopwatch::start();
        let mut more = Vec::with_capacity(2);
        for half in 0..2 {
            // Seed 0 is the default of all methods, which should share no random numbers with their reference.
            let seed = 1 + 2 * self.done.rounds + half;
            let settings = path::Settings { spp, seed, estimand, ..Default::default() };
            let output = render(&subject.session.world, &subject.view, &settings, study.control);
            if !output.complete {
                return Err(StudyError::Interrupted);
            }
            more.push(output.color);
        }
        let share = spp as f32 / (self.done.each + spp) as f32;
        for (half, more) in self.halves.iter_mut().zip(&mut more) {
            more.remove_nonfinite();
            half.pixels.iter_mut().zip(&more.pixels).for_each(|(mean, more)| *mean += (more - *mean) * share);
        }
        let time = watch.elapsed();
        self.done.each += spp;
        self.done.rounds += 1;
        self.done.seconds += time.wall_seconds;
        self.done.cpu_seconds += time.cpu_seconds;
        Ok(())
    }

    fn stored(&self) -> Stored {
        let [a, b] = self.halves.clone();
        let layers = vec![("a".to_owned(), a), ("b".to_owned(), b)];
        Stored { color: mean_of_halves(&self.halves), layers, facts: json!(self.done) }
    }
}

impl Reference {
    /// Combines independent halves, of `spp` samples per pixel together.
    pub(super) fn of_halves(halves: [Image; 2], spp: u32, cpu_seconds: f64) -> Reference {
        let average = mean_of_halves(&halves);
        let exposure = tone::auto_factor(&average);
        let [a, b] = &halves;
        let squares = a.pixels.iter().zip(&b.pixels).map(|(a, b)| (a - b) * (a - b) * 0.25).collect();
        let variance = Image { pixels: squares, ..average };
        let flips = flip_map(a, b, exposure);
        let noise = Noise {
            spp,
            cpu_seconds,
            standard_error: mean(&variance).sqrt() / mean(&average).max(f64::MIN_POSITIVE),
            rel_mse: rel_mse_of_variance(&variance, &average),
            // The halves' difference has four times the square of the mean's error.
            psnr: psnr(a, b, exposure).map(|db| db + 20.0 * 2f64.log10()),
            flip_of_halves: flips.iter().map(|&e| f64::from(e)).sum::<f64>() / flips.len().max(1) as f64,
        };
        Reference { mean: average, halves, noise, exposure }
    }
}

/// Returns the mean over pixels and channels.
pub fn mean(image: &Image) -> f64 {
    let sum: f64 = image.pixels.iter().map(|p| p.as_dvec3().element_sum() / 3.0).sum();
    sum / image.pixels.len().max(1) as f64
}

fn mean_of_halves([a, b]: &[Image; 2]) -> Image {
    let pixels = a.pixels.iter().zip(&b.pixels).map(|(a, b)| (a + b) * 0.5).collect();
    Image { width: a.width, height: a.height, pixels }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::Rgb;
    use base::sampling::hash;

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
        let noise = Reference::of_halves([half(1), half(2)], 8, 1.0).noise;
        let expected = f64::from(deviation) / 2f64.sqrt();
        assert!((noise.standard_error / expected - 1.0).abs() < 0.05, "{noise:?}");
        assert!((noise.rel_mse / (expected * expected / 1.01) - 1.0).abs() < 0.1, "{noise:?}");
    }
}
