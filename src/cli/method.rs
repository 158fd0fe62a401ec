//! The method chosen, with its settings.

use super::args::{MethodName, RenderArgs};
use super::exit::Failure;
use crate::eye::Window;
use crate::method::{Control, Output, path};
use crate::world::World;
use serde_json::{Value, json};

/// A method and everything it needs to know besides the scene.
#[derive(Clone, Copy, Debug)]
pub enum Method {
    /// Path tracing.
    Path(path::Settings),
}

impl Method {
    /// From what was typed.
    pub fn new(args: &RenderArgs) -> Result<Method, Failure> {
        match args.method {
            MethodName::Path => {
                let spp = args.spp.unwrap_or(path::Settings::default().spp);
                Ok(Method::Path(path::Settings { spp, seed: args.seed, max_depth: args.max_depth }))
            }
        }
    }

    /// The name under which the user chooses it.
    pub fn name(&self) -> &'static str {
        match self {
            Method::Path(_) => "path",
        }
    }

    /// Samples a pixel.
    pub fn spp(&self) -> u32 {
        match self {
            Method::Path(settings) => settings.spp,
        }
    }

    /// The seed.
    pub fn seed(&self) -> u32 {
        match self {
            Method::Path(settings) => settings.seed,
        }
    }

    /// The settings by name, for the picture's metadata and the statistics.
    pub fn settings(&self) -> Value {
        match self {
            Method::Path(s) => json!({ "spp": s.spp, "seed": s.seed, "max_depth": s.max_depth }),
        }
    }

    /// Renders `window`.
    pub fn render(&self, world: &World, window: &Window, control: &Control) -> Output {
        match self {
            Method::Path(settings) => path::render(world, window, settings, control),
        }
    }
}
