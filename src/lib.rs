//! lightsplat: global illumination by lightcuts, reconstructed or cached, and a path-traced reference, over
//! Embree 4.
//!
//! The pipeline, in the order of the data:
//!
//! - [`scene::formats`] reads a scene file, sanitises and recentres it; [`scene`] is what results;
//! - [`world`] makes it ready: [`embree`] for rays, [`material`] for scattering, [`light`] for emitters;
//! - [`vpl`] turns lights and photon paths into virtual point lights, [`light_tree`] clusters them;
//! - [`eye`] follows each pixel through mirrors and glass to the surfaces that scatter light into it;
//! - [`lightcut`] finds, for each of those, the coarsest clusters whose expected errors stay below what is asked;
//! - [`bias_compensation`] finds again by short rays what clamping takes from light close by;
//! - [`shade`] lights those surfaces by cuts and carries their radiance to pixels;
//! - [`gradient`] says how that light changes along the surface, [`hsh`] expands it over the hemisphere;
//! - [`radiance_cache`] keeps what cuts found as records, splats them onto the eye samples around and adapts their
//!   footprints;
//! - [`shadow`] answers whether segments are free, by packets of rays, [`sampling`] gives every stage its numbers;
//! - [`method`] holds the renderers that are compared; [`film`] writes and compares what they return;
//! - [`setting`] declares settings, of which [`method`] and the command line make the rest;
//! - [`verify`] measures how wrong a picture is by path-tracing some of its pixels, [`plan`] chooses settings for a
//!   time or an error;
//! - [`mod@bench`] measures how fast the parts are; [`cli`] is the command around it all, [`stats`] what it reports.

#![deny(unsafe_code)]

// So that unit tests may use the scenes that the tests of behaviour are made of.
#[cfg(test)]
extern crate self as lightsplat;
#[cfg(test)]
#[path = "../tests/behaviour/common.rs"]
mod test_scenes;

mod bench;
mod bias_compensation;
pub mod cli;
mod embree;
mod eye;
pub mod film;
mod gradient;
mod hsh;
mod light;
mod light_tree;
mod lightcut;
mod material;
pub mod math;
pub mod method;
mod photon;
mod plan;
pub mod progress;
mod radiance_cache;
mod sampling;
pub mod scene;
pub mod session;
pub mod setting;
mod shade;
mod shadow;
pub mod stats;
pub mod verify;
pub mod view;
mod vpl;
pub mod world;
