//! The trade-off as Markdown.

use super::verdict::{ERROR_TOLERANCE, TIME_TOLERANCE};
use super::{Effect, Point, SceneTrade, Trade};
use crate::bench::study::{figure, optional, seconds};
use crate::setting::JudgedBy;

/// Heads of [`sweeps`].
pub const SWEEP_HEADS: [&str; 6] =
    ["knob", "judged by", "coarse → fine: seconds, error", "error", "time", "verdict"];
/// Heads of [`front`].
pub const FRONT_HEADS: [&str; 6] =
    ["seconds", "from the limit", "light error", "FLIP", "point", "settings besides the defaults"];
/// Heads of [`effects`].
pub const EFFECT_HEADS: [&str; 3] = ["knob", "error, fine over coarse", "time, fine over coarse"];

/// Heading of [`SceneTrade::named`].
pub const NAMED: &str = "The default, the qualities, and other methods";

/// Caption of [`effects`].
pub const TOGETHER: &str = "By what factor error and time change from a knob's coarsest to its finest level (the error is that \
     of light) while all others vary by a designed sample; in brackets what covers that factor in 95 of 100 cases. The line from \
     level to level is straight in logarithms, what bends counts as noise. Of fewer samples than knobs, what is one \
     knob's may be taken for another's.";

/// Returns a section a scene.
pub fn markdown(trade: &Trade) -> String {
    let facts: Vec<String> = trade.facts.iter().map(|(name, value)| format!("{name} {value}")).collect();
    let mut text = format!("# Trade\n\n{}. Times are processor seconds.\n", facts.join(", "));
    for scene in &trade.scenes {
        text += &format!("\n## {}\n\n{}\n\n{}\n\n", scene.scene, about(scene), legend());
        text += &table(&SWEEP_HEADS, &sweeps(scene));
        text += &format!("\n### {NAMED}\n\n");
        text += &table(&FRONT_HEADS, &front(&scene.named()));
        text += "\n### Pareto front of the error from the limit\n\n";
        text += &table(&FRONT_HEADS, &front(&scene.front(|p| p.on_limit_front)));
        text += "\n### Pareto front of light error\n\n";
        text += &table(&FRONT_HEADS, &front(&scene.front(|p| p.on_light_front)));
        text += "\n### Pareto front of FLIP\n\n";
        text += &table(&FRONT_HEADS, &front(&scene.front(|p| p.on_flip_front)));
        text += &format!("\n### All knobs together\n\n{TOGETHER}\n\n");
        text += &table(&EFFECT_HEADS, &effects(scene));
    }
    text
}

/// Describes the references of the errors.
pub fn about(scene: &SceneTrade) -> String {
    let (pixels, light) = (&scene.reference, &scene.light_reference);
    format!(
        "From the limit: relative RMSE against lightcuts of a quarter of the error on the same virtual lights, what cuts and \
         records add. Light error: relative RMSE against {} paths through each pixel's eye samples, whose own noise, {} of relMSE, is \
         taken off, and without the worst pixel of a thousand; it holds what virtual lights and their clamping get wrong. FLIP: against {} paths over each pixel, whose halves differ by {}.",
        light.spp,
        figure(light.rel_mse),
        pixels.spp,
        figure(pixels.flip_of_halves)
    )
}

/// Explains the verdicts.
pub fn legend() -> String {
    format!(
        "Each knob alone, from coarse to fine; changes of error below {:.0} % and of time below {:.0} % count as none. \
         Error is that of the second column.",
        100.0 * ERROR_TOLERANCE,
        100.0 * TIME_TOLERANCE
    )
}

/// Returns the name of an error.
pub fn judged_by(error: JudgedBy) -> &'static str {
    match error {
        JudgedBy::Limit => "from the limit",
        JudgedBy::Light => "light error",
        JudgedBy::Flip => "FLIP",
    }
}

/// Returns a row a knob.
pub fn sweeps(scene: &SceneTrade) -> Vec<Vec<String>> {
    let row = |sweep: &super::Sweep| {
        let level = |(text, point): &(String, usize)| {
            let point = &scene.points[*point];
            let error = point.error(sweep.judged_by);
            format!("{text}: {}, {}", seconds(point.seconds), figure(error))
        };
        let levels: Vec<String> = sweep.levels.iter().map(level).collect();
        vec![
            sweep.knob.clone(),
            judged_by(sweep.judged_by).to_owned(),
            levels.join("; "),
            sweep.error.to_string(),
            sweep.time.to_string(),
            sweep.verdict.to_owned(),
        ]
    };
    scene.sweeps.iter().map(row).collect()
}

/// Returns a row a point.
pub fn front(points: &[&Point]) -> Vec<Vec<String>> {
    let row = |point: &&Point| {
        vec![
            seconds(point.seconds),
            optional(point.limit),
            optional(point.light),
            figure(point.flip),
            point.label.clone(),
            point.turned.clone(),
        ]
    };
    points.iter().map(row).collect()
}

/// Returns a row a knob, by the designed sample.
pub fn effects(scene: &SceneTrade) -> Vec<Vec<String>> {
    let text = |effect: &Option<Effect>| match effect {
        Some(e) => format!("{:.2} ({:.2} to {:.2})", e.factor, e.range[0], e.range[1]),
        None => "-".to_owned(),
    };
    scene.effects.iter().map(|e| vec![e.knob.clone(), text(&e.error), text(&e.time)]).collect()
}

fn table(heads: &[&str], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| {
        let cells: Vec<String> = cells.iter().map(|c| c.replace('|', "\\|")).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let heads: Vec<String> = heads.iter().map(|head| (*head).to_owned()).collect();
    let rules: Vec<String> = heads.iter().map(|_| "---".to_owned()).collect();
    let rows: String = rows.iter().map(|row| line(row)).collect();
    line(&heads) + &line(&rules) + &rows
}
