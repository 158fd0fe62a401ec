//! A model of the seconds of a render, fitted to a few renders that were smaller or cheaper.
//!
//! - The time of the light pass and the trees is proportional to the number of virtual lights.
//! - The time of the eye pass is a linear function of the samples. The number of extra samples depends on the time of
//!   all other stages.
//! - All other stages take `c · e^(β (h - h₀)) · (n / n₀)^-γ` seconds per point, at level h of the quality scale and
//!   for n points. β is the cost of finer settings. γ is the gain by denser points, as neighbours share more.
//!
//! Prices of [`crate::cost`] do not depend on the machine; this model does.

use transport::eye::ExtraSamples;

/// Cost of finer settings, before renders at two levels were timed.
const BETA: f64 = 0.35;
/// Range to which the measured cost of finer settings is clamped.
const BETA_RANGE: [f64; 2] = [0.05, 1.4];
/// Gain by denser points if the samples of a pixel are merged.
const MERGED_GAMMA: f64 = 0.4;
/// Gain by denser points if points share light by patches.
const PATCHES_GAMMA: f64 = 0.25;
/// Gain by denser points otherwise.
const OTHER_GAMMA: f64 = 0.1;
/// Gain by denser samples in the eye pass, before two renders were timed.
const EYE_GAMMA: f64 = 0.35;
/// Minimum difference of levels, or of logarithms of sample counts, between two renders that determine a slope.
const MIN_APART: f64 = 0.5;

/// Counts on which the time of a render depends.
#[derive(Clone, Copy, Debug)]
pub struct Size {
    /// Number of pixels.
    pub pixels: f64,
    /// Number of eye samples without extra ones.
    pub samples: f64,
    /// True if the samples of a pixel are merged before they are lit.
    pub merged: bool,
    /// True if points share light by patches.
    pub patches: bool,
    /// Maximum number of extra samples, as a share of the others.
    pub most_extra: f32,
    /// Number of virtual lights.
    pub vpls: f64,
}

/// A render that was timed. Times are wall-clock seconds.
#[derive(Clone, Copy, Debug)]
pub struct Timed {
    /// Level on the quality scale.
    pub level: f64,
    /// Counts of the render.
    pub size: Size,
    /// Number of eye samples with extra ones.
    pub samples: f64,
    /// Time of the light pass and the trees.
    pub light: f64,
    /// Time of the eye pass.
    pub eye: f64,
    /// Time of all other stages.
    pub rest: f64,
}

/// The fitted model.
#[derive(Clone, Copy, Debug)]
pub struct TimeModel {
    last: Timed,
    /// Seconds of another sample of the eye pass, if they were measured.
    eye: Option<f64>,
    beta: f64,
    /// Seconds per sample after the render.
    finishing: f64,
}

impl Size {
    /// Returns the number of points that are lit.
    fn points(&self) -> f64 {
        if self.merged { self.pixels } else { self.samples }
    }

    /// Returns the number of samples, extra ones included, if the first samples are taken in `rounds`, each takes
    /// `another` seconds, and all else takes `rest` seconds.
    fn all_samples(&self, rounds: f64, rest: f64, another: f64) -> f64 {
        let extra = ExtraSamples { most: self.most_extra, other_rays: Some(rest) };
        let first = rounds * self.samples;
        first * f64::from(1.0 + extra.share(first * another))
    }

    fn gamma(&self) -> f64 {
        match self {
            Size { merged: true, .. } => MERGED_GAMMA,
            Size { patches: true, .. } => PATCHES_GAMMA,
            _ => OTHER_GAMMA,
        }
    }
}

impl Timed {
    /// Returns how often all pixels got the first samples, 1 or 2, from the number of samples of `another` seconds.
    fn rounds(&self, another: f64) -> f64 {
        let [one, two] = [1.0, 2.0].map(|rounds| self.size.all_samples(rounds, self.rest, another));
        if self.samples > (one * two).sqrt() { 2.0 } else { 1.0 }
    }
}

impl TimeModel {
    /// Fits the model to renders, of which the last is the most similar to the one planned; `None` if there are none.
    ///
    /// Each eye sample takes `finishing` seconds after the render.
    pub fn fit(timed: &[Timed], finishing: f64) -> Option<TimeModel> {
        let last = *timed.last()?;
        let by_point = |t: &Timed| (t.rest / t.size.points()).max(f64::MIN_POSITIVE).ln();
        let pairs = timed.iter().enumerate().flat_map(|(i, a)| timed[i + 1..].iter().map(move |b| (a, b)));
        let density = |(a, b): &(&Timed, &Timed)| (b.size.points() / a.size.points()).ln();
        let mut beta = BETA;
        let mut apart = pairs.filter(|(a, b)| (a.level - b.level).abs() >= MIN_APART);
        // The latest pair: the last render, and the largest one before it.
        if let Some((a, b)) = apart.next_back() {
            let alike = by_point(b) - by_point(a) + last.size.gamma() * density(&(a, b));
            beta = (alike / (b.level - a.level)).clamp(BETA_RANGE[0], BETA_RANGE[1]);
        }
        Some(TimeModel { last, eye: eye(timed), beta, finishing })
    }

