//! Filters of attributes, which turn compact elements into those that accessors describe.

/// Applies a filter to elements of `stride` bytes.
pub(super) fn apply(filter: &str, elements: &mut [u8], stride: usize) -> Result<(), &'static str> {
    match (filter, stride) {
        ("NONE", _) => {}
        ("OCTAHEDRAL", 4) => each::<4>(elements, |v| of_bytes(v.map(|b| f32::from(b as i8)), v[3], 127.0)),
        ("OCTAHEDRAL", 8) => each::<8>(elements, |v| {
            let [x, y, z, w] = shorts(v);
            let turned = octahedral([x, y, z].map(f32::from), 32767.0);
            packed([turned[0] as i16, turned[1] as i16, turned[2] as i16, w])
        }),
        ("QUATERNION", 8) => each::<8>(elements, |v| packed(quaternion(shorts(v)))),
        ("EXPONENTIAL", _) => each::<4>(elements, |v| exponential(i32::from_le_bytes(v)).to_le_bytes()),
        ("COLOR", 4) => each::<4>(elements, |v| {
            let [y, co, cg, a] = v;
            let colour = colour(y.into(), (co as i8).into(), (cg as i8).into(), a.into(), 255.0);
            colour.map(|channel| channel as u8)
        }),
        ("COLOR", 8) => each::<8>(elements, |v| {
            let [y, co, cg, a] = shorts(v);
            let colour = colour((y as u16).into(), co.into(), cg.into(), (a as u16).into(), 65535.0);
            packed(colour.map(|channel| channel as u16 as i16))
        }),
        _ => return Err("has an unknown filter, or one that its stride excludes"),
    }
    Ok(())
}

fn each<const N: usize>(elements: &mut [u8], filter: impl Fn([u8; N]) -> [u8; N]) {
    elements.as_chunks_mut::<N>().0.iter_mut().for_each(|element| *element = filter(*element));
}

fn shorts(v: [u8; 8]) -> [i16; 4] {
    std::array::from_fn(|i| i16::from_le_bytes([v[2 * i], v[2 * i + 1]]))
}

fn packed(v: [i16; 4]) -> [u8; 8] {
    std::array::from_fn(|i| v[i / 2].to_le_bytes()[i % 2])
}

fn of_bytes([x, y, one, _]: [f32; 4], w: u8, most: f32) -> [u8; 4] {
    let [x, y, z] = octahedral([x, y, one], most).map(|v| v as i8 as u8);
    [x, y, z, w]
}

/// Returns the unit vector times `most` of a point on an octahedron that reaches as far as `one`.
fn octahedral([x, y, one]: [f32; 3], most: f32) -> [f32; 3] {
    let (x, y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    // The lower half is folded outwards.
    let fold = z.min(0.0);
    let (x, y) = (x - fold.copysign(x), y - fold.copysign(y));
    let length = (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|v| (v / length * most).round())
}

/// Returns a unit quaternion as shorts from its three smaller components, and the index of the largest.
fn quaternion([x, y, z, one]: [i16; 4]) -> [i16; 4] {
    let scale = std::f32::consts::FRAC_1_SQRT_2 / f32::from(one | 3);
    let [x, y, z] = [x, y, z].map(|v| f32::from(v) * scale);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let largest = (one & 3) as usize;
    let mut components = [0; 4];
    for (i, v) in [w, x, y, z].into_iter().enumerate() {
        components[(largest + i) % 4] = (v * 32767.0).round() as i16;
    }
    components
}

/// Returns the product of a mantissa of 24 bits and a power of 2.
fn exponential(code: i32) -> f32 {
    let (exponent, mantissa) = (code >> 24, code << 8 >> 8);
    // Powers of 2 are exact.
    let power = f64::from_bits(((exponent + 1023) as u64) << 52);
    (f64::from(mantissa) * power) as f32
}

/// Returns red, green, blue and alpha up to `most` from luma, two differences and alpha with the bit above it.
fn colour(y: i32, co: i32, cg: i32, alpha: u32, most: f32) -> [f32; 4] {
    let bits = 32 - alpha.leading_zeros();
    let scale = (1u32 << bits) - 1;
    let alpha = alpha & scale >> 1;
    let alpha = (alpha << 1 | alpha & 1) as i32;
    let channels = [y + co - cg, y + cg, y - co - cg, alpha];
    channels.map(|v| (v as f32 * most / scale as f32).round())
}
