//! Lobes: the scattering of a surface besides its Lambertian base. One file per lobe holds everything about it: value
//! and sampling density, sampling, albedo, the upper bound for clusters of lights, and value and bound in sixteen
//! lanes.
//!
//! A [`LobeModel`] is the part of a lobe that all points of a material share. The factor on the lobe, which may be
//! textured, comes with each call as `scale`. The dispatch in `model.rs` is the only code that enumerates the lobes.

mod anisotropic;
mod clear_coat;
mod direction_bound;
mod dull;
mod grazing;
mod half_vector;
mod interface;
mod lanes;
mod mirror;
mod model;
mod rough;
mod rough_interface;
mod sample;
mod shape;
mod thin;

pub(super) use anisotropic::AnisotropicLobe;
pub(super) use clear_coat::ClearCoat;
pub use direction_bound::{DirectionBound, DirectionBounds16};
pub use dull::DullLobe;
pub(super) use grazing::{Grazing, GrazingKind};
pub(super) use half_vector::{Directions, Directions16, FacetBound, FacetBounds16};
pub(super) use interface::{Interface, Passage};
pub(super) use lanes::{LobeLanes, Sampled16, SeenLobe, ValuePdf16, mean};
pub(super) use mirror::Mirror;
pub(super) use model::{LobeModel, MAX_LOBES};
pub(super) use rough::{DIFFUSE_ALPHA, RoughLobe};
pub(super) use rough_interface::RoughInterface;
pub use sample::BsdfSample;
pub use shape::{LobeShape, ReflectedLobe};
pub(super) use thin::{Thin, ThinFacets};
