//! The measures of the church. West is z = 0, east is -z; everything is built for the south side (x > 0)
//! and mirrored. A wall's local frame is (east along the wall, up, depth outwards).
//!
//! Units: metres.

use crate::shapes::*;
use glam::{Affine3A, Vec3};

/// Number of bays west of the apse.
pub const BAYS: usize = 5;
/// Length of a bay.
pub const BAY: f32 = 5.0;
/// z of the chancel arch, where the apse begins.
pub const EAST: f32 = -(BAYS as f32) * BAY;
/// Half the clear width of the nave: the inner face of the arcade wall.
pub const NAVE: f32 = 4.5;
/// Thickness of the arcade wall.
pub const WALL: f32 = 1.0;
/// x of the axis of the piers.
pub const PIER: f32 = NAVE + 0.5 * WALL;
/// Aisle's inner and outer faces.
pub const AISLE: [f32; 2] = [NAVE + WALL, 9.5];
/// Thickness of the aisle's outer wall.
pub const AISLE_WALL: f32 = 0.9;
/// Height of the arcade's capitals, where arcade and aisle vaults spring.
pub const ARCADE_SPRING: f32 = 5.0;
/// Height of the string course under the triforium.
pub const TRIFORIUM: f32 = 8.7;
/// Height of the string course under the clerestory.
pub const CLERESTORY: f32 = 11.6;
/// Height at which the high vault springs.
pub const VAULT_SPRING: f32 = 12.0;
/// Height of the vault's crown.
pub const CROWN: f32 = 18.2;
/// Height of the walls above the vault.
pub const TOP: f32 = 19.0;
/// Floor of the chancel.
pub const CHANCEL_FLOOR: f32 = 0.48;
/// z at which the chancel steps begin.
pub const CHANCEL: f32 = EAST + BAY - 0.9;

/// Opening of an arcade arch, about the middle of the bay at the springing line.
pub const ARCADE: PointedArch = PointedArch { half_span: 1.85, rise: 2.6 };
/// Clerestory window.
pub const CLERESTORY_WINDOW: Window =
    Window { head: PointedArch { half_span: 1.25, rise: 1.75 }, sill: 12.4, spring: 14.4 };
/// Aisle window.
pub const AISLE_WINDOW: Window =
    Window { head: PointedArch { half_span: 0.8, rise: 1.3 }, sill: 2.3, spring: 5.0 };
/// Window of the apse.
pub const APSE_WINDOW: Window =
    Window { head: PointedArch { half_span: 0.78, rise: 1.25 }, sill: 3.4, spring: 12.4 };

/// Pointed window: jambs from `sill` to `spring`, then the head.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// Arch at its top.
    pub head: PointedArch,
    /// Height of its foot.
    pub sill: f32,
    /// Height at which the head springs.
    pub spring: f32,
}

impl Window {
    /// Outline about `middle` along the wall, in a wall's local frame.
    pub fn outline(&self, middle: f32, segments: usize) -> Vec<glam::Vec2> {
        self.head.opening(glam::Vec2::new(middle, self.spring), self.sill - self.spring, segments)
    }
}

/// z of the line of piers west of bay `bay` (0 is the west wall).
pub fn pier_z(bay: usize) -> f32 {
    -(bay as f32) * BAY
}

/// Local frame of the south wall at `x` in bay `bay`: x runs east along the wall, y up, z outwards.
pub fn south_wall(x: f32, bay: usize) -> Affine3A {
    upright([x, 0.0, pier_z(bay)], Vec3::NEG_Z, Vec3::Y)
}
