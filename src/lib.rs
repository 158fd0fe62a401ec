//! lightsplat: global illumination by lightcuts, reconstructed or cached, and a path-traced reference, over
//! Embree 4.
//!
//! [`session`] is the API: a scene held ready, and frames rendered of it; [`walk`] renders those of a camera path.
//! The pipeline behind it, in the order of the data:
//!
//! - [`scene::formats`] reads a scene file, sanitises and recentres it; [`scene`] is the result;
//! - [`world`] makes it ready: [`embree`] for rays, [`material`] for scattering, [`light`] for emitters;
//! - [`view`] says from where it is seen and which part of the [`film`] is rendered;
//! - [`vpl`] turns lights and photon paths into virtual point lights, [`light_tree`] clusters them;
//! - [`caustics`] sends photons by mirrors and glass to the surfaces behind;
//! - [`paths`] follows paths from the eye in packets, whole or as far as other stages leave light to be found;
//! - [`eye`] follows each pixel through mirrors and glass to the points that scatter light into it;
//! - [`lightcut`] finds, for each of those, the coarsest clusters whose expected errors stay below the
//!   threshold, or reconstructs its light from the cut of its neighbours;
//! - [`bias_compensation`] finds by short rays the light that clamping takes away close by;
//! - [`shade`] lights points by these, [`method`] holds the renderers that are compared;
//! - [`gradient`] differentiates that light along a surface, [`hsh`] expands it over the hemisphere;
//! - [`radiance_cache`] keeps it as records, splats them onto the points around and adapts their footprints;
//! - [`photon`] finds indirect light by photons and final gathering instead, for comparison;
//! - [`shadow`] answers whether segments are free, by packets of rays; [`sampling`] gives every stage its
//!   numbers;
//! - [`reprojection`] carries the light of a walk's picture to where the next frame sees it;
//! - [`perception`] says which differences are seen in a walk's picture, and so in the next;
//! - [`denoise`] takes the noise off a picture, by Open Image Denoise where that is there;
//! - [`verify`] measures the error of a picture by path-tracing some of its pixels, [`plan`] chooses settings
//!   for a time or an error, each of which [`setting`] declares once;
//! - [`mod@bench`] measures how fast the parts are; [`cli`] is the command around it all, [`stats`] its
//!   reports.

#![deny(unsafe_code)]

// So that unit tests may use the scenes that the tests of behaviour are made of.
#[cfg(test)]
extern crate self as lightsplat;
#[cfg(test)]
#[path = "../tests/behaviour/common.rs"]
mod test_scenes;

mod bench;
mod bias_compensation;
mod caustics;
pub mod cli;
mod denoise;
mod embree;
mod eye;
pub mod film;
mod gradient;
mod hsh;
mod kd_tree;
mod light;
mod light_tree;
mod lightcut;
mod material;
pub mod math;
pub mod method;
mod parallel;
mod paths;
mod perception;
mod photon;
mod plan;
pub mod progress;
mod radiance_cache;
mod reprojection;
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
pub mod walk;
pub mod world;
