//! What the table compares. Settings are the methods' own defaults but for what is said here.

use crate::bench::study::Candidate;
use crate::cache::{DirectLight, Footprints};
use crate::cli::method::Method;
use crate::method::{cache, lightcuts};

/// A method's name over several settings, which make a curve of error against time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// The radiance cache.
    Cache,
    /// Lightcuts per pixel.
    Lightcuts,
}

/// A row of the table.
pub struct Entry {
    /// What is rendered.
    pub candidate: Candidate,
    /// What it is a setting of.
    pub family: Family,
    /// The paper's name for it, if it has one.
    pub paper: Option<&'static str>,
    /// Whether it is one of the methods compared, not just a point on the curve of its family.
    pub main: bool,
}

/// Errors of lightcuts per pixel that make its curve, relative to the default.
const COARSER: [f32; 4] = [0.5, 2.0, 4.0, 8.0];

/// All rows. Lightcuts per pixel take the eye samples, virtual lights and cuts of the cache.
pub fn entries() -> Vec<Entry> {
    let default = cache::Settings::default();
    let shaped = |footprints| {
        let mut settings = default;
        settings.cache.footprints = footprints;
        settings.cache.direct = DirectLight::Records;
        Method::Cache(settings)
    };
    let cuts = lightcuts::Settings {
        spp: default.spp,
        seed: default.seed,
        max_depth: default.max_depth,
        light: default.light,
        cut: default.cut,
        family: default.family,
        ..lightcuts::Settings::default()
    };
    let entry = |label: &str, paper, family, method| Entry {
        candidate: Candidate { label: label.to_owned(), method },
        family,
        paper,
        main: true,
    };
    let mut entries = vec![
        entry("cache", None, Family::Cache, Method::Cache(default)),
        entry("cache, anisotropic", Some("LCache2"), Family::Cache, shaped(Footprints::Anisotropic)),
        entry("cache, isotropic", Some("LCache1"), Family::Cache, shaped(Footprints::Isotropic)),
        entry("lightcuts", Some("LC"), Family::Lightcuts, Method::Lightcuts(cuts)),
    ];
    for factor in COARSER {
        let mut settings = cuts;
        settings.cut.epsilon *= factor;
        let label = format!("lightcuts, ε {} %", 100.0 * settings.cut.epsilon);
        let method = Method::Lightcuts(settings);
        entries.push(Entry { main: false, paper: None, ..entry(&label, None, Family::Lightcuts, method) });
    }
    entries
}
