//! Prices of work and constants of the choice between methods, fitted to images; and how often the planner chooses the
//! better method, the cache or denoised paths.
//!
//! The study writes `calibration.rs`, which replaces `src/render/calibration.rs` ([`fit`]).
//!
//! Budgets are the processor seconds of the cache at five levels of its settings, or at those that `--knob` names. The
//! error of paths within a budget is interpolated between their images. The cost of a choice is its error over the
//! error of the better method.

mod answer;
mod fit;

use super::document::Grid;
use super::study::{Candidate, Cell, Column, Question, Shot, Study, StudyError, Subject, figure, seconds};
use super::{Benchmark, Kind, Results};
use answer::{Budget, Figures, SceneAnswer};
use base::stats::Stopwatch;
use fit::Fitted;
use render::method::{LightStore, Method};
use render::plan::{Chooser, DRAFT, FINAL, Ladder, PREVIEW};
use serde_json::json;
use std::path::PathBuf;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "calibrate",
    about: "Prices of work and constants of the choice between methods, fitted; how often the choice is right",
    kind: Kind::Study {
        scenes: &["cornell", "knot", "nave", "kitchen", "apartment", "hall", "plaza"],
        pixels: [256, 256],
        run,
    },
};

/// Levels of the cache whose times are the budgets, by name. Level 4 is the default.
const LEVELS: [(&str, f64); 5] =
    [("level 1", 1.0), ("draft", DRAFT), ("preview", PREVIEW), ("level 4", 4.0), ("final", FINAL)];

/// Number of trees of the forest, which has the most triangles.
const FOREST: u32 = 100;

/// Samples per pixel of the paths.
const SPP: [u32; 4] = [2, 8, 32, 128];

/// Caption of the tables.
const LEGEND: &str = "Budgets are the processor seconds of the cache at five levels of its settings. Errors of denoised \
    paths within a budget are interpolated in logarithms, and extrapolated beyond the last image. RMSE is of the displayed \
    image, without the noise of the reference. FLIP includes that noise. Expected: work of the other method for the same \
    quality, over the work of the chosen one. Cost: the error of the choice over the error of the better method.";

/// Images of a scene over processor seconds.
const QUESTION: Question = Question {
    table: &[
        Column::new("spp", "", |_, s| Cell::exact(s.candidate.method.spp())),
        Column::new("seconds", "", |_, s| Cell::seconds(s.seconds())),
        Column::new("errors", "", |_, s| Cell::exact(figures(s))),
    ],
    ..Question::PLAIN
};

/// Table of a scene's budgets.
const BUDGETS: &[Column<Budget>] = &[
    Column::new("options", "cache", |_, b| Cell::text(&b.options)),
    Column::new("chose_paths", "", |_, b| Cell::exact(b.chose_paths)),
    Column::new("", "chosen", |_, b| Cell::text(if b.chose_paths { "paths" } else { "cache" })),
    Column::new("seconds", "seconds", |_, b| Cell::seconds(b.seconds)),
    Column::new("cache", "", |_, b| Cell::exact(b.cache)),
    Column::new("paths", "", |_, b| Cell::exact(b.paths)),
    Column::new("", "RMSE: cache", |_, b| Cell::figure(b.cache[0])),
    Column::new("", "paths", |_, b| Cell::figure(b.paths[0])),
    Column::new("", "FLIP: cache", |_, b| Cell::figure(b.cache[1])),
    Column::new("", "paths", |_, b| Cell::figure(b.paths[1])),
    Column::new("ahead", "expected", |_, b| Cell::figure(b.ahead)),
    Column::new("cost", "", |_, b| Cell::exact(b.cost)),
    Column::new("", "cost: RMSE", |_, b| Cell::figure(b.cost[0])),
    Column::new("", "FLIP", |_, b| Cell::figure(b.cost[1])),
];

/// The planner's results for a scene.
struct Planned {
    chooser: Chooser,
    ladder: Ladder,
    /// Processor seconds that it took.
    seconds: f64,
}

