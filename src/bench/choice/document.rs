//! The choices for people: a table of all, and the pictures of a scene.

use super::{Budget, Choices, SceneChoices};
use crate::document::{Document, Grid};
use crate::study::scatter::{Series, scatter};
use crate::study::{figure, seconds};

/// Explains the figures.
const LEGEND: &str = "Budgets are the processor seconds of the cache by five levels of its settings. Errors of as many \
    seconds of denoised paths are interpolated in logarithms, and go on beyond the last picture. RMSE is that of the \
    displayed picture without the noise of the reference, FLIP is against the reference as it is. Expected: work of the \
    other method for as good a picture, over that of the chosen one. Cost: the error of the choice over that of the better \
    method.";

/// Returns the total, then a section a scene.
pub fn document(choices: &Choices) -> Document {
    let mut document = Document::new("Choices between methods");
    document.facts(&choices.facts);
    document.text(LEGEND);
    let total = &choices.total;
    let figures =
        |of: &super::Figures| format!("{} by RMSE, {} by FLIP", figure(of.displayed), figure(of.flip));
    document.text(format!(
        "{} of {} choices were right by RMSE. Cost: median {}; worst {}.",
        total.right,
        total.choices,
        figures(&total.median),
        figures(&total.worst)
    ));
    choices.scenes.iter().for_each(|scene| section(&mut document, scene));
    document
}

fn section(document: &mut Document, scene: &SceneChoices) {
    document.heading(2, &scene.scene);
    document.text(format!(
        "A sample of the cache is worth {} paths, each of {} times its rays. The pilot took {} s, {} rays.",
        figure(scene.paths_a_sample),
        figure(scene.rays_ratio),
        seconds(scene.pilot_seconds),
        scene.pilot_rays
    ));
    let heads = [
        "cache",
        "chosen",
        "seconds",
        "RMSE: cache",
        "paths",
        "FLIP: cache",
        "paths",
        "expected",
        "cost: RMSE",
        "FLIP",
    ];
    let rows = scene.budgets.iter().map(row).collect();
    document.grid(Grid { names: 2, heads: heads.map(str::to_owned).to_vec(), rows, ..Grid::default() });
    let cache = scene.budgets.iter().map(|b| (b.seconds, b.cache.displayed, b.options.clone())).collect();
    let paths =
        scene.paths.iter().map(|p| (p.seconds, p.errors.displayed, format!("--spp {}", p.spp))).collect();
    let series = [("cache", "#d00", cache), ("path --denoise", "#0a7", paths)];
    let series =
        series.map(|(name, colour, points)| Series { name: name.to_owned(), colour, joined: true, points });
    document.figure(scatter("processor seconds", "RMSE of the displayed picture", &series));
}

fn row(budget: &Budget) -> Vec<String> {
    let Budget { options, cache, paths, cost, .. } = budget;
    let errors = [cache.displayed, paths.displayed, cache.flip, paths.flip, budget.ahead];
    let costs = [cost.displayed, cost.flip];
    let chosen = if budget.chose_paths { "paths" } else { "cache" };
    [options.clone(), chosen.to_owned(), seconds(budget.seconds)]
        .into_iter()
        .chain(errors.into_iter().chain(costs).map(figure))
        .collect()
}
