//! The trade-off for people: fronts, and a plot a knob.

use super::front::Effect;
use super::verdict::{ERROR_TOLERANCE, TIME_TOLERANCE};
use super::{ERRORS, Point, SceneTrade, Sort, Sweep, Trade};
use crate::document::{Document, Grid, escaped};
use crate::study::scatter::{Series, scatter};
use crate::study::{figure, optional, seconds};
use base::setting::JudgedBy;

const SECONDS: &str = "processor seconds";

/// Caption of the effects of knobs.
const TOGETHER: &str = "By what factor error and time change from a knob's coarsest to its finest level (the error is \
    that of light) while all others vary by a designed sample; in brackets what covers that factor in 95 of 100 cases. \
    The line from level to level is straight in logarithms, what bends counts as noise. Of fewer samples than knobs, \
    what is one knob's may be taken for another's.";

/// Returns a section a scene.
pub fn document(trade: &Trade) -> Document {
    let mut document = Document::new("Trade");
    document.facts(&trade.facts);
    document.text("Times are processor seconds over all threads.");
    trade.scenes.iter().for_each(|scene| section(&mut document, scene));
    document
}

fn section(document: &mut Document, scene: &SceneTrade) {
    document.heading(2, &scene.scene);
    document.text(about(scene));
    document.heading(3, "The default, the qualities, and other methods");
    document.grid(points(&scene.named()));
    for error in ERRORS {
        document.heading(3, format!("Pareto front of {}", name(error)));
        document.figure(scatter(SECONDS, name(error), &cloud(scene, error)));
        document.grid(points(&scene.front(error)));
    }
    document.heading(3, "Knob by knob");
    document.text(legend());
    document.grid(sweeps(scene));
    scene.sweeps.iter().for_each(|sweep| document.figure(plot(scene, sweep)));
    document.heading(3, "All knobs together");
    document.text(TOGETHER);
    document.grid(effects(scene));
}

/// Describes the references of the errors.
fn about(scene: &SceneTrade) -> String {
    let (pixels, light) = (&scene.reference, &scene.light_reference);
    format!(
        "From the limit: relative RMSE against the same picture by cuts of a quarter of the error on the same virtual lights \
         and with the same samples of direct light: what cuts and records add. Light error: relative RMSE against {} paths \
         over each pixel, whose own noise, {} of relMSE, is taken off, and without the worst pixel of a thousand; it holds \
         what virtual lights and their clamping get wrong, and the noise that is left. FLIP: against the same paths, whose \
         halves differ by {}. The default and paths are denoised. Reconstruction, lightcuts, photon-cache and knobs with \
         direct light by records or cuts keep four eye samples a pixel: their error from the limit and of light is against \
         lightcuts and {} paths ({} of relMSE) through those alone, their FLIP holds their aliasing.",
        pixels.spp,
        figure(pixels.rel_mse),
        figure(pixels.flip_of_halves),
        light.spp,
        figure(light.rel_mse)
    )
}

/// Explains the verdicts.
fn legend() -> String {
    format!(
        "Each knob alone, from coarse to fine; changes of error below {:.0} % and of time below {:.0} % count as none. \
         Error is that of the second column.",
        100.0 * ERROR_TOLERANCE,
        100.0 * TIME_TOLERANCE
    )
}

/// Returns the name of an error.
fn name(error: JudgedBy) -> &'static str {
    match error {
        JudgedBy::Limit => "error from the limit",
        JudgedBy::Light => "light error",
        JudgedBy::Flip => "FLIP",
    }
}

/// Returns a row a knob.
fn sweeps(scene: &SceneTrade) -> Grid {
    let row = |sweep: &Sweep| {
        let level = |(text, point): &(String, usize)| {
            let point = &scene.points[*point];
            format!("{text}: {}, {}", seconds(point.seconds), optional(point.error(sweep.judged_by)))
        };
        let levels: Vec<String> = sweep.levels.iter().map(level).collect();
        vec![
            sweep.knob.clone(),
            name(sweep.judged_by).to_owned(),
            levels.join("; "),
            sweep.error.to_string(),
            sweep.time.to_string(),
            sweep.verdict.to_owned(),
        ]
    };
    let heads = ["knob", "judged by", "coarse → fine: seconds, error", "error", "time", "verdict"];
    grid(&heads, scene.sweeps.iter().map(row).collect())
}

/// Returns a row a point.
fn points(points: &[&Point]) -> Grid {
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
    let heads =
        ["seconds", "from the limit", "light error", "FLIP", "point", "settings besides the defaults"];
    grid(&heads, points.iter().map(row).collect())
}

/// Returns a row a knob, by the designed sample.
fn effects(scene: &SceneTrade) -> Grid {
    let text = |effect: &Option<Effect>| match effect {
        Some(e) => format!("{:.2} ({:.2} to {:.2})", e.factor, e.range[0], e.range[1]),
        None => "-".to_owned(),
    };
    let rows = scene.effects.iter().map(|e| vec![e.knob.clone(), text(&e.error), text(&e.time)]).collect();
    grid(&["knob", "error, fine over coarse", "time, fine over coarse"], rows)
}

fn grid(heads: &[&str], rows: Vec<Vec<String>>) -> Grid {
    let heads: Vec<String> = heads.iter().map(|head| (*head).to_owned()).collect();
    Grid { names: heads.len(), heads, rows, ..Grid::default() }
}

/// Returns all points by their sort, the front joined.
fn cloud(scene: &SceneTrade, error: JudgedBy) -> Vec<Series> {
    let place = |point: &Point| {
        let turned = if matches!(point.sort, Sort::Sweep | Sort::Quality) { "" } else { &*point.turned };
        (point.seconds, point.error(error).unwrap_or(0.0), format!("{} {turned}", point.label))
    };
    let of = |name: &str, colour, sort| Series {
        name: name.to_owned(),
        colour,
        joined: false,
        points: scene.points.iter().filter(|point| point.sort == sort).map(place).collect(),
    };
    let joined = scene.front(error).into_iter().map(place).collect();
    // Those drawn later lie on top.
    vec![
        of("designed sample", "#bbb", Sort::Sample),
        of("one knob turned", "#4a7fb5", Sort::Sweep),
        Series { name: "front".to_owned(), colour: "#693", joined: true, points: joined },
        of("--quality", "#939", Sort::Quality),
        of("default", "#d00", Sort::Default),
        of("", "#a40", Sort::Other),
        Series { joined: true, ..of("path --denoise", "#0a7", Sort::DenoisedPath) },
    ]
}

/// Plots a knob's levels and the default.
fn plot(scene: &SceneTrade, sweep: &Sweep) -> String {
    let error = |point: &Point| point.error(sweep.judged_by).unwrap_or(0.0);
    let place = |point: &Point, name: &str| (point.seconds, error(point), name.to_owned());
    let levels: Vec<_> =
        sweep.levels.iter().map(|(text, point)| place(&scene.points[*point], text)).collect();
    let default = scene.points.iter().filter(|p| p.sort == Sort::Default);
    let series = [
        Series { name: "coarse to fine".to_owned(), colour: "#4a7fb5", joined: true, points: levels.clone() },
        Series {
            name: "default".to_owned(),
            colour: "#d00",
            joined: false,
            points: default.map(|p| place(p, "default")).collect(),
        },
        Series { name: String::new(), colour: "#4a7fb5", joined: false, points: levels },
    ];
    format!(
        "<figure style=\"width:46%\">{}<figcaption>{}: {}</figcaption></figure>\n",
        scatter(SECONDS, name(sweep.judged_by), &series),
        escaped(&sweep.knob),
        escaped(sweep.verdict)
    )
}
