//! The race for people: a table of times, then a section a scene.

use super::{Point, Race, SceneRace, TARGETS, Times};
use crate::document::{Document, Grid};
use crate::study::scatter::{Series, scatter};
use crate::study::{bounded, figure, optional, seconds};

/// Caption of the table.
const LEGEND: &str = "Processor seconds over all threads to a PSNR or FLIP: the default / `path --denoise`, and in \
    brackets how many times as fast the default is. They are interpolated, in logarithms, along the front of the pictures \
    of each that no other beats: the default with 1 to 64 samples a pixel and by --quality, paths with 1 to 256; < where \
    even the fastest is better, > where not even the best is as good: its time. PSNR is without the noise of the \
    reference, FLIP is against the reference as it is.";

/// Returns the table of times, then a section a scene.
pub fn document(race: &Race) -> Document {
    let mut document = Document::new("Race");
    document.facts(&race.facts);
    document.text(LEGEND);
    let heads: Vec<String> =
        [String::new()].into_iter().chain(TARGETS.map(|target| target.to_string())).collect();
    let row = |scene: &SceneRace| -> Vec<String> {
        [scene.scene.clone()].into_iter().chain(scene.times.iter().map(cell)).collect()
    };
    let rows = race.scenes.iter().map(row).collect();
    document.grid(Grid { names: 1, heads, rows, ..Grid::default() });
    race.scenes.iter().for_each(|scene| section(&mut document, scene));
    document
}

fn cell(times: &Times) -> String {
    let [default, path] = [times.default, times.path].map(bounded);
    let ratio = times.ratio.map_or(String::new(), |ratio| format!(" ({ratio})"));
    format!("{default} / {path}{ratio}")
}

fn section(document: &mut Document, scene: &SceneRace) {
    let noise = &scene.reference;
    document.heading(2, &scene.scene);
    document.text(format!(
        "Reference: {} paths a pixel, a PSNR of {} dB; FLIP between its halves, which differ by twice its noise, is {}.",
        noise.spp,
        optional(noise.psnr),
        figure(noise.flip_of_halves)
    ));
    let heads = ["picture", "options", "seconds", "elapsed", "PSNR", "FLIP", "relMSE"].map(str::to_owned);
    let rows = scene.points.iter().map(row).collect();
    document.grid(Grid { names: 2, heads: heads.to_vec(), rows, ..Grid::default() });
    let rmse = curves(scene, |point| point.errors.displayed_rmse());
    document.figure(scatter("processor seconds", "RMSE of the displayed picture", &rmse));
    let flip = curves(scene, |point| point.errors.flip);
    document.figure(scatter("processor seconds", "FLIP", &flip));
}

fn row(point: &Point) -> Vec<String> {
    let Point { label, options, errors, .. } = point;
    let figures = [optional(errors.psnr), figure(errors.flip), figure(errors.rel_mse)];
    let times = [point.seconds, point.elapsed].map(seconds);
    [label.clone(), options.clone()].into_iter().chain(times).chain(figures).collect()
}

/// Returns the pictures of the default as points, those of paths as a curve.
fn curves(scene: &SceneRace, error: impl Fn(&Point) -> f64) -> [Series; 2] {
    [("the default", "#d00", false), ("path --denoise", "#0a7", true)].map(|(name, colour, is_path)| {
        let points = scene.points.iter().filter(|point| point.is_path == is_path);
        Series {
            name: name.to_owned(),
            colour,
            joined: is_path,
            points: points.map(|point| (point.seconds, error(point), point.label.clone())).collect(),
        }
    })
}
