//! Rates of cases measured in turns, so that other load on the machine affects all of them equally.
//!
//! Every case is run once to warm up and to find the number of runs in a sample. Then each round takes a
//! sample of every case, every other round in reverse; a case's ratio is formed within the rounds.

use super::{Row, Settings, Spread, Table};
use rustix::time::{ClockId, clock_gettime};

/// Clock by which a benchmark is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// Processor time of the calling thread: for work on one thread.
    Thread,
    /// Processor time of all threads together: for cost.
    Process,
}

impl Clock {
    fn seconds(self) -> f64 {
        let time = clock_gettime(match self {
            Clock::Thread => ClockId::ThreadCPUTime,
            Clock::Process => ClockId::ProcessCPUTime,
        });
        time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
    }

    fn of(self, work: &mut dyn FnMut()) -> f64 {
        let start = self.seconds();
        work();
        self.seconds() - start
    }
}

/// Work to be timed.
pub(super) struct Case<'a> {
    /// Labels of its row.
    pub labels: Vec<String>,
    /// Index of the case that its ratio is to; may be its own.
    pub against: usize,
    /// Units of work in a run.
    pub units: f64,
    /// Further figures.
    pub figures: Vec<Option<f64>>,
    /// Function that does one run.
    pub work: Box<dyn FnMut() + 'a>,
}

impl<'a> Case<'a> {
    /// Creates a case without further figures.
    pub fn new(labels: &[&str], against: usize, units: f64, work: impl FnMut() + 'a) -> Case<'a> {
        Case {
            labels: labels.iter().map(|l| (*l).to_owned()).collect(),
            against,
            units,
            figures: Vec::new(),
            work: Box::new(work),
        }
    }
}

/// Distance from the median, in median deviations, beyond which a sample is an outlier.
const OUTLYING: f64 = 10.0 * 1.4826;
/// Relative distance of a ratio's quartiles beyond which it is unsteady.
const UNSTEADY: f64 = 0.1;
/// Minimum duration of a usable sample, seconds.
const SHORTEST: f64 = 1e-5;
/// Maximum number of runs in a sample.
const MOST_RUNS: f64 = 1e6;

/// Measures cases in turns. Rates are in units of work a second times `scale`.
pub(super) fn alternate(
    cases: Vec<Case>,
    clock: Clock,
    settings: &Settings,
    scale: f64,
) -> (Vec<Row>, Vec<String>) {
    let mut cases = cases;
    let runs: Vec<usize> = cases
        .iter_mut()
        .map(|case| {
            (case.work)();
            let once = clock.of(&mut *case.work).max(1e-9);
            (settings.seconds / once).clamp(1.0, MOST_RUNS) as usize
        })
        .collect();
    let mut rates = vec![Vec::with_capacity(settings.repeats); cases.len()];
    let mut short = vec![false; cases.len()];
    for round in 0..settings.repeats {
        for place in 0..cases.len() {
            let i = if round % 2 == 0 { place } else { cases.len() - 1 - place };
            let case = &mut cases[i];
            let seconds = clock.of(&mut || (0..runs[i]).for_each(|_| (case.work)()));
            short[i] |= seconds < SHORTEST;
            rates[i].push(case.units * runs[i] as f64 / seconds.max(1e-9) * scale);
        }
    }
    let mut warnings = Vec::new();
    let rows: Vec<Row> = cases
        .into_iter()
        .enumerate()
        .map(|(i, case)| {
            let ratios: Vec<f64> = rates[i].iter().zip(&rates[case.against]).map(|(a, b)| a / b).collect();
            let ratio = Spread::of(&ratios);
            let doubt = if short[i] {
                Some("there is next to nothing to do; try a larger scene".to_owned())
            } else if ratio.relative() > UNSTEADY {
                let spread = 100.0 * ratio.relative();
                Some(format!(
                    "the middle half of the ratios spreads over {spread:.0} %; try longer --seconds or a quieter machine"
                ))
            } else {
                let count = outliers(&ratios);
                let text = format!("{count} outliers; is something else running? More --repeats help");
                (count > 0).then_some(text)
            };
            warnings.extend(doubt.map(|doubt| format!("{}: {doubt}", case.labels.join(", "))));
            let rate = Spread::of(&rates[i]);
            Row { labels: case.labels, ratio, rate, samples: rates[i].clone(), figures: case.figures }
        })
        .collect();
    (rows, warnings)
}

/// Counts values far from the others. The median deviation is taken to be at least one per cent of the
/// median.
fn outliers(values: &[f64]) -> usize {
    let median = Spread::of(values).median;
    let deviations: Vec<f64> = values.iter().map(|v| (v - median).abs()).collect();
    let usual = Spread::of(&deviations).median.max(1e-2 * median);
    deviations.iter().filter(|&&d| d > OUTLYING * usual).count()
}

impl Table {
    /// Measures `cases`.
    pub(super) fn measured(
        (title, about): (&str, &str),
        (labels, unit, figures): (&[&str], &str, &[&str]),
        (clock, settings, scale): (Clock, &Settings, f64),
        cases: Vec<Case>,
    ) -> Table {
        let (rows, warnings) = alternate(cases, clock, settings, scale);
        let owned = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect();
        Table {
            title: title.to_owned(),
            about: about.to_owned(),
            labels: owned(labels),
            unit: unit.to_owned(),
            figures: owned(figures),
            rows,
            warnings,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;

    #[test]
    fn cases_take_turns_and_are_compared_within_rounds() {
        let order = RefCell::new(Vec::new());
        let case = |name: &'static str, against| {
            let order = &order;
            Case::new(&[name], against, 1.0, move || order.borrow_mut().push(name))
        };
        let settings = Settings { repeats: 3, seconds: 0.0, threads: 1 };
        let (rows, _) = alternate(vec![case("a", 0), case("b", 0)], Clock::Process, &settings, 1.0);
        assert_eq!(order.borrow().concat(), "aabbabbaab");
        assert_eq!((rows[0].ratio.median, rows[0].samples.len()), (1.0, 3));
        let median = |i: usize| rows[0].samples[i] / rows[1].samples[i];
        let expected = Spread::of(&[1.0 / median(0), 1.0 / median(1), 1.0 / median(2)]);
        assert!((rows[1].ratio.median / expected.median - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_sample_far_from_the_rest_is_an_outlier() {
        assert_eq!(outliers(&[1.0, 1.01, 0.99, 1.02, 3.0]), 1);
        assert_eq!(outliers(&[1.0, 1.2, 0.8, 1.1, 0.9]), 0);
        assert_eq!(outliers(&[1.0; 5]), 0);
    }
}
