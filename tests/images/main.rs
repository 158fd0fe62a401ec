//! Rendered images: what they show, and by how much they may differ from what is true.
//!
//! Start with [`all_methods`]: a table of scenes whose mean is known, rendered by every method. The other modules test
//! one method or one property each, [`extremes`] scenes and settings at the ends of their ranges, [`references`] images
//! of an independent renderer, [`regressions`] defects that were mended. [`kit`] makes scenes and renders them,
//! [`presets`] holds settings, [`oracle`] judges images.
//!
//! `cargo test --test images cache::` runs the tests of a module. Modules named `slow_...` take more than a few
//! seconds: `make quick` leaves them out. Ignored tests are studies, which `make studies` runs.

mod kit;
mod oracle;
mod presets;

mod absorption;
mod all_methods;
mod cache;
mod cache_artefacts;
mod choice;
mod compensation;
mod denoise;
mod drawn;
mod extremes;
mod glass;
mod glossy;
mod instances;
mod lightcuts;
mod live;
mod many_lights;
mod mitsuba;
mod models;
mod obj_materials;
mod occluder_cache;
mod opacity;
mod path;
mod photon_cache;
mod principled;
mod references;
mod regressions;
mod sharp_lobes;
mod sun;
mod verify;
mod walk;
