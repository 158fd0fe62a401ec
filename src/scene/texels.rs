//! The texels of a picture, laid out for random access: squares of 4 × 4 lie together, so that the four nearest to a
//! point come from 1.6 squares on average; and those of 8-bit pictures stay bytes, so that a square is a cache line.

use base::math::Rgb;
use rayon::prelude::*;

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

    /// Place in memory of the texel in column `x` of row `y`, for [`Texels::peek`].
    #[inline]
    pub fn line(&self, x: usize, y: usize) -> usize {
        self.place(x, y).0
    }

    /// A number that depends on the texels of a line of memory: reads them ahead, and nothing waits for it.
    #[inline]
    pub fn peek(&self, line: usize) -> u32 {
        match &self.store {
            Store::Coded { squares, .. } => squares[line].0[0][0].into(),
            Store::Plain { squares } => squares[line].0[0].x.to_bits(),
        }
    }

    /// Means of half as many columns and rows, one at least, each over what its texel covers. Of coded texels the error
    /// of coding goes to the next in its row, so that their mean stays the same.
    pub fn halved(&self) -> Texels {
        let (columns, rows) = (Span::halves(self.width), Span::halves(self.height));
        match &self.store {
            Store::Coded { values, .. } if values.is_sorted() => {
                let coding = Coding::new(values);
                let coded = |row: &Span| {
                    let mut rest = Rgb::ZERO;
                    let mut codes = Vec::with_capacity(columns.len());
                    for mean in self.means(&columns, row) {
                        let wanted = mean + rest;
                        let [r, g, b] = [wanted.x, wanted.y, wanted.z].map(|value| coding.nearest(value));
                        rest = wanted - Rgb::from([r, g, b].map(|code| values[usize::from(code)]));
                        codes.push([r, g, b, 0]);
                    }
                    codes
                };
                let codes: Vec<[u8; 4]> = rows.par_iter().flat_map_iter(coded).collect();
                Texels::coded(columns.len(), &codes, **values)
            }
            _ => {
                let of_row = |row: &Span| self.means(&columns, row);
                let means: Vec<Rgb> = rows.par_iter().flat_map_iter(of_row).collect();
                Texels::new(columns.len(), &means)
            }
        }
    }

    /// Means of texels over columns of a row.
    fn means(&self, columns: &[Span], row: &Span) -> Vec<Rgb> {
        let mut along = vec![Rgb::ZERO; self.width];
        for (y, share) in row.shares() {
            for (x, sum) in along.iter_mut().enumerate() {
                *sum += self.get(x, y) * share;
            }
        }
        let mut means = Vec::with_capacity(columns.len());
        for column in columns {
            let mut mean = Rgb::ZERO;
            for (x, share) in column.shares() {
                mean += along[x] * share;
            }
            means.push(mean);
        }
        means
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

/// Texels of a row or column that a texel of half as many covers: up to three from the first on.
struct Span {
    first: usize,
    count: usize,
    shares: [f32; 3],
}

impl Span {
    /// Those of all texels of the coarser one, where the finer has `from`.
    fn halves(from: usize) -> Vec<Span> {
        let to = (from / 2).max(1);
        let count = if from < 2 { 1 } else { 2 + from % 2 };
        let span = |x: usize| {
            // Places in units of 1 / to of a finer texel, so that they are whole numbers.
            let (start, end) = (x * from, (x + 1) * from);
            let first = (start / to).min(from - count);
            let overlap = |i: usize| end.min((i + 1) * to).saturating_sub(start.max(i * to));
            let share = |i: usize| overlap(first + i) as f32 / from as f32;
            Span { first, count, shares: std::array::from_fn(|i| if i < count { share(i) } else { 0.0 }) }
        };
        (0..to).map(span).collect()
    }

    #[inline]
    fn shares(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        (0..self.count).map(|i| (self.first + i, self.shares[i]))
    }
}

/// Search among values in ascending order.
struct Coding<'a> {
    values: &'a [f32; 256],
    /// Number of values below the start of each of as many even intervals from the least to the greatest.
    below: Vec<u8>,
    intervals_a_value: f32,
}

