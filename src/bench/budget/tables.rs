//! The tables of a budget.

use super::bare::{Bare, Traced};
use super::picture::Picture;
use super::round::{Cost, Round};
use crate::report::{Row, Spread, Table};
use base::stats::Stage;

/// Microseconds per second.
const MICRO: f64 = 1e6;

/// Nanoseconds per second.
const NANO: f64 = 1e9;

type OfRound<'a> = &'a dyn Fn(&Round) -> Cost;

/// Returns all tables.
pub fn all(rounds: &[Round]) -> Vec<Table> {
    if rounds.is_empty() {
        return Vec::new();
    }
    vec![steps(rounds), bare(rounds), estimate(rounds)]
}

/// Returns the times and rays of all steps.
fn steps(rounds: &[Round]) -> Table {
    let total = |picture: &Picture| picture.seconds;
    let row = |name: &str, seconds: &dyn Fn(&Picture) -> f64, rays: [f64; 2]| {
        let samples = samples(rounds, &|round| seconds(&round.picture));
        let ratios: Vec<f64> = rounds.iter().map(|r| seconds(&r.picture) / total(&r.picture)).collect();
        let ratio = Spread::of(&ratios);
        let figures = [100.0 * ratio.median, rays[0], rays[1]].map(|figure| (figure > 0.0).then_some(figure));
        Row { figures: figures.into(), ..row(name, ratio, samples) }
    };
    let rays = |rays: &dyn Fn(&Picture) -> f64| {
        let each: Vec<f64> = rounds.iter().map(|r| rays(&r.picture) / r.picture.pixels).collect();
        Spread::of(&each).median
    };
    let of_stage = |stage: Stage| {
        let rays = [rays(&|p| p.rays(stage).hits), rays(&|p| p.rays(stage).shadows)];
        row(stage.name(), &|picture| picture.step(stage), rays)
    };
    let mut rows: Vec<Row> = Stage::ALL.into_iter().map(of_stage).collect();
    rows.push(row("rest", &Picture::rest, [0.0; 2]));
    rows.push(row("total", &total, [rays(&|p| p.all_rays().hits), rays(&|p| p.all_rays().shadows)]));
    rows.retain(|row| row.rate.median > 0.0);
    Table {
        figures: ["% of total", "closest-hit rays/pixel", "shadow rays/pixel"].map(str::to_owned).into(),
        rows,
        ..table(
            "Steps",
            "Processor time of the default method on one thread, by step, in at most three rounds. Ratio to the total.",
            "step",
        )
    }
}

/// Returns the times of bare queries.
fn bare(rounds: &[Round]) -> Table {
    let traced = |of: fn(&Bare) -> Traced| {
        move |round: &Round| {
            let Traced { seconds, rays } = of(&round.bare);
            Cost { seconds, rays: rays as f64 }
        }
    };
    let (eye, shadow, bsdf) = (traced(|bare| bare.eye), traced(|bare| bare.shadow), traced(|bare| bare.bsdf));
    let cases: [(&str, OfRound); 6] = [
        ("bare: eye rays", &eye),
        ("bare: shadow rays", &shadow),
        ("bare: BSDF rays", &bsdf),
        ("bare: together", &|round| [eye(round), shadow(round), bsdf(round)].into_iter().sum()),
        ("bare: all rays of the eye pass (estimate)", &|round| round.by_number().into_iter().sum()),
        ("eye pass", &Round::eye_pass),
    ];
    let ratio = |round: &Round, cost: Cost| round.eye_pass().seconds / cost.seconds;
    Table {
        rows: rows(rounds, &cases, &ratio),
        figures: ray_figures(),
        ..table(
            "Bare Embree",
            "Embree's queries alone, on one thread: packets of sixteen rays, as for the first samples of the eye pass, \
             made before. The estimate prices the rays that the eye pass reports. Ratio: time of the eye pass over \
             this time.",
            "rays",
        )
    }
}

/// Returns the estimated time in Embree and the denoiser.
fn estimate(rounds: &[Round]) -> Table {
    let denoiser = |round: &Round| Cost { seconds: round.picture.step(Stage::Denoise), rays: 0.0 };
    let together = |round: &Round| {
        round.by_number().into_iter().chain(round.others_by_number()).chain([denoiser(round)]).sum()
    };
    let cases: [(&str, OfRound); 7] = [
        ("eye pass: eye rays", &|round| round.by_number()[0]),
        ("eye pass: further rays", &|round| round.by_number()[1]),
        ("eye pass: shadow rays", &|round| round.by_number()[2]),
        ("other steps: closest-hit rays", &|round| round.others_by_number()[0]),
        ("other steps: shadow rays", &|round| round.others_by_number()[1]),
        ("denoiser", &denoiser),
        ("Embree and denoiser", &together),
    ];
    let ratio = |round: &Round, cost: Cost| cost.seconds / round.picture.seconds;
    Table {
        rows: rows(rounds, &cases, &ratio),
        figures: ray_figures(),
        ..table(
            "Embree and denoiser (estimate)",
            "Number of rays that the steps report, times the bare time of a ray of the kind. Shadow rays of cuts count \
             as light samples, closest-hit rays of other steps as rays to all sides. Ratio to the total.",
            "part",
        )
    }
}

/// Returns the rows of all cases that take time.
fn rows(rounds: &[Round], cases: &[(&str, OfRound)], ratio: &dyn Fn(&Round, Cost) -> f64) -> Vec<Row> {
    let row = |(name, cost): &(&str, OfRound)| {
        let samples = samples(rounds, &|round| cost(round).seconds);
        let ratios: Vec<f64> = rounds.iter().map(|round| ratio(round, cost(round))).collect();
        let median = |of: &dyn Fn(&Round, Cost) -> f64| {
            let values: Vec<f64> = rounds.iter().map(|round| of(round, cost(round))).collect();
            Spread::of(&values).median
        };
        let rays = median(&|round, cost| cost.rays / round.picture.pixels);
        let price = median(&|_, cost| if cost.rays > 0.0 { NANO * cost.seconds / cost.rays } else { 0.0 });
        let figures = [rays, price].map(|figure| (figure > 0.0).then_some(figure));
        Row { figures: figures.into(), ..self::row(name, Spread::of(&ratios), samples) }
    };
    let takes_time = |row: &Row| row.rate.median > 0.0;
    cases.iter().map(row).filter(takes_time).collect()
}

/// Returns microseconds per pixel, by round.
fn samples(rounds: &[Round], seconds: &dyn Fn(&Round) -> f64) -> Vec<f64> {
    rounds.iter().map(|round| MICRO * seconds(round) / round.picture.pixels).collect()
}

fn row(name: &str, ratio: Spread, samples: Vec<f64>) -> Row {
    Row { labels: vec![name.to_owned()], ratio, rate: Spread::of(&samples), samples, figures: Vec::new() }
}

fn ray_figures() -> Vec<String> {
    ["rays/pixel", "ns/ray"].map(str::to_owned).into()
}

fn table(title: &str, about: &str, label: &str) -> Table {
    Table {
        title: title.to_owned(),
        about: about.to_owned(),
        labels: vec![label.to_owned()],
        unit: "us/pixel".to_owned(),
        figures: Vec::new(),
        rows: Vec::new(),
        warnings: Vec::new(),
    }
}
