//! Bytes of a compressed buffer view, and the numbers in them.

/// Problem of compressed bytes that end too early.
pub(super) const CUT: &str = "has compressed bytes that end too early";
/// Problem of compressed bytes with a remainder.
const LEFT: &str = "has compressed bytes that are left over";

/// Bytes that are read from front to back.
pub(super) struct ByteReader<'a>(pub &'a [u8]);

impl<'a> ByteReader<'a> {
    pub fn take(&mut self, count: usize) -> Result<&'a [u8], &'static str> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or(CUT)?;
        self.0 = rest;
        Ok(taken)
    }

    pub fn byte(&mut self) -> Result<u8, &'static str> {
        Ok(self.take(1)?[0])
    }

    /// Reads an unsigned number of 7 bits per byte, least significant first.
    pub fn varint(&mut self) -> Result<u32, &'static str> {
        let mut value = 0;
        for shift in [0, 7, 14, 21, 28] {
            let byte = self.byte()?;
            value |= u32::from(byte & 0x7F) << shift;
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err("has a compressed number of more than 32 bits")
    }

    pub fn end(&self) -> Result<(), &'static str> {
        if self.0.is_empty() { Ok(()) } else { Err(LEFT) }
    }
}

/// Returns the change that its code stands for: 0, -1, 1, -2, 2 and so on.
pub(super) fn unzigzag(code: u32) -> u32 {
    if code & 1 != 0 { !(code >> 1) } else { code >> 1 }
}

/// Adds an index of `stride` bytes to `bytes`.
pub(super) fn push_index(bytes: &mut Vec<u8>, index: u32, stride: usize) {
    bytes.extend(&index.to_le_bytes()[..stride]);
}
