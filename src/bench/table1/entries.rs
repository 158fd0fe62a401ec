//! Rows of the table. Settings are the methods' own defaults but for the exceptions stated here.

use crate::study::{Candidate, Study, Subject};
use render::method::{Method, cache, lightcuts, photon_cache, reconstruction};
use transport::lightcut::CutSettings;
use transport::radiance_cache::{DirectBy, Footprints, FoundBy};

/// A method's name over several settings, which make a curve of error against time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// The default, reconstruction cuts and the radiance cache.
    Own,
    /// Lightcuts per pixel, with cuts shared between neighbours.
    Lightcuts,
    /// Lightcuts per pixel as in the paper: one cut a sample.
    Unshared,
    /// Records of final gathering over a photon map.
    PhotonCache,
    /// Path tracing and a denoiser.
    DenoisedPath,
}

/// Families that others are compared with, each with the label of its own row.
pub const OPPONENTS: [(Family, &str); 3] = [
    (Family::Lightcuts, "lightcuts"),
    (Family::PhotonCache, "photon-cache"),
    (Family::DenoisedPath, "path --denoise"),
];

/// A row of the table.
pub struct Entry {
    /// Method and settings.
    pub candidate: Candidate,
    /// Family that the settings belong to.
    pub family: Family,
    /// The paper's name for it, if any.
    pub paper: Option<&'static str>,
    /// True for the methods compared, false for mere points on the curve of a family.
    pub main: bool,
}

/// Error thresholds of lightcuts per pixel that make its curve, relative to the default.
const CURVE: [f32; 4] = [0.5, 2.0, 4.0, 8.0];
/// Numbers of rays of photon-cache that make its curve, relative to the default.
const RAYS: [f32; 3] = [0.25, 0.5, 2.0];

/// Largest error bound of a cluster in the cut of a record, in the paper.
const PAPER_EPSILON: f32 = 0.01;

/// Frames of the walk-through.
const WALK: usize = 24;

/// Samples a pixel of the denoised paths that are compared, as many as the default has.
const DENOISED_SPP: u32 = 16;

/// Returns all rows for a scene, that of the walk-through only where its camera path passes the picture; denoised paths
/// only if the study denoises. Other methods but those and the default take the eye samples of reconstruction cuts,
/// the paper's caches and lightcuts per pixel their virtual lights and cuts too.
pub fn entries(study: &Study, subject: &Subject) -> Vec<Entry> {
    let reconstruction = reconstruction::Settings::default();
    let shaped = |footprints| {
        let mut settings = cache::Settings::default();
        settings.cache.footprints = footprints;
        settings.cache.direct = DirectBy::Records;
        settings.cache.cut = CutSettings { epsilon: PAPER_EPSILON, ..reconstruction.cut };
        settings.spp = reconstruction.spp;
        settings.light = reconstruction.light;
        settings.cut = reconstruction.cut;
        settings.cache.indirect = FoundBy::Records;
        Method::Cache(settings)
    };
    let cuts = lightcuts::Settings {
        spp: reconstruction.spp,
        seed: reconstruction.seed,
        max_depth: reconstruction.max_depth,
        light: reconstruction.light,
        cut: reconstruction.cut,
        family: reconstruction.family,
        ..lightcuts::Settings::default()
    };
    let unshared = lightcuts::Settings { share: false, ..cuts };
    let photons = photon_cache::Settings {
        spp: reconstruction.spp,
        seed: reconstruction.seed,
        max_depth: reconstruction.max_depth,
        ..photon_cache::Settings::default()
    };
    let entry = |label: &str, paper, family, method| Entry {
        candidate: Candidate::new(label, method),
        family,
        paper,
        main: true,
    };
    let mut entries = vec![
        entry("default", None, Family::Own, Method::default()),
        entry("reconstruction", None, Family::Own, Method::Reconstruction(reconstruction)),
        entry("cache, anisotropic", Some("LCache2"), Family::Own, shaped(Footprints::Anisotropic)),
        entry("cache, isotropic", Some("LCache1"), Family::Own, shaped(Footprints::Isotropic)),
        entry("photon-cache", Some("PM"), Family::PhotonCache, Method::PhotonCache(photons)),
        entry("lightcuts", None, Family::Lightcuts, Method::Lightcuts(cuts)),
        entry("lightcuts, unshared", Some("LC"), Family::Unshared, Method::Lightcuts(unshared)),
    ];
    if subject.walk(WALK).is_some() {
        let candidate = Candidate::walk("walk, a frame", Method::default(), WALK);
        entries.insert(1, Entry { candidate, family: Family::Own, paper: Some("LWalk2"), main: true });
    }
    for factor in CURVE {
        let mut settings = cuts;
        settings.cut.epsilon *= factor;
        let label = format!("lightcuts, ε {} %", 100.0 * settings.cut.epsilon);
        let method = Method::Lightcuts(settings);
        entries.push(Entry { main: false, paper: None, ..entry(&label, None, Family::Lightcuts, method) });
    }
    for factor in RAYS {
        let mut settings = photons;
        settings.rays = (settings.rays as f32 * factor).round() as u32;
        let label = format!("photon-cache, {} rays", settings.rays);
        let method = Method::PhotonCache(settings);
        entries.push(Entry { main: false, paper: None, ..entry(&label, None, Family::PhotonCache, method) });
    }
    for mut candidate in study.denoised_paths() {
        let main = candidate.method.spp() == DENOISED_SPP;
        if main {
            candidate.label = "path --denoise".to_owned();
        }
        entries.push(Entry { candidate, family: Family::DenoisedPath, paper: None, main });
    }
    entries
}
