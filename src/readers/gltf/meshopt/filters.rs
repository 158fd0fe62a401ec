//! Filters of attributes, which turn compact elements into those that accessors describe (appendix B of the
//! specification of `KHR_meshopt_compression`).

use std::f32::consts::FRAC_1_SQRT_2;

/// Applies a filter to elements of `stride` bytes.
pub(super) fn apply(filter: &str, elements: &mut [u8], stride: usize) -> Result<(), &'static str> {
    match (filter, stride) {
        ("NONE", _) => {}
        ("OCTAHEDRAL", 4) => each::<4>(elements, octahedral_bytes),
        ("OCTAHEDRAL", 8) => each::<8>(elements, octahedral_shorts),
        ("QUATERNION", 8) => each::<8>(elements, |element| from_shorts(quaternion(to_shorts(element)))),
        ("EXPONENTIAL", _) => {
            each::<4>(elements, |element| exponential(i32::from_le_bytes(element)).to_le_bytes());
        }
        ("COLOR", 4) => each::<4>(elements, colour_bytes),
        ("COLOR", 8) => each::<8>(elements, colour_shorts),
        _ => return Err("has an unknown filter, or one that its stride excludes"),
    }
    Ok(())
}

/// Replaces each element of `N` bytes.
fn each<const N: usize>(elements: &mut [u8], filter: impl Fn([u8; N]) -> [u8; N]) {
    elements.as_chunks_mut::<N>().0.iter_mut().for_each(|element| *element = filter(*element));
}

/// Returns four little-endian numbers of 16 bits.
fn to_shorts(bytes: [u8; 8]) -> [i16; 4] {
    std::array::from_fn(|i| i16::from_le_bytes([bytes[2 * i], bytes[2 * i + 1]]))
}

/// Returns the little-endian bytes of four numbers.
fn from_shorts(shorts: [i16; 4]) -> [u8; 8] {
    std::array::from_fn(|i| shorts[i / 2].to_le_bytes()[i % 2])
}

/// Decodes a normal or tangent in signed bytes. The fourth byte stays.
fn octahedral_bytes(element: [u8; 4]) -> [u8; 4] {
    let [x, y, one] = [0, 1, 2].map(|i| f32::from(element[i] as i8));
    let [x, y, z] = octahedral([x, y, one], f32::from(i8::MAX)).map(|v| v as i8 as u8);
    [x, y, z, element[3]]
}

/// Decodes a normal or tangent in signed numbers of 16 bits. The fourth number stays.
fn octahedral_shorts(element: [u8; 8]) -> [u8; 8] {
    let [x, y, one, last] = to_shorts(element);
    let [x, y, z] = octahedral([x, y, one].map(f32::from), f32::from(i16::MAX)).map(|v| v as i16);
    from_shorts([x, y, z, last])
}

/// Filter 1, octahedral: returns the unit vector times `most` of a point on the octahedron |x| + |y| + |z| = 1.
///
/// `one` is the code of 1. Points with z < 0 are folded outwards over the edges of the square |x| + |y| <= 1.
fn octahedral([x, y, one]: [f32; 3], most: f32) -> [f32; 3] {
    let (x, y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    let fold = z.min(0.0);
    let (x, y) = (x - fold.copysign(x), y - fold.copysign(y));
    let length = (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|v| (v / length * most).round())
}

/// Filter 2, quaternion: returns a unit quaternion (x, y, z, w) in numbers of 16 bits.
///
/// The three components that are not the largest are stored, cyclically behind the largest, in units of 1/√2: none is
/// greater. The largest is the root of the rest. The fourth number is the code of 1/√2, whose two lowest bits are the
/// index of the largest component instead.
fn quaternion([a, b, c, code]: [i16; 4]) -> [i16; 4] {
    let unit = FRAC_1_SQRT_2 / f32::from(code | 3);
    let [a, b, c] = [a, b, c].map(|v| f32::from(v) * unit);
    let rest = (1.0 - a * a - b * b - c * c).max(0.0).sqrt();
    let largest = (code & 3) as usize;
    let mut components = [0; 4];
    for (i, v) in [rest, a, b, c].into_iter().enumerate() {
        components[(largest + i) % 4] = (v * f32::from(i16::MAX)).round() as i16;
    }
    components
}

/// Filter 3, exponential: returns m 2^e of a signed mantissa m in the lower 24 bits and a signed exponent e above them.
fn exponential(code: i32) -> f32 {
    let (exponent, mantissa) = (code >> 24, code << 8 >> 8);
    // A power of 2 in f64 has the biased exponent alone, so it is exact.
    let power = f64::from_bits(((exponent + 1023) as u64) << 52);
    (f64::from(mantissa) * power) as f32
}

/// Decodes a colour in bytes.
fn colour_bytes([y, co, cg, alpha]: [u8; 4]) -> [u8; 4] {
    let differences = [co, cg].map(|v| i32::from(v as i8));
    colour(y.into(), differences, alpha.into(), f32::from(u8::MAX)).map(|channel| channel as u8)
}

/// Decodes a colour in numbers of 16 bits.
fn colour_shorts(element: [u8; 8]) -> [u8; 8] {
    let [y, co, cg, alpha] = to_shorts(element);
    let differences = [co, cg].map(i32::from);
    let channels = colour((y as u16).into(), differences, (alpha as u16).into(), f32::from(u16::MAX));
    from_shorts(channels.map(|channel| channel as u16 as i16))
}

/// Filter 4, colour: returns red, green, blue and alpha up to `most` from luma y and the chroma Co and Cg (YCoCg).
///
/// All channels are codes up to 2^n - 1. The highest bit of `alpha` that is set is bit n - 1 and tells n. The bits
/// below are alpha, whose lowest bit is repeated for the bit that is missing.
fn colour(y: i32, [co, cg]: [i32; 2], alpha: u32, most: f32) -> [f32; 4] {
    let bits = u32::BITS - alpha.leading_zeros();
    let greatest = (1u32 << bits) - 1;
    let below = alpha & (greatest >> 1);
    let repeated = (below << 1) | (below & 1);
    let channels = [y + co - cg, y + cg, y - co - cg, repeated as i32];
    channels.map(|v| (v as f32 * most / greatest as f32).round())
}
