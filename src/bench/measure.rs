//! Rates of cases measured in turns, so that other load on the machine affects all of them equally.
//!
//! Each case runs once to warm up and once to find the number of runs per sample. Each round then takes a sample of
//! every case, in reverse order every other round. Ratios are formed within rounds.

use super::{Row, Settings, Spread, Table};
use rustix::time::{ClockId, clock_gettime};

/// Clock that times a benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Clock {
    /// Processor time of the calling thread.
    Thread,
    /// Processor time of all threads together.
    Process,
}

impl Clock {
    /// Returns the seconds so far.
    pub fn seconds(self) -> f64 {
        let time = clock_gettime(match self {
            Clock::Thread => ClockId::ThreadCPUTime,
            Clock::Process => ClockId::ProcessCPUTime,
        });
        time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
    }
}

/// Work to be timed.
pub(super) struct Case<'a> {
    labels: Vec<String>,
    against: usize,
    units: f64,
    figures: Vec<Option<f64>>,
    work: Box<dyn FnMut() + 'a>,
}

impl<'a> Case<'a> {
    /// Creates a case whose ratio refers to the case of index `against`, which may be itself. A run of `work` does
    /// `units` of work.
    pub fn new(labels: &[&str], against: usize, units: f64, work: impl FnMut() + 'a) -> Case<'a> {
        let labels = labels.iter().map(|l| (*l).to_owned()).collect();
        Case { labels, against, units, figures: Vec::new(), work: Box::new(work) }
    }

    /// Adds further figures.
    pub fn with(self, figures: &[f64]) -> Case<'a> {
        Case { figures: figures.iter().copied().map(Some).collect(), ..self }
    }

    /// Returns the seconds that some runs take.
    fn time(&mut self, runs: usize, clock: Clock) -> f64 {
        let start = clock.seconds();
        (0..runs).for_each(|_| (self.work)());
        clock.seconds() - start
    }
}

/// Relative distance of a ratio's quartiles beyond which a warning is given.
const UNSTEADY: f64 = 0.1;
/// Minimum duration of a sample without a warning, seconds.
const MIN_SECONDS: f64 = 1e-5;
/// Maximum number of runs in a sample.
const MAX_RUNS: f64 = 1e6;

/// Samples of a case.
#[derive(Clone, Default)]
struct CaseSamples {
    rates: Vec<f64>,
    /// True if a sample was too short to be timed well.
    short: bool,
}

/// Measures cases against each other, and adds them to a table as rows. Rates are in millions of units per second.
pub(super) fn measure(mut table: Table, clock: Clock, mut cases: Vec<Case>, settings: &Settings) -> Table {
    let samples = samples(&mut cases, clock, settings);
    for (case, own) in cases.into_iter().zip(&samples) {
        let against = &samples[case.against].rates;
        let ratios: Vec<f64> = own.rates.iter().zip(against).map(|(a, b)| a / b).collect();
        let doubt = doubt(&ratios, own.short);
        table.warnings.extend(doubt.map(|doubt| format!("{}: {doubt}", case.labels.join(", "))));
        table.rows.push(Row {
            labels: case.labels,
            ratio: Spread::new(&ratios),
            rate: Spread::new(&own.rates),
            samples: own.rates.clone(),
            figures: case.figures,
        });
    }
    table
}

fn samples(cases: &mut [Case], clock: Clock, settings: &Settings) -> Vec<CaseSamples> {
    let runs = |case: &mut Case| {
        case.time(1, clock);
        (settings.seconds / case.time(1, clock).max(1e-9)).clamp(1.0, MAX_RUNS) as usize
    };
    let runs: Vec<usize> = cases.iter_mut().map(runs).collect();
    let mut samples = vec![CaseSamples::default(); cases.len()];
    for round in 0..settings.repeats {
        for place in 0..cases.len() {
            let i = if round % 2 == 0 { place } else { cases.len() - 1 - place };
            let seconds = cases[i].time(runs[i], clock);
            samples[i].short |= seconds < MIN_SECONDS;
            let units = cases[i].units * runs[i] as f64;
            samples[i].rates.push(1e-6 * units / seconds.max(1e-9));
        }
    }
    samples
}

/// Returns the reason for which the ratios of a case should be doubted, with a remedy.
fn doubt(ratios: &[f64], short: bool) -> Option<String> {
    let spread = Spread::new(ratios).relative();
    if short {
        return Some("there is next to nothing to do; try a larger scene".to_owned());
    }
    let percent = 100.0 * spread;
    let text = format!(
        "the middle half of the ratios spreads over {percent:.0} %; try longer --seconds or a quieter machine"
    );
    (spread > UNSTEADY).then_some(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;

    #[test]
    fn cases_take_turns_and_are_compared_within_rounds() {
        let order = RefCell::new(Vec::new());
        let case = |name: &'static str| {
            let order = &order;
            Case::new(&[name], 0, 2.0, move || order.borrow_mut().push(name))
        };
        let settings = Settings { repeats: 3, seconds: 0.0, threads: 1 };
        let rows = measure(Table::default(), Clock::Process, vec![case("a"), case("b")], &settings).rows;
        assert_eq!(order.borrow().concat(), "aabbabbaab");
        assert_eq!((rows[0].ratio.median, rows[0].samples.len()), (1.0, 3));
        let median = |i: usize| rows[0].samples[i] / rows[1].samples[i];
        let expected = Spread::new(&[1.0 / median(0), 1.0 / median(1), 1.0 / median(2)]);
        assert!((rows[1].ratio.median / expected.median - 1.0).abs() < 1e-12);
    }
}
