//! How often the planner chooses the better method: the cache, or denoised paths.
//!
//! Budgets are the processor seconds that the cache takes by five levels of its scale of settings; the error of as many
//! seconds of paths is interpolated between their pictures. The cost of a choice is its error over that of the better
//! method; the pilot's own time is stated beside it.
//!
//! Units: processor seconds over all threads.

mod document;

use super::study::{Candidate, Errors, Noise, Results, Run, Study, StudyError, Subject};
use super::{Benchmark, Kind};
use base::stats::{Stage, Stopwatch};
use render::method::{LightStore, Method};
use render::plan::{Chooser, DRAFT, FINAL, Ladder, PREVIEW, options};
use serde::Serialize;
use std::path::PathBuf;
use transport::paths::Estimand;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "choice",
    about: "How often the planner takes the better of cache and denoised paths, and what its choice costs",
    kind: Kind::Study {
        scenes: &["cornell", "knot", "nave", "kitchen", "apartment", "hall"],
        pixels: [256, 256],
        run,
    },
};

/// Levels of the cache whose times are the budgets; 4 is the default.
const LEVELS: [f64; 5] = [1.0, DRAFT, PREVIEW, 4.0, FINAL];

/// Samples a pixel of the paths.
const SPP: [u32; 4] = [2, 8, 32, 128];

/// All results.
#[derive(Serialize)]
struct Choices {
    facts: Vec<(String, String)>,
    scenes: Vec<SceneChoices>,
    /// Over all budgets of all scenes.
    total: Total,
}

/// Results of a scene.
#[derive(Serialize)]
struct SceneChoices {
    scene: String,
    reference: Noise,
    /// Processor seconds of the pilot.
    pilot_seconds: f64,
    pilot_rays: u64,
    /// Number of paths that are worth a sample of the cache, and rays of a path over those of a sample.
    paths_a_sample: f64,
    rays_ratio: f64,
    budgets: Vec<Budget>,
    paths: Vec<Paths>,
}

/// A budget, and the errors of both methods within it.
#[derive(Clone, Serialize)]
struct Budget {
    /// Settings of the cache that take it.
    options: String,
    seconds: f64,
    cache: Figures,
    /// Interpolated.
    paths: Figures,
    chose_paths: bool,
    /// Expected work of the other method over that of the chosen one.
    ahead: f64,
    /// Errors of the choice over those of the better method.
    cost: Figures,
}

/// A picture of paths.
#[derive(Serialize)]
struct Paths {
    spp: u32,
    seconds: f64,
    errors: Figures,
}

/// Errors that choices are judged by.
#[derive(Clone, Copy, Serialize)]
struct Figures {
    /// Root mean square error of the displayed picture.
    displayed: f64,
    flip: f64,
}

/// Costs of choices: of the displayed picture's error.
#[derive(Serialize)]
struct Total {
    right: usize,
    choices: usize,
    median: Figures,
    worst: Figures,
}

impl Figures {
    fn of(errors: &Errors) -> Figures {
        Figures { displayed: errors.displayed_rmse(), flip: errors.flip }
    }

    fn map2(self, other: Figures, f: impl Fn(f64, f64) -> f64) -> Figures {
        Figures { displayed: f(self.displayed, other.displayed), flip: f(self.flip, other.flip) }
    }
}

fn run(study: &Study, scenes: &[PathBuf]) -> Result<Results, StudyError> {
    let mut found = Vec::new();
    for path in scenes {
        found.extend(scene(study, &study.subject(path)?)?);
    }
    let scenes = found;
    let total = Total::of(scenes.iter().flat_map(|scene| &scene.budgets));
    let choices = Choices { facts: study.facts(), scenes, total };
    Ok(Results { json: serde_json::json!(choices), document: document::document(&choices) })
}

