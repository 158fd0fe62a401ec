//! Lobes: the scattering of a surface besides its Lambertian base. One file per lobe holds everything about it: value
//! and sampling density, sampling, albedo, and the upper bound for clusters of lights, each for one point or sixteen.
//!
//! A [`LobeModel`] is the part of a lobe that all points of a material share. The factor on the lobe, which may be
//! textured, comes with each call as `scale`. The dispatch in `model.rs` is the only code that enumerates the lobes.

mod anisotropic;
mod clear_coat;
mod dull;
mod grazing;
mod half_vector;
mod interface;
mod mirror;
mod model;
mod rough;
mod rough_interface;
mod sample;
mod shape;
mod thin;

pub(super) use anisotropic::AnisotropicLobe;
pub(super) use clear_coat::ClearCoat;
pub use dull::DullLobe;
pub(super) use grazing::{Grazing, GrazingKind};
pub use half_vector::DirectionBound;
pub(super) use half_vector::{Facet, FacetBound, SeenLobe, mean, means};
pub(super) use interface::{Interface, Passage};
pub(super) use mirror::Mirror;
pub(super) use model::{LobeModel, MAX_LOBES};
pub(super) use rough::{DIFFUSE_ALPHA, RoughLobe};
pub(super) use rough_interface::RoughInterface;
pub use sample::BsdfSample;
pub(super) use sample::Delta;
pub use shape::{LobeShape, ReflectedLobe};
pub(super) use thin::{Thin, ThinFacets};
