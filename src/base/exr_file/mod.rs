//! Reader of OpenEXR files, for pictures that a scene names and for files that commands edit.
//!
//! [`ExrSource`] opens a file and reads channels of its flat parts. [`picture_channels`] chooses the channels that are
//! the picture. [`read_picture`] returns them as linear Rec. 709 colours.
//!
//! Source: *OpenEXR File Layout* and *Technical Introduction to OpenEXR*, Academy Software Foundation.
//!
//! Deviations: deep data is refused. Subsampled channels under B44 compression are refused.

mod channels;
mod error;
mod picture;
mod primaries;
mod source;
mod subsampled;
#[cfg(test)]
mod tests;

pub use channels::{ColourModel, NoPicture, PartNames, PictureChannels, picture_channels};
pub use error::ExrError;
pub use picture::{ExrPicture, from_luma_chroma, read_picture};
pub use primaries::{Primaries, REC_709};
pub use source::{ExrSource, views};
