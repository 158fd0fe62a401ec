//! The texels of a picture, laid out for random access: squares of 4 × 4 lie together, so that the four nearest to a
//! point come from 1.6 squares on average; and those of 8-bit pictures stay bytes, so that a square is a cache line.

use crate::math::Rgb;

/// Texels of a square.
const SQUARE: usize = 16;

/// Linear colours of texels.
#[derive(Clone, Debug, PartialEq)]
pub struct Texels {
    width: usize,
    height: usize,
    /// Squares in a row of them.
    across: usize,
    store: Store,
}

#[derive(Clone, Debug, PartialEq)]
enum Store {
    /// Codes of the channels' values.
    Coded { squares: Vec<Square<[u8; 4]>>, values: Box<[f32; 256]> },
    /// The colours themselves.
    Plain { squares: Vec<Square<Rgb>> },
}

#[repr(align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Square<T>([T; SQUARE]);

impl Texels {
    /// Of rows of `width` texels, the top one first.
    pub fn new(width: usize, texels: &[Rgb]) -> Texels {
        Texels::with(width, texels.len(), |layout| Store::Plain {
            squares: layout.squares(texels, Rgb::ZERO),
        })
    }

    /// Of codes, whose fourth is not read, and the value of each.
    pub fn coded(width: usize, codes: &[[u8; 4]], values: [f32; 256]) -> Texels {
        Texels::with(width, codes.len(), |layout| {
            let squares = layout.squares(codes, [0; 4]);
            Store::Coded { squares, values: Box::new(values) }
        })
    }

    fn with(width: usize, count: usize, store: impl FnOnce(&Texels) -> Store) -> Texels {
        let (height, across) = (count / width.max(1), width.div_ceil(4));
        let layout = Texels { width, height, across, store: Store::Plain { squares: Vec::new() } };
        Texels { store: store(&layout), ..layout }
    }

    /// True if `fits` holds of every texel, where it holds of a colour if it does of each channel's value alone.
    pub fn all(&self, fits: impl Fn(Rgb) -> bool) -> bool {
        match &self.store {
            Store::Coded { values, .. } => {
                values.iter().all(|value| fits(Rgb::splat(*value))) || self.iter().all(fits)
            }
            Store::Plain { .. } => self.iter().all(fits),
        }
    }

    /// Number of texels.
    pub fn len(&self) -> usize {
        self.width * self.height
    }

    /// True if there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Memory that they take, in bytes.
    pub fn bytes(&self) -> usize {
        match &self.store {
            Store::Coded { squares, .. } => size_of_val(&squares[..]),
            Store::Plain { squares } => size_of_val(&squares[..]),
        }
    }

    /// All texels, row by row.
    pub fn iter(&self) -> impl Iterator<Item = Rgb> + '_ {
        (0..self.height).flat_map(move |y| (0..self.width).map(move |x| self.get(x, y)))
    }

    /// The texel in column `x` of row `y`.
    #[inline]
    pub fn get(&self, x: usize, y: usize) -> Rgb {
        let (square, at) = self.place(x, y);
        match &self.store {
            Store::Coded { squares, values } => {
                let [r, g, b, _] = squares[square].0[at];
                Rgb::from([r, g, b].map(|code| values[usize::from(code)]))
            }
            Store::Plain { squares } => squares[square].0[at],
        }
    }

    /// The square of a texel, and its place in it.
    #[inline]
    fn place(&self, x: usize, y: usize) -> (usize, usize) {
        ((y >> 2) * self.across + (x >> 2), (y & 3) << 2 | x & 3)
    }

    fn squares<T: Copy>(&self, rows: &[T], empty: T) -> Vec<Square<T>> {
        let mut squares = vec![Square([empty; SQUARE]); self.across * self.height.div_ceil(4)];
        for (y, row) in rows.chunks_exact(self.width.max(1)).enumerate() {
            for (x, texel) in row.iter().enumerate() {
                let (square, at) = self.place(x, y);
                squares[square].0[at] = *texel;
            }
        }
        squares
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::hash;

    #[test]
    fn texels_come_back_to_the_bit_whatever_the_size() {
        let values = std::array::from_fn(|code| code as f32 / 7.0 - 1.0);
        for (width, height) in [(1, 1), (4, 4), (5, 3), (1, 17), (64, 9)] {
            let codes: Vec<[u8; 4]> = (0..width * height).map(|i| hash(i as u32, 1).to_le_bytes()).collect();
            let texels: Vec<Rgb> = codes
                .iter()
                .map(|[r, g, b, _]| Rgb::from([r, g, b].map(|code| values[usize::from(*code)])))
                .collect();
            let (plain, coded) = (Texels::new(width, &texels), Texels::coded(width, &codes, values));
            for stored in [&plain, &coded] {
                assert_eq!(stored.len(), texels.len());
                assert!(stored.iter().eq(texels.iter().copied()), "{width}x{height}");
                assert_eq!(stored.get(width - 1, height - 1), texels[texels.len() - 1]);
            }
            assert!(coded.bytes() * 3 == plain.bytes());
        }
        assert!(Texels::new(0, &[]).is_empty() && Texels::new(0, &[]).iter().next().is_none());
    }

    #[test]
    fn only_values_that_occur_count() {
        let values = std::array::from_fn(|code| code as f32 / 255.0);
        let grey = Texels::coded(2, &[[10; 4], [100; 4]], values);
        let below = |limit: f32| grey.all(|texel| texel.cmplt(Rgb::splat(limit)).all());
        assert!(below(2.0) && below(0.4) && !below(0.3));
    }
}
