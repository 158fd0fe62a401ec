//! Rows of the table. Settings are the methods' defaults, with the exceptions stated here.

use crate::study::{Candidate, Group, Study, Subject, denoised_paths, photons_on_eye_samples};
use render::method::{Method, vpl};
use transport::radiance_cache::{DirectBy, Footprints, FoundBy};

/// Groups that others are compared with, each with the label of its main row.
pub const OPPONENTS: [(Group, &str); 3] = [
    (Group::Lightcuts, "lightcuts"),
    (Group::PhotonCache, "photon-cache"),
    (Group::DenoisedPath, "path --denoise"),
];

/// The paper's names of methods, by label.
const PAPER: [(&str, &str); 5] = [
    ("walk, a frame", "LWalk2"),
    ("cache, anisotropic", "LCache2"),
    ("cache, isotropic", "LCache1"),
    ("photon-cache", "PM"),
    ("lightcuts, unshared", "LC"),
];

/// Error thresholds of lightcuts that make its curve, relative to the default.
const CURVE: [f32; 4] = [0.5, 2.0, 4.0, 8.0];
/// Numbers of rays of photon-cache that make its curve, relative to the default.
const RAYS: [f32; 3] = [0.25, 0.5, 2.0];

/// Largest error bound of a cluster in the cut of a record, in the paper.
const PAPER_EPSILON: f32 = 0.01;

/// Number of frames of the walk-through.
const WALK: usize = 24;

/// Samples per pixel of the denoised paths that are compared, as many as the default has.
const DENOISED_SPP: u32 = 16;

/// Returns the paper's name of a method, if it has one.
pub fn paper(label: &str) -> Option<&'static str> {
    PAPER.iter().find(|(ours, _)| *ours == label).map(|(_, paper)| *paper)
}

/// Returns all rows of a scene. The walk-through requires a camera path that passes the image, denoised paths a
/// denoiser. Methods other than these and the default take the eye samples of reconstruction cuts; the paper's caches
/// and lightcuts also take their virtual lights and cuts.
pub fn entries(study: &Study, subject: &Subject) -> Vec<Candidate> {
    let reconstruction = vpl::Settings::reconstruction();
    let (cuts, photons) = (vpl::Settings::lightcuts(), photons_on_eye_samples());
    let unshared = vpl::Settings { share: false, ..cuts };
    let of = |group, candidate| Candidate { group, ..candidate };
    let mut entries = vec![Candidate::new("default", Method::default())];
    if subject.walk(WALK).is_some() {
        let walk = Candidate::new("walk, a frame", Method::default());
        entries.push(Candidate { walk: Some(WALK), ..walk });
    }
    entries.extend([
        Candidate::new("reconstruction", Method::Vpl(reconstruction)),
        Candidate::new("cache, anisotropic", paper_cache(Footprints::Anisotropic)),
        Candidate::new("cache, isotropic", paper_cache(Footprints::Isotropic)),
        of(Group::PhotonCache, Candidate::new("photon-cache", Method::Vpl(photons))),
        lightcuts(),
        of(Group::Unshared, Candidate::new("lightcuts, unshared", Method::Vpl(unshared))),
    ]);
    for factor in CURVE {
        let mut settings = cuts;
        settings.cut.epsilon *= factor;
        let label = format!("lightcuts, ε {} %", 100.0 * settings.cut.epsilon);
        let curve = Candidate { main: false, ..Candidate::new(label, Method::Vpl(settings)) };
        entries.push(of(Group::Lightcuts, curve));
    }
    for factor in RAYS {
        let mut settings = photons;
        settings.gathering.rays = (settings.gathering.rays as f32 * factor).round() as u32;
        let label = format!("photon-cache, {} rays", settings.gathering.rays);
        let curve = Candidate { main: false, ..Candidate::new(label, Method::Vpl(settings)) };
        entries.push(of(Group::PhotonCache, curve));
    }
    entries.extend(denoised_paths(study).map(|path| match path.method.spp() {
        DENOISED_SPP => Candidate { label: "path --denoise".to_owned(), ..path },
        _ => Candidate { main: false, ..path },
    }));
    entries
}

/// Returns lightcuts per pixel, which methods that keep eye samples are compared with.
pub fn lightcuts() -> Candidate {
    let method = Method::Vpl(vpl::Settings::lightcuts());
    Candidate { group: Group::Lightcuts, ..Candidate::new("lightcuts", method) }
}

/// Returns the paper's cache of both layers.
fn paper_cache(footprints: Footprints) -> Method {
    let vpl::Settings { spp, light, cut, .. } = vpl::Settings::reconstruction();
    let mut settings = vpl::Settings { spp, light, cut, ..vpl::Settings::cache() };
    settings.cache.footprints = footprints;
    settings.cache.direct = DirectBy::Records;
    settings.cache.indirect = FoundBy::Records;
    settings.cache.epsilon = PAPER_EPSILON;
    Method::Vpl(settings)
}
