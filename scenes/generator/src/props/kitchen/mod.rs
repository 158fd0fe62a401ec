//! Fitted kitchens: cupboards, appliances, the sink, and tableware.

pub mod appliances;
pub mod cabinets;
pub mod sink;
pub mod tableware;

/// Height of the upper face of the worktops.
pub const WORKTOP: f32 = 0.9;
/// Depth of worktops from the wall.
pub const WORKTOP_DEPTH: f32 = 0.63;
/// Depth of the bodies of the base cupboards.
const BASE_DEPTH: f32 = 0.58;
/// Lower edge and height of the wall cupboards, and their depth.
const WALL_UNIT: (f32, f32, f32) = (1.45, 0.72, 0.33);
