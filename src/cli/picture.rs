//! Files of an image: OpenEXR, the tone-mapped PNG, and PNG files of layers for display.

use super::exit::Failure;
use super::talk;
use base::film::{
    ExrFile, Film, Image, Look, Pixels, false_colour, write_exr, write_grey16, write_png, write_srgb8,
};
use base::stats::StageTime;
use render::session::{DEPTH, NO_DEPTH};
use std::path::{Path, PathBuf};

/// Files that have been written, with what there is to say of them.
pub struct Written {
    /// The files.
    pub files: Vec<PathBuf>,
    /// Names of the image's own files.
    names: String,
    /// Width and height in pixels.
    size: [u32; 2],
    /// Words for the exposure of the PNG.
    exposure: Option<String>,
}

impl Written {
    /// Returns the message of an image whose rendering took some time.
    pub fn said(&self, time: StageTime) -> String {
        let [width, height] = self.size;
        let seconds = time.wall_seconds;
        let exposure = self.exposure.as_ref().map_or(String::new(), |exposure| format!(", {exposure}"));
        format!("wrote {} ({width}x{height}, {seconds:.1} s{exposure})", self.names)
    }
}

/// Facts of an image that differ between equal renders.
const CIRCUMSTANCES: [&str; 2] = ["render_seconds", "threads"];

/// Removes the facts that differ between equal renders.
pub fn forget_circumstances(film: &mut Film) {
    CIRCUMSTANCES.iter().for_each(|key| film.metadata.remove(key));
}

/// Returns the file beside `path` for a partial image.
pub fn beside(path: &Path) -> PathBuf {
    let extension = path.extension().map(|extension| extension.to_string_lossy());
    path.with_extension(format!("partial.{}", extension.unwrap_or_default()))
}

/// Replaces what is not finite in the image of a file, or in its `layer`, and warns of it.
pub fn mend(path: &Path, layer: &str, image: &mut Image) {
    if let Some((count, first)) = image.mend_nonfinite() {
        warn_of_mended(path, layer, count, first);
    }
}

/// Replaces what is not finite in all layers of a file, and warns of it.
pub fn mend_all(path: &Path, file: &mut ExrFile) {
    for (layer, count, first) in file.mend_nonfinite() {
        warn_of_mended(path, &layer, count, first);
    }
}

fn warn_of_mended(path: &Path, layer: &str, count: usize, [column, row]: [u32; 2]) {
    let of_layer = if layer.is_empty() { String::new() } else { format!(" of the layer `{layer}`") };
    talk::warning(&format!(
        "{}: {count} pixels{of_layer} are NaN or infinite, the first in column {column}, row {row}; NaN counts as 0, \
         infinity as the largest half float; render the image again to remove the cause",
        path.display()
    ));
}

/// Returns true if the file is a partial image.
pub fn is_partial(exr: &Path) -> bool {
    ExrFile::read(exr).is_ok_and(|file| file.metadata().text("partial") == Some("true"))
}

/// Forms of the files of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Forms {
    /// True if colours, albedos and normals of the OpenEXR file are half floats.
    pub half: bool,
    /// Factor from depth to the numbers of a PNG file of 16 bits, if there is to be one.
    pub depth: Option<f32>,
}

/// Writes PNG files, if given, and then an image to `exr`, if given: if it exists after a kill, the others exist.
///
/// # Errors
/// If a file cannot be written. The others are written nevertheless.
pub fn write(
    exr: Option<&Path>,
    png: Option<(&Path, Look)>,
    mut film: Film,
    forms: Forms,
) -> Result<Written, Failure> {
    film.half = forms.half;
    let mut written = describe(exr, png, &mut film);
    let previews = write_previews(png, &film);
    let main = exr.or(png.map(|(path, _)| path));
    let depth = forms
        .depth
        .zip(main)
        .map(|(scale, main)| write_depth(&main.with_extension("depth.png"), scale, &film));
    if let Some(exr) = exr {
        write_exr(exr, &film).map_err(Failure::output)?;
    }
    written.files.extend(previews?);
    written.files.extend(depth.transpose()?.flatten());
    Ok(written)
}

/// Writes the layer of depth, times `scale`, as numbers of 16 bits. 0 stands for no surface. Returns the file, if there
/// is such a layer.
fn write_depth(path: &Path, scale: f32, film: &Film) -> Result<Option<PathBuf>, Failure> {
    let layer = film.layers.iter().find(|layer| layer.name == DEPTH).map(|layer| &layer.pixels);
    let Some(Pixels::Scalar(depth)) = layer else { return Ok(None) };
    // `as` saturates.
    let number = |depth: &f32| if *depth < NO_DEPTH { (depth * scale).round() as u16 } else { 0 };
    let numbers: Vec<u16> = depth.pixels.iter().map(number).collect();
    write_grey16(path, [depth.width, depth.height], &numbers).map_err(Failure::output)?;
    Ok(Some(path.to_owned()))
}

/// Stores the exposure of the PNG in the film. Returns what there is to say, and the OpenEXR file.
fn describe(exr: Option<&Path>, png: Option<(&Path, Look)>, film: &mut Film) -> Written {
    if let Some((_, look)) = png {
        film.metadata.set("png_exposure", f64::from(look.stops()));
        film.metadata.set("png_view", look.curve.name());
    }
    let names = exr.into_iter().chain(png.map(|(path, _)| path)).map(|path| path.display().to_string());
    Written {
        files: exr.map(Path::to_owned).into_iter().collect(),
        names: names.collect::<Vec<_>>().join(" and "),
        size: [film.window.width, film.window.height],
        exposure: png.map(|(_, look)| look.said()),
    }
}

/// Writes the PNG file, and a PNG file named after it for every layer for display. Returns the files.
fn write_previews(png: Option<(&Path, Look)>, film: &Film) -> Result<Vec<PathBuf>, Failure> {
    let Some((picture, look)) = png else { return Ok(Vec::new()) };
    write_png(picture, film.shown(), look).map_err(Failure::output)?;
    let mut files = vec![picture.to_owned()];
    for layer in &film.layers {
        if let Some(bytes) = false_colour::show(layer, &film.color, look.factor) {
            let path = picture.with_extension(format!("{}.png", layer.name));
            let size = [film.window.width, film.window.height];
            write_srgb8(&path, size, &bytes).map_err(Failure::output)?;
            files.push(path);
        }
    }
    Ok(files)
}
