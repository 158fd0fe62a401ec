//! The table for people, with plots and pictures.

use super::entries::{Family, OPPONENTS};
use super::paper::{CLAIMS, SAVED_BY_ANISOTROPY};
use super::row::HEADS;
use super::{SceneTable, Table1};
use crate::document::{Document, Grid};
use crate::study::page::{figure, heat, shown, worst, zoom};
use crate::study::scatter::{Series, scatter};
use crate::study::{self, bounded, optional};
use base::film::metrics::flip_map;

/// Number of parts of the picture that are shown pixel by pixel.
const ZOOMS: usize = 3;

/// Explanation of the columns.
const LEGEND: &str = "Times are processor seconds over all threads. N_c: records; direct %: share of them that hold \
    direct light; anisotropy: long over short radius of footprints, direct / indirect; a: their radius over the distance \
    of what casts light and shadow; cut: clusters; T_light: light pass and trees; T_f: records and cuts of eye samples' \
    own; T_cache: splatting and adaptation; total: all that, the eye pass, in which the default finds direct light, and \
    denoising. FLIP is against the reference as it is, PSNR and relMSE are without its noise, relMSE also without the \
    worst pixel of a thousand; brightness below 1 is mostly what clamping takes away. The default and paths are denoised \
    and estimate the whole pixel; the other rows keep four eye samples a pixel, whose aliasing counts in FLIP, PSNR and \
    relMSE. \"Light\": where that does not count, against the reference of those eye samples alone; of the default and \
    paths, against the reference of pixels, so that both have all errors that are not aliasing. \"To LC\": against \
    lightcuts per pixel on the same eye samples and virtual lights. \"Speed\": time of lightcuts (LC), photon-cache (PM) \
    or denoised paths over the row's; \"at equal FLIP\", \"PSNR\" and \"light\": the same for as large a FLIP, as \
    high a PSNR or as large a relMSE of light, interpolated between the other's rows; > and < where none is as good or \
    as bad.";

/// Returns the paper's claims, then a section a scene.
pub fn document(table: &Table1) -> Document {
    let mut document = Document::new("Table 1");
    document.facts(&table.facts);
    document.text(LEGEND);
    document.heading(2, "Beside the paper");
    document.text(
        "Ratios of times with the light pass; in brackets at equal FLIP / PSNR / error of light. The paper's are the \
         least and largest over its own scenes.",
    );
    let scenes = table.scenes.iter().map(|scene| scene.scene.clone());
    let heads: Vec<String> = ["", "paper"].into_iter().map(str::to_owned).chain(scenes).collect();
    document.grid(Grid { names: heads.len(), heads, rows: claims(table), ..Grid::default() });
    for (i, scene) in table.scenes.iter().enumerate() {
        section(&mut document, scene, i);
    }
    document
}

fn section(document: &mut Document, scene: &SceneTable, number: usize) {
    document.heading(2, &scene.scene);
    document.text(about(scene));
    document.grid(Grid {
        names: 2,
        heads: HEADS.map(str::to_owned).to_vec(),
        rows: scene.rows.iter().map(|row| row.cells()).collect(),
        minor: (0..scene.rows.len()).filter(|&i| !scene.rows[i].main).collect(),
    });
    let flip = curves(scene, |row| row.against_reference.flip);
    document.figure(scatter("processor seconds", "FLIP against the reference", &flip));
    let light = curves(scene, |row| row.light.rel_mse);
    document.figure(scatter("processor seconds", "relMSE of light, without noise", &light));
    document.figure(pictures(scene, number));
}

/// Describes the references of a scene's errors.
fn about(scene: &SceneTable) -> String {
    let noise = &scene.reference;
    format!(
        "{} triangles. Reference: {} paths a pixel, {:.0} s; its own standard error is {:.2} % of the mean radiance, \
         a relMSE of {} (taken off the relMSE below, which may so fall below 0, and which leaves out the worst pixel of a thousand) and a PSNR of {} dB; FLIP between its \
         halves, which differ by twice its noise, is {}. Reference of the eye samples (\"light\"): {} paths, a relMSE \
         of {}.",
        scene.triangles,
        noise.spp,
        noise.cpu_seconds,
        100.0 * noise.standard_error,
        study::figure(noise.rel_mse),
        optional(noise.psnr),
        study::figure(noise.flip_of_halves),
        scene.light_reference.spp,
        study::figure(scene.light_reference.rel_mse),
    )
}