/// `None` for a scene without light.
fn scene(study: &Study, subject: &Subject) -> Result<Option<SceneChoices>, StudyError> {
    let reference = study.reference(subject, Estimand::Pixels)?;
    let figures = |run: &Run| Ok::<_, StudyError>(Figures::of(&Errors::against(&run.color, &reference)?));
    let base = Method::default();
    let watch = Stopwatch::start();
    let chooser =
        Chooser::new(&subject.session.world, &LightStore::default(), &subject.view, &base, study.control);
    let pilot_seconds = watch.elapsed().cpu_seconds;
    let (Some(chooser), Some(ladder)) = (chooser, Ladder::new(base, &[])) else {
        (study.say)(&format!("{}: there is no light, and nothing to choose", subject.name));
        return if study.control.is_cancelled() { Err(StudyError::Interrupted) } else { Ok(None) };
    };
    let mut paths = Vec::new();
    for spp in SPP {
        let run = study.run(subject, &Candidate::denoised_path(format!("path --denoise, {spp} spp"), spp))?;
        paths.push(Paths { spp, seconds: run.seconds(&Stage::ALL), errors: figures(&run)? });
    }
    let mut budgets = Vec::new();
    for level in LEVELS {
        let method = ladder.at(level);
        let run = study.run(subject, &Candidate::new(format!("cache, level {level}"), method))?;
        let seconds = run.seconds(&Stage::ALL);
        let (cache, within) = (figures(&run)?, error_within(seconds, &paths));
        let choice = chooser.on_film(&method);
        let chose_paths = matches!(choice.method, Method::Path(_));
        let chosen = if chose_paths { within } else { cache };
        let cost = chosen.map2(
            cache.map2(within, f64::min),
            |chosen, best| if chosen > best { chosen / best } else { 1.0 },
        );
        let options = options(&method);
        budgets.push(Budget {
            options,
            seconds,
            cache,
            paths: within,
            chose_paths,
            ahead: choice.ahead,
            cost,
        });
    }
    let choice = chooser.on_film(&base);
    Ok(Some(SceneChoices {
        scene: subject.name.clone(),
        reference: reference.noise,
        pilot_seconds,
        pilot_rays: choice.pilot_rays,
        paths_a_sample: choice.paths_a_sample,
        rays_ratio: choice.rays_ratio,
        budgets,
        paths,
    }))
}

/// Errors of so many seconds of paths: along the lines between pictures, in logarithms, and on beyond the last.
fn error_within(seconds: f64, paths: &[Paths]) -> Figures {
    let above = paths.iter().position(|picture| picture.seconds >= seconds).unwrap_or(paths.len());
    let last = above.clamp(1, paths.len() - 1);
    let (a, b) = (&paths[last - 1], &paths[last]);
    let share = (seconds / a.seconds).ln() / (b.seconds / a.seconds).ln();
    a.errors.map2(b.errors, |a, b| a * (b / a).powf(share))
}

impl Total {
    fn of<'a>(budgets: impl Iterator<Item = &'a Budget>) -> Total {
        // Of some pictures nothing is left but the reference's noise.
        let known = |budget: &&Budget| budget.cache.displayed.min(budget.paths.displayed) > 0.0;
        let costs: Vec<Figures> = budgets.filter(known).map(|budget| budget.cost).collect();
        let sorted = |of: fn(&Figures) -> f64| {
            let mut values: Vec<f64> = costs.iter().map(of).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let (displayed, flip) = (sorted(|cost| cost.displayed), sorted(|cost| cost.flip));
        let at = |i: usize| {
            let of = |values: &[f64]| values.get(i).copied().unwrap_or(f64::NAN);
            Figures { displayed: of(&displayed), flip: of(&flip) }
        };
        let (median, worst) = (at(costs.len() / 2), at(costs.len().saturating_sub(1)));
        let right = costs.iter().filter(|cost| cost.displayed <= 1.0).count();
        Total { right, choices: costs.len(), median, worst }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(spp: u32, seconds: f64, error: f64) -> Paths {
        Paths { spp, seconds, errors: Figures { displayed: error, flip: 2.0 * error } }
    }

    #[test]
    fn errors_are_interpolated_between_pictures_and_go_on_beyond_them() {
        // The error halves as the time is four times as long.
        let paths = [picture(2, 1.0, 0.4), picture(8, 4.0, 0.2), picture(32, 16.0, 0.1)];
        for (seconds, expected) in
            [(0.25, 0.8), (1.0, 0.4), (2.0, 0.4 / 2f64.sqrt()), (16.0, 0.1), (64.0, 0.05)]
        {
            let found = error_within(seconds, &paths);
            assert!((found.displayed / expected - 1.0).abs() < 1e-9, "{seconds} {}", found.displayed);
            assert!((found.flip / (2.0 * expected) - 1.0).abs() < 1e-9);
        }
    }
}