fn run(study: &Study, files: &[PathBuf]) -> Result<Results, StudyError> {
    let mut scenes = Vec::new();
    for file in files {
        scenes.extend(scene(study, study.subject(file)?)?);
    }
    let forest = study.write_scene(|folder| lightsplat_scenes::forest(FOREST, folder))?;
    scenes.extend(scene(study, study.own_subject("forest", &forest)?)?);
    let [width, height] = study.plan.resolution;
    let mut results = Results::new("Calibration", study.facts(), LEGEND);
    total(&mut results, scenes.iter().flat_map(|scene| &scene.budgets));
    prices(&mut results, &fit::fit(&scenes, f64::from(width) * f64::from(height)));
    scenes.iter().for_each(|scene| section(&mut results, scene));
    Ok(results)
}

/// Returns the answer for a scene; `None` if there is nothing to choose.
fn scene(study: &Study, subject: Subject) -> Result<Option<SceneAnswer>, StudyError> {
    let Some(pilot) = Planned::new(study, &subject) else {
        (study.say)(&format!("{}: there is no light, and nothing to choose", subject.name));
        return if study.control.is_cancelled() { Err(StudyError::Interrupted) } else { Ok(None) };
    };
    let wanted = study.plan.knobs(&LEVELS.map(|(name, _)| name))?;
    let levels = LEVELS.into_iter().filter(|(name, _)| wanted.contains(name));
    let level = |(name, level)| Candidate::new(format!("cache, {name}"), pilot.ladder.at(level));
    let images: Vec<_> = SPP.map(Candidate::denoised_path).into_iter().chain(levels.map(level)).collect();
    let answer = study.ask(Question { images: &images, ..QUESTION }, [Ok(subject)])?;
    let (paths, cache) = answer.shots.split_at(SPP.len());
    let budgets = cache.iter().map(|shot| Budget::new(shot, paths, &pilot.chooser)).collect();
    let choice = pilot.chooser.on_film(&Method::default());
    let denoising = answer.reference.as_ref().map_or([None; 3], |reference| fit::denoising(&reference.mean));
    Ok(Some(SceneAnswer { answer, denoising, budgets, pilot_seconds: pilot.seconds, choice }))
}

/// Returns the errors of an image.
fn figures(shot: &Shot) -> Figures {
    [shot.errors.displayed_rmse(), shot.errors.flip]
}

impl Planned {
    fn new(study: &Study, subject: &Subject) -> Option<Planned> {
        let watch = Stopwatch::start();
        let (world, lights) = (&subject.session.world, &LightStore::default());
        let chooser = Chooser::new(world, lights, &subject.view, &Method::default(), study.control)?;
        let seconds = watch.elapsed().cpu_seconds;
        Some(Planned { chooser, ladder: Ladder::new(Method::default(), &[])?, seconds })
    }
}

impl Budget {
    /// Judges a choice.
    fn new(shot: &Shot, paths: &[Shot], chooser: &Chooser) -> Budget {
        let method = &shot.candidate.method;
        let curve: Vec<(f64, Figures)> = paths.iter().map(|path| (path.seconds(), figures(path))).collect();
        let (cache, paths) = (figures(shot), error_within(shot.seconds(), &curve));
        let choice = chooser.on_film(method);
        let chose_paths = matches!(choice.method, Method::Path(_));
        let chosen = if chose_paths { paths } else { cache };
        let cost = |i: usize| {
            let best = cache[i].min(paths[i]);
            if chosen[i] > best { chosen[i] / best } else { 1.0 }
        };
        Budget {
            options: method.scaled_options(),
            spp: method.spp().into(),
            seconds: shot.seconds(),
            cache,
            paths,
            chose_paths,
            quotient: choice.quotient,
            paths_a_sample: choice.paths_a_sample,
            ahead: choice.ahead,
            cost: [0, 1].map(cost),
        }
    }
}

/// Returns the errors of images that take some seconds: along the lines between images in logarithms, and beyond the
/// last image.
fn error_within(seconds: f64, images: &[(f64, Figures)]) -> Figures {
    let above = images.iter().position(|image| image.0 >= seconds).unwrap_or(images.len());
    let last = above.clamp(1, images.len() - 1);
    let (a, b) = (&images[last - 1], &images[last]);
    let share = (seconds / a.0).ln() / (b.0 / a.0).ln();
    [0, 1].map(|i| a.1[i] * (b.1[i] / a.1[i]).powf(share))
}

