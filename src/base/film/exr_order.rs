//! Order of attributes in the headers of an OpenEXR file: by name, so that equal images give equal bytes.
//!
//! The format allows any order, and the library that writes it uses a random one.
//!
//! Layout (OpenEXR file layout, "Header"): magic number and version have four bytes each. Headers of attributes follow.
//! An attribute consists of name and type, both ended by a zero, the size of its value in four bytes, little endian,
//! and the value. A zero ends a header. In files of several parts, another zero ends the headers.

/// Number of bytes of magic number and version.
const PREFACE: usize = 8;
/// Bit of the version that marks several parts.
const MULTIPART: u8 = 0x10;

/// Sorts the attributes of every header in the bytes of a file. Invalid files stay unchanged.
pub(super) fn sort_attributes(file: &mut [u8]) {
    let mut at = PREFACE;
    let several = file.get(5).is_some_and(|flags| flags & MULTIPART != 0);
    loop {
        let Some(ends) = attributes(file, at) else { return };
        let Some(&end) = ends.last() else { return };
        let starts = std::iter::once(at).chain(ends.iter().copied());
        let mut sorted: Vec<&[u8]> = starts.zip(&ends).map(|(start, &end)| &file[start..end]).collect();
        sorted.sort();
        let sorted = sorted.concat();
        file[at..end].copy_from_slice(&sorted);
        at = end + 1;
        if !several || file.get(at).is_none_or(|next| *next == 0) {
            return;
        }
    }
}

/// Returns the ends of the attributes of the header that starts at `at`.
fn attributes(file: &[u8], mut at: usize) -> Option<Vec<usize>> {
    let mut ends = Vec::new();
    let past_zero = |from: usize| Some(from + file.get(from..)?.iter().position(|byte| *byte == 0)? + 1);
    while *file.get(at)? != 0 {
        let size = past_zero(past_zero(at)?)?;
        let value = size + 4;
        at = value.checked_add(u32::from_le_bytes(file.get(size..value)?.try_into().ok()?) as usize)?;
        ends.push(at);
    }
    Some(ends)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn attribute(name: &str, value: &[u8]) -> Vec<u8> {
        let size = (value.len() as u32).to_le_bytes();
        [name.as_bytes(), b"\0kind\0", &size, value].concat()
    }

    #[test]
    fn attributes_of_every_header_are_sorted_and_all_else_stays() {
        let names = [("b", &[0u8, 1][..]), ("a", &[]), ("ab", &[7; 9])];
        let header = |order: [usize; 3]| order.map(|i| attribute(names[i].0, names[i].1)).concat();
        for (flags, headers) in [(0, 1), (MULTIPART, 2)] {
            let file = |order| {
                let headers = [header(order), vec![0]].concat().repeat(headers);
                let end = if flags == 0 { vec![] } else { vec![0] };
                [vec![1, 2, 3, 4, 5, flags, 0, 0], headers, end, b"pixels\0".to_vec()].concat()
            };
            for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0]] {
                let mut bytes = file(order);
                sort_attributes(&mut bytes);
                assert_eq!(bytes, file([1, 2, 0]));
            }
            // Damaged files stay unchanged.
            for length in 0..file([0, 1, 2]).len() - 20 {
                let whole = file([0, 1, 2]);
                let mut cut = whole[..length].to_vec();
                sort_attributes(&mut cut);
                assert_eq!(cut.len(), length);
            }
        }
    }
}