impl Coding<'_> {
    /// Number of intervals.
    const INTERVALS: usize = 2048;

    fn new(values: &[f32; 256]) -> Coding<'_> {
        let intervals_a_value = Self::INTERVALS as f32 / (values[255] - values[0]).max(f32::MIN_POSITIVE);
        let start = |i: usize| values[0] + i as f32 / intervals_a_value;
        let below = |i: usize| values.partition_point(|value| *value < start(i)).min(255) as u8;
        Coding { values, below: (0..Self::INTERVALS).map(below).collect(), intervals_a_value }
    }

    /// Code of the value nearest to `value`.
    #[inline]
    fn nearest(&self, value: f32) -> u8 {
        let interval = ((value - self.values[0]) * self.intervals_a_value) as usize;
        let mut above = self.below[interval.min(Self::INTERVALS - 1)].max(1);
        while above < 255 && self.values[usize::from(above)] < value {
            above += 1;
        }
        let [low, high] = [above - 1, above].map(|code| self.values[usize::from(code)]);
        if value - low < high - value { above - 1 } else { above }
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
    fn halves_have_the_same_mean() {
        let mean = |texels: &Texels| texels.iter().sum::<Rgb>() / texels.len() as f32;
        // As sRGB has them: close to each other where dark.
        let values = std::array::from_fn(|code| (code as f32 / 255.0).powf(2.2));
        for (width, height) in [(64, 64), (37, 51), (3, 2), (128, 1), (1, 9)] {
            for contrast in [1, 85, 255] {
                let code = |i: usize| (hash(i as u32, 7) as usize % 2 * contrast) as u8;
                let codes: Vec<[u8; 4]> =
                    (0..width * height).map(|i| [code(i), code(i + 999), 80, 0]).collect();
                let coded = Texels::coded(width, &codes, values);
                let plain = Texels::new(width, &coded.iter().collect::<Vec<Rgb>>());
                let (half_coded, half_plain) = (coded.halved(), plain.halved());
                assert_eq!(half_coded.len(), (width / 2).max(1) * (height / 2).max(1));
                assert!((mean(&half_plain) - mean(&plain)).abs().max_element() < 1e-5);
                // At most half a code is left at the end of a row.
                let (error, row) = (mean(&half_coded) - mean(&coded), (width / 2).max(1) as f32);
                assert!(error.abs().max_element() < 0.0045 / row + 1e-5, "{width}x{height} {error}");
                let far = half_coded.iter().zip(half_plain.iter()).map(|(a, b)| (a - b).abs().max_element());
                assert!(far.fold(0.0, f32::max) < 0.009);
            }
        }
        let one = Texels::new(1, &[Rgb::X]);
        assert_eq!(one.halved(), one);
    }

    #[test]
    fn codes_are_those_of_the_nearest_values() {
        let values: [f32; 256] = std::array::from_fn(|code| (code as f32 / 255.0).powf(2.2) - 0.1);
        let coding = Coding::new(&values);
        for i in 0..5000 {
            let value = i as f32 / 4000.0 - 0.15;
            let error = |code: usize| (values[code] - value).abs();
            let least = (0..256).map(error).fold(f32::INFINITY, f32::min);
            assert!(error(coding.nearest(value).into()) <= least + 1e-7, "{value}");
        }
        let same = [0.5; 256];
        assert_eq!(same[usize::from(Coding::new(&same).nearest(0.7))], 0.5);
    }

    #[test]
    fn only_values_that_occur_count() {
        let values = std::array::from_fn(|code| code as f32 / 255.0);
        let grey = Texels::coded(2, &[[10; 4], [100; 4]], values);
        let below = |limit: f32| grey.all(|texel| texel.cmplt(Rgb::splat(limit)).all());
        assert!(below(2.0) && below(0.4) && !below(0.3));
    }
}
