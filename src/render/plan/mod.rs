//! Settings planned for a goal: a time, or an error.
//!
//! | | goal | plan | result |
//! |---|---|---|---|
//! | [`for_time`] | seconds of the run | small renders and a model of their time | the wall clock |
//! | [`for_error`] | relative RMS error | renders of rising cost, compared with paths | measured on the image |
//!
//! Both move along the quality scale of the method ([`Ladder`]). Settings given by the user are pinned.
//!
//! If the user leaves the method open, a [`Chooser`] chooses the cache or denoised paths first.
//!
//! The settings for a time depend on the machine and on its other load, so two runs may differ. The settings for an
//! error do not: the same input gives the same settings and bits. Either way the settings are reported, and give the
//! same image again when typed.

mod bracket;
mod choice;
mod error;
mod ladder;
mod pilot;
mod time;
mod time_model;
mod trials;
mod work;

pub use choice::{Chooser, MethodChoice, Reason};
pub use error::{ErrorGoal, PlannedImage, for_error};
pub use ladder::{DRAFT, FINAL, Ladder, PREVIEW, REFERENCE};
pub use time::{Deadline, LATE, TimePlan, for_time};
pub use trials::smaller;
