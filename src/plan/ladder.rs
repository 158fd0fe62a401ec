//! The ladder: settings from cheap to exact, one number for all of them.
//!
//! A rung holds factors on the method's defaults, and heights between rungs interpolate them
//! geometrically, so that a plan need not jump. Every step halves ε, which cuts cost by its root,
//! and the virtual lights follow: a cut as fine as ε asks is no use in a tree whose leaves are coarser.

use crate::eye::EyePass;
use crate::film::Window;
use crate::method::Method;
use crate::stats::available_bytes;

/// Factors on a method's settings.
#[derive(Clone, Copy)]
struct Rung {
    /// On the largest errors of clusters, of samples and of records.
    epsilon: f64,
    /// On the cap of cuts.
    max_cut: f64,
    /// On the number of indirect virtual lights.
    vpls: f64,
    /// On the patches whose cuts are lent.
    patches: f64,
    /// On samples a pixel.
    spp: f64,
    /// On samples a pixel by path tracing, which has no other setting.
    paths: f64,
}

/// From cheap to exact: near the Pareto front of error against time of the knot, nave and kitchen at 512 x 512.
#[rustfmt::skip]
const LADDER: [Rung; 9] = [
    Rung { epsilon: 50.0, max_cut: 0.01, vpls: 0.016, patches: 0.016,  spp: 0.25, paths: 0.00390625 },
    Rung { epsilon: 32.0, max_cut: 0.06, vpls: 0.033, patches: 0.0625, spp: 0.25, paths: 0.015625 },
    Rung { epsilon: 16.0, max_cut: 0.25, vpls: 0.25,  patches: 0.125,  spp: 0.5,  paths: 0.0625 },
    Rung { epsilon: 8.0,  max_cut: 0.5,  vpls: 0.5,   patches: 0.25,   spp: 1.0,  paths: 0.25 },
    Rung { epsilon: 4.0,  max_cut: 1.0,  vpls: 1.0,   patches: 0.25,   spp: 1.0,  paths: 1.0 },
    Rung { epsilon: 2.0,  max_cut: 1.0,  vpls: 2.0,   patches: 0.25,   spp: 1.0,  paths: 4.0 },
    Rung { epsilon: 1.0,  max_cut: 2.0,  vpls: 4.0,   patches: 0.5,    spp: 2.0,  paths: 16.0 },
    Rung { epsilon: 0.5,  max_cut: 4.0,  vpls: 8.0,   patches: 1.0,    spp: 2.0,  paths: 64.0 },
    Rung { epsilon: 0.25, max_cut: 8.0,  vpls: 16.0,  patches: 2.0,    spp: 4.0,  paths: 256.0 },
];

/// Heights that have names: a draft ...
pub const DRAFT: f64 = 2.0;
/// ... a preview ...
pub const PREVIEW: f64 = 3.0;
/// ... what is worth keeping ...
pub const FINAL: f64 = 5.0;
/// ... and what others are held to. Path tracing has no bias, but at the time that this takes more than twice the error.
pub const REFERENCE: f64 = 7.0;

/// Settings that a plan leaves alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct Held {
    /// Samples a pixel.
    pub spp: bool,
    /// Largest error of clusters.
    pub epsilon: bool,
    /// The same in records.
    pub record_epsilon: bool,
    /// The cap of cuts.
    pub max_cut: bool,
    /// Indirect virtual lights.
    pub vpls: bool,
    /// Patches whose cuts are lent.
    pub patches: bool,
}

/// A method's settings by height.
#[derive(Clone, Copy, Debug)]
pub struct Ladder {
    base: Method,
    /// What is held.
    pub held: Held,
    most_spp: u32,
}

impl Ladder {
    /// Around the settings of `base`; `None` for a method of which no ladder is known.
    pub fn new(base: Method, held: Held) -> Option<Ladder> {
        let known = !matches!(base, Method::PhotonCache(_));
        known.then_some(Ladder { base, held, most_spp: u32::MAX })
    }

    /// Of no more samples of `window` than fit into the memory that is there.
    pub fn within(mut self, window: &Window) -> Ladder {
        if let (Method::Cache(_), Some(bytes)) = (&self.base, available_bytes()) {
            let doubled = (0..16).map(|k| self.base.spp().saturating_mul(1 << k));
            let fits = doubled.take_while(|&spp| EyePass::expected_bytes(window, spp) <= bytes);
            self.most_spp = fits.last().unwrap_or(1);
        }
        self
    }

    /// The height of the last rung; the first has 0.
    pub fn top(&self) -> f64 {
        (LADDER.len() - 1) as f64
    }

    /// The method with the settings at `height`.
    pub fn at(&self, height: f64) -> Method {
        self.between(height, height)
    }

