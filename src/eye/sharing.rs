//! Which cache records an eye sample can be lit by.

/// What a sample needs of a record: light that has passed its coat, and a series of enough bands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sharing(u32);

/// Bits for the number of bands.
const BANDS_BITS: u32 = 4;

impl Sharing {
    /// For a coat by its number (see [`crate::material::Bsdf::coat`]) and a series of up to 15 `bands`; 0 for irradiance.
    pub fn new(coat: u32, bands: usize) -> Sharing {
        Sharing(coat << BANDS_BITS | (bands as u32).min((1 << BANDS_BITS) - 1))
    }

    /// The same with another number of bands.
    pub fn with_bands(self, bands: usize) -> Sharing {
        Sharing::new(self.coat(), bands)
    }

    /// The coat; 0 for none.
    #[inline]
    pub fn coat(self) -> u32 {
        self.0 >> BANDS_BITS
    }

    /// Bands of the series; 0 where irradiance is enough.
    #[inline]
    pub fn bands(self) -> usize {
        (self.0 & ((1 << BANDS_BITS) - 1)) as usize
    }

    /// Whether a record made for a sample like this holds what `other` needs: the coats agree, and there are no fewer bands.
    #[inline]
    pub fn serves(self, other: Sharing) -> bool {
        (self.0 ^ other.0) >> BANDS_BITS == 0 && self.0 >= other.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_serve_samples_of_their_coat_that_need_no_more_bands() {
        let kinds = || (0..4).flat_map(|coat| (0..=8).map(move |bands| (coat, bands)));
        for (coat, bands) in kinds() {
            let record = Sharing::new(coat, bands);
            assert_eq!((record.coat(), record.bands()), (coat, bands));
            for (other, needed) in kinds() {
                assert_eq!(record.serves(Sharing::new(other, needed)), coat == other && bands >= needed);
            }
        }
    }
}
