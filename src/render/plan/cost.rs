//! A model of the time of a render, fitted to a few renders that were smaller or cheaper.
//!
//! The light pass and its trees take time with the virtual lights, whatever the film. The eye pass takes time with the
//! samples that it draws, and some whatever their number; how many are worth drawing beside the first ones depends on
//! what all else takes. All else takes time with the points that it lights: each one `c · e^(β (h - h₀)) · (n / n₀)^-γ`
//! seconds at level h of the quality scale and n points in all. β is the cost of finer settings, γ the gain by denser
//! points, as neighbours share more.
//!
//! Measured: γ between films an eighth as wide and whole ones is .38 to .45 in six scenes at three levels, n the number
//! of pixels, where their samples are merged; .2 to .4 where each sample is lit by records, the less the more there
//! are; .1 where every pixel has its cuts. Films a sixteenth as wide say nothing of it.

use transport::eye::ExtraSamples;

/// Seconds a point per height: before two heights are known, and the range in which it is believed.
const BETA: (f64, [f64; 2]) = (0.35, [0.05, 1.4]);
/// The exponent of density where samples are merged, where others share light by patches, and where they do not; and of
/// the eye pass where one render alone is known.
const MERGED_GAMMA: f64 = 0.4;
const PATCHES_GAMMA: f64 = 0.25;
const OTHER_GAMMA: f64 = 0.1;
const EYE_GAMMA: f64 = 0.35;
/// Heights and logarithms of numbers of samples closer than this say nothing of exponents and slopes.
const LEAST_APART: f64 = 0.5;

/// Numbers of what a render takes time with.
#[derive(Clone, Copy, Debug)]
pub struct Size {
    /// Pixels.
    pub pixels: f64,
    /// Eye samples, but for extra ones.
    pub samples: f64,
    /// True if the samples of a pixel are merged before they are lit.
    pub merged: bool,
    /// True if points share light by patches.
    pub patches: bool,
    /// Extra samples at most, as a share of the others.
    pub most_extra: f32,
    /// Virtual lights asked for.
    pub vpls: f64,
}

/// A render that was timed. Times are wall-clock seconds.
#[derive(Clone, Copy, Debug)]
pub struct Timed {
    /// Its level on the quality scale.
    pub height: f64,
    /// Its size.
    pub size: Size,
    /// Eye samples drawn, extra ones included.
    pub drawn: f64,
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
    /// Seconds that a sample takes after the render.
    looking: f64,
}

impl Size {
    /// Number of points that are lit.
    fn points(&self) -> f64 {
        if self.merged { self.pixels } else { self.samples }
    }

    fn gamma(&self) -> f64 {
        match self {
            Size { merged: true, .. } => MERGED_GAMMA,
            Size { patches: true, .. } => PATCHES_GAMMA,
            _ => OTHER_GAMMA,
        }
    }
}

impl Cost {
    /// Fits the model to renders, of which the last is the most similar to the one planned; `None` if there
    /// are none. Each eye sample takes `looking` seconds after the render.
    pub fn fit(timed: &[Timed], looking: f64) -> Option<Cost> {
        let last = *timed.last()?;
        let by_point = |t: &Timed| (t.rest / t.size.points()).max(f64::MIN_POSITIVE).ln();
        let pairs = timed.iter().enumerate().flat_map(|(i, a)| timed[i + 1..].iter().map(move |b| (a, b)));
        let density = |(a, b): &(&Timed, &Timed)| (b.size.points() / a.size.points()).ln();
        let mut beta = BETA.0;
        let mut heights = pairs.filter(|(a, b)| (a.height - b.height).abs() >= LEAST_APART);
        // The latest pair: its second is the last, and its first the largest before it.
        if let Some((a, b)) = heights.next_back() {
            let alike = by_point(b) - by_point(a) + last.size.gamma() * density(&(a, b));
            beta = (alike / (b.height - a.height)).clamp(BETA.1[0], BETA.1[1]);
        }
        Some(Cost { last, eye: eye(timed), beta, looking })
    }

    /// Level of the last render that the model was fitted to.
    pub fn height(&self) -> f64 {
        self.last.height
    }

