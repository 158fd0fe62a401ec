//! Settings that stand in several structs.

use super::{JudgedBy, Spec, UP};

/// Sharing of cuts between neighbours.
pub static SHARE: Spec =
    Spec::new("share", "Sharing of cuts between neighbours, for speed", "Lightcuts").values(&["on", "off"]);

/// Number of patches of eye samples.
pub static PATCHES: Spec = Spec::new(
    "patches",
    "Patches of eye samples, about: a cut shared by sixteen of each is reconstructed at the others",
    "Lightcuts",
)
.at_least(1.0)
.scaled(&UP);

/// Compensation for light lost to clamping.
pub static COMPENSATION: Spec = Spec::new(
    "compensation",
    "Compensation by short rays for light lost to clamping, in creases most of all",
    "Lightcuts",
)
.values(&["off", "on"])
.judged_by(JudgedBy::Light);

/// Images that show how the picture was made.
pub static INSPECT: Spec = Spec::new(
    "inspect",
    "Further layers of the OpenEXR file, and PNG files beside the picture, that show how it was made",
    "",
)
.flag();
