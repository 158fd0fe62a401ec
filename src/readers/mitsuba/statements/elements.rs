//! Elements.

use super::row::{named, read, refused};
use crate::statements::Statement;

/// Elements of a description.
pub(in crate::mitsuba) const ELEMENTS: &[Statement] = &[
    read("default", "value of a `$parameter`, unless -D gives one"),
    read("alias", "second id of an object"),
    read("include", "contents of another file"),
    read("path", "folder in which files are searched first"),
    read("ref", "object by its id"),
    read("boolean", ""),
    read("integer", ""),
    read("float", ""),
    read("string", ""),
    read("point", ""),
    read("vector", ""),
    read("rgb", ""),
    read("srgb", "0.6: colour in sRGB"),
    read("color", "0.6: colour"),
    read("spectrum", "a value (a grey in lights of 0.6), red, green and blue, or wavelengths and values"),
    read("blackbody", "0.6: temperature and scale"),
    read("transform", ""),
    read("translate", ""),
    read("rotate", ""),
    read("scale", ""),
    read("lookat", "without `up`, turned as in Mitsuba 3"),
    read("matrix", "9 or 16 numbers"),
    read("integrator", ""),
    read("sensor", ""),
    read("film", ""),
    read("sampler", ""),
    read("rfilter", ""),
    read("shape", ""),
    read("emitter", ""),
    read("bsdf", ""),
    read("texture", ""),
    named("medium", "left out"),
    named("phase", "left out"),
    named("volume", "left out"),
    named("subsurface", "left out"),
    refused("animation", "nothing moves"),
];