    /// Seconds of a render of a size at `height`.
    pub fn seconds(&self, height: f64, size: &Size) -> f64 {
        let last = &self.last;
        let light = match last.size.vpls {
            vpls if vpls > 0.0 => last.light * size.vpls / vpls,
            _ => last.light,
        };
        let points = size.points() / last.size.points();
        let rest = last.rest * (self.beta * (height - last.height)).exp() * points.powf(1.0 - size.gamma());
        let eye = match self.eye {
            Some(another) => {
                let extra = ExtraSamples { most: size.most_extra, other_rays: Some(rest) };
                let drawn = size.samples * f64::from(1.0 + extra.share(size.samples * another));
                (last.eye + (drawn - last.drawn) * another).max(0.0)
            }
            None if last.size.vpls > 0.0 => {
                last.eye * (size.samples / last.size.samples).powf(1.0 - EYE_GAMMA)
            }
            None => last.eye * size.samples / last.size.samples,
        };
        light + eye + rest
    }

    /// Seconds that the samples of a size take after the render.
    pub fn looking(&self, size: &Size) -> f64 {
        self.looking * size.samples
    }
}

/// Seconds that another sample of the eye pass takes, by the renders of the fewest and of the most samples, if these
/// are far apart; at least a fifth of the mean of the latter, since clocks err.
fn eye(timed: &[Timed]) -> Option<f64> {
    let by_drawn = |a: &&Timed, b: &&Timed| a.drawn.total_cmp(&b.drawn);
    let (few, most) = timed.iter().min_by(by_drawn).zip(timed.iter().max_by(by_drawn))?;
    let mean = most.eye / most.drawn;
    let another = (most.eye - few.eye) / (most.drawn - few.drawn);
    ((most.drawn / few.drawn).ln() >= LEAST_APART).then(|| another.clamp(0.2 * mean, mean))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn size(pixels: f64, spp: f64, vpls: f64, merged: bool) -> Size {
        let most_extra = if merged { 1.0 } else { 0.0 };
        Size { pixels, samples: pixels * spp, merged, patches: merged, most_extra, vpls }
    }

    /// A machine on which the model is exact.
    fn timed(height: f64, size: Size) -> Timed {
        let rest = 1e-5 * (0.6 * height).exp() * size.points().powf(1.0 - size.gamma());
        let another = 2e-7;
        let extra = ExtraSamples { most: size.most_extra, other_rays: Some(rest) };
        let drawn = size.samples * f64::from(1.0 + extra.share(another * size.samples));
        Timed { height, size, drawn, light: 3e-6 * size.vpls, eye: 5e-3 + another * drawn, rest }
    }

    #[test]
    fn exact_costs_are_predicted_from_three_renders() {
        for merged in [false, true] {
            let of = |height, pixels, spp, vpls| timed(height, size(pixels, spp, vpls, merged));
            let known = [of(0.0, 4e3, 1.0, 2e4), of(0.0, 1.6e4, 1.0, 2e4), of(2.5, 1.6e4, 3.0, 1e5)];
            let cost = Cost::fit(&known, 0.0).unwrap();
            for (height, pixels, spp, vpls) in
                [(0.0, 2.6e5, 1.0, 2e4), (2.5, 1e6, 4.0, 1e5), (6.0, 1e6, 64.0, 2e6)]
            {
                let Timed { light, eye, rest, size, .. } = of(height, pixels, spp, vpls);
                let found = cost.seconds(height, &size);
                assert!((found / (light + eye + rest) - 1.0).abs() < 1e-6, "{height} {found} {merged}");
            }
        }
    }

    #[test]
    fn one_render_makes_a_model_and_none_does_not() {
        assert!(Cost::fit(&[], 0.0).is_none());
        let expected = timed(1.0, size(4e3, 1.0, 2e4, false));
        let one = Cost::fit(&[expected], 1e-6).unwrap();
        assert_eq!(one.looking(&size(4e3, 2.0, 2e4, false)), 8e-3);
        let seconds = |height, spp| one.seconds(height, &size(4e3, spp, 2e4, false));
        assert!((seconds(1.0, 1.0) - expected.light - expected.eye - expected.rest).abs() < 1e-12);
        assert!(seconds(2.0, 1.0) > seconds(1.0, 1.0));
        assert!(seconds(1.0, 2.0) > seconds(1.0, 1.0));
    }

    #[test]
    fn renders_too_fast_to_time_are_no_trouble() {
        let nothing = Timed {
            height: 0.0,
            size: size(1.0, 1.0, 0.0, false),
            drawn: 1.0,
            light: 0.0,
            eye: 0.0,
            rest: 0.0,
        };
        let other = Timed { height: 3.0, size: size(9.0, 1.0, 0.0, false), drawn: 9.0, ..nothing };
        let cost = Cost::fit(&[nothing, other], 0.0).unwrap();
        assert!(cost.seconds(6.0, &size(1e6, 1.0, 1e6, false)).is_finite());
    }
}
