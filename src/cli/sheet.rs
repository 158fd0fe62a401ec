//! `lightsplat sheet`: puts thumbnails of the frames of a walk on one image.

use super::args::SheetArgs;
use super::exit::Failure;
use super::outputs::{Inputs, check_name};
use super::talk;
use anyhow::anyhow;
use base::film::{atomic, write_srgb8};
use image::imageops::{overlay, replace, thumbnail};
use image::{DynamicImage, RgbImage, Rgba, RgbaImage};

/// Gap between frames in pixels.
const GAP: u32 = 4;
/// Grey level of the gaps.
const GREY: u8 = 32;
/// Approximate aspect ratio of a sheet.
const ASPECT: f64 = 16.0 / 9.0;
/// Maximum number of pixels of a sheet.
const MAX_PIXELS: u64 = 1 << 28;

/// Runs the command.
pub fn run(args: SheetArgs) -> Result<(), Failure> {
    check_name(&args.output, "png", "--output", "for PNG")?;
    atomic::check_writable(&args.output).map_err(Failure::output)?;
    let picture_of = |number| args.names.file(number).with_extension("png");
    Inputs::new(args.frames.iter().map(picture_of)).check_apart([args.output.as_path()])?;
    let count = args.frames.iter().len() as u32;
    let mut sheet: Option<Sheet> = None;
    for (place, number) in (0..).zip(args.frames.iter()) {
        let path = picture_of(number);
        let picture = image::open(&path).map_err(|error| {
            Failure::input(anyhow!(
                "{}: {error}; a sheet needs the PNG files of all its frames",
                path.display()
            ))
        })?;
        let picture = on_grey(picture);
        let sheet = match &mut sheet {
            Some(sheet) => sheet,
            None => sheet.insert(Sheet::new(count, args.columns, args.width, picture.dimensions())?),
        };
        sheet.put(place, &picture);
    }
    let Some(Sheet { image, .. }) = sheet else { return Ok(()) };
    let size = [image.width(), image.height()];
    write_srgb8(&args.output, size, image.as_raw()).map_err(Failure::output)?;
    talk::wrote(&format!("wrote {} with {count} frames", args.output.display()), &[args.output]);
    Ok(())
}

/// Returns a frame, with grey behind a transparent background.
fn on_grey(picture: DynamicImage) -> RgbImage {
    let mut ground = RgbaImage::from_pixel(picture.width(), picture.height(), Rgba([GREY, GREY, GREY, 255]));
    overlay(&mut ground, &picture.into_rgba8(), 0, 0);
    DynamicImage::ImageRgba8(ground).into_rgb8()
}

/// Sheet of frames in rows, from left to right and top to bottom.
struct Sheet {
    image: RgbImage,
    columns: u32,
    /// Width and height of a frame on the sheet.
    cell: [u32; 2],
}

impl Sheet {
    /// Builds an empty sheet for `count` frames with the aspect ratio of the first.
    ///
    /// # Errors
    /// If the sheet would be too large.
    fn new(count: u32, columns: Option<u32>, width: u32, first: (u32, u32)) -> Result<Sheet, Failure> {
        let width = width.min(first.0);
        let height = (f64::from(first.1) * f64::from(width) / f64::from(first.0)).round().max(1.0) as u32;
        let shape = f64::from(height) / f64::from(width);
        let columns = columns.unwrap_or_else(|| (f64::from(count) * ASPECT * shape).sqrt().round() as u32);
        let columns = columns.clamp(1, count);
        let side = |cells: u32, size: u32| u64::from(cells) * u64::from(size + GAP) + u64::from(GAP);
        let sides = [side(columns, width), side(count.div_ceil(columns), height)];
        if sides[0].saturating_mul(sides[1]) > MAX_PIXELS {
            return Err(Failure::usage(anyhow!(
                "a sheet of {count} frames would have {} x {} pixels; use fewer --frames or a smaller --width",
                sides[0],
                sides[1]
            )));
        }
        let [w, h] = sides.map(|side| side as u32);
        Ok(Sheet { image: RgbImage::from_pixel(w, h, image::Rgb([GREY; 3])), columns, cell: [width, height] })
    }

    /// Puts a frame at its place.
    fn put(&mut self, place: u32, picture: &RgbImage) {
        let [width, height] = self.cell;
        let at = |index: u32, size: u32| i64::from(GAP + index * (size + GAP));
        let (x, y) = (at(place % self.columns, width), at(place / self.columns, height));
        replace(&mut self.image, &thumbnail(picture, width, height), x, y);
    }
}
