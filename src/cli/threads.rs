//! Worker threads.

use super::exit::Failure;
use anyhow::Context;

/// Environment variable of the number of threads.
pub const VARIABLE: &str = "LIGHTSPLAT_THREADS";

/// Returns the number of threads: as given, or the number of processors.
pub fn count(typed: Option<u32>) -> usize {
    typed.map_or_else(|| std::thread::available_parallelism().map_or(1, |n| n.get()), |n| n as usize)
}

/// Starts a pool of threads.
///
/// # Errors
/// If the system does not start them.
pub fn pool(threads: usize) -> Result<rayon::ThreadPool, Failure> {
    let built = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    built
        .with_context(|| format!("cannot start {threads} threads; try fewer with --threads"))
        .map_err(Failure::render)
}
