//! Inputs of all stages of a frame.

use super::finish::Finish;
use crate::method::LightStore;
use base::progress::Control;
use world::World;
use world::view::View;

/// Inputs of all stages of a frame.
#[derive(Clone, Copy)]
pub struct FrameContext<'a> {
    /// The scene.
    pub world: &'a World,
    /// Virtual lights and photons of the session.
    pub lights: &'a LightStore,
    /// Camera and window.
    pub view: &'a View,
    /// Stages after the method's own.
    pub finish: &'a Finish<'a>,
    /// Progress and cancellation.
    pub control: &'a Control,
}
