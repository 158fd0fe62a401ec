//! The table as a page with plots and pictures.

use super::entries::{Family, OPPONENTS};
use super::markdown::{about, claims};
use super::row::HEADS;
use super::{SceneTable, Table1};
use crate::bench::export::escaped;
use crate::bench::study::page::{figure, heat, page, shown, table, worst, zoom};
use crate::bench::study::scatter::{Series, scatter};
use crate::film::metrics::flip_map;

/// Number of parts of the picture that are shown pixel by pixel.
const ZOOMS: usize = 3;

/// Returns the page.
pub fn html(table1: &Table1) -> String {
    let facts: Vec<String> = table1.facts.iter().map(|(name, value)| format!("{name} {value}")).collect();
    let mut body = format!("<p>{}</p>\n", escaped(&facts.join(", ")));
    body += "<p>Times are processor seconds over all threads. N_c: records; direct %: share of them that hold direct \
             light; anisotropy: long over short radius of footprints, direct / indirect; a: their radius over the \
             distance of what casts light and shadow; cut: clusters; T_light: light pass and trees; T_f: records and \
             cuts of eye samples' own; T_cache: splatting and adaptation; total: all that and the eye pass. PSNR and \
             FLIP are against the reference as it is, relMSE is without its noise and without the worst pixel of a \
             thousand; brightness below 1 is mostly what clamping takes away. \"To LC\": against lightcuts per pixel on \
             the same eye samples and virtual lights. \
             \"Light\": against the reference of the eye samples alone, in which only wrong light counts. \"Speed\": time of \
             lightcuts (LC) or photon-cache (PM) over the row's; \"at equal FLIP\" and \"at equal light\": the same for as \
             large a FLIP, or relMSE of light, interpolated between the other's rows; &gt; and &lt; where none is as \
             good or as bad.</p>\n<h2>Beside the paper</h2>\n";
    let heads = ["", "paper"].into_iter().map(str::to_owned);
    let heads: Vec<String> = heads.chain(table1.scenes.iter().map(|s| s.scene.clone())).collect();
    body += &table(&heads, &claims(table1), |_| false);
    body += "<p>Ratios of times with the light pass; in brackets at equal FLIP / at equal error of light. The paper's are the least and largest over its own scenes.</p>\n";
    for (i, scene) in table1.scenes.iter().enumerate() {
        body += &section(scene, i);
    }
    page("Table 1", &body)
}

fn section(scene: &SceneTable, number: usize) -> String {
    let mut text = format!("<h2>{}</h2>\n<p>{}</p>\n", escaped(&scene.scene), escaped(&about(scene)));
    let rows: Vec<Vec<String>> = scene.rows.iter().map(|row| row.cells()).collect();
    text += &table(&HEADS.map(str::to_owned), &rows, |i| !scene.rows[i].main);
    text += &scatter(
        "processor seconds",
        "FLIP against the reference",
        &curves(scene, |r| r.against_reference.flip),
    );
    text +=
        &scatter("processor seconds", "relMSE of light, without noise", &curves(scene, |r| r.light.rel_mse));
    text + &pictures(scene, number)
}

/// Returns other methods as curves, the settings of reconstruction cuts and of the cache as points.
fn curves(scene: &SceneTable, error: impl Fn(&super::Row) -> f64) -> Vec<Series> {
    let of = |family| {
        let rows = scene.rows.iter().filter(move |row| row.family == family);
        let mut points: Vec<_> = rows.map(|row| (row.total, error(row), row.label.clone())).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    let mut series: Vec<Series> = OPPONENTS
        .into_iter()
        .zip(["#a40", "#693"])
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
