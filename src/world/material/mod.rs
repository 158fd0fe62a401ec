//! Scattering at surfaces: [`Materials`] holds the values computed once a scene, [`Bsdf`] is a material at
//! one point, to be evaluated, sampled and bounded.
//!
//! Every material is a Lambert base, perhaps under a dielectric coat, and up to three lobes (see
//! [`scene::Material`]), and may have gaps; definitions are Mitsuba 3's `diffuse`, `plastic`, `roughplastic`,
//! `conductor`, `roughconductor`, `dielectric`, `mask` and `twosided`, so that pictures agree with its references.
//! Rough glass is `roughdielectric`, principled materials are `principled`.
//! [`Bsdf`] adds up base and lobes; each lobe by itself is in its file under `lobe`.
//!
//! All directions are in the local shading frame (z = shading normal), point away from the surface and have
//! unit length: `wo` towards the eye (or the previous vertex of the path), `wi` towards the light.

mod albedo;
mod alike16;
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
mod packet;
mod principled;
mod roughness;
mod sample;
mod straight;
mod table;
mod tables;

pub use alike16::AlikeBsdfs16;
pub use bsdf::LobeSet;
pub use lobe::{DirectionBound, DirectionBounds16, DullLobe, LobeShape};
pub use materials::Materials;
pub use model::Bsdf;
pub use packet::{BsdfSamples16, Bsdfs16};
pub use straight::LastStraight;

#[cfg(test)]
pub mod tests;
