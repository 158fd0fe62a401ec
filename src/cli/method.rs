//! The method chosen, with its settings.

use super::args::{LightcutArgs, MethodName, OccluderCache, PhotonArgs, RenderArgs, TreeFamily};
use super::cache_args::{CacheArgs, DirectBy, FootprintShape, Pair, Switch};
use super::exit::Failure;
use crate::cache::{CacheSettings, DirectLight, Footprints};
use crate::eye::{EyeSamples, Look, Window};
use crate::light_tree::Family;
use crate::method::{Control, Output, cache, lightcuts, path, photon_cache};
use crate::shadow::{Cached, ShadowSettings};
use crate::world::World;
use anyhow::anyhow;
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

impl Method {
    /// From what was typed. An option of another method is an error: it would have no effect.
    pub fn new(args: &RenderArgs) -> Result<Method, Failure> {
        match args.method {
            MethodName::Path if args.lightcuts != LightcutArgs::default() => Err(Failure::usage(anyhow!(
                "the options under \"Lightcuts\" belong to --method cache and lightcuts"
            ))),
            MethodName::Path | MethodName::Lightcuts if args.cache != CacheArgs::default() => {
                Err(Failure::usage(anyhow!(
                    "the options under \"Radiance cache\" belong to --method cache and photon-cache"
                )))
            }
            MethodName::Path | MethodName::Lightcuts | MethodName::Cache
                if args.photon != PhotonArgs::default() =>
            {
                Err(Failure::usage(anyhow!(
                    "the options under \"Photon map\" belong to --method photon-cache"
                )))
            }
            MethodName::PhotonCache
                if args.lightcuts.vpls.is_some()
                    || args.lightcuts.clamp.is_some()
                    || args.cache.compensation.is_some() =>
            {
                Err(Failure::usage(anyhow!(
                    "--vpls, --clamp and --compensation are for indirect virtual lights, of which --method photon-cache has none; see --photons"
                )))
            }
            MethodName::PhotonCache => Ok(Method::PhotonCache(photon_settings(args))),
            MethodName::Path => {
                let spp = args.spp.unwrap_or(path::Settings::default().spp);
                Ok(Method::Path(path::Settings { spp, seed: args.seed, max_depth: args.max_depth }))
            }
            MethodName::Cache => Ok(Method::Cache(cache_settings(args))),
            MethodName::Lightcuts => Ok(Method::Lightcuts(lightcuts_settings(args))),
        }
    }

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
            Method::Cache(_) | Method::PhotonCache(_) => Some(EyeSamples::expected_bytes(window, self.spp())),
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

    /// Renders `window`.
    pub fn render(&self, world: &World, window: &Window, control: &Control) -> Output {
        match self {
            Method::Path(settings) => path::render(world, window, settings, control),
            Method::Cache(settings) => cache::render(world, window, settings, control),
            Method::PhotonCache(settings) => photon_cache::render(world, window, settings, control),
            Method::Lightcuts(settings) => lightcuts::render(world, window, settings, control),
        }
    }
}

fn cache_report(s: &cache::Settings) -> Value {
    let own = json!({
        "spp": s.spp,
        "seed": s.seed,
        "max_depth": s.max_depth,
        "epsilon": decimal(s.cut.epsilon),
        "max_cut": s.cut.max_cut,
        "vpls": s.light.indirect,
        "direct_vpls": s.light.direct,
        "clamp": decimal(s.cut.clamp.unwrap_or(0.0)),
        "tree": family_name(s.family),
        "compensation": switch(s.cache.compensation),
    });
    joined(own, records_report(&s.cache))
}

fn photon_report(s: &photon_cache::Settings) -> Value {
    let own = json!({
        "spp": s.spp,
        "seed": s.seed,
        "max_depth": s.max_depth,
        "epsilon": decimal(s.cut.epsilon),
        "max_cut": s.cut.max_cut,
        "direct_vpls": s.direct_vpls,
        "tree": family_name(s.family),
        "photons": s.photons,
        "nearest": s.nearest,
        "gather_rays": s.rays,
        "sample_rays": s.own_rays,
    });
    joined(own, records_report(&s.cache))
}

/// Members of both objects.
fn joined(mut a: Value, b: Value) -> Value {
    if let (Some(a), Value::Object(b)) = (a.as_object_mut(), b) {
        a.extend(b);
    }
    a
}

fn records_report(c: &CacheSettings) -> Value {
    json!({
        "record_epsilon": decimal(c.cut.epsilon),
        "direct": match c.direct {
            DirectLight::Records => "records",
            DirectLight::PerSample => "samples",
        },
        "footprints": match c.footprints {
            Footprints::Isotropic => "isotropic",
            Footprints::Anisotropic => "anisotropic",
            Footprints::Occlusion => "occlusion",
        },
        "accuracy": c.layers.map(|l| decimal(l.accuracy)),
        "reach": c.layers.map(|l| l.reach.map(decimal)),
        "series_alpha": decimal(c.series.min_alpha),
        "series_error": c.series.max_error,
        "mu": decimal(c.mu),
        "passes": c.passes,
        "threshold": decimal(c.threshold),
        "patch": c.patch,
        "share": switch(c.share),
        "occluder_cache": occluders(&c.shadows, c.share),
        "least_cell": c.least_cell,
    })
}

fn lightcuts_report(s: &lightcuts::Settings) -> Value {
    json!({
                "spp": s.spp,
                "seed": s.seed,
                "max_depth": s.max_depth,
                "epsilon": decimal(s.cut.epsilon),
                "max_cut": s.cut.max_cut,
                "vpls": s.light.indirect,
                "direct_vpls": s.light.direct,
                "clamp": decimal(s.cut.clamp.unwrap_or(0.0)),
                "tree": family_name(s.family),
                "share": switch(s.share),
                "occluder_cache": occluders(&s.shadows, s.share),
    })
}

