//! The quality scale of a method, with the limits of a plan.

use crate::method::{LEVELS, Method, ScaleLimits};
use base::film::Window;
use base::stats::available_bytes;

/// Level of a draft.
pub const DRAFT: f64 = 2.0;
/// Level of a preview.
pub const PREVIEW: f64 = 3.0;
/// Level of a final image.
pub const FINAL: f64 = 5.0;
/// Level of a reference. Path tracing has no bias, but more than twice the error in the same time.
pub const REFERENCE: f64 = 7.0;

/// Maximum number of doublings of the default samples that are tried for the memory available.
const MAX_DOUBLINGS: u32 = 16;

/// Settings of a method by level of quality.
#[derive(Clone, Debug)]
pub struct Ladder {
    base: Method,
    limits: ScaleLimits,
}

impl Ladder {
    /// Creates the scale around the settings of `base`, except the pinned ones; `None` if the method has no scale.
    pub fn new(base: Method, pinned: &[&'static str]) -> Option<Ladder> {
        let limits = ScaleLimits { pinned: pinned.to_vec(), max_spp: u32::MAX };
        (!base.moves().is_empty()).then_some(Ladder { base, limits })
    }

    /// Pins one more setting, given its key.
    pub fn pin(&mut self, key: &'static str) {
        self.limits.pinned.push(key);
    }

    /// Limits the samples of `window` to those that fit into the memory available.
    pub fn within(mut self, window: &Window) -> Ladder {
        let needed = |spp: u32| {
            let mut method = self.base;
            method.set_spp(spp);
            method.expected_bytes(window)
        };
        if let Some(bytes) = available_bytes().filter(|_| needed(2) > needed(1)) {
            let doubled = (0..MAX_DOUBLINGS).map(|k| self.base.spp().saturating_mul(1 << k));
            self.limits.max_spp = doubled.take_while(|&spp| needed(spp) <= bytes).last().unwrap_or(1);
        }
        self
    }

    /// Returns the last level; the first is 0.
    pub fn top(&self) -> f64 {
        (LEVELS - 1) as f64
    }

    /// Returns the method with the settings at `level`.
    pub fn at(&self, level: f64) -> Method {
        let mut method = self.base;
        method.scale(level, &self.limits);
        method
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_get_finer_with_the_level() {
        let names = ["reconstruction", "cache", "lightcuts", "path"];
        for base in names.map(|name| Method::named(name).unwrap()) {
            let ladder = Ladder::new(base, &[]).unwrap();
            let mut before: Option<Method> = None;
            for k in 0..=32 {
                let now = ladder.at(f64::from(k) * 0.25);
                let number = |method: Method, key| method.settings()[key].as_f64().unwrap_or(0.0);
                let numbers = |method: Method| ["spp", "max_cut", "vpls"].map(|key| number(method, key));
                let epsilon = |method: Method| number(method, "epsilon");
                if let Some(before) = before {
                    assert!(numbers(before).iter().zip(numbers(now)).all(|(a, b)| *a <= b), "{k} {now:?}");
                    assert!(epsilon(before) >= epsilon(now), "{k} {now:?}");
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
        let all: Vec<_> = base.moves().iter().map(|moved| moved.key).collect();
        assert_eq!(Ladder::new(base, &all).unwrap().at(0.7).settings(), base.settings());
        let found = Ladder::new(base, &[]).unwrap().at(1.37);
        let text = found.scaled_options();
        // The method has no records.
        assert!(text.len() < 150 && !text.contains("record-epsilon"), "{text}");
        let mut again = base;
        for option in text.split("--").skip(1) {
            let option = option.trim();
            let (option, value) =
                option.strip_prefix("set ").unwrap_or(option).split_once([' ', '=']).unwrap();
            assert_eq!(again.set(&option.replace('-', "_"), value), Ok(true), "{option} {value}");
        }
        assert_eq!(again.settings(), found.settings());
    }

    #[test]
    fn levels_are_exact() {
        let ladder = Ladder::new(Method::named("reconstruction").unwrap(), &[]).unwrap();
        assert_eq!(
            ladder.at(4.0).scaled_options(),
            "--spp 4 --set epsilon=0.08 --set max-cut=5000 --set vpls=300000 --set patches=1020"
        );
    }
}
