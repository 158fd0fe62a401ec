//! The integrator's maximum path length.
//!
//! Only this property and `hide_emitters` affect the expected image.

use super::converter::Converter;
use super::tree::Object;
use crate::error::SceneError;

impl Converter<'_> {
    /// Returns the maximum path length in edges; `None` for no limit.
    pub(super) fn max_depth(&mut self, integrator: &Object) -> Result<Option<u32>, SceneError> {
        if integrator.plugin == "direct" {
            return Ok(Some(2));
        }
        match integrator.integer("max_depth")? {
            None | Some(-1) => Ok(None),
            Some(depth) if depth < 1 => {
                let remedy = "give 1 for emitters alone, or more, or -1 for no limit";
                Err(integrator.place.wrong(format!("max_depth is {depth}"), remedy))
            }
            Some(depth) => Ok(Some(u32::try_from(depth).unwrap_or(u32::MAX))),
        }
    }
}