/// Returns the paper's claims, its figures and ours scene by scene.
fn claims(table: &Table1) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for claim in &CLAIMS {
        let [ours, other] = claim.of;
        let ours = |scene: &SceneTable| {
            let (Some(row), Some(other)) = (scene.row(ours), scene.row(other)) else { return "-".to_owned() };
            let speed = other.total / row.total.max(f64::MIN_POSITIVE);
            match row.versus.iter().flatten().find(|v| v.method == other.label) {
                Some(v) => {
                    let equal = [v.at_equal_flip, v.at_equal_psnr, v.at_equal_light].map(bounded);
                    format!("{speed:.2} ({})", equal.join(" / "))
                }
                None => format!("{speed:.2}"),
            }
        };
        let paper = claim.range.map_or("-".to_owned(), |[least, most]| format!("{least} to {most}"));
        rows.push(row(table, claim.what, paper, ours));
    }
    let [least, most] = SAVED_BY_ANISOTROPY.map(|share| 100.0 * share);
    let saved = |scene: &SceneTable| {
        let records = |label| scene.row(label).and_then(|row| row.records).map(|[d, i]| d + i);
        match (records("cache, anisotropic"), records("cache, isotropic")) {
            (Some(a), Some(b)) if b > 0.0 => format!("{:.1} %", 100.0 * (1.0 - a / b)),
            _ => "-".to_owned(),
        }
    };
    rows.push(row(table, "records that anisotropy saves", format!("{least} to {most} %"), saved));
    rows
}

fn row(table: &Table1, what: &str, paper: String, ours: impl Fn(&SceneTable) -> String) -> Vec<String> {
    [what.to_owned(), paper].into_iter().chain(table.scenes.iter().map(ours)).collect()
}

/// Returns other methods as curves, the default, reconstruction cuts and the cache as points.
fn curves(scene: &SceneTable, error: impl Fn(&super::Row) -> f64) -> Vec<Series> {
    let of = |family| {
        let rows = scene.rows.iter().filter(move |row| row.family == family);
        let mut points: Vec<_> = rows.map(|row| (row.total, error(row), row.label.clone())).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    let mut series: Vec<Series> = OPPONENTS
        .into_iter()
        .zip(["#a40", "#693", "#939"])
        .map(|((family, name), colour)| Series {
            name: name.to_owned(),
            colour,
            joined: true,
            points: of(family),
        })
        .collect();
    series.push(Series { name: String::new(), colour: "#4a7fb5", joined: false, points: of(Family::Own) });
    series.push(Series { name: String::new(), colour: "#a40", joined: false, points: of(Family::Unshared) });
    series
}

/// Returns every method's picture, its FLIP, and parts of it; the reference's parts show under the pointer.
fn pictures(scene: &SceneTable, number: usize) -> String {
    let pictures = &scene.pictures;
    let (reference, exposure) = (&pictures.reference, pictures.exposure);
    let flips: Vec<_> = pictures.rows.iter().map(|image| flip_map(image, reference, exposure)).collect();
    let main: Vec<usize> = (0..scene.rows.len()).filter(|&i| scene.rows[i].main).collect();
    let parts =
        main.first().map_or_else(Vec::new, |&i| worst(&flips[i], reference.width, reference.height, ZOOMS));
    let id = |what: &str| format!("s{number}-{what}");
    let named = |figure: String, id: &str| figure.replacen("<img ", &format!("<img id=\"{id}\" "), 1);
    let mut text =
        "<h3>Pictures</h3>\n<p>Each with its FLIP against the reference, and the parts where the first method's \
                    is largest. Hold the pointer over a picture to see the reference.</p>\n<div>"
            .to_owned();
    text += &named(figure(&shown(reference, exposure), None, "reference", ""), &id("whole"));
    for (k, part) in parts.iter().enumerate() {
        let zoomed = figure(&zoom(reference, exposure, *part), None, "", "zoom");
        text += &named(zoomed, &id(&k.to_string()));
    }
    text += "</div>\n";
    for i in main {
        let (row, image) = (&scene.rows[i], &pictures.rows[i]);
        let caption = format!("{}: {:.2} s, FLIP {:.4}", row.label, row.total, row.against_reference.flip);
        text += "<div>";
        text += &figure(&shown(image, exposure), Some(&id("whole")), &caption, "");
        text += &figure(&heat(&flips[i], image), None, "FLIP, 0 to 1", "");
        for (k, part) in parts.iter().enumerate() {
            text += &figure(&zoom(image, exposure, *part), Some(&id(&k.to_string())), "", "zoom");
        }
        text += "</div>\n";
    }
    text
}
