//! Partition of primitives. All threads partition the largest clusters, at which others would wait; the order of the
//! primitives is that of one thread.

use super::cost::Primitive;
use rayon::prelude::*;

/// Minimum number of primitives that all threads partition.
const LARGE: usize = 1 << 15;

/// Number of primitives per task.
const CHUNK: usize = 1 << 13;

/// Number of threads from which on large clusters are partitioned by all threads, which test each primitive twice.
const MANY_THREADS: usize = 4;

/// Moves primitives that satisfy `goes_left` to the front; returns their number.
pub fn partition(primitives: &mut [Primitive], goes_left: impl Fn(&Primitive) -> bool + Sync) -> usize {
    match primitives.len() >= LARGE && rayon::current_num_threads() >= MANY_THREADS {
        true => by_all_threads(primitives, goes_left, CHUNK),
        false => by_one_thread(primitives, goes_left),
    }
}

fn by_one_thread(primitives: &mut [Primitive], goes_left: impl Fn(&Primitive) -> bool) -> usize {
    let (mut i, mut j) = (0, primitives.len());
    loop {
        while i < j && goes_left(&primitives[i]) {
            i += 1;
        }
        while i < j && !goes_left(&primitives[j - 1]) {
            j -= 1;
        }
        if i >= j {
            return i;
        }
        primitives.swap(i, j - 1);
        i += 1;
        j -= 1;
    }
}

/// Swaps the pairs that [`by_one_thread`] swaps: the k-th misplaced primitive of the left part, and the k-th from the
/// end of the right part.
fn by_all_threads(
    primitives: &mut [Primitive],
    goes_left: impl Fn(&Primitive) -> bool + Sync,
    chunk: usize,
) -> usize {
    let count = |part: &[Primitive]| part.iter().filter(|r| goes_left(r)).count();
    let middle: usize = primitives.par_chunks(chunk).map(count).sum();
    let (left, right) = primitives.split_at_mut(middle);
    let misplaced: Vec<usize> = left.par_chunks(chunk).map(|part| part.len() - count(part)).collect();
    let ends = sums(&misplaced);
    let counts: Vec<usize> = right.par_rchunks(chunk).map(count).collect();
    let counts = sums(&counts);
    // Start of the shortest end of the right part with so many misplaced primitives.
    let start_of = |wanted: usize| {
        let (part, passed) = match counts.partition_point(|sum| *sum < wanted) {
            0 => (0, 0),
            part => (part, counts[part - 1]),
        };
        let mut start = right.len().saturating_sub(part * chunk);
        let mut found = passed;
        while found < wanted {
            start -= 1;
            found += usize::from(goes_left(&right[start]));
        }
        start
    };
    let starts: Vec<usize> = ends.par_iter().map(|end| start_of(*end)).collect();
    let (mut rest, mut tasks) = (right, Vec::with_capacity(starts.len()));
    for (part, start) in left.chunks_mut(chunk).zip(starts) {
        let (others, own) = rest.split_at_mut(start);
        tasks.push((part, own));
        rest = others;
    }
    tasks.into_par_iter().for_each(|(left, right)| {
        let misplaced = left.iter_mut().filter(|r| !goes_left(r));
        let others = right.iter_mut().rev().filter(|r| goes_left(r));
        misplaced.zip(others).for_each(|(a, b)| std::mem::swap(a, b));
    });
    middle
}

/// Returns the sums of the numbers up to each.
fn sums(numbers: &[usize]) -> Vec<usize> {
    let mut sum = 0;
    let add = |number: &usize| {
        sum += number;
        sum
    };
    numbers.iter().map(add).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::{hash, unit};

    #[test]
    fn all_threads_swap_what_one_thread_swaps() {
        let primitive = |i: u32| Primitive([unit(hash(i, 1)), i as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        for count in [0, 1, 2, 7, 64, 65, 1000] {
            for share in [0.0, 0.02, 0.5, 0.97, 1.0] {
                let goes_left = |r: &Primitive| r.0[0] < share;
                let mut one: Vec<Primitive> = (0..count).map(primitive).collect();
                let mut all = one.clone();
                let left = by_one_thread(&mut one, goes_left);
                assert_eq!(by_all_threads(&mut all, goes_left, 8), left);
                assert!(one.iter().zip(&all).all(|(a, b)| a.0 == b.0), "{count} {share}");
                assert!(all[..left].iter().all(goes_left) && !all[left..].iter().any(goes_left));
            }
        }
    }
}
