//! Figures of a method on a scene.

use super::entries::{Entry, Family, OPPONENTS};
use crate::study::{Bounded, Errors, Run, bounded, figure, optional, seconds};
use base::stats::Stage;
use serde::Serialize;
use serde_json::Value;

/// A row of the table.
#[derive(Serialize)]
pub struct Row {
    /// Label of its entry.
    pub label: String,
    /// The paper's name for it.
    pub paper: Option<&'static str>,
    /// True for a method compared, false for a point on a curve.
    pub main: bool,
    #[serde(skip)]
    pub family: Family,
    /// The method's settings.
    pub settings: Value,
    /// True if its picture is denoised.
    pub denoised: bool,
    /// Numbers of records, direct and indirect.
    pub records: Option<[f64; 2]>,
    /// Long over short radius of footprints, direct and indirect.
    pub anisotropy: [Option<f64>; 2],
    /// Radius of footprints over distance, direct and indirect.
    pub accuracy: [Option<f64>; 2],
    /// Clusters in a cut of indirect records, or rays of their gathering; without records, clusters in cuts
    /// of eye samples.
    pub cut: Option<f64>,
    /// Processor seconds: eye pass, light pass and trees, records and cuts, splatting.
    pub eye: f64,
    pub light_pass: f64,
    pub f: f64,
    /// `None` where there are no records.
    pub cache: Option<f64>,
    pub total: f64,
    /// Elapsed seconds.
    pub elapsed: f64,
    /// Speed against other methods.
    pub versus: [Option<Versus>; OPPONENTS.len()],
    pub against_reference: Errors,
    /// Errors of light: against the reference of the eye samples; of whole pixels, where those are estimated.
    pub light: Errors,
    /// Errors against lightcuts per pixel; `None` for lightcuts themselves, and for estimates of whole pixels.
    pub against_lightcuts: Option<Errors>,
}

/// Ratio of another method's time to this one's.
#[derive(Clone, Serialize)]
pub struct Versus {
    /// The label of the other's row.
    pub method: String,
    /// At their own settings.
    pub speed: f64,
    /// At equal FLIP against the reference.
    pub at_equal_flip: Option<Bounded>,
    /// At equal PSNR against the reference.
    pub at_equal_psnr: Option<Bounded>,
    /// At equal relMSE of light.
    pub at_equal_light: Option<Bounded>,
}

/// Heads of the columns of [`Row::cells`].
pub const HEADS: [&str; 33] = [
    "method",
    "paper's",
    "N_c",
    "direct %",
    "anisotropy",
    "a",
    "cut",
    "T_light",
    "T_f",
    "T_cache",
    "total",
    "elapsed",
    "PSNR",
    "relMSE",
    "FLIP",
    "brightness",
    "light relMSE",
    "light FLIP",
    "PSNR to LC",
    "relMSE to LC",
    "FLIP to LC",
    "speed to LC",
    "at equal FLIP",
    "at equal PSNR",
    "at equal light",
    "speed to PM",
    "at equal FLIP",
    "at equal PSNR",
    "at equal light",
    "speed to path",
    "at equal FLIP",
    "at equal PSNR",
    "at equal light",
];

impl Row {
    /// Computes the figures of a picture.
    pub fn new(entry: &Entry, run: &Run, [against_reference, of_light]: [Errors; 2]) -> Row {
        let records = |layer: &str| run.counter("Cache", &format!("records, {layer}"));
        let records = records("direct").zip(records("indirect")).map(|(d, i)| [d, i]);
        let mean = |what: &str| ["direct", "indirect"].map(|l| run.counter("Cache", &format!("{what}, {l}")));
        let [eye, light, f, cache] = [
            &[Stage::EyePass][..],
            &[Stage::LightPass, Stage::Tree],
            &[Stage::Records, Stage::Render],
            &[Stage::Splat],
        ]
        .map(|stages| run.seconds(stages));
        Row {
            label: entry.candidate.label.clone(),
            paper: entry.paper,
            main: entry.main,
            family: entry.family,
            settings: entry.candidate.method.settings(),
            denoised: run.denoised(),
            records,
            anisotropy: mean("anisotropy"),
            accuracy: mean("accuracy"),
            cut: match records {
                Some(_) => run.counter("Cache", "cut or rays, indirect"),
                None => run.counter("Lightcut", "mean cut"),
            },
            eye,
            light_pass: light,
            f,
            cache: records.map(|_| cache),
            total: run.seconds(&Stage::ALL),
            elapsed: run.elapsed(),
            versus: [const { None }; OPPONENTS.len()],
            against_reference,
            light: of_light,
            against_lightcuts: None,
        }
    }

    /// Returns the cells under [`HEADS`].
    pub fn cells(&self) -> Vec<String> {
        let total = self.records.map(|[d, i]| d + i);
        let share = self.records.map(|[d, i]| 100.0 * d / (d + i).max(1.0));
        let pair = |[a, b]: [Option<f64>; 2]| match (a, b) {
            (None, None) => "-".to_owned(),
            _ => format!("{} / {}", optional(a), optional(b)),
        };
        let errors = &self.against_reference;
        let others = self.against_lightcuts.as_ref();
        let versus = self.versus.iter().flat_map(|versus| match versus {
            Some(v) => {
                let [flip, psnr, light] = [v.at_equal_flip, v.at_equal_psnr, v.at_equal_light].map(bounded);
                [format!("{:.2}", v.speed), flip, psnr, light]
            }
            None => ["-"; 4].map(str::to_owned),
        });
        let cells = vec![
            self.label.clone(),
            self.paper.unwrap_or("").to_owned(),
            total.map_or("-".to_owned(), |n| format!("{n:.0}")),
            share.map_or("-".to_owned(), |n| format!("{n:.0}")),
            pair(self.anisotropy),
            pair(self.accuracy),
            optional(self.cut),
            seconds(self.light_pass),
            seconds(self.f),
            self.cache.map_or("-".to_owned(), seconds),
            seconds(self.total),
            seconds(self.elapsed),
            optional(errors.psnr),
            figure(errors.rel_mse),
            figure(errors.flip),
            figure(errors.brightness),
            figure(self.light.rel_mse),
            figure(self.light.flip),
            optional(others.and_then(|e| e.psnr)),
            optional(others.map(|e| e.rel_mse)),
            optional(others.map(|e| e.flip)),
        ];
        cells.into_iter().chain(versus).collect()
    }
}
