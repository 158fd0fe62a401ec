//! Statements of Mitsuba XML: elements, plugins, and the parameters of plugins. The name of a parameter's row is
//! `plugin: parameter`, in the spelling of 3.x.
//!
//! The reader consults the tables for parameters that have no effect, and names every other parameter that nothing asks
//! for.

mod bsdfs;
mod elements;
mod emitters;
mod row;
mod shapes;
mod textures;
mod views;

use crate::statements::{self, Fate, Statement};

/// Tables by heading of the page and tag of the objects.
pub(super) const TABLES: [(&str, &str, &[Statement]); 10] = [
    ("Mitsuba XML: elements", "", elements::ELEMENTS),
    ("Mitsuba XML: integrators", "integrator", views::INTEGRATORS),
    ("Mitsuba XML: sensors", "sensor", views::SENSORS),
    ("Mitsuba XML: films", "film", views::FILMS),
    ("Mitsuba XML: samplers", "sampler", views::SAMPLERS),
    ("Mitsuba XML: reconstruction filters", "rfilter", views::FILTERS),
    ("Mitsuba XML: shapes", "shape", shapes::SHAPES),
    ("Mitsuba XML: emitters", "emitter", emitters::EMITTERS),
    ("Mitsuba XML: BSDFs", "bsdf", bsdfs::BSDFS),
    ("Mitsuba XML: textures and spectra", "texture", textures::TEXTURES),
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
    TABLES.iter().find(|(_, of, _)| *of == tag).map_or(&[], |(_, _, table)| table)
}
