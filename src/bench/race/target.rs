//! Qualities that times are measured to.

use crate::study::{Bounded, Errors, rmse_of_psnr, time_to};
use serde::Serialize;
use std::fmt;

/// A quality.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// PSNR of the displayed picture, dB.
    Psnr(f64),
    /// Mean FLIP of the displayed picture.
    Flip(f64),
}

/// All of them.
pub const TARGETS: [Target; 5] =
    [Target::Psnr(35.0), Target::Psnr(40.0), Target::Psnr(45.0), Target::Flip(0.08), Target::Flip(0.05)];

impl Target {
    /// Returns a picture's error of its kind, which falls as pictures get better: for PSNR the root mean square.
    pub fn error(self, errors: &Errors) -> f64 {
        match self {
            Target::Psnr(_) => errors.displayed_rmse(),
            Target::Flip(_) => errors.flip,
        }
    }

    /// Returns the time to it by the times and errors of a method's pictures.
    pub fn time(self, pictures: &[(f64, f64)]) -> Option<Bounded> {
        let error = match self {
            Target::Psnr(psnr) => rmse_of_psnr(psnr),
            Target::Flip(flip) => flip,
        };
        time_to(error, pictures)
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Target::Psnr(psnr) => write!(f, "PSNR {psnr}"),
            Target::Flip(flip) => write!(f, "FLIP {flip}"),
        }
    }
}
