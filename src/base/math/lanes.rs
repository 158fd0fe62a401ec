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

    /// Sets the lanes in which `bits` are set to a vector (see [`blend`]).
    #[inline(always)]
    pub fn fill(&mut self, bits: &U32x16, v: Vec3) {
        self.blend(bits, &Vec3x16::splat(v));
    }

    /// Sets the lanes in which `bits` are set to the vectors of other lanes (see [`blend`]).
    #[inline(always)]
    pub fn blend(&mut self, bits: &U32x16, v: &Vec3x16) {
        blend(&mut self.x, bits, &v.x);
        blend(&mut self.y, bits, &v.y);
        blend(&mut self.z, bits, &v.z);
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

/// Returns `yes` if the condition holds, else `no`, without a branch.
///
/// Loops with `if` may compile to masked stores, whose values later loads await for dozens of cycles.
#[inline(always)]
pub fn select(condition: bool, yes: f32, no: f32) -> f32 {
    std::hint::select_unpredictable(condition, yes, no)
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

/// Returns numbers with all bits set in the lanes of a mask, and 0 in other lanes, for [`blend`].
#[inline(always)]
pub fn bits_of(mask: u16) -> U32x16 {
    let mut bits = [0; LANES];
    for i in 0..LANES {
        bits[i] = 0u32.wrapping_sub(u32::from(mask) >> i & 1);
    }
    bits
}

/// Sets the lanes in which `bits` are set to those of `values`. Other lanes must have no bit set.
///
/// Logic on bits becomes vector instructions, where a choice by a mask becomes branches.
#[inline(always)]
pub fn blend(row: &mut F32x16, bits: &U32x16, values: &F32x16) {
    for i in 0..LANES {
        row[i] = f32::from_bits((values[i].to_bits() & bits[i]) | (row[i].to_bits() & !bits[i]));
    }
}

/// Sets the lanes in which `bits` are set to those of `values`, for whole numbers (see [`blend`]).
#[inline(always)]
pub fn blend_u32(row: &mut U32x16, bits: &U32x16, values: &U32x16) {
    for i in 0..LANES {
        row[i] = (values[i] & bits[i]) | (row[i] & !bits[i]);
    }
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

    #[test]
    fn blends_set_the_lanes_of_a_mask_alone() {
        let numbers = std::array::from_fn(|i| i as f32 - 3.5);
        for mask in [0, 1, 0x8000, 0b1000_0100_0000_1001, 0xffff] {
            let bits = bits_of(mask);
            assert_eq!(mask_of(&bits), mask);
            let mut row = [f32::NAN; LANES];
            blend(&mut row, &bits, &numbers);
            let mut vectors = Vec3x16::splat(Vec3::splat(9.0));
            vectors.fill(&bits, Vec3::new(1.0, -2.0, 3.0));
            let mut counts = [5; LANES];
            blend_u32(&mut counts, &bits, &[8; LANES]);
            for i in 0..LANES {
                let set = mask >> i & 1 != 0;
                assert!(if set { row[i] == numbers[i] } else { row[i].is_nan() });
                assert_eq!(vectors.get(i), if set { Vec3::new(1.0, -2.0, 3.0) } else { Vec3::splat(9.0) });
                assert_eq!(counts[i], if set { 8 } else { 5 });
            }
        }
    }
}