    /// The same, cuts as fine as at `fine` and the numbers of samples, virtual lights and patches as at `coarse`.
    pub fn between(&self, coarse: f64, fine: f64) -> Method {
        let held = self.held;
        let epsilon = |base: f32, typed: bool| match typed {
            true => base,
            false => short(f64::from(base) * factor(fine, |r| r.epsilon), base),
        };
        let whole = |base: u32, typed: bool, height: f64, of: fn(&Rung) -> f64| match factor(height, of) {
            factor if typed || factor == 1.0 => base,
            // Two digits or three say enough; what is typed again is shorter.
            factor => rounded(f64::from(base) * factor),
        };
        let spp = |base: u32, of: fn(&Rung) -> f64| match held.spp {
            true => base,
            false => ((f64::from(base) * factor(coarse, of)).round() as u32).clamp(1, self.most_spp),
        };
        let cap = |base: usize| {
            whole(base.min(u32::MAX as usize) as u32, held.max_cut, fine, |r| r.max_cut).max(1) as usize
        };
        let vpls = |base: u32| whole(base, held.vpls, coarse, |r| r.vpls);
        let mut method = self.base;
        match &mut method {
            Method::Path(s) => s.spp = spp(s.spp, |r| r.paths),
            Method::Lightcuts(s) => {
                s.spp = spp(s.spp, |r| r.spp);
                s.cut.epsilon = epsilon(s.cut.epsilon, held.epsilon);
                s.cut.max_cut = cap(s.cut.max_cut);
                s.light.indirect = vpls(s.light.indirect);
            }
            Method::Cache(s) => {
                s.spp = spp(s.spp, |r| r.spp);
                s.cut.epsilon = epsilon(s.cut.epsilon, held.epsilon);
                s.cache.cut.epsilon = epsilon(s.cache.cut.epsilon, held.record_epsilon);
                s.cut.max_cut = cap(s.cut.max_cut);
                s.cache.cut.max_cut = s.cut.max_cut;
                s.light.indirect = vpls(s.light.indirect);
                s.cache.patches = whole(s.cache.patches, held.patches, coarse, |r| r.patches).max(1);
            }
            Method::PhotonCache(_) => {}
        }
        method
    }
}

/// Options that give the settings of `method` that a ladder moves.
pub fn options(method: &Method) -> String {
    let spp = format!("--spp {}", method.spp());
    let cuts = |epsilon: f32, max_cut: usize, vpls: u32| {
        format!("{spp} --epsilon {epsilon} --max-cut {max_cut} --vpls {vpls}")
    };
    match method {
        Method::Path(_) | Method::PhotonCache(_) => spp,
        Method::Lightcuts(s) => cuts(s.cut.epsilon, s.cut.max_cut, s.light.indirect),
        Method::Cache(s) => {
            let common = cuts(s.cut.epsilon, s.cut.max_cut, s.light.indirect);
            let all = format!("{common} --patches {}", s.cache.patches);
            if s.lights_by_cuts() { all } else { format!("{all} --record-epsilon {}", s.cache.cut.epsilon) }
        }
    }
}

/// A factor at `height`, which is kept between the first rung and the last.
fn factor(height: f64, of: fn(&Rung) -> f64) -> f64 {
    let height = height.clamp(0.0, (LADDER.len() - 1) as f64);
    let below = (height as usize).min(LADDER.len() - 2);
    let (a, b) = (of(&LADDER[below]), of(&LADDER[below + 1]));
    let part = height - below as f64;
    // Exact on the rungs, where logarithms would round.
    if part == 0.0 { a } else { a * (b / a).powf(part) }
}

/// A fraction of three digits, which reads back as the same number.
fn short(value: f64, base: f32) -> f32 {
    format!("{:.2e}", value.min(1.0)).parse().unwrap_or(base)
}

fn rounded(value: f64) -> u32 {
    let value: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    value.round().min(f64::from(u32::MAX)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::{cache, lightcuts, path, photon_cache};

    fn ladder(base: Method, held: Held) -> Ladder {
        Ladder::new(base, held).unwrap()
    }

    #[test]
    fn settings_get_finer_with_height() {
        let methods = [
            Method::Cache(cache::Settings::default()),
            Method::Lightcuts(lightcuts::Settings::default()),
            Method::Path(path::Settings::default()),
        ];
        for base in methods {
            let ladder = ladder(base, Held::default());
            let mut before: Option<Method> = None;
            for k in 0..=32 {
                let now = ladder.at(f64::from(k) * 0.25);
                let numbers = |m: &Method| {
                    let settings = m.settings();
                    ["spp", "max_cut", "vpls"].map(|key| settings[key].as_f64().unwrap_or(0.0))
                };
                let epsilon = |m: &Method| m.settings()["epsilon"].as_f64().unwrap_or(0.0);
                if let Some(before) = before {
                    assert!(numbers(&before).iter().zip(numbers(&now)).all(|(a, b)| *a <= b), "{k} {now:?}");
                    assert!(epsilon(&before) >= epsilon(&now), "{k} {now:?}");
                }
                before = Some(now);
            }
            assert_ne!(ladder.at(0.0).settings(), ladder.at(ladder.top()).settings());
        }
        let other = Method::PhotonCache(photon_cache::Settings::default());
        assert!(Ladder::new(other, Held::default()).is_none());
    }

    #[test]
    fn what_is_typed_stays_and_numbers_read_back() {
        let base = Method::Cache(cache::Settings::default());
        let all =
            Held { spp: true, epsilon: true, record_epsilon: true, max_cut: true, vpls: true, patches: true };
        assert_eq!(ladder(base, all).at(0.7).settings(), base.settings());
        let Method::Cache(found) = ladder(base, Held::default()).at(1.37) else { panic!() };
        let text = options(&Method::Cache(found));
        assert!(text.contains(&format!("--epsilon {} ", found.cut.epsilon)) && text.len() < 120, "{text}");
        // Refused where there are no records.
        assert!(!text.contains("--record-epsilon"), "{text}");
        assert_eq!(found.cut.epsilon.to_string().parse(), Ok(found.cut.epsilon));
    }
}
