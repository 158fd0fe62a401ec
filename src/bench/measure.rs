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

/// Cases to be measured against each other, and the description of their table.
pub(super) struct Experiment<'a> {
    pub title: &'a str,
    pub about: &'a str,
    /// Names of the cases' labels.
    pub labels: &'a [&'a str],
    /// Unit of the rates.
    pub unit: &'a str,
    /// Factor from units of work per second to that unit.
    pub scale: f64,
    /// Names of the cases' further figures.
    pub figures: &'a [&'a str],
    pub clock: Clock,
    pub cases: Vec<Case<'a>>,
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

impl Experiment<'_> {
    /// Measures the cases.
    pub fn measure(mut self, settings: &Settings) -> Table {
        let samples = self.samples(settings);
        let mut warnings = Vec::new();
        let mut rows = Vec::with_capacity(self.cases.len());
        for (case, own) in self.cases.into_iter().zip(&samples) {
            let against = &samples[case.against].rates;
            let ratios: Vec<f64> = own.rates.iter().zip(against).map(|(a, b)| a / b).collect();
            let doubt = doubt(&ratios, own.short);
            warnings.extend(doubt.map(|doubt| format!("{}: {doubt}", case.labels.join(", "))));
            rows.push(Row {
                labels: case.labels,
                ratio: Spread::new(&ratios),
                rate: Spread::new(&own.rates),
                samples: own.rates.clone(),
                figures: case.figures,
            });
        }
        let owned = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect();
        Table {
            title: self.title.to_owned(),
            about: self.about.to_owned(),
            labels: owned(self.labels),
            unit: self.unit.to_owned(),
            figures: owned(self.figures),
            rows,
            warnings,
        }
    }

    fn samples(&mut self, settings: &Settings) -> Vec<CaseSamples> {
        let (clock, scale) = (self.clock, self.scale);
        let runs = |case: &mut Case| {
            case.time(1, clock);
            (settings.seconds / case.time(1, clock).max(1e-9)).clamp(1.0, MAX_RUNS) as usize
        };
        let runs: Vec<usize> = self.cases.iter_mut().map(runs).collect();
        let mut samples = vec![CaseSamples::default(); self.cases.len()];
        for round in 0..settings.repeats {
            for place in 0..self.cases.len() {
                let i = if round % 2 == 0 { place } else { self.cases.len() - 1 - place };
                let seconds = self.cases[i].time(runs[i], clock);
                samples[i].short |= seconds < MIN_SECONDS;
                let units = self.cases[i].units * runs[i] as f64;
                samples[i].rates.push(units / seconds.max(1e-9) * scale);
            }
        }
        samples
    }
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
        let experiment = Experiment {
            title: "",
            about: "",
            labels: &["name"],
            unit: "",
            scale: 1.0,
            figures: &[],
            clock: Clock::Process,
            cases: vec![case("a"), case("b")],
        };
        let rows = experiment.measure(&Settings { repeats: 3, seconds: 0.0, threads: 1 }).rows;
        assert_eq!(order.borrow().concat(), "aabbabbaab");
        assert_eq!((rows[0].ratio.median, rows[0].samples.len()), (1.0, 3));
        let median = |i: usize| rows[0].samples[i] / rows[1].samples[i];
        let expected = Spread::new(&[1.0 / median(0), 1.0 / median(1), 1.0 / median(2)]);
        assert!((rows[1].ratio.median / expected.median - 1.0).abs() < 1e-12);
    }
}
