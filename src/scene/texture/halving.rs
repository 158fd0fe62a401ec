//! Images at half their width and height: one step down a mip map.

use super::texels::{Store, Texels};
use base::math::Rgb;
use rayon::prelude::*;

impl Texels {
    /// Returns the image at half its width and height, but at least one texel: each texel is the mean over the texels
    /// that it covers. The coding error of a coded texel is carried to the next in its row, which preserves the mean.
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

    /// Returns the means of texels over the `columns` of a coarser row.
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
}

/// Texels of a row or column that one texel of the coarser row or column covers: up to three, from `first` on.
struct Span {
    first: usize,
    count: usize,
    /// Share of the coarser texel that each covers.
    shares: [f32; 3],
}

impl Span {
    /// Returns the spans of all texels of the row that is half as long as one of `from` texels.
    fn halves(from: usize) -> Vec<Span> {
        let to = (from / 2).max(1);
        let count = if from < 2 { 1 } else { 2 + from % 2 };
        let span = |x: usize| {
            // Positions in units of 1 / `to` of a finer texel are whole numbers.
            let (start, end) = (x * from, (x + 1) * from);
            let first = (start / to).min(from - count);
            let overlap = |i: usize| end.min((i + 1) * to).saturating_sub(start.max(i * to));
            let share = |i: usize| overlap(first + i) as f32 / from as f32;
            Span { first, count, shares: std::array::from_fn(|i| if i < count { share(i) } else { 0.0 }) }
        };
        (0..to).map(span).collect()
    }

    /// Lists the texels, each with its share of the coarser one.
    #[inline]
    fn shares(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        (0..self.count).map(|i| (self.first + i, self.shares[i]))
    }
}

/// Search for the nearest of 256 values in ascending order.
struct Coding<'a> {
    values: &'a [f32; 256],
    /// Number of values below the start of each even interval between the least and the greatest value.
    below: Vec<u8>,
    /// Number of intervals per unit of the values.
    intervals_per_unit: f32,
}

impl Coding<'_> {
    /// Number of intervals.
    const INTERVALS: usize = 2048;

    /// Prepares the search.
    fn new(values: &[f32; 256]) -> Coding<'_> {
        let intervals_per_unit = Self::INTERVALS as f32 / (values[255] - values[0]).max(f32::MIN_POSITIVE);
        let start = |i: usize| values[0] + i as f32 / intervals_per_unit;
        let below = |i: usize| values.partition_point(|value| *value < start(i)).min(255) as u8;
        Coding { values, below: (0..Self::INTERVALS).map(below).collect(), intervals_per_unit }
    }

    /// Returns the code of the value nearest to `value`.
    #[inline]
    fn nearest(&self, value: f32) -> u8 {
        let interval = ((value - self.values[0]) * self.intervals_per_unit) as usize;
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
    fn halves_have_the_same_mean() {
        let mean = |texels: &Texels| texels.iter().sum::<Rgb>() / texels.len() as f32;
        // Values of sRGB codes lie close together at the dark end.
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
}