/// Adds the costs over all budgets.
fn total<'b>(results: &mut Results, budgets: impl Iterator<Item = &'b Budget>) {
    // Some images differ from the reference by its noise alone.
    let measurable = |budget: &&Budget| budget.cache[0].min(budget.paths[0]) > 0.0;
    let costs: Vec<Figures> = budgets.filter(measurable).map(|budget| budget.cost).collect();
    let at = |i: usize| {
        [0, 1].map(|figure| {
            let mut values: Vec<f64> = costs.iter().map(|cost| cost[figure]).collect();
            values.sort_by(f64::total_cmp);
            values.get(i).copied().unwrap_or(f64::NAN)
        })
    };
    let (median, worst) = (at(costs.len() / 2), at(costs.len().saturating_sub(1)));
    let right = costs.iter().filter(|cost| cost[0] <= 1.0).count();
    results.json["total"] =
        json!({ "right": right, "choices": costs.len(), "median": median, "worst": worst });
    let text = |[rmse, flip]: Figures| format!("{} by RMSE, {} by FLIP", figure(rmse), figure(flip));
    results.document.text(&format!(
        "{right} of {} choices were right by RMSE. Cost: median {}; worst {}.",
        costs.len(),
        text(median),
        text(worst)
    ));
}

/// Adds the fitted values, and the file that holds them.
fn prices(results: &mut Results, fitted: &[Fitted]) {
    results.json["calibration"] = json!(fitted);
    results.document.heading(2, "Prices and constants");
    let row = |price: &Fitted| {
        let texts =
            [figure(price.used), figure(price.value), figure(price.residual), price.images.to_string()];
        [price.name.to_owned()].into_iter().chain(texts).collect()
    };
    let heads = ["name", "used", "fitted", "single images, factor", "images"];
    results.document.grid(&Grid::new(1, &heads, fitted.iter().map(row).collect()));
    let from = ["version", "processor", "date"].map(|name| results.fact(name)).join(", ");
    results.document.file("calibration.rs", fit::source(fitted, &format!("{from}.")));
}

fn section(results: &mut Results, scene: &SceneAnswer) {
    let SceneAnswer { answer, budgets, pilot_seconds, choice, .. } = scene;
    let pilot = json!({
        "pilot_seconds": pilot_seconds,
        "pilot_rays": choice.pilot_rays,
        "paths_a_sample": choice.paths_a_sample,
        "rays_ratio": choice.rays_ratio,
        "budgets": answer.objects(BUDGETS, budgets),
        "paths": answer.objects(QUESTION.table, &answer.shots[..SPP.len()]),
    });
    results.push("scenes", answer.facts(), pilot);
    let document = &mut results.document;
    document.heading(2, &answer.scene);
    document.text(&format!(
        "A sample of the cache equals {} paths, each with {} times its rays. The pilot took {} s, {} rays.",
        figure(choice.paths_a_sample),
        figure(choice.rays_ratio),
        seconds(*pilot_seconds),
        choice.pilot_rays
    ));
    document.grid(&answer.grid_of(BUDGETS, 2, budgets));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_interpolated_between_images_and_go_on_beyond_them() {
        // The error halves as the time is four times as long.
        let image = |seconds, error| (seconds, [error, 2.0 * error]);
        let paths = [image(1.0, 0.4), image(4.0, 0.2), image(16.0, 0.1)];
        for (seconds, expected) in
            [(0.25, 0.8), (1.0, 0.4), (2.0, 0.4 / 2f64.sqrt()), (16.0, 0.1), (64.0, 0.05)]
        {
            let found = error_within(seconds, &paths);
            assert!((found[0] / expected - 1.0).abs() < 1e-9, "{seconds} {}", found[0]);
            assert!((found[1] / (2.0 * expected) - 1.0).abs() < 1e-9);
        }
    }
}
