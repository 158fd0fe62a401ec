//! Behaviour of whole pictures and scenes, a module for each method or property.
//!
//! `cargo test --test behaviour cache::` runs those of a module. Tests that take longer than a few seconds
//! are in modules named `slow_...`, which `make quick` leaves out.

mod cache;
mod cache_artefacts;
mod choice;
mod common;
mod compensation;
mod denoise;
mod drawn;
mod glass;
mod glossy;
mod lightcuts;
mod many_lights;
mod mitsuba;
mod occluder_cache;
mod own_scenes;
mod path;
mod photon_cache;
mod principled;
mod scene_corpus;
mod sharp_lobes;
mod sun;
mod verify;
mod walk;
