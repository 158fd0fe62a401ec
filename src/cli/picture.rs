//! Files of a picture: OpenEXR, tone-mapped PNG, and PNGs of the layers that are meant to be shown.

use super::exit::Failure;
use base::film::{ExrFile, Film, false_colour, write_exr, write_png, write_srgb8};
use std::path::{Path, PathBuf};

/// Files that have been written, and a line that says so.
pub struct Written {
    /// The line.
    pub said: String,
    /// The files.
    pub files: Vec<PathBuf>,
}

/// Facts of a picture that differ between equal renders: time and machine.
const CIRCUMSTANCES: [&str; 2] = ["render_seconds", "threads"];

/// Takes those facts out, so that equal renders are equal files.
pub fn forget_circumstances(film: &mut Film) {
    CIRCUMSTANCES.iter().for_each(|key| film.metadata.remove(key));
}

/// File of a part of the picture at `path`, beside it.
pub fn beside(path: &Path) -> PathBuf {
    let extension = path.extension().map(|extension| extension.to_string_lossy());
    path.with_extension(format!("partial.{}", extension.unwrap_or_default()))
}

/// True if the file is a picture of which only a part has been rendered.
pub fn is_partial(exr: &Path) -> bool {
    ExrFile::read(exr).is_ok_and(|file| file.metadata().text("partial") == Some("true"))
}

/// Writes a picture to `exr`, then to a PNG by a factor on radiance.
pub fn write(exr: &Path, png: Option<(&Path, f32)>, mut film: Film) -> Result<Written, Failure> {
    let mut written = describe(exr, png, &mut film);
    write_exr(exr, &film).map_err(Failure::output)?;
    written.files.extend(write_previews(png, &film)?);
    Ok(written)
}

/// The same with the OpenEXR file last: where it is, the others are.
pub fn write_exr_last(exr: &Path, png: Option<(&Path, f32)>, mut film: Film) -> Result<Written, Failure> {
    let mut written = describe(exr, png, &mut film);
    written.files.extend(write_previews(png, &film)?);
    write_exr(exr, &film).map_err(Failure::output)?;
    Ok(written)
}

/// Stores the exposure of the PNG in the film; returns the line that names the files, and the first of them.
fn describe(exr: &Path, png: Option<(&Path, f32)>, film: &mut Film) -> Written {
    let mut said = format!("wrote {}", exr.display());
    if let Some((path, factor)) = png {
        film.metadata.set("png_exposure", f64::from(factor.log2()));
        said += &format!(" and {} (exposure {:+.2} EV)", path.display(), factor.log2());
    }
    Written { said, files: vec![exr.to_owned()] }
}

/// Writes the PNG, and beside it every layer that is meant to be shown as another, named after it; returns their files.
fn write_previews(png: Option<(&Path, f32)>, film: &Film) -> Result<Vec<PathBuf>, Failure> {
    let Some((picture, factor)) = png else { return Ok(Vec::new()) };
    write_png(picture, &film.color, factor).map_err(Failure::output)?;
    let mut files = vec![picture.to_owned()];
    for layer in &film.layers {
        if let Some(bytes) = false_colour::show(layer, &film.color, factor) {
            let path = picture.with_extension(format!("{}.png", layer.name));
            let size = [film.window.width, film.window.height];
            write_srgb8(&path, size, &bytes).map_err(Failure::output)?;
            files.push(path);
        }
    }
    Ok(files)
}
