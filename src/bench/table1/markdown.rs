//! The table as Markdown.

use super::paper::{CLAIMS, SAVED_BY_ANISOTROPY};
use super::row::HEADS;
use super::{SceneTable, Speed, Table1};
use crate::bench::study::{figure, optional};

/// Returns a section a scene, then the paper's claims.
pub fn markdown(table: &Table1) -> String {
    let facts: Vec<String> = table.facts.iter().map(|(name, value)| format!("{name} {value}")).collect();
    let mut text = format!("# Table 1\n\n{}. Times are processor seconds.\n", facts.join(", "));
    for scene in &table.scenes {
        text += &format!("\n## {}\n\n{}\n\n", scene.scene, about(scene));
        text += &line(HEADS.map(str::to_owned).to_vec());
        let rules = (0..HEADS.len()).map(|i| if i < 2 { "---" } else { "--:" }.to_owned());
        text += &line(rules.collect());
        scene.rows.iter().for_each(|row| text += &line(row.cells()));
    }
    text +=
        "\n## Beside the paper\n\nRatios of times; in brackets at equal FLIP / at equal error of light.\n\n";
    let heads: Vec<String> = ["", "paper"].into_iter().map(str::to_owned).collect();
    let scenes = table.scenes.iter().map(|scene| scene.scene.clone());
    text += &line(heads.into_iter().chain(scenes).collect());
    text += &line((0..2 + table.scenes.len()).map(|_| "---".to_owned()).collect());
    for cells in claims(table) {
        text += &line(cells);
    }
    text
}

/// Describes the references of a scene's errors.
pub fn about(scene: &SceneTable) -> String {
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
        figure(noise.rel_mse),
        optional(noise.psnr),
        figure(noise.flip_of_halves),
        scene.light_reference.spp,
        figure(scene.light_reference.rel_mse),
    )
}

/// Returns the paper's claims, its figures and ours scene by scene.
pub fn claims(table: &Table1) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for claim in &CLAIMS {
        let [ours, other] = claim.of;
        let ours = |scene: &SceneTable| {
            let (Some(row), Some(other)) = (scene.row(ours), scene.row(other)) else { return "-".to_owned() };
            let speed = other.total / row.total.max(f64::MIN_POSITIVE);
            match row.versus.iter().flatten().find(|v| v.method == other.label) {
                Some(v) => {
                    let text = |speed: Option<Speed>| speed.map_or("-".to_owned(), |s| s.to_string());
                    format!("{speed:.2} ({} / {})", text(v.at_equal_flip), text(v.at_equal_light))
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

fn line(cells: Vec<String>) -> String {
    let cells: Vec<String> = cells.iter().map(|c| c.replace('|', "\\|")).collect();
    format!("| {} |\n", cells.join(" | "))
}
