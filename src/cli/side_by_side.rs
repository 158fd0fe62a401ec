//! Images side by side: workers take one after the other, each with an equal part of the threads.
//!
//! Small images keep one thread busy all the time and several threads less. So this takes less time than one image
//! after the other on all threads. Images do not depend on the number of threads, nor on the images beside them.

use super::course::{RunProgress, RunSpan, Stages};
use super::exit::Failure;
use super::progress::Watch;
use super::values::ProgressMode;
use super::{interrupt, threads};
use base::progress::Control;
use base::stats::Stage;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Images that are rendered side by side.
pub struct SideBySide<'a> {
    /// Maximum number of images at a time.
    pub jobs: usize,
    /// Control of the run, which cancels all images.
    pub control: &'a Control,
    /// Form of the progress, which counts complete items.
    pub progress: ProgressMode,
    /// Part of the run.
    pub span: RunSpan,
}

impl SideBySide<'_> {
    /// Runs `work` on all items, with a control for each. After a failure no other item begins.
    ///
    /// # Errors
    /// The first failure, or if threads cannot be started.
    pub fn each<T: Send>(
        &self,
        items: Vec<T>,
        work: impl Fn(T, &Control) -> Result<(), Failure> + Sync,
    ) -> Result<(), Failure> {
        let threads = rayon::current_num_threads();
        let (count, jobs) = (items.len() as u64, self.jobs.clamp(1, threads));
        let part = |worker: usize| threads::pool((threads + worker) / jobs);
        let pools = (0..jobs).map(part).collect::<Result<Vec<_>, Failure>>()?;
        // Both hold plain data, which a panic elsewhere leaves consistent.
        let (left, failed) = (Mutex::new(items.into_iter()), Mutex::new(None));
        let next = || left.lock().unwrap_or_else(PoisonError::into_inner).next();
        let failure = || failed.lock().unwrap_or_else(PoisonError::into_inner);
        let worker = || {
            while let Some(item) = next().filter(|_| failure().is_none()) {
                if let Err(first) = work(item, &self.control.of_image()) {
                    failure().get_or_insert(first);
                }
                self.control.advance(1);
            }
        };
        let spawn = || {
            thread::scope(|scope| {
                for pool in &pools {
                    scope.spawn(move || pool.install(worker));
                }
            });
        };
        let all = || {
            self.control.begin(Stage::Render, count);
            interrupt::while_side_by_side(spawn);
        };
        Watch::new(self.progress, RunProgress::new(1, Stages::default(), self.span)).frame(
            None,
            self.control,
            all,
            |()| !self.control.is_cancelled(),
        );
        let failure = failure().take();
        failure.map_or(Ok(()), Err)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::anyhow;
    use std::collections::BTreeSet;
    use std::sync::Barrier;

    #[test]
    fn items_are_worked_on_at_a_time_with_their_part_of_the_threads() {
        let control = Control::new();
        let side =
            SideBySide { jobs: 2, control: &control, progress: ProgressMode::None, span: RunSpan::begin() };
        let (both, seen) = (Barrier::new(2), Mutex::new(BTreeSet::new()));
        let done = threads::pool(5).unwrap().install(|| {
            side.each((0..8).collect(), |item: usize, _| {
                both.wait();
                seen.lock().unwrap().insert((item, rayon::current_num_threads()));
                Ok(())
            })
        });
        assert!(done.is_ok());
        let seen = seen.into_inner().unwrap();
        assert_eq!(seen.iter().map(|(item, _)| *item).collect::<Vec<_>>(), (0..8).collect::<Vec<_>>());
        assert!(seen.iter().all(|(_, threads)| [2, 3].contains(threads)), "{seen:?}");
    }

    #[test]
    fn a_failure_ends_the_run_and_is_returned() {
        let control = Control::new();
        let side =
            SideBySide { jobs: 1, control: &control, progress: ProgressMode::None, span: RunSpan::begin() };
        let begun = Mutex::new(0);
        let done = side.each(vec![1, 2, 3, 4], |item, _| {
            *begun.lock().unwrap() += 1;
            if item == 2 { Err(Failure::render(anyhow!("two"))) } else { Ok(()) }
        });
        assert!(done.unwrap_err().to_string().contains("two"));
        assert_eq!(begun.into_inner().unwrap(), 2);
    }
}
