//! From what was typed to a method with its settings.

use super::args::{LightcutArgs, MethodName, PhotonArgs, RenderArgs, TreeFamily};
use super::cache_args::{CacheArgs, FootprintShape, LightBy, Pair, Switch};
use super::exit::Failure;
use crate::light_tree::Family;
use crate::method::{Method, cache, lightcuts, path, photon_cache};
use crate::radiance_cache::{CacheSettings, Footprints, FoundBy};
use anyhow::anyhow;

/// From what was typed. An option of another method is an error: it would have no effect.
pub fn method(args: &RenderArgs) -> Result<Method, Failure> {
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
            Err(Failure::usage(anyhow!("the options under \"Photon map\" belong to --method photon-cache")))
        }
        MethodName::Cache if args.cache.without_records() => Err(Failure::usage(anyhow!(
            "--record-epsilon, --footprints, --probe-rays, --accuracy, --reach, --series-alpha, --series-error, --gradients, --mu, --passes, --threshold and --least-cell are for records: add --indirect records"
        ))),
        MethodName::PhotonCache
            if args.lightcuts.vpls.is_some()
                || args.lightcuts.clamp.is_some()
                || args.lightcuts.compensation.is_some()
                || args.cache.indirect.is_some() =>
        {
            Err(Failure::usage(anyhow!(
                "--vpls, --clamp, --compensation and --indirect are for indirect virtual lights, of which --method photon-cache has none; see --photons"
            )))
        }
        MethodName::PhotonCache => Ok(Method::PhotonCache(photon_settings(args))),
        MethodName::Path => {
            let spp = args.spp.unwrap_or(path::Settings::default().spp);
            Ok(Method::Path(path::Settings {
                spp,
                seed: args.seed,
                max_depth: args.max_depth,
                ..Default::default()
            }))
        }
        MethodName::Cache => Ok(Method::Cache(cache_settings(args))),
        MethodName::Lightcuts => Ok(Method::Lightcuts(lightcuts_settings(args))),
    }
}

fn cache_settings(args: &RenderArgs) -> cache::Settings {
    let typed = lightcuts_settings(args);
    let mut settings = cache::Settings {
        spp: typed.spp,
        seed: args.seed,
        max_depth: args.max_depth,
        light: typed.light,
        cut: typed.cut,
        compensation: typed.compensation,
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
    cache.probe_rays = cached.probe_rays.unwrap_or(cache.probe_rays);
    let found = |typed: Option<LightBy>, default| match typed {
        Some(LightBy::Records) => FoundBy::Records,
        Some(LightBy::Samples) => FoundBy::Samples,
        None => default,
    };
    cache.direct = found(cached.direct, cache.direct);
    cache.indirect = found(cached.indirect, cache.indirect);
    cache.series.min_alpha = cached.series_alpha.unwrap_or(cache.series.min_alpha);
    cache.series.max_error = cached.series_error.unwrap_or(cache.series.max_error);
    cache.gradients = cached.gradients.map_or(cache.gradients, |typed| typed == Switch::On);
    cache.mu = cached.mu.unwrap_or(cache.mu);
    cache.passes = cached.passes.unwrap_or(cache.passes);
    cache.threshold = cached.threshold.unwrap_or(cache.threshold);
    cache.patches = cached.patches.unwrap_or(cache.patches);
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
    settings.compensation = typed.compensation.map_or(settings.compensation, |typed| typed == Switch::On);
    settings.share = typed.share.map_or(settings.share, |typed| typed == Switch::On);
    let shadows = &mut settings.shadows;
    shadows.cached = typed.occluder_cache.map(|typed| typed == Switch::On);
    shadows.cache.slots = typed.occluder_slots.map_or(shadows.cache.slots, |n| n as usize);
    shadows.cache.ways = typed.occluder_ways.map_or(shadows.cache.ways, |n| n as usize);
    settings.family = match typed.tree {
        Some(TreeFamily::Divisive) => Family::Divisive,
        Some(TreeFamily::Agglomerative) => Family::Agglomerative,
        None => settings.family,
    };
    settings
}
