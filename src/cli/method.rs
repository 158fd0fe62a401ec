//! The method chosen, with its settings.

use super::args::{LightcutArgs, MethodName, RenderArgs, TreeFamily};
use super::exit::Failure;
use crate::eye::Window;
use crate::light_tree::Family;
use crate::method::{Control, Output, lightcuts, path};
use crate::world::World;
use anyhow::anyhow;
use serde_json::{Value, json};

/// A method and everything it needs to know besides the scene.
#[derive(Clone, Copy, Debug)]
pub enum Method {
    /// Path tracing.
    Path(path::Settings),
    /// Lightcuts per pixel.
    Lightcuts(lightcuts::Settings),
}

impl Method {
    /// From what was typed. An option of another method is an error: it would have no effect.
    pub fn new(args: &RenderArgs) -> Result<Method, Failure> {
        match args.method {
            MethodName::Path if args.lightcuts != LightcutArgs::default() => Err(Failure::usage(anyhow!(
                "--epsilon, --max-cut, --vpls, --direct-vpls, --clamp and --tree belong to --method lightcuts"
            ))),
            MethodName::Path => {
                let spp = args.spp.unwrap_or(path::Settings::default().spp);
                Ok(Method::Path(path::Settings { spp, seed: args.seed, max_depth: args.max_depth }))
            }
            MethodName::Lightcuts => Ok(Method::Lightcuts(lightcuts_settings(args))),
        }
    }

    /// The name under which the user chooses it.
    pub fn name(&self) -> &'static str {
        match self {
            Method::Path(_) => "path",
            Method::Lightcuts(_) => "lightcuts",
        }
    }

    /// Samples a pixel.
    pub fn spp(&self) -> u32 {
        match self {
            Method::Path(settings) => settings.spp,
            Method::Lightcuts(settings) => settings.spp,
        }
    }

    /// The seed.
    pub fn seed(&self) -> u32 {
        match self {
            Method::Path(settings) => settings.seed,
            Method::Lightcuts(settings) => settings.seed,
        }
    }

    /// The settings by the names of their options, for the picture's metadata and the statistics.
    pub fn settings(&self) -> Value {
        match self {
            Method::Path(s) => json!({ "spp": s.spp, "seed": s.seed, "max_depth": s.max_depth }),
            Method::Lightcuts(s) => json!({
                "spp": s.spp,
                "seed": s.seed,
                "max_depth": s.max_depth,
                "epsilon": decimal(s.cut.epsilon),
                "max_cut": s.cut.max_cut,
                "vpls": s.light.indirect,
                "direct_vpls": s.light.direct,
                "clamp": decimal(s.cut.clamp.unwrap_or(0.0)),
                "tree": match s.family {
                    Family::Divisive => "divisive",
                    Family::Agglomerative => "agglomerative",
                },
            }),
        }
    }

    /// Renders `window`.
    pub fn render(&self, world: &World, window: &Window, control: &Control) -> Output {
        match self {
            Method::Path(settings) => path::render(world, window, settings, control),
            Method::Lightcuts(settings) => lightcuts::render(world, window, settings, control),
        }
    }
}

/// The value with the digits that were typed, not those of its nearest f32.
fn decimal(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(value as f64)
}

fn lightcuts_settings(args: &RenderArgs) -> lightcuts::Settings {
    let mut settings =
        lightcuts::Settings { seed: args.seed, max_depth: args.max_depth, ..Default::default() };
    let typed = &args.lightcuts;
    settings.spp = args.spp.unwrap_or(settings.spp);
    settings.cut.epsilon = typed.epsilon.unwrap_or(settings.cut.epsilon);
    settings.cut.max_cut = typed.max_cut.map_or(settings.cut.max_cut, |n| n as usize);
    settings.light.indirect = typed.vpls.unwrap_or(settings.light.indirect);
    settings.light.direct = typed.direct_vpls.unwrap_or(settings.light.direct);
    if let Some(share) = typed.clamp {
        settings.cut.clamp = (share > 0.0).then_some(share);
    }
    settings.family = match typed.tree {
        Some(TreeFamily::Divisive) => Family::Divisive,
        Some(TreeFamily::Agglomerative) => Family::Agglomerative,
        None => settings.family,
    };
    settings
}
