//! Any of the methods, with its settings.

use super::{Output, cache, lightcuts, path, photon_cache};
use crate::eye::{EyePass, Look};
use crate::film::Window;
use crate::light_tree::Family;
use crate::lightcut::CutSettings;
use crate::progress::Control;
use crate::radiance_cache::{CacheSettings, Footprints, FoundBy};
use crate::shadow::ShadowSettings;
use crate::view::View;
use crate::vpl::LightPassSettings;
use crate::world::World;
use serde_json::{Value, json};

/// A method and everything it needs to know besides the scene.
#[derive(Clone, Copy, Debug)]
pub enum Method {
    /// Path tracing.
    Path(path::Settings),
    /// The radiance cache.
    Cache(cache::Settings),
    /// The same cache over a photon map.
    PhotonCache(photon_cache::Settings),
    /// Lightcuts per pixel.
    Lightcuts(lightcuts::Settings),
}

impl Default for Method {
    fn default() -> Method {
        Method::Cache(cache::Settings::default())
    }
}

impl Method {
    /// The name under which the user chooses it.
    pub fn name(&self) -> &'static str {
        match self {
            Method::Path(_) => "path",
            Method::Cache(_) => "cache",
            Method::PhotonCache(_) => "photon-cache",
            Method::Lightcuts(_) => "lightcuts",
        }
    }

    /// Samples a pixel.
    pub fn spp(&self) -> u32 {
        match self {
            Method::Path(settings) => settings.spp,
            Method::Cache(settings) => settings.spp,
            Method::PhotonCache(settings) => settings.spp,
            Method::Lightcuts(settings) => settings.spp,
        }
    }

    /// The seed.
    pub fn seed(&self) -> u32 {
        match self {
            Method::Path(settings) => settings.seed,
            Method::Cache(settings) => settings.seed,
            Method::PhotonCache(settings) => settings.seed,
            Method::Lightcuts(settings) => settings.seed,
        }
    }

    /// Memory that the method needs for `window` besides the scene, where that grows with the samples.
    pub fn expected_bytes(&self, window: &Window) -> Option<u64> {
        match self {
            Method::Path(_) | Method::Lightcuts(_) => None,
            Method::Cache(_) | Method::PhotonCache(_) => Some(EyePass::expected_bytes(window, self.spp())),
        }
    }

    /// What the method takes a pixel's value to be.
    pub fn look(&self) -> Look {
        match self {
            Method::Path(_) => Look::Pixels,
            Method::Cache(_) | Method::PhotonCache(_) | Method::Lightcuts(_) => {
                Look::EyeSamples { spp: self.spp(), seed: self.seed() }
            }
        }
    }

    /// The settings by the names of their options, for the picture's metadata and the statistics.
    pub fn settings(&self) -> Value {
        match self {
            Method::Path(s) => json!({ "spp": s.spp, "seed": s.seed, "max_depth": s.max_depth }),
            Method::Cache(s) => cache_report(s),
            Method::PhotonCache(s) => photon_report(s),
            Method::Lightcuts(s) => lightcuts_report(s),
        }
    }

    /// Renders what `view` sees.
    pub fn render(&self, world: &World, view: &View, control: &Control) -> Output {
        match self {
            Method::Path(settings) => path::render(world, view, settings, control),
            Method::Cache(settings) => cache::render(world, view, settings, control),
            Method::PhotonCache(settings) => photon_cache::render(world, view, settings, control),
            Method::Lightcuts(settings) => lightcuts::render(world, view, settings, control),
        }
    }
}

fn cache_report(s: &cache::Settings) -> Value {
    let own = vpls_report(&s.light, &s.cut, s.compensation);
    joined([cuts_report(s.spp, s.seed, s.max_depth, &s.cut, s.family), own, records_report(&s.cache)])
}

fn photon_report(s: &photon_cache::Settings) -> Value {
    let own = json!({
        "direct_vpls": s.direct_vpls,
        "photons": s.photons,
        "nearest": s.nearest,
        "gather_rays": s.rays,
        "sample_rays": s.own_rays,
    });
    joined([cuts_report(s.spp, s.seed, s.max_depth, &s.cut, s.family), own, records_report(&s.cache)])
}

fn lightcuts_report(s: &lightcuts::Settings) -> Value {
    let own = json!({ "share": switch(s.share), "occluder_cache": occluders(&s.shadows, s.share) });
    let vpls = vpls_report(&s.light, &s.cut, s.compensation);
    joined([cuts_report(s.spp, s.seed, s.max_depth, &s.cut, s.family), vpls, own])
}

/// What all methods have that cut light trees.
fn cuts_report(spp: u32, seed: u32, max_depth: Option<u32>, cut: &CutSettings, family: Family) -> Value {
    json!({
        "spp": spp,
        "seed": seed,
        "max_depth": max_depth,
        "epsilon": decimal(cut.epsilon),
        "max_cut": cut.max_cut,
        "tree": match family {
            Family::Divisive => "divisive",
            Family::Agglomerative => "agglomerative",
        },
    })
}

/// What those have whose indirect light comes from virtual lights.
fn vpls_report(light: &LightPassSettings, cut: &CutSettings, compensation: bool) -> Value {
    json!({
        "vpls": light.indirect,
        "direct_vpls": light.direct,
        "clamp": decimal(cut.clamp.unwrap_or(0.0)),
        "compensation": switch(compensation),
    })
}

/// Members of all objects.
fn joined(objects: [Value; 3]) -> Value {
    objects
        .into_iter()
        .filter_map(|object| if let Value::Object(o) = object { Some(o) } else { None })
        .flatten()
        .collect()
}

fn records_report(c: &CacheSettings) -> Value {
    json!({
        "record_epsilon": decimal(c.cut.epsilon),
        "direct": found_by(c.direct),
        "indirect": found_by(c.indirect),
        "footprints": match c.footprints {
            Footprints::Isotropic => "isotropic",
            Footprints::Anisotropic => "anisotropic",
            Footprints::Occlusion => "occlusion",
        },
        "probe_rays": c.probe_rays,
        "accuracy": c.layers.map(|l| decimal(l.accuracy)),
        "reach": c.layers.map(|l| l.reach.map(decimal)),
        "series_alpha": decimal(c.series.min_alpha),
        "series_error": c.series.max_error,
        "gradients": switch(c.gradients),
        "mu": decimal(c.mu),
        "passes": c.passes,
        "threshold": decimal(c.threshold),
        "patches": c.patches,
        "share": switch(c.share),
        "occluder_cache": occluders(&c.shadows, c.share),
        "least_cell": c.least_cell,
    })
}

fn found_by(found: FoundBy) -> &'static str {
    match found {
        FoundBy::Records => "records",
        FoundBy::Samples => "samples",
    }
}

fn switch(on: bool) -> &'static str {
    if on { "on" } else { "off" }
}

/// The size of the occluder cache, if it is asked.
fn occluders(shadows: &ShadowSettings, share: bool) -> Value {
    let size = shadows.cache;
    match shadows.for_samples(share) {
        true => json!({ "slots": size.slots, "ways": size.ways }),
        false => json!("off"),
    }
}

/// The value with the digits that were typed, not those of its nearest f32.
fn decimal(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(value as f64)
}
