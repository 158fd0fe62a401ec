//! Texels of an image, laid out for random access.
//!
//! Squares of 4 × 4 texels lie together, so that the four texels nearest to a point come from 1.6 squares on average.
//! Texels of 8-bit images stay bytes, so that a square is one cache line.

use base::math::Rgb;

/// Number of texels in a square.
const SQUARE: usize = 16;

/// Linear colours of texels.
#[derive(Clone, Debug, PartialEq)]
pub struct Texels {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Number of squares in a row of squares.
    across: usize,
    pub(super) store: Store,
}

/// Texels in memory.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Store {
    /// Codes of the channels, and the value that each code stands for.
    Coded { squares: Vec<Square<[u8; 4]>>, values: Box<[f32; 256]> },
    /// Colours in floating point.
    Plain { squares: Vec<Square<Rgb>> },
}

/// Square of 4 × 4 texels, row by row.
#[repr(align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Square<T>([T; SQUARE]);

impl Texels {
    /// Stores rows of `width` texels, the top row first.
    pub fn new(width: usize, texels: &[Rgb]) -> Texels {
        Texels::with(width, texels.len(), |layout| Store::Plain {
            squares: layout.squares(texels, Rgb::ZERO),
        })
    }

    /// Stores rows of `width` texels as codes of their channels, of which the fourth is not read. `values` holds the
    /// value that each code stands for.
    pub fn coded(width: usize, codes: &[[u8; 4]], values: [f32; 256]) -> Texels {
        Texels::with(width, codes.len(), |layout| {
            let squares = layout.squares(codes, [0; 4]);
            Store::Coded { squares, values: Box::new(values) }
        })
    }

    /// Lays out `count` texels in rows of `width`; `store` makes their memory.
    fn with(width: usize, count: usize, store: impl FnOnce(&Texels) -> Store) -> Texels {
        let (height, across) = (count / width.max(1), width.div_ceil(4));
        let layout = Texels { width, height, across, store: Store::Plain { squares: Vec::new() } };
        Texels { store: store(&layout), ..layout }
    }

    /// Returns true if `fits` holds for every texel. `fits` must hold for a colour whenever it holds for the grey of
    /// each of its channels.
    pub fn all(&self, fits: impl Fn(Rgb) -> bool) -> bool {
        match &self.store {
            Store::Coded { values, .. } => {
                values.iter().all(|value| fits(Rgb::splat(*value))) || self.iter().all(fits)
            }
            Store::Plain { .. } => self.iter().all(fits),
        }
    }

    /// Returns the number of texels.
    pub fn len(&self) -> usize {
        self.width * self.height
    }

    /// Returns true if there are no texels.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the memory that the texels take, in bytes.
    pub fn bytes(&self) -> usize {
        match &self.store {
            Store::Coded { squares, .. } => size_of_val(&squares[..]),
            Store::Plain { squares } => size_of_val(&squares[..]),
        }
    }

    /// Lists all texels, row by row.
    pub fn iter(&self) -> impl Iterator<Item = Rgb> + '_ {
        (0..self.height).flat_map(move |y| (0..self.width).map(move |x| self.get(x, y)))
    }

    /// Returns the texel in column `x` of row `y`.
    #[inline]
    pub fn get(&self, x: usize, y: usize) -> Rgb {
        let (square, at) = self.locate(x, y);
        match &self.store {
            Store::Coded { squares, values } => {
                let [r, g, b, _] = squares[square].0[at];
                Rgb::from([r, g, b].map(|code| values[usize::from(code)]))
            }
            Store::Plain { squares } => squares[square].0[at],
        }
    }

    /// Returns the number of the square that holds the texel in column `x` of row `y`, for [`Texels::peek`].
    #[inline]
    pub fn square(&self, x: usize, y: usize) -> usize {
        self.locate(x, y).0
    }

    /// Returns a number that depends on the texels of a square. Reading it brings the square into the cache ahead of
    /// its use.
    #[inline]
    pub fn peek(&self, square: usize) -> u32 {
        match &self.store {
            Store::Coded { squares, .. } => squares[square].0[0][0].into(),
            Store::Plain { squares } => squares[square].0[0].x.to_bits(),
        }
    }

    /// Returns the number of a texel's square, and the texel's index in the square.
    #[inline]
    fn locate(&self, x: usize, y: usize) -> (usize, usize) {
        ((y >> 2) * self.across + (x >> 2), (y & 3) << 2 | x & 3)
    }

    /// Sorts rows of texels into squares; texels beyond the edges are `empty`.
    fn squares<T: Copy>(&self, rows: &[T], empty: T) -> Vec<Square<T>> {
        let mut squares = vec![Square([empty; SQUARE]); self.across * self.height.div_ceil(4)];
        for (y, row) in rows.chunks_exact(self.width.max(1)).enumerate() {
            for (x, texel) in row.iter().enumerate() {
                let (square, at) = self.locate(x, y);
                squares[square].0[at] = *texel;
            }
        }
        squares
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::hash;

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
