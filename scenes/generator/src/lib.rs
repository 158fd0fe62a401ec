//! Geometry of lightsplat's own scenes. [`generate`] yields named parts; the scene's TOML file assigns a
//! material to every part, so that the looks of a scene stay editable.
//!
//! `shapes` holds the primitives of modelling, `props` the objects in scenes, `scenes` the plans. `files` holds the
//! TOML files, so that the program has its scenes wherever it is.

mod files;
mod props;
mod scenes;
mod shapes;

pub use files::{NAMES, file};
pub use shapes::Part;

/// Parts of the scene called `name`, or `None` where there is no such generator.
pub fn generate(name: &str) -> Option<Vec<Part>> {
    match name {
        "apartment" => Some(scenes::apartment::parts()),
        "hall" => Some(scenes::hall::parts()),
        "kitchen" => Some(scenes::kitchen::parts()),
        "knot" => Some(scenes::knot::parts()),
        "nave" => Some(scenes::nave::parts()),
        _ => None,
    }
}
