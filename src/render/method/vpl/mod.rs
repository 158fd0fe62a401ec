//! Light by virtual point lights: one method, whose settings say how each layer of light is found. [`Preset`] names
//! points of their space.
//!
//! | preset | direct light | indirect light | neighbours that share cuts |
//! |---|---|---|---|
//! | `cache` | sampled | records by cuts | in patches of surfaces |
//! | `photon-cache` | cuts | records by final gathering over photons | in patches of surfaces |
//! | `reconstruction` | cuts | cuts | in patches of surfaces |
//! | `lightcuts` | cuts | cuts | in blocks of pixels |
//!
//! **The cache.** Direct light is sampled at every visibility sample. Indirect light is computed at some thousand
//! points and extrapolated to the shading points between them.
//! Paper: Herzog et al. 2009, records splatted onto all eye samples; LCache1 with isotropic, LCache2 with anisotropic
//! footprints.
//! Deviations: the default footprints and gradients account for the edges of occluders (`occlusion`). Records hold
//! indirect light only. The eye pass samples direct light, whose shadows are fine, and leaves noise for a denoiser.
//! Cuts light the shading points
//!
//! - whose reflection is too sharp for records,
//! - where a record would reach too few points,
//! - where records still disagree visibly after the last pass.
//!
//! Use it as the default. The noise of sampled light is unbiased; virtual lights and records are not.
//!
//! **The photon cache** has records by final gathering over a photon map.
//! Papers: the method PM of Herzog et al. 2009, section 7; Jensen 1996; Christensen 1999; Krivanek et al. 2005.
//! Use it to compare with the cache. The method does not clamp, so creases are not dark. The price is noise of the
//! photons, visible as blotches, and time.
//!
//! **Reconstruction cuts**: sixteen eye samples of a patch share a cut, from which the light of the others is
//! reconstructed.
//! Paper: Walter et al. 2005, *Lightcuts: A Scalable Approach to Illumination*, section 5; see
//! [`transport::lightcut::ReconstructionCut`], also for its deviations.
//! Use them for images without noise that are not to be denoised. Compared with records of both layers of light they
//! take as long and err less, above all at fine shadows. The patch's cut corresponds to a record, and a linear fit to
//! its gradient. Further rays correct the fit if the sixteen samples disagree.
//!
//! **Lightcuts per pixel**: every eye sample has its own cut, or shares one with its neighbours. The memory does not
//! grow with the samples.
//! Paper: Walter et al. 2005; "LC" in Herzog et al. 2009, section 6, over direct and indirect VPLs.
//! Use them for images without noise if a small, smooth error is acceptable.
//!
//! Without sampled direct light, light that reaches visible surfaces through glass or over mirrors is found by four
//! paths from each eye sample, with their noise.

mod abilities;
mod blocks;
mod film;
mod gathering;
mod preset;
mod settings;

pub use gathering::GatheringSettings;
pub use preset::Preset;
pub use settings::{IndirectSource, Neighbours, Settings};
