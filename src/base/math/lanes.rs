//! Sixteen values at a time, as structures of arrays.
//!
//! A loop over all lanes compiles to vector instructions if its body neither calls nor branches. So stages read lanes
//! with `get`, compute on [`Vec3`]s, and write with `set`. Work that does not vectorise (look-ups, rare cases) is done
//! lane by lane in another loop.

use glam::{Vec2, Vec3};

/// Number of lanes of a packet, as in the widest packets of Embree.
pub const LANES: usize = 16;

/// One number per lane.
pub type F32x16 = [f32; LANES];

/// One unsigned number per lane.
pub type U32x16 = [u32; LANES];

/// One point of the plane per lane.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Vec2x16 {
    /// First coordinates.
    pub x: F32x16,
    /// Second coordinates.
    pub y: F32x16,
}

/// One vector or colour per lane.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Vec3x16 {
    /// First coordinates.
    pub x: F32x16,
    /// Second coordinates.
    pub y: F32x16,
    /// Third coordinates.
    pub z: F32x16,
}

// The derived forms would call a function for each row.
impl Default for Vec2x16 {
    #[inline(always)]
    fn default() -> Vec2x16 {
        Vec2x16 { x: [0.0; LANES], y: [0.0; LANES] }
    }
}

impl Default for Vec3x16 {
    #[inline(always)]
    fn default() -> Vec3x16 {
        Vec3x16::ZERO
    }
}

impl Vec2x16 {
    /// Returns the point in a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Vec2 {
        Vec2::new(self.x[lane], self.y[lane])
    }

    /// Sets the point in a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, v: Vec2) {
        self.x[lane] = v.x;
        self.y[lane] = v.y;
    }
}

impl Vec3x16 {
    /// The zero vector in all lanes.
    pub const ZERO: Vec3x16 = Vec3x16 { x: [0.0; LANES], y: [0.0; LANES], z: [0.0; LANES] };

    /// Returns a packet with one vector in all lanes.
    #[inline(always)]
    pub const fn splat(v: Vec3) -> Vec3x16 {
        Vec3x16 { x: [v.x; LANES], y: [v.y; LANES], z: [v.z; LANES] }
    }

    /// Returns the coordinates by row: all first, all second and all third ones.
    #[inline(always)]
    pub fn rows(&self) -> [&F32x16; 3] {
        [&self.x, &self.y, &self.z]
    }

    /// Sets the lanes outside a mask to 0.
    #[inline(always)]
    pub fn keep(&mut self, mask: u16) {
        for row in [&mut self.x, &mut self.y, &mut self.z] {
            for (i, value) in row.iter_mut().enumerate() {
                *value = if mask >> i & 1 != 0 { *value } else { 0.0 };
            }
        }
    }

    /// Adds `v` times `scale`, coordinate by coordinate.
    #[inline(always)]
    pub fn add_scaled(&mut self, scale: Vec3, v: &Vec3x16) {
        for i in 0..LANES {
            self.x[i] += scale.x * v.x[i];
            self.y[i] += scale.y * v.y[i];
            self.z[i] += scale.z * v.z[i];
        }
    }

    /// Returns the vector in a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Vec3 {
        Vec3::new(self.x[lane], self.y[lane], self.z[lane])
    }

    /// Sets the vector in a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, v: Vec3) {
        self.x[lane] = v.x;
        self.y[lane] = v.y;
        self.z[lane] = v.z;
    }
}

/// Returns the mask of the first `count` lanes, at most all.
#[inline]
pub fn first_lanes(count: usize) -> u16 {
    ((1u32 << count.min(LANES)) - 1) as u16
}

/// Returns the mask of the lanes with non-zero `flags`.
#[inline]
pub fn mask_of(flags: &U32x16) -> u16 {
    let mut mask = 0;
    for i in 0..LANES {
        mask |= u32::from(flags[i] != 0) << i;
    }
    mask as u16
}

/// Returns the mask of the lanes whose number is `value`.
#[inline(always)]
pub fn lanes_with(row: &U32x16, value: u32) -> u16 {
    let mut mask = 0;
    for i in 0..LANES {
        mask |= u32::from(row[i] == value) << i;
    }
    mask as u16
}

/// Returns the lanes of a mask in ascending order.
#[inline]
pub fn lanes_in(mask: u16) -> impl Iterator<Item = usize> {
    let mut left = mask;
    std::iter::from_fn(move || {
        (left != 0).then(|| {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            lane
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_and_lanes_agree() {
        assert_eq!(
            (first_lanes(0), first_lanes(3), first_lanes(16), first_lanes(20)),
            (0, 7, 0xffff, 0xffff)
        );
        let mask = 0b1000_0100_0000_1001;
        assert_eq!(lanes_in(mask).collect::<Vec<_>>(), [0, 3, 10, 15]);
        let mut flags = [0; LANES];
        lanes_in(mask).for_each(|lane| flags[lane] = 7);
        assert_eq!(mask_of(&flags), mask);
        assert_eq!((lanes_with(&flags, 7), lanes_with(&flags, 0), lanes_with(&flags, 1)), (mask, !mask, 0));
    }
}
