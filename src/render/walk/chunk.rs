//! Chunks of a walk: frames that share records. A chunk begins without records, so that its frames do not depend on the
//! run or the machine that renders them.

use std::num::NonZeroUsize;
use std::ops::Range;

/// Frames of a walk that share records.
#[derive(Debug, PartialEq, Eq)]
pub struct FrameChunk {
    /// Numbers of the frames wanted, ascending.
    pub frames: Vec<usize>,
    /// True if no later run can want further frames of the chunk after these.
    pub ends: bool,
}

/// Groups frames by chunk: frames 1 to N of the path are the first chunk, and so on. Without a size there is one chunk.
pub fn chunks(frames: &[usize], size: Option<NonZeroUsize>, path_length: usize) -> Vec<FrameChunk> {
    let size = size.map_or(path_length.max(1), NonZeroUsize::get);
    let number = |frame: &usize| frame.saturating_sub(1) / size;
    let split = frames.chunk_by(|a, b| number(a) == number(b));
    split
        .map(|frames| {
            let last = frames.last().copied().unwrap_or_default();
            FrameChunk { frames: frames.to_vec(), ends: last % size == 0 || last == path_length }
        })
        .collect()
}

/// Consecutive frames of a chunk to be rendered.
#[derive(Debug, PartialEq, Eq)]
pub struct Run {
    /// Indices of the frames in the chunk.
    pub frames: Range<usize>,
    /// True if the run begins with saved records, false if it begins without records.
    pub from_saved: bool,
}

/// Returns the runs that render all frames of a chunk that are not `done`.
///
/// Each frame gets the records of a run from the first frame to the last. `saved` is the index of the frame after which
/// records were saved, if they were.
pub fn runs(done: &[bool], saved: Option<usize>) -> Vec<Run> {
    let resumed = saved.map_or(0, |saved| saved + 1);
    let up_to_last_lacking = |range: Range<usize>| {
        let end = range.clone().rev().find(|i| !done[*i]).map_or(range.start, |last| last + 1);
        range.start..end
    };
    let anew = if saved.is_some() { 0..resumed } else { 0..done.len() };
    let further = if saved.is_some() { resumed..done.len() } else { 0..0 };
    [(anew, false), (further, true)]
        .into_iter()
        .map(|(range, from_saved)| Run { frames: up_to_last_lacking(range), from_saved })
        .filter(|run| !run.frames.is_empty())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_are_places_of_the_path_whichever_frames_are_wanted() {
        let split = |frames: &[usize], size, length| {
            let split = chunks(frames, NonZeroUsize::new(size), length);
            split.into_iter().map(|chunk| (chunk.frames, chunk.ends)).collect::<Vec<_>>()
        };
        let all = [(vec![1, 2, 3], true), (vec![4, 5, 6], true), (vec![7], true)];
        assert_eq!(split(&[1, 2, 3, 4, 5, 6, 7], 3, 7), all);
        assert_eq!(split(&[2, 5, 7], 3, 9), [(vec![2], false), (vec![5], false), (vec![7], false)]);
        assert_eq!(split(&[1, 4, 9], 0, 10), [(vec![1, 4, 9], false)]);
        assert_eq!(split(&[9, 10], 0, 10), [(vec![9, 10], true)]);
        assert_eq!(split(&[], 3, 10), []);
    }

    #[test]
    fn runs_begin_anew_or_go_on_and_reach_every_frame_that_lacks() {
        let of = |done: &str, saved| {
            let done: Vec<bool> = done.chars().map(|c| c == 'x').collect();
            let runs = runs(&done, saved);
            runs.into_iter().map(|run| (run.frames, run.from_saved)).collect::<Vec<_>>()
        };
        assert_eq!(of("....", None), [(0..4, false)]);
        // Without saved records, existing frames are rendered again for their records.
        assert_eq!(of("xx..", None), [(0..4, false)]);
        assert_eq!(of("xx..", Some(1)), [(2..4, true)]);
        // The process ended between writing a frame and saving its records.
        assert_eq!(of("xx..", Some(0)), [(1..4, true)]);
        assert_eq!(of(".xx.", Some(2)), [(0..1, false), (3..4, true)]);
        assert_eq!(of("x.xx", Some(3)), [(0..2, false)]);
        assert_eq!(of("x.xx", None), [(0..2, false)]);
        assert_eq!(of("xxxx", Some(2)), []);
        assert_eq!(of("xxxx", None), []);
        assert_eq!(of("", None), []);
    }
}
