//! Settings that several tests share.

use lightsplat::method::{DirectBy, FoundBy, LightPassSettings, cache, lightcuts};

/// The default with `vpls` virtual lights.
pub fn with_vpls(vpls: u32) -> cache::Settings {
    let light = LightPassSettings { indirect: vpls, ..Default::default() };
    cache::Settings { light, ..Default::default() }
}

/// The default without indirect light.
pub fn direct_only() -> cache::Settings {
    let light = LightPassSettings { direct: 1, indirect: 0, ..Default::default() };
    cache::Settings { light, ..Default::default() }
}

/// Indirect light by records, direct light by cuts: no sample of a pixel is left to chance.
///
/// Records serve even small cells. By default a small film would have cuts instead.
pub fn by_records(vpls: u32) -> cache::Settings {
    let mut settings = cache::Settings { spp: 1, ..with_vpls(vpls) };
    (settings.cache.direct, settings.cache.indirect) = (DirectBy::Cuts, FoundBy::Records);
    settings.cache.least_cell = 8;
    settings
}

/// [`by_records`] without compensation, whose short rays are noisier than the differences that are tested.
pub fn noiseless_records(vpls: u32) -> cache::Settings {
    cache::Settings { compensation: false, ..by_records(vpls) }
}

/// Lightcuts per pixel over the virtual lights of `like`, at a quarter of the default error: the reference of records.
pub fn per_pixel(like: &cache::Settings) -> lightcuts::Settings {
    let mut settings = lightcuts::Settings { light: like.light, spp: like.spp, ..Default::default() };
    (settings.cut.epsilon, settings.cut.max_cut, settings.cut.clamp) = (0.005, 10_000, like.cut.clamp);
    (settings.compensation, settings.seed) = (like.compensation, like.seed);
    settings
}
