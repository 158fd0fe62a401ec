//! Mode "attributes": changes from element to element, byte by byte, in groups of 16.

use super::reader::{ByteReader, CUT, unzigzag};

/// Number of elements of a group.
const GROUP: usize = 16;

/// Decodes `count` elements of `stride` bytes each.
pub(super) fn decode(bytes: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, &'static str> {
    let channels = stride / 4;
    let (has_controls, tail, padded) = match bytes.first() {
        Some(0xA0) => (false, stride, stride.max(32)),
        Some(0xA1) => (true, stride + channels, (stride + channels).max(24)),
        _ => return Err("has compressed attributes of an unknown version"),
    };
    let end = bytes.len().checked_sub(padded).filter(|end| *end >= 1).ok_or(CUT)?;
    let mut reader = ByteReader(&bytes[1..end]);
    let (baseline, modes) = bytes[bytes.len() - tail..].split_at(stride);
    let mode = |channel: usize| modes.get(channel).copied().unwrap_or(0);
    let mut last = baseline.to_vec();
    let mut elements: Vec<u8> = Vec::new();
    let per_block = ((8192 / stride) & !(GROUP - 1)).min(256);
    let mut left = count;
    while left > 0 {
        let in_block = left.min(per_block);
        let controls = if has_controls { reader.take(channels)? } else { &[] };
        let mut codes: Vec<Vec<u8>> = Vec::with_capacity(stride);
        for at in 0..stride {
            let control = controls.get(at / 4).map(|byte| byte >> (2 * (at % 4)) & 3);
            codes.push(byte_codes(&mut reader, in_block, control)?);
        }
        let start = elements.len();
        elements.resize(start + in_block * stride, 0);
        for channel in 0..channels {
            let at = 4 * channel;
            let codes: [&[u8]; 4] = std::array::from_fn(|byte| codes[at + byte].as_slice());
            let mut value = [last[at], last[at + 1], last[at + 2], last[at + 3]];
            for i in 0..in_block {
                value = next(value, codes.map(|codes| codes[i]), mode(channel))?;
                elements[start + i * stride + at..][..4].copy_from_slice(&value);
            }
            last[at..at + 4].copy_from_slice(&value);
        }
        left -= in_block;
    }
    reader.end()?;
    Ok(elements)
}

/// Returns four bytes of an element after those of the element before, by the codes of their changes.
fn next(before: [u8; 4], codes: [u8; 4], mode: u8) -> Result<[u8; 4], &'static str> {
    Ok(match (mode & 15, mode >> 4) {
        (0, 0) => std::array::from_fn(|i| before[i].wrapping_add(unzigzag(codes[i].into()) as u8)),
        (1, 0) => {
            let half = |i: usize| {
                let code = u16::from_le_bytes([codes[i], codes[i + 1]]);
                let before = u16::from_le_bytes([before[i], before[i + 1]]);
                before.wrapping_add(unzigzag(code.into()) as u16).to_le_bytes()
            };
            let ([a, b], [c, d]) = (half(0), half(2));
            [a, b, c, d]
        }
        (2, turn) => {
            let change = u32::from_le_bytes(codes).rotate_left(turn.into());
            (u32::from_le_bytes(before) ^ change).to_le_bytes()
        }
        _ => return Err("has compressed attributes of an unknown channel mode"),
    })
}

/// Returns the codes of one byte of the elements of a block. `control` is that of version 1.
fn byte_codes(reader: &mut ByteReader, count: usize, control: Option<u8>) -> Result<Vec<u8>, &'static str> {
    let lengths = match control {
        None => [0, 2, 4, 8],
        Some(0) => [0, 1, 2, 4],
        Some(1) => [1, 2, 4, 8],
        Some(2) => return Ok(vec![0; count]),
        Some(_) => return Ok(reader.take(count)?.to_vec()),
    };
    let groups = count.div_ceil(GROUP);
    let headers = reader.take(groups.div_ceil(4))?;
    let mut codes = Vec::with_capacity(groups * GROUP);
    for group in 0..groups {
        let length: u8 = lengths[usize::from(headers[group / 4] >> (2 * (group % 4)) & 3)];
        match length {
            0 => codes.extend([0; GROUP]),
            8 => codes.extend(reader.take(GROUP)?),
            _ => {
                let (per_byte, most) = (8 / usize::from(length), (1 << length) - 1);
                let packed = reader.take(GROUP / per_byte)?;
                for i in 0..GROUP {
                    let place = i % per_byte;
                    // Single bits are stored from the least significant on, longer ones from the most significant.
                    let shift = if length == 1 { place } else { 8 - usize::from(length) * (place + 1) };
                    let code = packed[i / per_byte] >> shift & most;
                    // All bits set stand for a byte of its own.
                    codes.push(if code == most { reader.byte()? } else { code });
                }
            }
        }
    }
    Ok(codes)
}
