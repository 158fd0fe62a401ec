//! Tests against streams of meshoptimizer's encoder, 0.2.30 of its Python package, and of filters by their definition.

use super::MeshoptView;
use serde_json::json;

fn hex(text: &str) -> Vec<u8> {
    let digits: Vec<u8> = text.bytes().filter(|byte| !byte.is_ascii_whitespace()).collect();
    let byte = |pair: &[u8; 2]| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap();
    digits.as_chunks::<2>().0.iter().map(byte).collect()
}

fn decode(
    mode: &str,
    filter: &str,
    count: usize,
    stride: usize,
    bytes: &[u8],
) -> Result<Vec<u8>, &'static str> {
    let statements = json!({
        "buffer": 0, "byteLength": bytes.len(), "byteStride": stride, "count": count, "mode": mode, "filter": filter,
    });
    serde_json::from_value::<MeshoptView>(statements).unwrap().decode(bytes)
}

fn words(indices: &[u32]) -> Vec<u8> {
    indices.iter().flat_map(|index| index.to_le_bytes()).collect()
}

/// Returns 37 elements of two rising shorts, four bytes and a float.
fn elements() -> Vec<u8> {
    (0..37u32)
        .flat_map(|i| {
            let shorts = [100 * i + i * i % 7, 37 * i].map(|v| (v as u16).to_le_bytes());
            let bytes = [(91 * i) as u8, 0, 7, if i % 5 != 0 { 255 } else { 0 }];
            [shorts.as_flattened(), &bytes, &(i as f32 * 0.25 + 1.0).to_le_bytes()].concat()
        })
        .collect()
}

const VERSION_0: &str = "a01f00cacec4c8ccc2c6cacec4c8ccc2c6cacec4c8ccc2c6cacec4c8ccc2c6cacec4ffc00000c8cc
    c2c6ca150208822088220822088000001f004a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4affc000004a4a
    4a4a4a150002000800200080020000001f00b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6ffc00000b6b6
    b6b6b600001510240902409024090240000000002f00404040402020202020202020101010101010101010101010101010100808088888
    800000000000050080000000000080000000000000000000000000000000000000000000000000000007000000803f";
const VERSION_1: &str = "a1bb6bba00cacec4c8ccc2c6cacec4c8ccc2c6cacec4c8ccc2c6cacec4c8ccc2c6cacec4c8ccc2c6
    ca004a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a00b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6
    b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b6b61510240902409024090240000000404040402020202020202020101010101010101010
    10101010101010080808080808080800000000000000000000000000000007000000803f010001";
/// Elements of single bits, in more than one block.
const BITS: &str = "a1a15555555510002400090002400090002400090002400090002400090002400090002400090002
    40009000240009000240009000240009000240009000240009000240009000010101010002010002010002a11500240009000240009000
    240001010002000000000000000000000000000000000000000100000300";

#[test]
fn attributes_of_both_versions_are_those_that_were_encoded() {
    for stream in [VERSION_0, VERSION_1] {
        assert_eq!(decode("ATTRIBUTES", "NONE", 37, 12, &hex(stream)).unwrap(), elements());
    }
    let bits: Vec<u8> = (0..300u32).flat_map(|i| [u8::from(i % 9 == 0), (i / 64) as u8, 0, 3]).collect();
    assert_eq!(decode("ATTRIBUTES", "NONE", 300, 4, &hex(BITS)).unwrap(), bits);
}

#[test]
fn words_of_exclusive_differences_are_rotated_to_the_left() {
    // One block of one group: bytes as they are (control 3), a mode of differences that are turned by 4 bits.
    let bytes = [&[0xA1, 0xFF, 1, 0, 0, 0x10][..], &[0; 19], &[5, 0, 0, 0], &[0x42]].concat();
    let bytes =
        [&bytes[..2], &[1, 2], &[0, 0], &[0, 0], &[0x10, 0], &[0; 19], &[5, 0, 0, 0], &[0x42]].concat();
    let first = 5u32 ^ 0x1000_0001u32.rotate_left(4);
    let expected = words(&[first, first ^ 2 << 4]);
    assert_eq!(decode("ATTRIBUTES", "NONE", 2, 4, &bytes).unwrap(), expected);
}

