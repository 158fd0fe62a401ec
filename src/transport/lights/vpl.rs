//! Virtual point lights (VPLs), and sets of them of one kind and origin.
//!
//! A VPL is stored in two parts: a 16-byte [`Vpl`] with all data of a shadow ray and a geometry term, and an
//! intensity in a separate array. Random fetches of VPLs cost as much as tracing, so the first part is as small as
//! possible. Only the tree builder and the leaves of a cut read intensities.
//!
//! Units: intensity is radiant intensity (W/sr) for omni VPLs, radiant intensity per cosine for oriented VPLs,
//! irradiance on a facing surface (W/m²) for directional VPLs, a bound of the radiant intensity (W/sr) for lobed VPLs.

use super::Origin;
use super::octahedral;
use base::math::{Rgb, luminance};
use glam::Vec3;

/// Directional distribution of a VPL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VplKind {
    /// Equal in all directions, or restricted by the cone of a spot light.
    Omni,
    /// Proportional to the cosine to its normal: a patch of a diffuse surface.
    Oriented,
    /// Light from infinitely far, without falloff: a directional light, or a patch of the environment.
    Directional,
    /// Lobe of a patch of a rough metal, or of a rough surface that reflects as much.
    Lobed,
}

/// Hot part of a VPL: 16 bytes, four per cache line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub struct Vpl {
    /// Position, or for [`VplKind::Directional`] the unit direction towards the light.
    pub position: Vec3,
    /// Oriented: size in the upper four bits, normal in the other bits. Omni: index of the spot profile + 1, or 0.
    /// Lobed: index of the lobe.
    word: u32,
}

impl Vpl {
    /// Creates a VPL of equal intensity in all directions.
    pub fn omni(position: Vec3) -> Vpl {
        Vpl { position, word: 0 }
    }

    /// Creates an omni VPL restricted by the spot profile with index `profile`.
    pub fn spot(position: Vec3, profile: u32) -> Vpl {
        Vpl { position, word: profile + 1 }
    }

    /// Creates a VPL of intensity in proportion to the cosine to the unit vector `normal`, which is stored to within
    /// 3e-4 rad.
    pub fn oriented(position: Vec3, normal: Vec3) -> Vpl {
        Vpl { position, word: octahedral::encode(normal) }
    }

    /// Creates an oriented VPL for a patch with the size code `size` (see [`size_of_area`]).
    pub fn patch(position: Vec3, normal: Vec3, size: u32) -> Vpl {
        let mut vpl = Vpl::oriented(position, normal);
        vpl.word |= size.min(MAX_SIZE) << SIZE_SHIFT;
        vpl
    }

    /// Creates a VPL infinitely far in the unit direction `towards`.
    pub fn directional(towards: Vec3) -> Vpl {
        Vpl { position: towards, word: 0 }
    }

    /// Creates a VPL with the lobe of index `lobe`. Its position is a little in front of its surface, so that shadow
    /// rays need no normal.
    pub fn lobed(position: Vec3, lobe: u32) -> Vpl {
        Vpl { position, word: lobe }
    }

    /// Normal of an oriented VPL, unit length.
    #[inline]
    pub fn normal(&self) -> Vec3 {
        octahedral::decode(self.word)
    }

    /// Size code of the patch of an oriented VPL; 0 if the VPL is a point.
    #[inline]
    pub fn size(&self) -> u32 {
        self.word >> SIZE_SHIFT
    }

    /// Index of the lobe of a lobed VPL.
    #[inline]
    pub fn lobe(&self) -> usize {
        self.word as usize
    }

    /// Index of the spot profile that restricts an omni VPL.
    #[inline]
    pub fn spot_profile(&self) -> Option<usize> {
        (self.word as usize).checked_sub(1)
    }
}

/// Minimum distance as a fraction of the scene's diagonal. Shorter distances are clamped to it, which keeps the light
/// of a VPL on the receiver finite.
pub const MIN_DISTANCE: f32 = 1e-5;

/// Square of the minimum distance in a scene.
pub fn min_dist_sq(diagonal: f32) -> f32 {
    let distance = (diagonal * MIN_DISTANCE).max(1e-18);
    distance * distance
}

const SIZE_SHIFT: u32 = 28;
const MAX_SIZE: u32 = 15;

/// Returns the size code of a patch of an area: its binary logarithm over the minimum squared distance, halved and
/// rounded.
pub fn size_of_area(area: f32, diagonal: f32) -> u32 {
    let steps = 0.5 * (area / min_dist_sq(diagonal)).log2();
    // NaN and areas that are too small become 0.
    steps.round().clamp(0.0, MAX_SIZE as f32) as u32
}

/// Minimum squared distance at which a patch with the size code `size` may be treated as a point.
#[inline]
pub fn near_sq_of_size(size: u32, min_dist_sq: f32) -> f32 {
    min_dist_sq * f32::from_bits((127 + 2 * size) << 23)
}

/// VPLs of one kind and origin, over which one light tree is built.
#[derive(Clone, Debug)]
pub struct VplSet {
    /// Kind of all VPLs.
    pub kind: VplKind,
    /// Origin of all VPLs.
    pub origin: Origin,
    /// Hot parts.
    pub vpls: Vec<Vpl>,
    /// Intensity of each VPL.
    pub intensities: Vec<Rgb>,
    /// Number of edges from the emitter to each VPL, at most 255; empty for VPLs on emitters.
    pub edges: Vec<u8>,
}

impl VplSet {
    /// Creates an empty set.
    pub fn new(kind: VplKind, origin: Origin) -> VplSet {
        VplSet { kind, origin, vpls: Vec::new(), intensities: Vec::new(), edges: Vec::new() }
    }

    /// Reserves memory for `more` further VPLs.
    pub fn reserve(&mut self, more: usize) {
        self.vpls.reserve(more);
        self.intensities.reserve(more);
    }

    /// Adds a VPL, unless it is black or not finite.
    pub fn push(&mut self, vpl: Vpl, intensity: Rgb) {
        let usable = vpl.position.is_finite() && intensity.is_finite() && intensity.min_element() >= 0.0;
        if usable && luminance(intensity) > 0.0 {
            self.vpls.push(vpl);
            self.intensities.push(intensity);
        }
    }

    /// Adds a VPL whose light takes `edges` edges to it, unless it is black or not finite.
    pub fn push_behind(&mut self, edges: u8, vpl: Vpl, intensity: Rgb) {
        self.push(vpl, intensity);
        self.edges.resize(self.vpls.len(), edges);
    }

    /// Adds all VPLs of another set.
    pub fn append(&mut self, mut other: VplSet) {
        self.vpls.append(&mut other.vpls);
        self.intensities.append(&mut other.intensities);
        self.edges.append(&mut other.edges);
    }

    /// Number of VPLs.
    pub fn len(&self) -> usize {
        self.vpls.len()
    }

    /// True if there are no VPLs.
    pub fn is_empty(&self) -> bool {
        self.vpls.is_empty()
    }
}
