//! The quality scale: settings from cheap to exact, one number for all of them.
//!
//! Values between the levels of a method's own table ([`crate::method::Move`]) interpolate its factors
//! geometrically, so that a plan need not jump.

use crate::method::{Method, Move, RUNGS};
use base::film::Window;
use base::stats::available_bytes;

/// Heights that have names: a draft ...
pub const DRAFT: f64 = 2.0;
/// ... a preview ...
pub const PREVIEW: f64 = 3.0;
/// ... for pictures to keep ...
pub const FINAL: f64 = 5.0;
/// ... and for references. Path tracing has no bias, but in the time of this more than twice the error.
pub const REFERENCE: f64 = 7.0;

/// A method's settings by height.
#[derive(Clone, Debug)]
pub struct Ladder {
    base: Method,
    /// Keys of settings that stay as they are.
    held: Vec<&'static str>,
    most_spp: u32,
}

impl Ladder {
    /// Creates the scale around the settings of `base`, except those pinned in `held`; `None` for a method
    /// without one.
    pub fn new(base: Method, held: &[&'static str]) -> Option<Ladder> {
        let known = !base.ladder().is_empty();
        known.then(|| Ladder { base, held: held.to_vec(), most_spp: u32::MAX })
    }

    /// Holds one more setting.
    pub fn hold(&mut self, key: &'static str) {
        self.held.push(key);
    }

    /// Of no more samples of `window` than fit into the memory that is there.
    pub fn within(mut self, window: &Window) -> Ladder {
        let needed = |spp: u32| {
            let mut method = self.base;
            method.set_number("spp", 0, f64::from(spp));
            method.expected_bytes(window)
        };
        if let Some(bytes) = available_bytes().filter(|_| needed(2) > needed(1)) {
            let doubled = (0..16).map(|k| self.base.spp().saturating_mul(1 << k));
            self.most_spp = doubled.take_while(|&spp| needed(spp) <= bytes).last().unwrap_or(1);
        }
        self
    }

    /// Returns the last level; the first is 0.
    pub fn top(&self) -> f64 {
        (RUNGS - 1) as f64
    }

    /// The method with the settings at `height`.
    pub fn at(&self, height: f64) -> Method {
        self.between(height, height)
    }

    /// The same, cuts as fine as at `fine` and the numbers of samples, virtual lights and patches as at `coarse`.
    pub fn between(&self, coarse: f64, fine: f64) -> Method {
        let mut method = self.base;
        for moved in self.base.ladder().iter().filter(|moved| !self.held.contains(&moved.key)) {
            let Some(base) = self.base.number(moved.key) else { continue };
            let factor = factor(if moved.fine { fine } else { coarse }, &moved.factors);
            let value = base * factor;
            let value = match moved.key {
                "spp" => value.round().clamp(1.0, f64::from(self.most_spp)),
                _ if factor == 1.0 => base,
                // Three significant digits are enough; shorter numbers are easier to type again.
                _ => format!("{value:.2e}").parse().unwrap_or(base),
            };
            method.set_number(moved.key, 0, value);
        }
        method
    }
}

/// Returns the command-line options of the settings of `method` that the scale moves.
pub fn options(method: &Method) -> String {
    let option = |moved: &Move| {
        let text = method.text(moved.key)?;
        Some(format!("--{} {text}", moved.key.replace('_', "-")))
    };
    method.ladder().iter().filter_map(option).collect::<Vec<_>>().join(" ")
}

/// Returns a factor at `height`, which is clamped to the first and the last level.
fn factor(height: f64, factors: &[f64; RUNGS]) -> f64 {
    let height = height.clamp(0.0, (RUNGS - 1) as f64);
    let below = (height as usize).min(RUNGS - 2);
    let (a, b) = (factors[below], factors[below + 1]);
    let part = height - below as f64;
    // Exact on the levels, where logarithms would round.
    if part == 0.0 { a } else { a * (b / a).powf(part) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_get_finer_with_height() {
        let names = ["reconstruction", "cache", "lightcuts", "path"];
        for base in names.map(|name| Method::named(name).unwrap()) {
            let ladder = Ladder::new(base, &[]).unwrap();
            let mut before: Option<Method> = None;
            for k in 0..=32 {
                let now = ladder.at(f64::from(k) * 0.25);
                let numbers = |m: &Method| ["spp", "max_cut", "vpls"].map(|key| m.number(key).unwrap_or(0.0));
                let epsilon = |m: &Method| m.number("epsilon").unwrap_or(0.0);
                if let Some(before) = before {
                    assert!(numbers(&before).iter().zip(numbers(&now)).all(|(a, b)| *a <= b), "{k} {now:?}");
                    assert!(epsilon(&before) >= epsilon(&now), "{k} {now:?}");
                }
                before = Some(now);
            }
            assert_ne!(ladder.at(0.0).settings(), ladder.at(ladder.top()).settings());
        }
        assert!(Ladder::new(Method::named("photon-cache").unwrap(), &[]).is_none());
    }

    #[test]
    fn what_is_typed_stays_and_numbers_read_back() {
        let base = Method::named("reconstruction").unwrap();
        let keys: Vec<_> = base.ladder().iter().map(|moved| moved.key).collect();
        assert_eq!(Ladder::new(base, &keys).unwrap().at(0.7).settings(), base.settings());
        let found = Ladder::new(base, &[]).unwrap().at(1.37);
        let text = options(&found);
        // Refused where there are no records.
        assert!(text.len() < 120 && !text.contains("--record-epsilon"), "{text}");
        let mut again = base;
        for option in text.split("--").skip(1) {
            let (option, value) = option.trim().split_once(' ').unwrap();
            assert_eq!(again.set(&option.replace('-', "_"), value), Ok(true), "{option} {value}");
        }
        assert_eq!(again.settings(), found.settings());
    }

    #[test]
    fn rungs_are_exact() {
        let ladder = Ladder::new(Method::named("reconstruction").unwrap(), &[]).unwrap();
        assert_eq!(
            options(&ladder.at(4.0)),
            "--spp 4 --epsilon 0.08 --max-cut 5000 --vpls 300000 --patches 1020"
        );
    }
}
