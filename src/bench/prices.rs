//! Prices of the cost model ([`render::cost`]) on this machine, beside the prices that plans use.
//!
//! Units: microseconds of processor time.

use super::{Benchmark, Context, Kind, Row, Spread, Table};
use base::progress::Control;
use render::plan::{MeasuredPrice, measure_prices};
use world::view::{Framing, View};

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "prices",
    about: "Prices of rays, virtual lights and denoised pixels, beside those that plans use",
    kind: Kind::Parts { needs_scene: true, run },
};

/// Maximum number of rounds. A round renders two images.
const MAX_ROUNDS: usize = 3;

fn run(context: &Context) -> Vec<Table> {
    match rounds(context) {
        Ok(rounds) => table(&rounds).into_iter().collect(),
        Err(error) => {
            (context.say)(&error);
            Vec::new()
        }
    }
}

/// Measures all prices several times, on one thread.
fn rounds(context: &Context) -> Result<Vec<Vec<MeasuredPrice>>, String> {
    let Some(session) = context.session else { return Ok(Vec::new()) };
    let view = View::new(&session.cameras, &Framing::default()).map_err(|error| error.to_string())?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|error| error.to_string())?;
    let count = context.settings.repeats.clamp(1, MAX_ROUNDS);
    let measure = |round: usize| {
        (context.say)(&format!("round {} of {count}", round + 1));
        pool.install(|| measure_prices(&session.world, &view, &Control::new()))
    };
    Ok((0..count).filter_map(measure).collect())
}

/// Returns the table of rounds with the same prices; `None` without rounds.
fn table(rounds: &[Vec<MeasuredPrice>]) -> Option<Table> {
    let row = |(i, price): (usize, &MeasuredPrice)| {
        let samples: Vec<f64> = rounds.iter().filter_map(|round| Some(round.get(i)?.measured)).collect();
        let ratios: Vec<f64> = samples.iter().map(|measured| measured / price.used).collect();
        Row {
            labels: vec![price.name.to_owned()],
            ratio: Spread::of(&ratios),
            rate: Spread::of(&samples),
            samples,
            figures: vec![Some(price.used)],
        }
    };
    Some(Table {
        title: "Prices".to_owned(),
        about: "Processor time on one thread, in at most three rounds. Ratio to the price that plans use."
            .to_owned(),
        labels: vec!["price".to_owned()],
        unit: "us".to_owned(),
        figures: vec!["used".to_owned()],
        rows: rounds.first()?.iter().enumerate().map(row).collect(),
        warnings: Vec::new(),
    })
}
