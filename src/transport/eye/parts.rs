//! Arrays in parts, as tasks have filled them, and their permutation into one array.

use base::progress::Control;
use base::stats::give_back;
use rayon::prelude::*;
use std::mem;

/// Number of freed bytes at which memory is returned to the system. Ordinary images stay below; returning it there
/// would cost time and save nothing.
pub(super) const RELEASE_BYTES: usize = 64 << 20;

/// Maximum size in bytes of an array that may be in memory twice. Copies of larger arrays would set the peak memory of
/// large images.
const MAX_COPIED_BYTES: usize = 128 << 20;

/// Number of items per entry of the table of parts.
const BLOCK: usize = 64;

/// An array in parts.
pub(super) struct Parts<T> {
    /// Parts that are not empty.
    parts: Vec<Vec<T>>,
    /// Number of items before each part, followed by the number of all items.
    starts: Vec<usize>,
    /// Part of the first item of each block.
    blocks: Vec<u32>,
}

impl<T> Parts<T> {
    /// Returns the array of the items of all parts, in order.
    pub(super) fn new(mut parts: Vec<Vec<T>>) -> Parts<T> {
        parts.retain(|part| !part.is_empty());
        let (mut starts, mut blocks) = (vec![0], Vec::new());
        let mut count = 0;
        for (number, part) in (0..).zip(&parts) {
            count += part.len();
            starts.push(count);
            blocks.resize(count.div_ceil(BLOCK), number);
        }
        Parts { parts, starts, blocks }
    }

    /// Returns the number of items.
    pub(super) fn len(&self) -> usize {
        self.starts.last().copied().unwrap_or(0)
    }

    /// Returns an item.
    #[inline]
    pub(super) fn get(&self, item: usize) -> &T {
        let mut part = self.blocks[item / BLOCK] as usize;
        while self.starts[part + 1] <= item {
            part += 1;
        }
        &self.parts[part][item - self.starts[part]]
    }

    fn is_large(&self) -> bool {
        self.len() * size_of::<T>() > MAX_COPIED_BYTES
    }

    /// Joins the parts of a large array; returns `None` if `control` is cancelled.
    pub(super) fn joined_if_large(self, control: &Control) -> Option<Parts<T>> {
        match self.is_large() && self.parts.len() > 1 {
            true => Some(Parts::new(vec![self.joined(control)?])),
            false => Some(self),
        }
    }

    /// Joins all parts; returns `None` if `control` is cancelled. The parts are freed one by one, and memory is
    /// returned at intervals.
    fn joined(mut self, control: &Control) -> Option<Vec<T>> {
        if self.parts.len() == 1 {
            return self.parts.pop();
        }
        let mut all = Vec::with_capacity(self.len());
        let mut freed = 0;
        for part in &mut self.parts {
            if control.is_cancelled() {
                return None;
            }
            freed += size_of_val(&part[..]);
            all.append(&mut mem::take(part));
            if freed > RELEASE_BYTES {
                give_back();
                freed = 0;
            }
        }
        Some(all)
    }
}

impl<T: Copy + Send + Sync> Parts<T> {
    /// Permutes the items: the item at `i` of the result was at `order[i]`. Returns `None` if `control` is cancelled.
    pub(super) fn ordered(self, order: &[u32], control: &Control) -> Option<Vec<T>> {
        match self.is_large() {
            true => moved(self.joined(control)?, order, control),
            false if control.is_cancelled() => None,
            false => Some(order.par_iter().map(|i| *self.get(*i as usize)).collect()),
        }
    }
}

/// Permutes the items in place, along the cycles of the permutation.
fn moved<T: Copy>(mut items: Vec<T>, order: &[u32], control: &Control) -> Option<Vec<T>> {
    let mut moved = vec![false; items.len()];
    for start in 0..items.len() {
        if moved[start] {
            continue;
        }
        let (first, mut at) = (items[start], start);
        loop {
            if control.is_cancelled() {
                return None;
            }
            moved[at] = true;
            let from = order[at] as usize;
            if from == start {
                break;
            }
            items[at] = items[from];
            at = from;
        }
        items[at] = first;
    }
    Some(items)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_of_parts_are_found_and_ordered() {
        for sizes in [vec![], vec![0, 0], vec![1], vec![200, 0, 1, 1, 0, 0, 63, 64, 65, 7, 0]] {
            let mut next = 0u32;
            let mut part = |size: &u32| {
                next += size;
                (next - size..next).collect::<Vec<u32>>()
            };
            let parts: Vec<Vec<u32>> = sizes.iter().map(&mut part).collect();
            let control = Control::new();
            let all = parts.concat();
            let array = Parts::new(parts);
            assert_eq!(array.len(), all.len());
            assert!((0..all.len()).all(|i| *array.get(i) == all[i]));
            let turned: Vec<u32> = all.iter().map(|i| (i + 7) % all.len() as u32).collect();
            assert_eq!(array.ordered(&turned, &control).as_ref(), Some(&turned));
        }
        let parts = || Parts::new(vec![vec![1, 2], vec![], vec![3]]);
        let control = Control::new();
        assert_eq!(parts().joined(&control), Some(vec![1, 2, 3]));
        control.cancel();
        assert_eq!(parts().joined(&control), None);
        assert_eq!(parts().ordered(&[0, 1, 2], &control), None);
    }

    #[test]
    fn items_are_ordered_along_cycles_of_any_length() {
        let items: Vec<u32> = (100..108).collect();
        let order = [0, 2, 3, 1, 5, 4, 7, 6];
        let expected: Vec<u32> = order.iter().map(|i| items[*i as usize]).collect();
        let control = Control::new();
        assert_eq!(moved(items.clone(), &order, &control), Some(expected));
        assert_eq!(moved(Vec::<u32>::new(), &[], &control), Some(vec![]));
        let turned: Vec<u32> = (0..1000).map(|i| (i + 7) % 1000).collect();
        assert_eq!(moved((0..1000).collect(), &turned, &control).as_ref(), Some(&turned));
        control.cancel();
        assert_eq!(moved(items, &order, &control), None);
    }
}
