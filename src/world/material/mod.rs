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

mod alike16;
mod base;
mod bound;
mod bsdf;
mod fresnel;
mod layers;
mod lobe;
mod microfacet;
mod model;
mod packet;
mod principled;
mod roughness;
mod sample;
mod straight;
mod table;

pub use alike16::{AlikeBsdfs16, DirectionBounds16};
pub use bound::DirectionBound;
pub use bsdf::{Bsdf, LobeSet};
pub use lobe::{DullLobe, LobeShape};
pub use model::Materials;
pub use packet::{BsdfSamples16, Bsdfs16};
pub use straight::LastStraight;

#[cfg(test)]
pub mod tests;
