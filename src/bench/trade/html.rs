//! The trade-off as a page: both fronts, and a plot a knob.

use super::markdown::{
    EFFECT_HEADS, FRONT_HEADS, NAMED, SWEEP_HEADS, TOGETHER, about, effects, front, judged_by, legend, sweeps,
};
use super::{Point, SceneTrade, Sort, Sweep, Trade};
use crate::bench::export::escaped;
use crate::bench::study::page::{page, table};
use crate::bench::study::scatter::{Series, scatter};

/// Returns the page.
pub fn html(trade: &Trade) -> String {
    let facts: Vec<String> = trade.facts.iter().map(|(name, value)| format!("{name} {value}")).collect();
    let facts = escaped(&facts.join(", "));
    let mut body = format!("<p>{facts}. Times are processor seconds over all threads.</p>\n");
    for scene in &trade.scenes {
        body += &section(scene);
    }
    page("Trade", &body)
}

fn section(scene: &SceneTrade) -> String {
    let mut text = format!("<h2>{}</h2>\n<p>{}</p>\n", escaped(&scene.scene), escaped(&about(scene)));
    text += &format!("<h3>{NAMED}</h3>\n");
    text += &rows(&FRONT_HEADS, front(&scene.named()));
    text += "<h3>Error from the limit against time</h3>\n";
    text += &scatter(SECONDS, "error from the limit", &cloud(scene, |p| p.limit, |p| p.on_limit_front));
    text += &rows(&FRONT_HEADS, front(&scene.front(|p| p.on_limit_front)));
    text += "<h3>Error of light against time</h3>\n";
    text += &scatter(SECONDS, "light error", &cloud(scene, |p| p.light, |p| p.on_light_front));
    text += &rows(&FRONT_HEADS, front(&scene.front(|p| p.on_light_front)));
    text += "<h3>FLIP against time</h3>\n";
    text += &scatter(SECONDS, "FLIP", &cloud(scene, |p| Some(p.flip), |p| p.on_flip_front));
    text += &rows(&FRONT_HEADS, front(&scene.front(|p| p.on_flip_front)));
    text += &format!("<h3>Knob by knob</h3>\n<p>{}</p>\n", escaped(&legend()));
    text += &rows(&SWEEP_HEADS, sweeps(scene));
    for sweep in &scene.sweeps {
        text += &plot(scene, sweep);
    }
    text += &format!("<h3>All knobs together</h3>\n<p>{}</p>\n", escaped(TOGETHER));
    text + &rows(&EFFECT_HEADS, effects(scene))
}

const SECONDS: &str = "processor seconds";

fn rows(heads: &[&str], rows: Vec<Vec<String>>) -> String {
    let heads: Vec<String> = heads.iter().map(|head| (*head).to_owned()).collect();
    table(&heads, &rows, |_| false)
}

/// Returns all points by their sort, the front joined.
fn cloud(scene: &SceneTrade, error: fn(&Point) -> Option<f64>, on: fn(&Point) -> bool) -> Vec<Series> {
    let place = |point: &Point| {
        let turned = if matches!(point.sort, Sort::Sweep | Sort::Quality) { "" } else { &*point.turned };
        (point.seconds, error(point).unwrap_or(0.0), format!("{} {turned}", point.label))
    };
    let of = |name: &str, colour, sort| Series {
        name: name.to_owned(),
        colour,
        joined: false,
        points: scene.points.iter().filter(|point| point.sort == sort).map(place).collect(),
    };
    let joined = scene.front(on).into_iter().map(place).collect();
    // Those drawn later lie on top.
    vec![
        of("designed sample", "#bbb", Sort::Sample),
        of("one knob turned", "#4a7fb5", Sort::Sweep),
        Series { name: "front".to_owned(), colour: "#693", joined: true, points: joined },
        of("--quality", "#939", Sort::Quality),
        of("default", "#d00", Sort::Default),
        Series { name: String::new(), ..of("", "#a40", Sort::Other) },
    ]
}

/// Plots a knob's levels and the default.
fn plot(scene: &SceneTrade, sweep: &Sweep) -> String {
    let place = |point: &Point, name: &str| (point.seconds, point.error(sweep.judged_by), name.to_owned());
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
    let y = judged_by(sweep.judged_by);
    format!(
        "<figure style=\"width:46%\">{}<figcaption>{}: {}</figcaption></figure>\n",
        scatter(SECONDS, y, &series),
        escaped(&sweep.knob),
        escaped(sweep.verdict)
    )
}
