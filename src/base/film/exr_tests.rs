//! Tests: written files are read back completely, in any shape; files of other programs are read.

use super::*;
use crate::film::Window;
use crate::math::Rgb;
use ::exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image as ExrImage, ImageAttributes, Layer as ExrLayer,
    LayerAttributes, Text, Vec2, WritableImage, f16,
};
use std::path::Path;

fn ramp(width: u32, height: u32) -> Image {
    let mut image = Image::new(width, height);
    for (i, pixel) in image.pixels.iter_mut().enumerate() {
        *pixel = Rgb::new(i as f32 * 0.37, 1e-30 + i as f32, 1e30 / (1.0 + i as f32));
    }
    image
}

#[test]
fn a_film_comes_back_bit_by_bit_with_its_layers_window_and_metadata() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.exr");
    let mut film = Film::new(ramp(37, 21));
    film.window = Window { film: [100, 60], offset: [11, 7], width: 37, height: 21 };
    let mut variance = ramp(37, 21);
    variance.pixels.reverse();
    film.layers.push(Layer::color("variance", variance.clone()));
    film.layers.push(Layer::vector("normal", film.color.clone()));
    film.layers.push(Layer::scalar("depth.Z", variance.map(|p| p.y)));
    film.layers.push(Layer::id("objectId", Image { width: 37, height: 21, pixels: (0..37 * 21).collect() }));
    film.camera = Some(CameraMatrices {
        world_to_camera: std::array::from_fn(|i| i as f32),
        world_to_ndc: std::array::from_fn(|i| -(i as f32)),
    });
    film.metadata.set("method", "path");
    film.metadata.set("scene", "Kathédrale — ναός");
    film.metadata.set("settings", "x".repeat(5000));
    film.metadata.set("spp", 64.0);
    film.metadata.set("seconds", 0.1);
    write_exr(&path, &film).unwrap();

    let file = ExrFile::read(&path).unwrap();
    assert_eq!(file.color().unwrap(), film.color);
    assert_eq!(file.layer("variance").unwrap(), variance);
    assert_eq!(file.layers(), ["", "variance"]);
    assert_eq!(file.layer("normal").unwrap(), film.color);
    assert_eq!(file.layer("depth.Z").unwrap(), variance.map(|p| Rgb::splat(p.y)));
    assert_eq!(file.layer("objectId").unwrap().pixels[500], Rgb::splat(500.0));
    let names = ["B", "G", "R", "depth.Z", "normal.X", "normal.Y", "normal.Z", "objectId"];
    let variance = ["variance.B", "variance.G", "variance.R"];
    assert_eq!(file.channels(), [&names[..], &variance].concat());
    assert_eq!(file.window(), film.window);
    assert_eq!(file.camera(), film.camera);
    let metadata = file.metadata();
    assert_eq!(metadata.iter().count(), 5);
    for (key, value) in film.metadata.iter() {
        assert_eq!(metadata.get(key), Some(value), "{key}");
    }
}

#[test]
fn extreme_shapes_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.exr");
    for (width, height) in [(1, 1), (1, 333), (333, 1), (16_384, 3), (2, 16_384)] {
        let film = Film::new(ramp(width, height));
        write_exr(&path, &film).unwrap();
        assert_eq!(read_exr(&path).unwrap(), film.color, "{width}x{height}");
    }
}

#[test]
fn a_film_whose_images_differ_in_size_is_refused_and_the_old_file_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.exr");
    std::fs::write(&path, "old").unwrap();
    let mut film = Film::new(ramp(4, 4));
    film.layers.push(Layer::color("variance", ramp(4, 5)));
    assert!(matches!(write_exr(&path, &film), Err(ImageError::Size { .. })));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
}

/// Writes a file of one part with channels of 2x2 pixels, as another program may.
fn foreign(path: &Path, part: Option<&str>, channels: Vec<(&str, FlatSamples)>) {
    let list = channels.into_iter().map(|(name, samples)| AnyChannel::new(name, samples)).collect();
    let attributes = LayerAttributes { layer_name: part.map(Text::from), ..LayerAttributes::default() };
    let layer = ExrLayer::new(Vec2(2, 2), attributes, Encoding::default(), AnyChannels::sort(list));
    ExrImage::new(ImageAttributes::with_size((2, 2)), layer).write().to_file(path).unwrap();
}

fn floats(value: f32) -> FlatSamples {
    FlatSamples::F32(vec![value; 4])
}

#[test]
fn halves_integers_layers_parts_and_luminance_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let half = FlatSamples::F16(vec![f16::from_f32(0.5); 4]);
    foreign(
        &path,
        None,
        vec![("R", half), ("G", floats(2.0)), ("B", FlatSamples::U32(vec![3; 4])), ("A", floats(1.0))],
    );
    assert_eq!(read_exr(&path).unwrap().pixels, [Rgb::new(0.5, 2.0, 3.0); 4]);

    let layered = ["diffuse.R", "diffuse.G", "diffuse.B"].map(|name| (name, floats(4.0)));
    foreign(&path, None, layered.to_vec());
    assert_eq!(read_exr(&path).unwrap().pixels, [Rgb::splat(4.0); 4]);

    foreign(&path, Some("beauty"), ["R", "G", "B"].map(|name| (name, floats(5.0))).to_vec());
    let file = ExrFile::read(&path).unwrap();
    assert_eq!(file.color().unwrap().pixels, [Rgb::splat(5.0); 4]);
    assert_eq!(file.layer("beauty").unwrap().pixels, [Rgb::splat(5.0); 4]);

    foreign(&path, None, vec![("Y", floats(6.0))]);
    assert_eq!(read_exr(&path).unwrap().pixels, [Rgb::splat(6.0); 4]);
}

