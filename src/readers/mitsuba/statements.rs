//! Statements of Mitsuba XML: elements, plugins, and the parameters of plugins. The name of a parameter's row is
//! `plugin: parameter`, in the spelling of 3.x.
//!
//! The reader consults the tables for parameters that have no effect, and names every other parameter that nothing asks
//! for.

use crate::statements::{self, Fate, Statement};

/// Headings of the page by tag of the objects. The page has a further table of elements.
pub(super) const HEADINGS: [(&str, &str); 9] = [
    ("integrator", "Mitsuba XML: integrators"),
    ("sensor", "Mitsuba XML: sensors"),
    ("film", "Mitsuba XML: films"),
    ("sampler", "Mitsuba XML: samplers"),
    ("rfilter", "Mitsuba XML: reconstruction filters"),
    ("shape", "Mitsuba XML: shapes"),
    ("emitter", "Mitsuba XML: emitters"),
    ("bsdf", "Mitsuba XML: BSDFs"),
    ("texture", "Mitsuba XML: textures and spectra"),
];

/// Returns what becomes of a plugin's parameter.
pub(super) fn fate_of_parameter(tag: &str, plugin: &str, parameter: &str) -> Fate {
    statements::fate(table(tag), &format!("{plugin}: {parameter}"))
}

/// Returns what becomes of a plugin.
pub(super) fn fate_of_plugin(tag: &str, plugin: &str) -> Fate {
    statements::fate(table(tag), plugin)
}

/// Returns the table of the objects with tag `tag`; an empty one if they are not supported.
fn table(tag: &str) -> &'static [Statement] {
    HEADINGS.iter().find(|(of, _)| *of == tag).map_or(&[], |(_, heading)| statements::table(heading))
}