    /// Returns the level of the last render that the model was fitted to.
    pub fn level(&self) -> f64 {
        self.last.level
    }

    /// Returns the seconds of a render of a size at `level`.
    pub fn seconds(&self, level: f64, size: &Size) -> f64 {
        let last = &self.last;
        let light = match last.size.vpls {
            vpls if vpls > 0.0 => last.light * size.vpls / vpls,
            _ => last.light,
        };
        let points = size.points() / last.size.points();
        let rest = last.rest * (self.beta * (level - last.level)).exp() * points.powf(1.0 - size.gamma());
        let eye = match self.eye {
            Some(another) => {
                let samples = size.all_samples(last.rounds(another), rest, another);
                (last.eye + (samples - last.samples) * another).max(0.0)
            }
            None if last.size.vpls > 0.0 => {
                last.eye * (size.samples / last.size.samples).powf(1.0 - EYE_GAMMA)
            }
            None => last.eye * size.samples / last.size.samples,
        };
        light + eye + rest
    }

    /// Returns the seconds that the samples of a size take after the render.
    pub fn finishing(&self, size: &Size) -> f64 {
        self.finishing * size.samples
    }
}

/// Returns the seconds of another sample of the eye pass; `None` if the renders have similar numbers of samples.
///
/// The slope is taken between the fewest and the most samples. It is at least a fifth of the mean of the latter, since
/// clocks err.
fn eye(timed: &[Timed]) -> Option<f64> {
    let by_samples = |a: &&Timed, b: &&Timed| a.samples.total_cmp(&b.samples);
    let (least, most) = timed.iter().min_by(by_samples).zip(timed.iter().max_by(by_samples))?;
    let mean = most.eye / most.samples;
    let another = (most.eye - least.eye) / (most.samples - least.samples);
    ((most.samples / least.samples).ln() >= MIN_APART).then(|| another.clamp(0.2 * mean, mean))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn size(pixels: f64, spp: f64, vpls: f64, merged: bool) -> Size {
        let most_extra = if merged { 1.0 } else { 0.0 };
        Size { pixels, samples: pixels * spp, merged, patches: merged, most_extra, vpls }
    }

    /// A machine on which the model is exact.
    fn timed(level: f64, size: Size, rounds: f64) -> Timed {
        let rest = 1e-5 * (0.6 * level).exp() * size.points().powf(1.0 - size.gamma());
        let another = 2e-7;
        let samples = size.all_samples(rounds, rest, another);
        Timed { level, size, samples, light: 3e-6 * size.vpls, eye: 5e-3 + another * samples, rest }
    }

    #[test]
    fn exact_costs_are_predicted_from_three_renders() {
        for (merged, rounds) in [(false, 1.0), (true, 1.0), (true, 2.0)] {
            let of = |level, pixels, spp, vpls| timed(level, size(pixels, spp, vpls, merged), rounds);
            let known = [of(0.0, 4e3, 1.0, 2e4), of(0.0, 1.6e4, 1.0, 2e4), of(2.5, 1.6e4, 3.0, 1e5)];
            let cost = TimeModel::fit(&known, 0.0).unwrap();
            for (level, pixels, spp, vpls) in
                [(0.0, 2.6e5, 1.0, 2e4), (2.5, 1e6, 4.0, 1e5), (6.0, 1e6, 64.0, 2e6)]
            {
                let Timed { light, eye, rest, size, .. } = of(level, pixels, spp, vpls);
                let found = cost.seconds(level, &size);
                assert!((found / (light + eye + rest) - 1.0).abs() < 1e-6, "{level} {found} {merged}");
            }
        }
    }

    #[test]
    fn one_render_makes_a_model_and_none_does_not() {
        assert!(TimeModel::fit(&[], 0.0).is_none());
        let expected = timed(1.0, size(4e3, 1.0, 2e4, false), 1.0);
        let one = TimeModel::fit(&[expected], 1e-6).unwrap();
        assert_eq!(one.finishing(&size(4e3, 2.0, 2e4, false)), 8e-3);
        let seconds = |level, spp| one.seconds(level, &size(4e3, spp, 2e4, false));
        assert!((seconds(1.0, 1.0) - expected.light - expected.eye - expected.rest).abs() < 1e-12);
        assert!(seconds(2.0, 1.0) > seconds(1.0, 1.0));
        assert!(seconds(1.0, 2.0) > seconds(1.0, 1.0));
    }

    #[test]
    fn renders_too_fast_to_time_are_no_trouble() {
        let nothing = Timed {
            level: 0.0,
            size: size(1.0, 1.0, 0.0, false),
            samples: 1.0,
            light: 0.0,
            eye: 0.0,
            rest: 0.0,
        };
        let other = Timed { level: 3.0, size: size(9.0, 1.0, 0.0, false), samples: 9.0, ..nothing };
        let cost = TimeModel::fit(&[nothing, other], 0.0).unwrap();
        assert!(cost.seconds(6.0, &size(1e6, 1.0, 1e6, false)).is_finite());
    }
}
