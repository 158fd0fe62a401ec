//! A level found by trials.
//!
//! The logarithm of time rises with the level, nearly linearly over small ranges. Every trial is made where
//! the line through the former ones predicts the time wanted, so that the last ones are close to it.

/// Slope of the logarithm of time, a level, before two levels are measured, and the range to which it is
/// clamped.
const SLOPE: (f64, [f64; 2]) = (0.35, [0.1, 1.2]);
/// A trial as near as this, relatively, is near enough.
const NEAR: f64 = 0.06;

/// A level and its predicted time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuned {
    /// Between 0 and the top.
    pub height: f64,
    /// Seconds.
    pub seconds: f64,
    /// Trials made.
    pub trials: u64,
}

/// The height up to `top` that takes as long as `wanted()` says, which is asked after every trial, of which
/// there are `most` at most; `try_at` gives the seconds that a height takes, or `None` where nothing can be
/// said. `start` is tried first.
pub fn tune(
    start: f64,
    top: f64,
    most: usize,
    wanted: impl Fn() -> f64,
    mut try_at: impl FnMut(f64) -> Option<f64>,
) -> Option<Tuned> {
    let mut known: Vec<(f64, f64)> = Vec::with_capacity(most);
    let mut height = start.clamp(0.0, top);
    loop {
        known.push((height, try_at(height)?.max(f64::MIN_POSITIVE).ln()));
        let goal = wanted().max(f64::MIN_POSITIVE).ln();
        let off = known[known.len() - 1].1 - goal;
        let (next, seconds) = along(&known, goal, top);
        // Where nothing is higher or lower, there is nothing to try.
        if off.abs() < NEAR || known.len() >= most || (next - height).abs() < 1e-9 {
            return Some(Tuned { height: next, seconds, trials: known.len() as u64 });
        }
        height = next;
    }
}

/// Returns the point where the line from the last trial, through the nearest other, meets `goal`, and the
/// seconds there.
fn along(known: &[(f64, f64)], goal: f64, top: f64) -> (f64, f64) {
    let (last, before) = (known[known.len() - 1], &known[..known.len() - 1]);
    // Those close by say nothing of slopes: trials are noisy.
    let apart = before.iter().filter(|(height, _)| (height - last.0).abs() > 0.25);
    let nearest = apart.min_by(|a, b| (a.0 - last.0).abs().total_cmp(&(b.0 - last.0).abs()));
    let slope = nearest.map_or(SLOPE.0, |other| (other.1 - last.1) / (other.0 - last.0));
    let slope = slope.clamp(SLOPE.1[0], SLOPE.1[1]);
    let height = (last.0 + (goal - last.1) / slope).clamp(0.0, top);
    (height, (last.1 + slope * (height - last.0)).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns seconds on a machine that takes `fixed` seconds at least.
    fn curve(fixed: f64, slope: f64, height: f64) -> f64 {
        fixed + 0.2 * (slope * height).exp()
    }

    #[test]
    fn times_within_reach_are_hit_from_any_start() {
        for (fixed, slope) in [(0.0, 0.3), (0.0, 0.7), (0.1, 0.5), (0.5, 0.4)] {
            for wanted_height in [0.4, 2.0, 4.7] {
                let goal = curve(fixed, slope, wanted_height);
                for start in [0.0, 2.5, 6.0] {
                    let found =
                        tune(start, 6.0, 4, || goal, |height| Some(curve(fixed, slope, height))).unwrap();
                    let got = curve(fixed, slope, found.height);
                    assert!((got / goal - 1.0).abs() < 0.05, "{fixed} {slope} {start}: {got} for {goal}");
                    assert!((found.seconds / got - 1.0).abs() < 0.05, "{found:?} takes {got}");
                }
            }
        }
    }

    #[test]
    fn what_trials_take_is_taken_off() {
        let left = std::cell::Cell::new(2.0);
        let try_at = |height: f64| {
            left.set(left.get() - 0.1);
            Some(curve(0.0, 0.5, height))
        };
        let found = tune(6.0, 6.0, 4, || left.get(), try_at).unwrap();
        assert!((curve(0.0, 0.5, found.height) / left.get() - 1.0).abs() < 0.05, "{found:?}");
    }

    #[test]
    fn times_out_of_reach_end_at_the_ends_and_say_so() {
        let short = tune(3.0, 6.0, 4, || 0.01, |height| Some(curve(0.1, 0.5, height))).unwrap();
        assert!(short.height == 0.0 && short.seconds > 0.2, "{short:?}");
        let long = tune(3.0, 6.0, 4, || 100.0, |height| Some(curve(0.1, 0.5, height))).unwrap();
        assert!(long.height == 6.0 && long.seconds < 10.0, "{long:?}");
        assert_eq!(tune(3.0, 6.0, 4, || 1.0, |_| None), None);
        assert!(tune(3.0, 6.0, 4, || -1.0, |_| Some(0.0)).unwrap().seconds.is_finite());
    }
}
