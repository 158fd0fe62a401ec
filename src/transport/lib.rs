//! Light transport between the surfaces of a world.
//!
//! In the order of the data:
//!
//! - [`emission`] samples the beginnings of photon paths at emitters, and traces them;
//! - [`lights`] turns emitters and photons into virtual point lights, and clusters them in trees;
//! - [`caustics`] traces photons over mirrors and through glass to the surfaces behind;
//! - [`learning`] learns which emitters light the visible points;
//! - [`paths`] traces paths from the eye in packets;
//! - [`eye`] finds the points that scatter light into each pixel, through mirrors and glass;
//! - [`lightcut`] gathers the light of a tree at a point to a given error, or reconstructs it from its neighbours'
//!   cuts;
//! - [`bias_compensation`] finds, with short rays, the light that clamping takes away nearby;
//! - [`shade`] lights points with these;
//! - [`gradient`] differentiates that light along a surface, [`hsh`] expands it over the hemisphere;
//! - [`radiance_cache`] keeps it as records, splats them and adapts their footprints;
//! - [`irradiance`] estimates irradiance from the density of photons;
//! - [`photon`] finds indirect light with photons and final gathering, for comparison;
//! - [`reprojection`] carries light to the next frame of a walk, [`perception`] tells which differences are visible.

#![forbid(unsafe_code)]

pub mod bias_compensation;
pub mod caustics;
pub mod emission;
pub mod eye;
pub mod gradient;
pub mod hsh;
pub mod irradiance;
pub mod learning;
pub mod lightcut;
pub mod lights;
pub mod paths;
pub mod perception;
pub mod photon;
pub mod radiance_cache;
pub mod reprojection;
pub mod shade;
