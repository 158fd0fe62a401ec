//! Scenes and settings at extremes, a module for each of them: images are right, or refused with a reason.

mod brightness;
mod chains;
mod distances;
mod memory;
mod numbers;
mod random;
mod random_scenes;
mod settings;
mod units;
