//! Threads that watch work: progress, previews.

use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// Time between the starts of copies of an image, over the time that one takes on one of all processors. So copies take
/// at most 1 % of the processors' time.
const SPACING: u32 = 100;

/// Runs `work` here and `watch` in another thread. The channel of `watch` closes when `work` ends or panics.
pub fn beside<R>(work: impl FnOnce() -> R, watch: impl FnOnce(Receiver<()>) + Send) -> R {
    thread::scope(|scope| {
        let (open, stop) = channel();
        scope.spawn(|| watch(stop));
        let result = work();
        drop(open);
        result
    })
}

/// Waits for an interval. Returns false when the work has ended.
pub fn goes_on(stop: &Receiver<()>, interval: Duration) -> bool {
    matches!(stop.recv_timeout(interval), Err(RecvTimeoutError::Timeout))
}

/// Returns the minimum time from the start of a copy that took `cost` to the start of the next, with this number of
/// threads at work.
pub fn spacing(cost: Duration, threads: u32) -> Duration {
    cost.saturating_mul(SPACING) / threads.max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_watcher_ends_when_the_work_panics() {
        let result = std::panic::catch_unwind(|| {
            beside(|| panic!("at work"), |stop| while goes_on(&stop, Duration::from_millis(10)) {})
        });
        assert!(result.is_err());
    }

    #[test]
    fn copies_take_at_most_a_hundredth_of_the_time_of_all_threads() {
        let cost = Duration::from_millis(30);
        assert_eq!(spacing(cost, 1), Duration::from_secs(3));
        assert_eq!(spacing(cost, 10), Duration::from_millis(300));
        assert!(spacing(Duration::MAX, 0) > Duration::from_secs(1 << 40));
    }
}
