//! Images for display, with the transparency of their background.

use super::Image;
use crate::math::Rgb;

/// An image for display.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'a> {
    /// Radiance; premultiplied if the background is transparent.
    pub color: &'a Image,
    /// Share of each pixel that surfaces cover, if the background is transparent.
    pub alpha: Option<&'a Image<f32>>,
}

impl<'a> From<&'a Image> for Shown<'a> {
    fn from(color: &'a Image) -> Shown<'a> {
        Shown { color, alpha: None }
    }
}

impl<'a> Shown<'a> {
    /// Returns the mean radiance of the surfaces in each pixel, and the share of it that they cover, from 0 to 1.
    pub fn colors(self) -> impl Iterator<Item = (Rgb, f32)> + 'a {
        self.color.pixels.iter().enumerate().map(move |(i, &color)| match self.alpha {
            None => (color, 1.0),
            Some(alpha) => match alpha.pixels.get(i).copied().unwrap_or(1.0).clamp(0.0, 1.0) {
                alpha if alpha > 0.0 => (color / alpha, alpha),
                _ => (Rgb::ZERO, 0.0),
            },
        })
    }
}
