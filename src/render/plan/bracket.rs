//! Search for the lowest step whose error meets a goal, among steps whose errors fall.
//!
//! [`ErrorBracket`] holds the errors that were measured and says which step to try next. It jumps by as many steps as
//! the approximate fall of errors suggests, within bounds.

/// Approximate fall of the logarithm of the error per step.
pub const FALL: f64 = 0.15;
/// Maximum number of steps of a jump, besides one.
const MAX_JUMP: f64 = 3.0;
/// Number of finer steps after which the search stops if they leave at least [`STILL`] of the error.
///
/// Something other than the settings dominates the error then.
const STALL: usize = 4;
/// See [`STALL`].
const STILL: f64 = 0.93;
/// Safety margin, in steps, added to the interpolated step at which the error is predicted to meet the goal.
const MARGIN: f64 = 0.1;
/// Minimum number of steps that an interpolated step must save.
const MIN_SAVED: f64 = 0.2;

/// Errors by step.
pub struct ErrorBracket {
    goal: f64,
    top: usize,
    met: Option<(usize, f64)>,
    failed: Vec<(usize, f64)>,
}

/// Next action of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Next {
    /// Try a step.
    Try(usize),
    /// Try a place between two steps, and end.
    TryBetween(f64),
    /// End with the lowest step that met the goal.
    Met,
    /// End with the last step: no step meets the goal.
    Missed,
}

impl ErrorBracket {
    /// Begins a search for an error of at most `goal` among the steps up to `top`.
    pub fn new(goal: f64, top: usize) -> ErrorBracket {
        ErrorBracket { goal, top, met: None, failed: Vec::new() }
    }

    /// Returns the step to try after one of this error.
    pub fn add(&mut self, step: usize, error: f64) -> Next {
        let jump = ((error / self.goal).ln().abs() / FALL).min(MAX_JUMP) as usize;
        let next = if error <= self.goal {
            self.met = Some((step, error));
            step.saturating_sub(jump.max(1))
        } else {
            let stalls = self.failed.iter().any(|&(below, e)| below + STALL <= step && error > STILL * e);
            if self.met.is_none() && (stalls || step >= self.top) {
                return Next::Missed;
            }
            self.failed.push((step, error));
            step + jump + 1
        };
        let lowest = self.failed.iter().map(|&(step, _)| step + 1).max().unwrap_or(0);
        match self.met {
            Some(met) if lowest >= met.0 => self.between(met).map_or(Next::Met, Next::TryBetween),
            Some((least, _)) => Next::Try(next.clamp(lowest, least - 1)),
            None => Next::Try(next.min(self.top)),
        }
    }

    fn between(&self, met: (usize, f64)) -> Option<f64> {
        let failed = self.failed.iter().max_by_key(|&&(step, _)| step)?;
        between(*failed, met, self.goal)
    }
}

/// Returns the place between two steps at which the logarithm of the error, interpolated, comes down to `goal`.
///
/// The result includes a margin. It is `None` if that saves little.
fn between(failed: (usize, f64), met: (usize, f64), goal: f64) -> Option<f64> {
    let part = (failed.1 / goal).ln() / (failed.1 / met.1).ln() + MARGIN;
    let step = failed.0 as f64 + part * (met.0 as f64 - failed.0 as f64);
    (met.0 as f64 - step >= MIN_SAVED).then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_between_steps_are_tried_if_they_save_much() {
        // The error falls from 4 % to 1 % in a step.
        let at = |goal: f64| between((6, 0.04), (7, 0.01), goal);
        let found = at(0.02).unwrap();
        assert!((found - 6.6).abs() < 1e-9, "{found}");
        assert!(at(0.039).unwrap() < 6.2 && at(0.0101).is_none());
        // No error at all.
        assert!(between((6, 0.04), (7, 0.0), 0.02).unwrap() < 6.2);
    }

    /// Runs a search. Returns its end, the last step tried, and the number of tries.
    fn search(goal: f64, top: usize, start: usize, error: impl Fn(f64) -> f64) -> (Next, f64, usize) {
        let mut bracket = ErrorBracket::new(goal, top);
        let mut step = start;
        for tries in 1..100 {
            match bracket.add(step, error(step as f64)) {
                Next::Try(next) => {
                    assert!(next <= top && next != step);
                    step = next;
                }
                Next::TryBetween(place) => return (Next::TryBetween(place), place, tries),
                Next::Met => return (Next::Met, bracket.met.unwrap().0 as f64, tries),
                Next::Missed => return (Next::Missed, step as f64, tries),
            }
        }
        panic!("no end");
    }

    #[test]
    fn the_lowest_step_that_meets_the_goal_is_found_from_any_start() {
        for fall in [0.05, 0.15, 0.4] {
            let error = |step: f64| 0.1 * (-fall * step).exp();
            for start in 0..=16 {
                for lowest in [0, 1, 5, 11, 16] {
                    let (end, place, tries) = search(1.0001 * error(f64::from(lowest)), 16, start, error);
                    let is_right = match end {
                        Next::Met => place == f64::from(lowest),
                        Next::TryBetween(place) => {
                            place > f64::from(lowest) - 1.0 && place < f64::from(lowest)
                        }
                        _ => false,
                    };
                    assert!(is_right && tries <= 12, "{fall} {start} {lowest}: {end:?} {place} {tries}");
                }
            }
        }
    }

    #[test]
    fn errors_that_do_not_fall_end_the_search() {
        let (end, place, tries) = search(0.01, 16, 4, |_| 0.1);
        assert!(end == Next::Missed && place < 16.0 && tries <= 4, "{place} {tries}");
        let (end, place, _) = search(1e-9, 16, 4, |step| 0.1 * (-0.15 * step).exp());
        assert_eq!((end, place), (Next::Missed, 16.0));
    }
}
