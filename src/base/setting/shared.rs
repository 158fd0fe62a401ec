//! Settings of several structs.

use super::{JudgedBy, Spec, UP};

/// Heading of settings that Herzog et al. 2009 vary, or that stay for comparison.
pub const PAPER: &str = "Settings of the paper (for comparison)";

/// Sharing of cuts between neighbours.
pub static SHARE: Spec =
    Spec::new("share", "Share cuts between neighbours, for speed", "Lightcuts").values(&["on", "off"]);

/// Number of patches of eye samples.
pub static PATCHES: Spec = Spec::new(
    "patches",
    "Approximate number of patches of eye samples. Sixteen samples of a patch share a cut, which also lights the \
     other samples",
    "Lightcuts",
)
.at_least(1.0)
.scaled(&UP);

/// Compensation for light lost to clamping.
pub static COMPENSATION: Spec = Spec::new(
    "compensation",
    "Recover clamped light by tracing short rays. The effect is largest in creases",
    "Lightcuts",
)
.values(&["off", "on"])
.judged_by(JudgedBy::Light);

/// Images that show how the image was made.
pub static INSPECT: Spec =
    Spec::new("inspect", "Write additional layers and PNG files that show how the image was made", "").flag();

/// Ends of paths by photons.
pub static PHOTON_ENDS: Spec = Spec::new(
    "photon_ends",
    "End the paths of denoised images by photons, at the diffuse surfaces that light those in view. Faster, with small \
     errors near edges of light",
    "Photon map",
)
.values(&["on", "off"])
.judged_by(JudgedBy::Flip);
