//! Settings of the integrator that change the expected picture: the maximum path length, and hidden emitters.
//!
//! An integrator may nest another one, as `aov` and `moment` do. The settings are then those of the innermost one.
//!
//! Deviations: `--method` chooses how light is found, whatever the integrator.

use super::converter::Converter;
use super::statements::fate_of_plugin;
use super::tree::Object;
use crate::error::SceneError;
use crate::statements::Fate;

/// Maximum nesting of integrators.
const MAX_NESTED: u32 = 8;

/// Integrators that nest the one whose picture they extend.
const WRAPPERS: [&str; 6] = ["aov", "moment", "stokes", "multichannel", "adaptive", "irrcache"];

/// Settings of an integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct IntegratorSettings {
    /// Maximum path length in edges; `None` for no limit.
    pub max_depth: Option<u32>,
    /// True if the camera does not see emitters directly.
    pub hides_emitters: bool,
}

impl Converter<'_> {
    /// Returns the settings of the scene's integrator.
    pub(super) fn integrator(&mut self) -> Result<IntegratorSettings, SceneError> {
        match self.first(&self.document.root, "integrator")? {
            Some(integrator) => self.settings(&integrator, 0),
            None => Ok(IntegratorSettings::default()),
        }
    }

    /// Returns the settings of an integrator inside `depth` others.
    fn settings(&mut self, integrator: &Object, depth: u32) -> Result<IntegratorSettings, SceneError> {
        if depth > MAX_NESTED {
            return Err(integrator.place.wrong("integrators refer to each other", "break the cycle"));
        }
        let plugin = integrator.plugin.as_str();
        let is_wrapper = WRAPPERS.contains(&plugin);
        if fate_of_plugin("integrator", plugin) == Fate::Named {
            let stands_in = match is_wrapper {
                true => "the image of the nested integrator is rendered",
                false => "the light of all paths is rendered",
            };
            self.log.warn(
                &integrator.place,
                format!("the integrator \"{plugin}\" is not supported"),
                stands_in,
            )?;
        }
        let settings = if is_wrapper {
            self.of_nested(integrator, depth)?
        } else {
            if !matches!(plugin, "path" | "direct") && fate_of_plugin("integrator", plugin) == Fate::Read {
                let what = format!("the integrator \"{plugin}\" computes the same light in another way");
                self.log.note(&integrator.place, what, "--method chooses the way");
            }
            let is_direct = plugin.starts_with("direct");
            IntegratorSettings {
                max_depth: if is_direct { Some(2) } else { max_depth(integrator)? },
                hides_emitters: integrator.boolean("hide_emitters", false)?,
            }
        };
        integrator.report_unused(self.log)?;
        Ok(settings)
    }

    /// Returns the settings of the integrator inside a wrapper.
    fn of_nested(&mut self, wrapper: &Object, depth: u32) -> Result<IntegratorSettings, SceneError> {
        if let Some(channels) = wrapper.string("aovs")? {
            let what = format!("the channels \"{channels}\" are not supported");
            self.log.warn(&wrapper.place, what, "they are not written")?;
        }
        match self.first(wrapper, "integrator")? {
            Some(nested) => self.settings(&nested, depth + 1),
            None => {
                let what = format!("the integrator \"{}\" nests no other", wrapper.plugin);
                self.log.warn(&wrapper.place, what, "the light of all paths is rendered")?;
                Ok(IntegratorSettings::default())
            }
        }
    }
}

/// Returns the maximum path length in edges; `None` for no limit.
fn max_depth(integrator: &Object) -> Result<Option<u32>, SceneError> {
    match integrator.integer("max_depth")? {
        None | Some(-1) => Ok(None),
        Some(depth) if depth < 1 => {
            let remedy = "give 1 for emitters alone, or more, or -1 for no limit";
            Err(integrator.place.wrong(format!("max_depth is {depth}"), remedy))
        }
        Some(depth) => Ok(Some(u32::try_from(depth).unwrap_or(u32::MAX))),
    }
}