#[test]
fn a_colour_replaced_leaves_channels_of_any_type_and_foreign_attributes_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let half = || FlatSamples::F16(vec![f16::from_f32(0.5); 4]);
    let mut channels = ["R", "G", "B"].map(|name| (name, half())).to_vec();
    channels.extend([
        ("Z", half()),
        ("id", FlatSamples::U32(vec![u32::MAX; 4])),
        ("variance.R", floats(2.0)),
    ]);
    foreign(&path, Some("view"), channels);
    let mut file = ExrFile::read(&path).unwrap();
    file.replace_color(&ramp(2, 2), Some("noisy")).unwrap();
    file.rename_layer("variance", "noisy.variance");
    file.set("denoised", "yes");
    file.rename_fact("denoised", "cleaned");
    assert!(matches!(file.replace_color(&ramp(4, 1), None), Err(ImageError::Size { .. })));
    file.write(&path).unwrap();

    let file = ExrFile::read(&path).unwrap();
    assert_eq!(file.color().unwrap(), ramp(2, 2));
    assert_eq!(file.layer("noisy").unwrap().pixels, [Rgb::splat(0.5); 4]);
    let names = ["B", "G", "R", "Z", "id", "noisy.B", "noisy.G", "noisy.R", "noisy.variance.R"];
    assert_eq!(file.channels(), names.map(|name| format!("view.{name}")));
    let list = &file.parts.layer_data[0].channel_data.list;
    assert_eq!((&list[3].sample_data, &list[5].sample_data), (&half(), &half()));
    assert_eq!(list[4].sample_data, FlatSamples::U32(vec![u32::MAX; 4]));
    assert_eq!(file.metadata().iter().count(), 1);
    assert_eq!(file.metadata().text("cleaned"), Some("yes"));
}

#[test]
fn grey_and_layered_colours_are_replaced_where_they_stand() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let new = Image { width: 2, height: 2, pixels: vec![Rgb::splat(3.0); 4] };
    let replaced = |channels: Vec<(&str, FlatSamples)>, kept| {
        foreign(&path, None, channels);
        let mut file = ExrFile::read(&path).unwrap();
        file.replace_color(&new, kept).unwrap();
        (file.channels(), file.color().unwrap().pixels[0])
    };
    let (channels, color) = replaced(vec![("Y", floats(6.0))], Some("noisy"));
    assert_eq!(channels, ["Y", "noisy.Y"]);
    assert!((color - Rgb::splat(3.0)).abs().max_element() < 1e-5);
    let blender = ["A.Combined.R", "A.Combined.G", "A.Combined.B", "A.Normal.R", "A.Normal.G", "A.Normal.B"];
    let (channels, color) = replaced(blender.map(|name| (name, floats(1.0))).to_vec(), None);
    assert_eq!((channels.len(), color), (6, Rgb::splat(3.0)));
}

#[test]
fn luminance_and_chroma_are_a_colour_that_is_replaced_by_rgb() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    // Luminance of (0.6, 0.3, 0.1) by Rec. 709.
    let y = 0.34934;
    let channels = [("BY", 0.1 / y - 1.0), ("RY", 0.6 / y - 1.0), ("Y", y)];
    foreign(&path, None, channels.map(|(name, value)| (name, floats(value))).to_vec());
    let mut file = ExrFile::read(&path).unwrap();
    let own = Rgb::new(0.6, 0.3, 0.1);
    let near = |a: Rgb| (a - own).abs().max_element() < 1e-4;
    assert!(near(file.color().unwrap().pixels[3]));
    file.replace_color(&ramp(2, 2), Some("noisy")).unwrap();
    file.write(&path).unwrap();
    let file = ExrFile::read(&path).unwrap();
    assert_eq!(file.color().unwrap(), ramp(2, 2));
    assert_eq!(file.channels(), ["B", "G", "R", "noisy.BY", "noisy.RY", "noisy.Y"]);
    assert!(near(file.layer("noisy").unwrap().pixels[0]));
}

#[test]
fn what_has_no_colour_is_an_error_that_lists_the_channels() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    foreign(&path, None, vec![("Z", floats(1.0)), ("normal.X", floats(1.0))]);
    let error = read_exr(&path).unwrap_err().to_string();
    assert!(error.contains("Z") && error.contains("normal.X"), "{error}");

    let two = ["a.R", "a.G", "a.B", "b.R", "b.G", "b.B"].map(|name| (name, floats(1.0)));
    foreign(&path, None, two.to_vec());
    assert!(matches!(read_exr(&path), Err(ImageError::NoPicture { .. })));
    let file = ExrFile::read(&path).unwrap();
    assert_eq!(file.layers(), ["a", "b"]);
    assert!(file.layer("c").unwrap_err().to_string().contains("layer `c`"));
}

#[test]
fn missing_foreign_truncated_and_flipped_files_are_errors_and_no_panic() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    assert!(matches!(read_exr(&path), Err(ImageError::Read { .. })));
    assert!(matches!(read_exr(folder.path()), Err(ImageError::Read { .. })));
    std::fs::write(&path, b"not a picture").unwrap();
    assert!(matches!(read_exr(&path), Err(ImageError::Decode { .. })));
    write_exr(&path, &Film::new(ramp(20, 20))).unwrap();
    let whole = std::fs::read(&path).unwrap();
    for length in [0, 3, 100, whole.len() / 2, whole.len() - 1] {
        std::fs::write(&path, &whole[..length]).unwrap();
        assert!(read_exr(&path).is_err(), "{length} bytes");
    }
    for at in 0..whole.len().min(600) {
        let mut flipped = whole.clone();
        flipped[at] ^= 0x15;
        std::fs::write(&path, &flipped).unwrap();
        let _any_outcome_but_a_panic = read_exr(&path);
    }
}
