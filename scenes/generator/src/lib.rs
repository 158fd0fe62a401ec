//! Geometry of lightsplat's own scenes. [`generate`] yields named parts; the scene's TOML file assigns a
//! material to every part, so that the looks of a scene stay editable.
//!
//! `shapes` holds the primitives of modelling, `props` the objects in scenes, `scenes` the plans. `files` holds the
//! TOML files, so that the program has its scenes wherever it is. `sized` writes scenes of any size.

mod files;
mod props;
mod scenes;
mod shapes;
mod sized;

pub use files::{NAMES, file};
pub use shapes::Part;
pub use sized::{dunes, forest};

/// Parts of the scene called `name`, or `None` where there is no such generator. A number after `plaza` is its number
/// of lamps, at most a million.
pub fn generate(name: &str) -> Option<Vec<Part>> {
    if let Some(lamps) = name.strip_prefix("plaza ") {
        return lamps.parse().ok().filter(|lamps| *lamps <= 1_000_000).map(scenes::plaza::parts);
    }
    match name {
        "apartment" => Some(scenes::apartment::parts()),
        "hall" => Some(scenes::hall::parts()),
        "kitchen" => Some(scenes::kitchen::parts()),
        "knot" => Some(scenes::knot::parts()),
        "plaza" => Some(scenes::plaza::parts(scenes::plaza::LAMPS)),
        "nave" => Some(scenes::nave::parts()),
        _ => None,
    }
}