#[test]
fn triangles_and_sequences_are_those_that_were_encoded() {
    let mut indices = Vec::new();
    for corner in (0..5).flat_map(|y| (0..6).map(move |x| 7 * y + x)) {
        indices.extend([corner, corner + 1, corner + 7, corner + 1, corner + 8, corner + 7]);
    }
    indices.extend([0, 40, 3, 100, 5, 2, 40, 0, 17]);
    let stream = "e1fe1e100e100e100e100e100efe1e1b0e1a0e190e180e170eff1e170e170e170e170e170eff1e170e170e170e170e170e
        ff1e170e170e170e170e170effff5f0f0ebf026f0b0e6f0b0e6f0b0e2f5106ffc201bd01051e007687566778a9866589689801690000";
    let decoded = decode("TRIANGLES", "NONE", indices.len(), 4, &hex(stream)).unwrap();
    // The encoder may begin a triangle with another corner.
    let turned = |indices: &[u8]| -> Vec<[u32; 3]> {
        let list: Vec<u32> =
            indices.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
        let turn = |&[a, b, c]: &[u32; 3]| [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap();
        list.as_chunks::<3>().0.iter().map(turn).collect()
    };
    assert_eq!(turned(&decoded), turned(&words(&indices)));
    let short = decode("TRIANGLES", "NONE", indices.len(), 2, &hex(stream)).unwrap();
    assert!(short.as_chunks::<2>().0.iter().zip(decoded.as_chunks::<4>().0).all(|(a, b)| a[..] == b[..2]));
    let sequence =
        decode("INDICES", "NONE", 12, 4, &hex("d1000404c90104050405b08b11bb01030300000000")).unwrap();
    assert_eq!(sequence, words(&[0, 1, 2, 50, 3, 51, 4, 52, 70000, 5, 4, 3]));
}

/// Decodes one element of 4 or 8 bytes, which is stored as the baseline without changes.
fn filtered(filter: &str, element: &[u8]) -> Vec<u8> {
    let bytes = [&[0xA0][..], &vec![0; element.len()], &vec![0; 32 - element.len()], element].concat();
    decode("ATTRIBUTES", filter, 1, element.len(), &bytes).unwrap()
}

#[test]
fn filters_give_what_they_define() {
    // Octahedral: the axes, and the middle of a face below, folded.
    assert_eq!(filtered("OCTAHEDRAL", &[0, 0, 127, 9]), [0, 0, 127, 9]);
    assert_eq!(filtered("OCTAHEDRAL", &[127, 0, 127, 9]), [127, 0, 0, 9]);
    assert_eq!(filtered("OCTAHEDRAL", &[127, 127, 127, 0]), [0, 0, -127i8 as u8, 0]);
    let shorts = |values: [i16; 4]| values.map(i16::to_le_bytes).as_flattened().to_vec();
    assert_eq!(filtered("OCTAHEDRAL", &shorts([-511, 0, 511, 3])), shorts([-32767, 0, 0, 3]));
    // Quaternions: half of each component, and the largest last.
    let half = (0.5f32 * std::f32::consts::SQRT_2 * 1023.0).round() as i16;
    let all = filtered("QUATERNION", &shorts([half, half, -half, 1023]));
    let close = all.as_chunks::<2>().0.iter().zip([16384, 16384, -16384, 16384]);
    // 1023 | 3 has the index 3: the largest is w, and x, y, z follow from it on.
    for (found, expected) in close {
        assert!((i32::from(i16::from_le_bytes(*found)) - expected).abs() < 40, "{all:?}");
    }
    assert_eq!(filtered("EXPONENTIAL", &[0x03, 0, 0, 0xFE]), 0.75f32.to_le_bytes());
    assert_eq!(filtered("EXPONENTIAL", &[0xFF, 0xFF, 0xFF, 0x02]), (-4.0f32).to_le_bytes());
    // Grey of 8 bits: luma alone; alpha of 7 bits below the bit of the scale.
    assert_eq!(filtered("COLOR", &[51, 0, 0, 0xFF]), [51, 51, 51, 255]);
    assert_eq!(filtered("COLOR", &[100, 20, -10i8 as u8, 0x80]), [130, 90, 90, 0]);
    assert_eq!(filtered("COLOR", &shorts([51, 0, 0, 0xFF])), shorts([13107, 13107, 13107, -1]));
}

#[test]
fn damaged_streams_are_errors() {
    let stream = hex(VERSION_1);
    for length in 0..stream.len() {
        assert!(decode("ATTRIBUTES", "NONE", 37, 12, &stream[..length]).is_err(), "{length}");
    }
    assert!(decode("ATTRIBUTES", "NONE", 36, 12, &[&stream[..], &[0]].concat()).is_err());
    assert!(decode("ATTRIBUTES", "NONE", usize::MAX / 16, 12, &stream).is_err());
    assert!(decode("ATTRIBUTES", "QUATERNION", 37, 12, &stream).unwrap_err().contains("filter"));
    assert!(decode("ATTRIBUTES", "NONE", 37, 13, &stream).unwrap_err().contains("stride"));
    assert!(decode("TRIANGLES", "COLOR", 3, 4, &stream).unwrap_err().contains("filter"));
    assert!(decode("LINES", "NONE", 3, 4, &stream).unwrap_err().contains("mode"));
    assert!(decode("TRIANGLES", "NONE", 3, 4, &[&[0xE1, 0x00][..], &[0; 16]].concat()).is_err());
    assert!(decode("TRIANGLES", "NONE", 3, 4, &[&[0xE1, 0xF0][..], &[0xFF; 16]].concat()).is_err());
    assert!(decode("TRIANGLES", "NONE", 4, 4, &[0xE1; 40]).is_err());
    assert!(decode("INDICES", "NONE", 2, 4, &[0xD1, 0x80, 0x80, 0x80, 0x80, 0x80, 0, 0, 0, 0]).is_err());
}
