//! Every method and record mode, with settings for pictures of some hundred pixels.

use render::method::Method;

/// A method under its name.
pub struct Entrant {
    /// Name in tables.
    pub name: &'static str,
    /// Method and settings.
    pub method: Method,
    /// True if its picture is denoised.
    pub denoise: bool,
}

/// Settings of virtual lights.
const LIGHTS: [(&str, &str); 2] = [("vpls", "3000"), ("direct_vpls", "512")];
/// Number of points that may share a record.
const CELL: (&str, &str) = ("least_cell", "4");

/// Returns all of them; denoised pictures only `if_denoised`.
pub fn all(if_denoised: bool) -> Vec<Entrant> {
    let drawn = [CELL, ("spp", "8")];
    let records = [CELL, ("direct", "records"), ("spp", "2")];
    let cuts = [CELL, ("direct", "cuts"), ("spp", "2")];
    let photons = [CELL, ("photons", "10000"), ("gather_rays", "64"), ("spp", "2")];
    let entrants: [(&str, &str, &[_]); 8] = [
        ("cache", "cache", &drawn),
        ("denoised", "cache", &drawn),
        ("direct records", "cache", &records),
        ("direct cuts", "cache", &cuts),
        ("reconstruction", "reconstruction", &[("spp", "2")]),
        ("lightcuts", "lightcuts", &[("spp", "1")]),
        ("photon-cache", "photon-cache", &photons),
        ("path", "path", &[("spp", "64")]),
    ];
    let entrant = |(name, method, settings): (&'static str, &str, &[(&str, &str)])| {
        let mut method = Method::named(method)?;
        for (key, value) in LIGHTS.iter().chain(settings) {
            // Not all methods have virtual lights.
            let _ = method.set(key, value);
        }
        Some(Entrant { name, method, denoise: name == "denoised" })
    };
    entrants.into_iter().filter_map(entrant).filter(|entrant| if_denoised || !entrant.denoise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_is_one_of_the_method() {
        assert_eq!(all(true).len(), 8);
        assert_eq!(all(false).len(), 7);
        let all = all(true);
        for (i, entrant) in all.iter().enumerate() {
            let text = format!("{:?}", entrant.method);
            let others = all[..i].iter().filter(|other| format!("{:?}", other.method) == text);
            assert_eq!(others.count(), usize::from(entrant.denoise), "{text}");
        }
    }
}
