//! The measures of the hall. z = 0 is the end wall behind the camera, the hall runs towards -z; x = 0 is the
//! middle.
//!
//! Units: metres.

/// Bays along the hall.
pub const BAYS: usize = 8;
/// Length of a bay.
pub const BAY: f32 = 5.0;
/// z of the far end wall.
pub const END: f32 = -(BAYS as f32) * BAY;
/// Half the clear width, to the cladding.
pub const HALF: f32 = 12.0;
/// x of the columns' axes.
pub const COLUMN: f32 = 11.45;
/// Top of the columns and underside of the trusses.
pub const EAVES: f32 = 9.4;
/// Height of a truss.
pub const TRUSS: f32 = 2.9;
/// Lower and upper edge of a tooth of the roof.
pub const ROOF: [f32; 2] = [9.9, 12.9];
/// x of the crane rails and height of their tops.
pub const RAIL: [f32; 2] = [10.55, 7.3];
/// Height of the concrete wall under the cladding.
pub const PLINTH_WALL: f32 = 2.4;
/// Level of the catwalk.
pub const CATWALK: f32 = 4.2;

/// z of the line of columns `line` (0 is the near end wall).
pub fn line_z(line: usize) -> f32 {
    -(line as f32) * BAY
}
