//! Studies: benchmarks that render whole images by several methods and judge them.
//!
//! A study asks questions ([`Question`]): which images to render, which errors to measure, and which table and figures
//! to show. An [`Answer`] holds the judged images.
//!
//! Every image is stored in the study's folder under a key of all it depends on (`store`), so that an interrupted run
//! resumes where it stopped, and a second run renders only missing images. References are path-traced in two
//! independent halves, whose difference estimates their noise (`reference`).
//!
//! Units: processor seconds over all threads, unless stated to be elapsed.

mod answer;
mod ask;
mod candidate;
mod cell;
mod counted;
mod equal;
mod error;
mod judge;
mod peers;
mod plan;
mod question;
mod reference;
mod run;
mod store;
mod subject;

pub use error::StudyError;
pub use peers::PeerFigure;
pub use plan::{Plan, ReferenceSettings, Study};
pub use subject::file_of;

pub(super) use candidate::{
    Candidate, Group, denoised_paths, eye_samples, photons_on_eye_samples, qualities,
};
pub(super) use cell::{Cell, bounded, figure, optional, seconds};
pub(super) use counted::Counted;
pub(super) use equal::{Bounded, time_to};
pub(super) use judge::{Errors, rmse_of_psnr};
pub(super) use question::{Answer, Column, Curve, Figure, Question, Shot, Truth};
pub(super) use reference::Reference;
pub(super) use run::Run;
pub(super) use subject::Subject;
