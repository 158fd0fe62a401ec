//! Scattering at surfaces. [`Materials`] holds the values that are computed once per scene. [`Bsdf`] is a material at
//! one point, to be evaluated, sampled and bounded.
//!
//! A material is a Lambertian base, with or without a dielectric coat, and lobes (see [`scene::Material`]). It may have
//! gaps. Definitions are those of Mitsuba 3, so that images agree with its references: `diffuse`, `plastic`,
//! `roughplastic`, `conductor`, `roughconductor`, `dielectric`, `roughdielectric`, `principled`,
//! `principledthin`, `mask` and `twosided`.
//!
//! Files use only files before them in this order: `microfacet`, `fresnel`, `table` and `albedo`; `base` and
//! `lobe` (one file per lobe); `model` (data); `seen`, `bsdf`, `sample`, `bound`, `packet` and `straight`
//! (evaluation); `colours`, `layers` and `build` (from the scene's materials);
//! `materials` (lookup).
//!
//! All directions are in the local shading frame (z = shading normal), point away from the surface and have unit
//! length: `wo` towards the eye or the previous vertex of the path, `wi` towards the light.

mod base;
mod bound;
mod bsdf;
mod build;
mod colours;
mod fresnel;
mod layers;
mod lobe;
mod materials;
mod microfacet;
mod model;
mod packed;
mod packet;
mod principled;
mod roughness;
mod sample;
mod seen;
mod straight;
mod table;
mod tables;

pub use bound::AlikeBsdfs16;
pub use bsdf::MeanBsdf;
pub use lobe::{BsdfSample, DirectionBound, DullLobe, LobeShape};
pub use materials::Materials;
pub use model::{Bsdf, LobeSet};
pub use packed::PackedBsdf;
pub use packet::{BsdfSamples16, Bsdfs16};
pub use straight::LastStraight;

#[cfg(test)]
pub mod tests;
