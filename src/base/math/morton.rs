//! Order of pixels along the Morton curve.

/// Returns the place of a pixel along the Morton curve: the bits of both coordinates, interleaved.
#[inline]
pub fn morton(x: u32, y: u32) -> u64 {
    let spread = |v: u32| {
        let mut v = u64::from(v);
        for (shift, mask) in [
            (16, 0x0000_ffff_0000_ffff),
            (8, 0x00ff_00ff_00ff_00ff),
            (4, 0x0f0f_0f0f_0f0f_0f0f),
            (2, 0x3333_3333_3333_3333),
            (1, 0x5555_5555_5555_5555),
        ] {
            v = (v | (v << shift)) & mask;
        }
        v
    };
    spread(x) | spread(y) << 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_visits_quadrants_one_after_the_other() {
        let order = [(0, 0), (1, 0), (0, 1), (1, 1), (2, 0)].map(|(x, y)| morton(x, y));
        assert_eq!(order, [0, 1, 2, 3, 4]);
        assert_eq!(morton(u32::MAX, u32::MAX), u64::MAX);
    }
}
