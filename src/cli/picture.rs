//! Files of a picture: OpenEXR, tone-mapped PNG, and PNGs of the layers that are meant to be shown.

use super::exit::Failure;
use crate::film::{Film, false_colour, write_exr, write_png, write_srgb8};
use std::path::Path;

/// Writes a picture to `exr`, then to a PNG by a factor on radiance; returns a line that says so.
pub fn write(exr: &Path, png: Option<(&Path, f32)>, mut film: Film) -> Result<String, Failure> {
    let said = describe(exr, png, &mut film);
    write_exr(exr, &film).map_err(Failure::output)?;
    write_previews(png, &film)?;
    Ok(said)
}

/// The same with the OpenEXR file last: where it is, the others are.
pub fn write_exr_last(exr: &Path, png: Option<(&Path, f32)>, mut film: Film) -> Result<String, Failure> {
    let said = describe(exr, png, &mut film);
    write_previews(png, &film)?;
    write_exr(exr, &film).map_err(Failure::output)?;
    Ok(said)
}

/// Stores the exposure of the PNG in the film; returns a line that names the files.
fn describe(exr: &Path, png: Option<(&Path, f32)>, film: &mut Film) -> String {
    let mut said = format!("wrote {}", exr.display());
    if let Some((path, factor)) = png {
        film.metadata.set("png_exposure", f64::from(factor.log2()));
        said += &format!(" and {} (exposure {:+.2} EV)", path.display(), factor.log2());
    }
    said
}

fn write_previews(png: Option<(&Path, f32)>, film: &Film) -> Result<(), Failure> {
    let Some((path, factor)) = png else { return Ok(()) };
    write_png(path, &film.color, factor).map_err(Failure::output)?;
    write_layers(path, film, factor)
}

/// Writes every layer that is meant to be shown as a PNG file named after the picture's.
fn write_layers(picture: &Path, film: &Film, factor: f32) -> Result<(), Failure> {
    for layer in &film.layers {
        if let Some(bytes) = false_colour::show(layer, &film.color, factor) {
            let path = picture.with_extension(format!("{}.png", layer.name));
            let size = [film.window.width, film.window.height];
            write_srgb8(&path, size, &bytes).map_err(Failure::output)?;
        }
    }
    Ok(())
}
