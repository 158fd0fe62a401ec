//! Threads to work on.

use super::exit::Failure;
use anyhow::Context;

/// Those typed, or one for each processor.
pub fn count(typed: Option<u32>) -> usize {
    typed.map_or_else(|| std::thread::available_parallelism().map_or(1, |n| n.get()), |n| n as usize)
}

/// Starts so many.
pub fn pool(threads: usize) -> Result<rayon::ThreadPool, Failure> {
    let built = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    built
        .with_context(|| format!("cannot start {threads} threads; try fewer with --threads"))
        .map_err(Failure::render)
}
