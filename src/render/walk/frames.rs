//! Lists of frames: `7`, `1-10`, `1-100x5` (every fifth), `1,5,9-12`. Frames count from 1.
//!
//! The forms of other programs mean the same: `1..10`, `1:10`, and `1-100:5` or `1:100:5` for a step.

use scene::MAX_FRAMES;
use std::str::FromStr;

/// Frames in ascending order, without duplicates, at least one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameList(Vec<usize>);

impl FrameList {
    /// Iterates over the numbers of the frames.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = usize> {
        self.0.iter().copied()
    }

    /// Returns the last frame.
    pub fn last(&self) -> usize {
        self.0.last().copied().unwrap_or_default()
    }
}

impl FromStr for FrameList {
    type Err = String;

    fn from_str(text: &str) -> Result<FrameList, String> {
        let mut frames = Vec::new();
        for part in text.split(',') {
            let (first, last, step) = range(part.trim()).ok_or_else(|| {
                format!("`{part}` is not a frame or a range; write 7, 1-10, 1-100x5 or a list like 1,5,9-12")
            })?;
            if first == 0 {
                return Err("frames count from 1".to_owned());
            }
            if last < first || step == 0 {
                return Err(format!(
                    "`{part}` contains no frame; write the lower frame first, and a step of at least 1"
                ));
            }
            if last > MAX_FRAMES {
                return Err(format!("frame {last} is beyond {MAX_FRAMES}, the maximum length of a path"));
            }
            frames.extend((first..=last).step_by(step));
        }
        frames.sort_unstable();
        frames.dedup();
        Ok(FrameList(frames))
    }
}

/// Parses first frame, last frame and step of `A`, `A-B` or `A-BxS`. `..` or `:` may stand for `-`, and `:` for `x`.
fn range(text: &str) -> Option<(usize, usize, usize)> {
    let number = |text: &str| text.trim().parse::<usize>().ok();
    let between = ["..", "-", ":"].into_iter().find_map(|between| text.split_once(between));
    let Some((first, rest)) = between else {
        let only = number(text)?;
        return Some((only, only, 1));
    };
    let (last, step) = match rest.split_once(['x', 'X', ':']) {
        Some((last, step)) => (last, number(step)?),
        None => (rest, 1),
    };
    Some((number(first)?, number(last)?, step))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_ranges_and_lists_are_read_in_order_and_once() {
        let list = |text: &str| text.parse::<FrameList>().unwrap().0;
        assert_eq!(list("7"), [7]);
        assert_eq!(list("1-4"), [1, 2, 3, 4]);
        assert_eq!(list("1-100x30"), [1, 31, 61, 91]);
        assert_eq!(list("9-12, 1,5,10"), [1, 5, 9, 10, 11, 12]);
        assert_eq!(list(" 3 - 5 X 2 "), [3, 5]);
        for same in ["10..20", "10:20", "10-20", "10 .. 20", "10-20:1", "10:20:1", "10..20x1"] {
            assert_eq!(list(same), list("10-20x1"), "{same}");
        }
        for same in ["1-20:2", "1:20:2", "1..20:2", "1..20x2"] {
            assert_eq!(list(same), list("1-20x2"), "{same}");
        }
        assert_eq!("2-6x3".parse::<FrameList>().unwrap().last(), 5);
    }

    #[test]
    fn anything_else_is_refused_with_the_part_that_is_wrong() {
        let error = |text: &str| text.parse::<FrameList>().unwrap_err();
        for bad in [
            "",
            "a",
            "1-",
            "-3",
            "1,,2",
            "1-5x",
            "1-2-3",
            "1.5",
            "1..",
            "..4",
            "1...4",
            "1:",
            "1-5:",
            "1:2:3:4",
            "99999999999999999999999",
        ] {
            assert!(error(bad).contains("1-100x5"), "{bad}");
        }
        assert!(error("0-4").contains("count from 1"));
        assert!(error("5-4").contains("`5-4`") && error("1-4x0").contains("step"));
        assert!(error("1-99999999").contains("beyond"));
    }
}
