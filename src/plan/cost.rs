//! A model of the time of a render, fitted to a few renders that were smaller or cheaper.
//!
//! The light pass and its trees take time with the virtual lights, whatever the film. The eye pass takes time with the
//! eye samples, and some whatever their number. All else takes time with the eye samples: each one
//! `c · e^(β (h - h₀)) · (n / n₀)^-γ` seconds at level h of the quality scale and n samples in all. β is the cost of
//! finer settings, γ the gain by denser samples, as neighbours share more.

/// Seconds a sample per height: before two heights are known, and the range in which it is believed.
const BETA: (f64, [f64; 2]) = (0.35, [0.05, 1.4]);
/// The exponent of density: the same.
const GAMMA: (f64, [f64; 2]) = (0.35, [0.0, 0.8]);
/// Heights and logarithms of densities closer than this say nothing of exponents.
const LEAST_APART: f64 = 0.5;

/// A render that was timed. Times are wall-clock seconds.
#[derive(Clone, Copy, Debug)]
pub struct Timed {
    /// Its level on the quality scale.
    pub height: f64,
    /// Eye samples.
    pub samples: f64,
    /// Virtual lights asked for.
    pub vpls: f64,
    /// Of the light pass and its trees.
    pub light: f64,
    /// Of the eye pass.
    pub eye: f64,
    /// Of all else.
    pub rest: f64,
}

/// The model: see the head.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    last: Timed,
    /// Seconds that another sample of the eye pass takes, where they are known.
    eye: Option<f64>,
    beta: f64,
    gamma: f64,
}

impl Cost {
    /// Fits the model to renders, of which the last is the most similar to the one planned; `None` if there
    /// are none.
    pub fn fit(timed: &[Timed]) -> Option<Cost> {
        let last = *timed.last()?;
        let by_sample = |t: &Timed| (t.rest / t.samples).max(f64::MIN_POSITIVE).ln();
        let mut gamma = GAMMA.0;
        // Two of one height, as different in size as there are.
        let pairs = timed.iter().enumerate().flat_map(|(i, a)| timed[i + 1..].iter().map(move |b| (a, b)));
        let density = |(a, b): &(&Timed, &Timed)| (b.samples / a.samples).ln().abs();
        let sizes = pairs.clone().filter(|(a, b)| a.height == b.height && a.samples != b.samples);
        if let Some((a, b)) = sizes.max_by(|x, y| density(x).total_cmp(&density(y)))
            && density(&(a, b)) >= LEAST_APART
        {
            let slope = (by_sample(a) - by_sample(b)) / (b.samples / a.samples).ln();
            gamma = slope.clamp(GAMMA.1[0], GAMMA.1[1]);
        }
        let mut beta = BETA.0;
        let mut heights = pairs.filter(|(a, b)| (a.height - b.height).abs() >= LEAST_APART);
        // The latest pair: its second is the last, and its first the largest before it.
        if let Some((a, b)) = heights.next_back() {
            let alike = by_sample(b) - by_sample(a) + gamma * (b.samples / a.samples).ln();
            beta = (alike / (b.height - a.height)).clamp(BETA.1[0], BETA.1[1]);
        }
        Some(Cost { last, eye: eye(timed), beta, gamma })
    }

    /// Seconds of a render of so many samples and virtual lights at `height`.
    pub fn seconds(&self, height: f64, samples: f64, vpls: f64) -> f64 {
        let last = &self.last;
        let light = if last.vpls > 0.0 { last.light * vpls / last.vpls } else { last.light };
        let fewer = (samples / last.samples).powf(-self.gamma);
        let eye = match self.eye {
            Some(another) => (last.eye + (samples - last.samples) * another).max(0.0),
            None => last.eye * (samples / last.samples).powf(1.0 - GAMMA.0),
        };
        light + eye + samples * last.rest / last.samples * (self.beta * (height - last.height)).exp() * fewer
    }
}

/// Seconds that another sample of the eye pass takes, by the renders of the fewest and of the most samples, if these
/// are far apart; at least a fifth of the mean of the latter, since clocks err.
fn eye(timed: &[Timed]) -> Option<f64> {
    let by_samples = |a: &&Timed, b: &&Timed| a.samples.total_cmp(&b.samples);
    let (few, most) = timed.iter().min_by(by_samples).zip(timed.iter().max_by(by_samples))?;
    let mean = most.eye / most.samples;
    let another = (most.eye - few.eye) / (most.samples - few.samples);
    ((most.samples / few.samples).ln() >= LEAST_APART).then(|| another.clamp(0.2 * mean, mean))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A machine on which the model is exact.
    fn timed(height: f64, samples: f64, vpls: f64) -> Timed {
        let each = 1e-5 * (0.6 * height).exp() * samples.powf(-0.2);
        Timed { height, samples, vpls, light: 3e-6 * vpls, eye: 5e-3 + 2e-7 * samples, rest: each * samples }
    }

    #[test]
    fn exact_costs_are_predicted_from_three_renders() {
        let cost =
            Cost::fit(&[timed(0.0, 4e3, 2e4), timed(0.0, 1.6e4, 2e4), timed(2.5, 1.6e4, 1e5)]).unwrap();
        for (height, samples, vpls) in [(0.0, 2.6e5, 2e4), (2.5, 1e6, 1e5), (6.0, 1e6, 2e6)] {
            let expected = timed(height, samples, vpls);
            let found = cost.seconds(height, samples, vpls);
            assert!(
                (found / (expected.light + expected.eye + expected.rest) - 1.0).abs() < 1e-9,
                "{height} {found}"
            );
        }
    }

    #[test]
    fn one_render_makes_a_model_and_none_does_not() {
        assert!(Cost::fit(&[]).is_none());
        let one = Cost::fit(&[timed(1.0, 4e3, 2e4)]).unwrap();
        let expected = timed(1.0, 4e3, 2e4);
        assert!((one.seconds(1.0, 4e3, 2e4) - expected.light - expected.eye - expected.rest).abs() < 1e-12);
        assert!(one.seconds(2.0, 4e3, 2e4) > one.seconds(1.0, 4e3, 2e4));
        assert!(one.seconds(1.0, 8e3, 2e4) > one.seconds(1.0, 4e3, 2e4));
    }

    #[test]
    fn renders_too_fast_to_time_are_no_trouble() {
        let nothing = Timed { height: 0.0, samples: 1.0, vpls: 0.0, light: 0.0, eye: 0.0, rest: 0.0 };
        let cost = Cost::fit(&[nothing, Timed { height: 3.0, samples: 9.0, ..nothing }]).unwrap();
        assert!(cost.seconds(6.0, 1e6, 1e6).is_finite());
    }
}
