//! Open Image Denoise 2, loaded at run time: nothing links to it, and a program that can use it runs without, too.
//!
//! [`Device::load`] finds the library and makes its CPU device; [`Device::denoise`] runs the filter `RT` on a picture
//! in linear radiance, alone or guided by albedo and normals.
//!
//! Pictures are slices of three floats a pixel, in rows.

mod api;
mod device;
mod error;
mod locate;

pub use device::{Device, Picture, Quality, Version};
pub use error::Error;