fn switch(on: bool) -> &'static str {
    if on { "on" } else { "off" }
}

/// Which rays ask, and with what size.
fn occluders(shadows: &ShadowSettings, share: bool) -> Value {
    let size = shadows.cache;
    let rays = match shadows.for_samples(share) {
        Cached::Nothing => return json!("off"),
        Cached::Single => "single",
        Cached::All => "all",
    };
    json!({ "rays": rays, "slots": size.slots, "ways": size.ways })
}

fn family_name(family: Family) -> &'static str {
    match family {
        Family::Divisive => "divisive",
        Family::Agglomerative => "agglomerative",
    }
}

/// The value with the digits that were typed, not those of its nearest f32.
fn decimal(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(value as f64)
}

fn cache_settings(args: &RenderArgs) -> cache::Settings {
    let typed = lightcuts_settings(args);
    let mut settings = cache::Settings {
        spp: typed.spp,
        seed: args.seed,
        max_depth: args.max_depth,
        light: typed.light,
        cut: typed.cut,
        family: typed.family,
        ..Default::default()
    };
    settings.inspect = args.cache.inspect;
    settings.cache.cut.clamp = typed.cut.clamp;
    settings.cache.cut.max_cut = typed.cut.max_cut;
    (settings.cache.share, settings.cache.shadows) = (typed.share, typed.shadows);
    records_settings(&args.cache, &mut settings.cache);
    settings
}

fn photon_settings(args: &RenderArgs) -> photon_cache::Settings {
    let typed = lightcuts_settings(args);
    let mut settings = photon_cache::Settings {
        spp: typed.spp,
        seed: args.seed,
        max_depth: args.max_depth,
        direct_vpls: typed.light.direct,
        cut: typed.cut,
        family: typed.family,
        inspect: args.cache.inspect,
        ..Default::default()
    };
    settings.photons = args.photon.photons.unwrap_or(settings.photons);
    settings.nearest = args.photon.nearest.map_or(settings.nearest, |n| n as usize);
    settings.rays = args.photon.gather_rays.unwrap_or(settings.rays);
    settings.own_rays = args.photon.sample_rays.unwrap_or(settings.own_rays);
    settings.cache.cut.max_cut = typed.cut.max_cut;
    (settings.cache.share, settings.cache.shadows) = (typed.share, typed.shadows);
    records_settings(&args.cache, &mut settings.cache);
    settings
}

/// What is typed about records, whatever they are computed from.
fn records_settings(cached: &CacheArgs, cache: &mut CacheSettings) {
    cache.cut.epsilon = cached.record_epsilon.unwrap_or(cache.cut.epsilon);
    for (l, layer) in cache.layers.iter_mut().enumerate() {
        layer.accuracy = cached.accuracy.map_or(layer.accuracy, |Pair(a)| a[l]);
        layer.reach = cached.reach.map_or(layer.reach, |Pair(r)| r);
    }
    cache.footprints = match cached.footprints {
        Some(FootprintShape::Isotropic) => Footprints::Isotropic,
        Some(FootprintShape::Anisotropic) => Footprints::Anisotropic,
        Some(FootprintShape::Occlusion) => Footprints::Occlusion,
        None => cache.footprints,
    };
    cache.direct = match cached.direct {
        Some(DirectBy::Records) => DirectLight::Records,
        Some(DirectBy::Samples) => DirectLight::PerSample,
        None => cache.direct,
    };
    cache.series.min_alpha = cached.series_alpha.unwrap_or(cache.series.min_alpha);
    cache.series.max_error = cached.series_error.unwrap_or(cache.series.max_error);
    cache.mu = cached.mu.unwrap_or(cache.mu);
    cache.compensation = cached.compensation.map_or(cache.compensation, |typed| typed == Switch::On);
    cache.passes = cached.passes.unwrap_or(cache.passes);
    cache.threshold = cached.threshold.unwrap_or(cache.threshold);
    cache.patch = cached.patch.map_or(cache.patch, |n| n as usize);
    cache.least_cell = cached.least_cell.unwrap_or(cache.least_cell);
}

fn lightcuts_settings(args: &RenderArgs) -> lightcuts::Settings {
    let mut settings =
        lightcuts::Settings { seed: args.seed, max_depth: args.max_depth, ..Default::default() };
    let typed = &args.lightcuts;
    settings.spp = args.spp.unwrap_or(settings.spp);
    settings.cut.epsilon = typed.epsilon.unwrap_or(settings.cut.epsilon);
    settings.cut.max_cut = typed.max_cut.map_or(settings.cut.max_cut, |n| n as usize);
    settings.light.indirect = typed.vpls.unwrap_or(settings.light.indirect);
    settings.light.direct = typed.direct_vpls.unwrap_or(settings.light.direct);
    if let Some(share) = typed.clamp {
        settings.cut.clamp = (share > 0.0).then_some(share);
    }
    settings.share = typed.share.map_or(settings.share, |typed| typed == Switch::On);
    let shadows = &mut settings.shadows;
    shadows.cached = typed.occluder_cache.map(|typed| match typed {
        OccluderCache::Off => Cached::Nothing,
        OccluderCache::Single => Cached::Single,
        OccluderCache::All => Cached::All,
    });
    shadows.cache.slots = typed.occluder_slots.map_or(shadows.cache.slots, |n| n as usize);
    shadows.cache.ways = typed.occluder_ways.map_or(shadows.cache.ways, |n| n as usize);
    settings.family = match typed.tree {
        Some(TreeFamily::Divisive) => Family::Divisive,
        Some(TreeFamily::Agglomerative) => Family::Agglomerative,
        None => settings.family,
    };
    settings
}
