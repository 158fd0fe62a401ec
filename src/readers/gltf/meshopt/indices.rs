//! Modes "triangles" and "indices": lists of vertex indices.

use super::reader::{ByteReader, CUT, push_index, unzigzag};

/// Number of entries that a queue remembers.
const REMEMBERED: usize = 16;

/// The latest entries.
struct Queue<T> {
    entries: [T; REMEMBERED],
    /// Number of entries ever added.
    added: usize,
}

impl<T: Copy + Default> Queue<T> {
    fn new() -> Queue<T> {
        Queue { entries: [T::default(); REMEMBERED], added: 0 }
    }

    fn push(&mut self, entry: T) {
        self.entries[self.added % REMEMBERED] = entry;
        self.added += 1;
    }

    /// Returns the entry added `ago` entries before the latest.
    fn get(&self, ago: u8) -> Result<T, &'static str> {
        let ago = usize::from(ago);
        match ago < REMEMBERED.min(self.added) {
            true => Ok(self.entries[(self.added - 1 - ago) % REMEMBERED]),
            false => Err("refers to compressed indices before the first"),
        }
    }
}

/// State of decoding triangles.
struct TriangleDecoder<'a> {
    extra: ByteReader<'a>,
    next: u32,
    last: u32,
    vertices: Queue<u32>,
}

impl TriangleDecoder<'_> {
    fn new_vertex(&mut self) -> u32 {
        self.next = self.next.wrapping_add(1);
        self.next.wrapping_sub(1)
    }

    fn explicit(&mut self) -> Result<u32, &'static str> {
        self.last = self.last.wrapping_add(unzigzag(self.extra.varint()?));
        Ok(self.last)
    }

    /// Returns a vertex by its code of 4 bits, and true if the vertex has to be remembered.
    fn vertex(&mut self, code: u8) -> Result<(u32, bool), &'static str> {
        Ok(match code {
            0 => (self.new_vertex(), true),
            15 => (self.explicit()?, true),
            _ => (self.vertices.get(code - 1)?, false),
        })
    }
}

/// Decodes `count` indices of triangles.
pub(super) fn triangles(bytes: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, &'static str> {
    let mut reader = ByteReader(bytes);
    if reader.byte()? != 0xE1 || !count.is_multiple_of(3) {
        return Err("has compressed triangles of an unknown version");
    }
    let codes = reader.take(count / 3)?;
    let (extra, table) = reader.0.split_at_checked(reader.0.len().wrapping_sub(16)).ok_or(CUT)?;
    if table.iter().any(|byte| byte & 15 == 15 || byte >> 4 == 15) {
        return Err("has a wrong table of compressed triangles");
    }
    let mut state = TriangleDecoder { extra: ByteReader(extra), next: 0, last: 0, vertices: Queue::new() };
    let mut edges: Queue<[u32; 2]> = Queue::new();
    let mut indices = Vec::with_capacity(count * stride);
    for &code in codes {
        let (high, low) = (code >> 4, code & 15);
        let [a, b, c] = if high < 15 {
            let [a, b] = edges.get(high)?;
            let (c, is_new) = match low {
                0 => (state.new_vertex(), true),
                1..=12 => (state.vertices.get(low)?, false),
                13 | 14 => {
                    state.last =
                        if low == 13 { state.last.wrapping_sub(1) } else { state.last.wrapping_add(1) };
                    (state.last, true)
                }
                _ => (state.explicit()?, true),
            };
            if is_new {
                state.vertices.push(c);
            }
            [a, b, c]
        } else {
            let is_listed = low < 14;
            let rest = if is_listed { table[usize::from(low)] } else { state.extra.byte()? };
            if !is_listed && rest == 0 {
                state.next = 0;
            }
            let a = if low == 15 { state.explicit()? } else { state.new_vertex() };
            let (b, b_is_new) = state.vertex(rest >> 4)?;
            let (c, c_is_new) = state.vertex(rest & 15)?;
            state.vertices.push(a);
            [(b, b_is_new), (c, c_is_new)]
                .iter()
                .filter(|(_, is_new)| *is_new)
                .for_each(|(vertex, _)| state.vertices.push(*vertex));
            edges.push([b, a]);
            [a, b, c]
        };
        edges.push([c, b]);
        edges.push([a, c]);
        [a, b, c].into_iter().for_each(|index| push_index(&mut indices, index, stride));
    }
    state.extra.end()?;
    Ok(indices)
}

/// Decodes `count` indices in sequence.
pub(super) fn sequence(bytes: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, &'static str> {
    let end = bytes.len().checked_sub(4).ok_or(CUT)?;
    let mut reader = ByteReader(&bytes[..end]);
    if reader.byte()? != 0xD1 {
        return Err("has compressed indices of an unknown version");
    }
    let (mut last, mut indices) = ([0u32; 2], Vec::new());
    for _ in 0..count {
        let code = reader.varint()?;
        let baseline = &mut last[(code & 1) as usize];
        *baseline = baseline.wrapping_add(unzigzag(code >> 1));
        push_index(&mut indices, *baseline, stride);
    }
    reader.end()?;
    Ok(indices)
}
