//! Settings that several tests share.

use lightsplat::method::{DirectBy, FoundBy, LightPassSettings, vpl};

/// The default with `vpls` virtual lights.
pub fn with_vpls(vpls: u32) -> vpl::Settings {
    let light = LightPassSettings { indirect: vpls, ..Default::default() };
    vpl::Settings { light, ..vpl::Settings::cache() }
}

/// Settings with a fraction of their virtual lights and photons. On small films these take most of the time, and most
/// noise is due to samples.
pub fn with_lights_over(divisor: u32, mut settings: vpl::Settings) -> vpl::Settings {
    settings.light.indirect /= divisor;
    settings.gathering.photons /= divisor;
    settings
}

/// The default without indirect light.
pub fn direct_only() -> vpl::Settings {
    let light = LightPassSettings { direct: 1, indirect: 0, ..Default::default() };
    vpl::Settings { light, ..vpl::Settings::cache() }
}

/// Indirect light by records, direct light by cuts: no sample of a pixel is left to chance.
///
/// Records serve even small cells. By default a small film would have cuts instead.
pub fn by_records(vpls: u32) -> vpl::Settings {
    let mut settings = vpl::Settings { spp: 1, ..with_vpls(vpls) };
    (settings.cache.direct, settings.cache.indirect) = (DirectBy::Cuts, FoundBy::Records);
    settings.cache.least_cell = 8;
    settings
}

/// [`by_records`] without compensation, whose short rays are noisier than the differences that are tested.
pub fn noiseless_records(vpls: u32) -> vpl::Settings {
    vpl::Settings { compensation: false, ..by_records(vpls) }
}

/// Lightcuts per pixel over the virtual lights of `like`, at a quarter of the default error: the reference of records.
pub fn per_pixel(like: &vpl::Settings) -> vpl::Settings {
    let mut settings = vpl::Settings { light: like.light, spp: like.spp, ..vpl::Settings::lightcuts() };
    (settings.cut.epsilon, settings.cut.max_cut, settings.cut.clamp) = (0.005, 10_000, like.cut.clamp);
    (settings.compensation, settings.seed) = (like.compensation, like.seed);
    settings
}
