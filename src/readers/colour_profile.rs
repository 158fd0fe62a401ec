//! Colour profiles of image files. They are not read: colours count as sRGB, and a warning names another profile.
//!
//! The rules of glTF ask for that (glTF 2.0 specification, section 3.8.3), and Mitsuba does so. No warning names the
//! profiles of their images.
//!
//! Profiles stand in chunks of PNG (`cICP`, `iCCP`, `sRGB`, `gAMA` and `cHRM`, the first of which counts), and as ICC
//! profiles in JPEG and WebP. An ICC profile counts as sRGB if it maps codes to about the colours that they have in
//! sRGB. So do exponents of 2.2.

use super::decode::srgb_to_linear;
use super::error::{Location, Warning};
use image::{ImageDecoder, ImageReader};
use moxcms::{ColorProfile, DataColorSpace, Layout, ProfileText, TransformOptions};
use png::{Info, SourceChromaticities};
use std::io::Cursor;
use std::path::Path;

/// Maximum difference of a linear value from that of sRGB. An exponent of 2.2 differs by up to 0.011, with rounding.
const MAX_DIFFERENCE: f32 = 0.015;
/// Maximum difference of a chromaticity from that of sRGB.
const MAX_CHROMATICITY: f32 = 0.002;
/// Exponent that files of sRGB state.
const GAMMA: f32 = 1.0 / 2.2;
/// Maximum difference from that exponent.
const MAX_GAMMA: f32 = 0.01;

/// Returns a warning if the image `path` has a colour profile other than sRGB; `place` refers to it.
pub(crate) fn warning(bytes: &[u8], path: &Path, place: &Location) -> Option<Warning> {
    let format = place.path.extension().unwrap_or_default().to_ascii_lowercase();
    if ["gltf", "glb", "xml"].iter().any(|ignoring| format == *ignoring) {
        return None;
    }
    let what = format!("{}: {} is not read", path.display(), other_than_srgb(bytes)?);
    Some(Warning::new(place.clone(), what, "colours count as sRGB; convert the image to sRGB"))
}

/// Returns the name of the colour profile of an image, if it has one that is not sRGB.
fn other_than_srgb(bytes: &[u8]) -> Option<String> {
    if bytes.starts_with(b"\x89PNG") {
        let reader = png::Decoder::new(Cursor::new(bytes)).read_info().ok()?;
        return of_png(reader.info());
    }
    // The start of the files of JPEG and of WebP. Other formats have no profile, or one that is hardly ever there.
    if !(bytes.starts_with(b"\xFF\xD8\xFF") || bytes.starts_with(b"RIFF")) {
        return None;
    }
    let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().ok()?;
    let profile = reader.into_decoder().ok()?.icc_profile().ok()??;
    of_icc(&profile)
}

fn of_png(info: &Info) -> Option<String> {
    if let Some(code) = info.coding_independent_code_points {
        // Primaries of Rec. 709, and the curve of sRGB (ITU-T H.273).
        let (primaries, curve) = (code.color_primaries, code.transfer_function);
        let name = || format!("the colour profile of primaries {primaries} and curve {curve} (cICP)");
        return ((primaries, curve) != (1, 13)).then(name);
    }
    if let Some(profile) = &info.icc_profile {
        return of_icc(profile);
    }
    if info.srgb.is_some() {
        return None;
    }
    let gamma = info.gama_chunk.map(|gamma| gamma.into_value());
    if let Some(gamma) = gamma.filter(|gamma| !((gamma - GAMMA).abs() <= MAX_GAMMA)) {
        return Some(format!("the exponent {gamma} (gAMA)"));
    }
    let is_other = info.chrm_chunk.is_some_and(|own| distance_from_srgb(&own) > MAX_CHROMATICITY);
    is_other.then(|| "the colour profile of its primaries (cHRM)".to_owned())
}

/// Returns the maximum difference of a coordinate from that of sRGB.
fn distance_from_srgb(own: &SourceChromaticities) -> f32 {
    [
        (own.white, [0.3127, 0.3290]),
        (own.red, [0.64, 0.33]),
        (own.green, [0.30, 0.60]),
        (own.blue, [0.15, 0.06]),
    ]
    .into_iter()
    .flat_map(|((x, y), [u, v])| [x.into_value() - u, y.into_value() - v])
    .fold(0.0, |most, difference| most.max(difference.abs()))
}

fn of_icc(bytes: &[u8]) -> Option<String> {
    let Ok(profile) = ColorProfile::new_from_slice(bytes) else {
        return Some("a damaged colour profile".to_owned());
    };
    let name = match &profile.description {
        Some(ProfileText::PlainString(name)) => name.as_str(),
        Some(ProfileText::Localizable(names)) => names.first().map_or("", |name| name.value.as_str()),
        Some(ProfileText::Description(name)) => name.ascii_string.as_str(),
        None => "",
    };
    let name = name.trim_matches(['\0', ' ']);
    (!is_srgb(&profile)).then(|| format!("the colour profile \"{name}\""))
}

/// Returns true if a profile maps codes to about the colours that they have in sRGB.
fn is_srgb(profile: &ColorProfile) -> bool {
    let (layout, channels) = match profile.color_space {
        DataColorSpace::Rgb => (Layout::Rgb, 3),
        DataColorSpace::Gray => (Layout::Gray, 1),
        _ => return false,
    };
    let options = TransformOptions::default();
    let transform = profile.create_transform_8bit(layout, &ColorProfile::new_srgb(), Layout::Rgb, options);
    let Ok(transform) = transform else { return false };
    let of = |[r, g, b]: [u8; 3]| {
        let mut mapped = [0; 3];
        let code = if channels == 3 { [r, g, b] } else { [g; 3] };
        let linear = |code: u8| srgb_to_linear(f32::from(code) / 255.0);
        transform.transform(&code[..channels], &mut mapped).is_ok()
            && code.iter().zip(mapped).all(|(a, b)| (linear(*a) - linear(b)).abs() <= MAX_DIFFERENCE)
    };
    let greys = (1..16).map(|step| [16 * step; 3]);
    greys.chain([[200, 60, 40], [60, 200, 40], [40, 60, 200], [220, 210, 90]]).all(of)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LoadOptions, load};
    use image::codecs::jpeg::JpegEncoder;
    use image::{DynamicImage, ImageEncoder, ImageFormat, RgbImage};
    use png::{CodingIndependentCodePoints, ScaledFloat, SrgbRenderingIntent};

    /// Returns a PNG of a pixel whose header is changed.
    fn png(change: impl FnOnce(&mut Info)) -> Vec<u8> {
        let mut info = Info::with_size(1, 1);
        info.color_type = png::ColorType::Rgb;
        change(&mut info);
        let mut bytes = Vec::new();
        let writer = png::Encoder::with_info(&mut bytes, info).unwrap().write_header();
        writer.unwrap().write_image_data(&[200, 60, 40]).unwrap();
        bytes
    }

    fn with_icc(profile: &ColorProfile) -> Vec<u8> {
        let icc = profile.encode().unwrap();
        png(|info| info.icc_profile = Some(icc.into()))
    }

    fn grey(gamma: f32) -> ColorProfile {
        ColorProfile::new_gray_with_gamma(gamma)
    }

    #[test]
    fn profiles_of_srgb_are_no_trouble() {
        let chromaticities =
            SourceChromaticities::new((0.3127, 0.329), (0.64, 0.33), (0.3, 0.6), (0.15, 0.06));
        for file in [
            png(|_| ()),
            png(|info| info.srgb = Some(SrgbRenderingIntent::Perceptual)),
            png(|info| info.source_gamma = Some(ScaledFloat::new(0.45455))),
            png(|info| info.source_chromaticities = Some(chromaticities)),
            with_icc(&ColorProfile::new_srgb()),
            with_icc(&grey(2.2)),
        ] {
            assert_eq!(other_than_srgb(&file), None);
        }
        let jpeg = DynamicImage::from(RgbImage::new(8, 8));
        let mut bytes = Cursor::new(Vec::new());
        jpeg.write_to(&mut bytes, ImageFormat::Jpeg).unwrap();
        assert_eq!(other_than_srgb(bytes.get_ref()), None);
        assert_eq!(other_than_srgb(b"RIFF"), None);
    }

    #[test]
    fn a_file_is_named_once_and_for_its_colours_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.toml");
        std::fs::write(
            folder.path().join("linear.png"),
            png(|info| info.source_gamma = Some(ScaledFloat::new(1.0))),
        )
        .unwrap();
        let named = |materials: &str| {
            let text = format!(
                "camera = {{ origin = [0, 0, 5], target = [0, 0, 0] }}\nenvironment = {{ radiance = 1 }}\n\
                 material = [{{ name = \"m\", kind = \"diffuse\", {materials} }}]\n\
                 mesh = [{{ shape = \"rectangle\", material = \"m\" }}]\n"
            );
            std::fs::write(&path, text).unwrap();
            let load = |strict| load(&path, &LoadOptions { strict, ..LoadOptions::default() });
            let warnings = load(false).unwrap().warnings;
            assert_eq!(load(true).is_err(), !warnings.is_empty());
            warnings.iter().map(|warning| warning.to_string()).collect::<Vec<_>>()
        };
        assert!(named("reflectance = 0.5, normal_map = \"linear.png\"").is_empty());
        let one = named(
            "reflectance = \"linear.png\", opacity = { file = \"linear.png\", wrap = \"mirror\" }, \
             normal_map = \"linear.png\"",
        );
        assert!(
            one.len() == 1 && one[0].contains("linear.png: the exponent 1 (gAMA) is not read"),
            "{one:?}"
        );
        let linear = std::fs::read(folder.path().join("linear.png")).unwrap();
        let of = |scene: &str| warning(&linear, Path::new("linear.png"), &Location::file(Path::new(scene)));
        assert!(of("a.mtl").is_some() && of("a.xml").is_none() && of("a.GLB").is_none());
    }

    #[test]
    fn other_profiles_are_named() {
        let says = |file: Vec<u8>, part: &str| {
            let name = other_than_srgb(&file).unwrap_or_else(|| panic!("{part}"));
            assert!(name.contains(part), "{name}");
        };
        let wide = SourceChromaticities::new((0.3127, 0.329), (0.68, 0.32), (0.265, 0.69), (0.15, 0.06));
        says(png(|info| info.source_gamma = Some(ScaledFloat::new(1.0))), "exponent 1 (gAMA)");
        says(png(|info| info.source_chromaticities = Some(wide)), "cHRM");
        says(png(|info| info.icc_profile = Some(vec![1, 2, 3].into())), "damaged");
        says(with_icc(&ColorProfile::new_display_p3()), "Display P3");
        says(with_icc(&ColorProfile::new_adobe_rgb()), "Adobe RGB");
        says(with_icc(&grey(1.0)), "colour profile");
        let mut info = Info::with_size(1, 1);
        let mut of_code = |color_primaries, transfer_function| {
            info.coding_independent_code_points = Some(CodingIndependentCodePoints {
                color_primaries,
                transfer_function,
                matrix_coefficients: 0,
                is_video_full_range_image: true,
            });
            of_png(&info)
        };
        assert!(of_code(9, 16).is_some_and(|name| name.contains("primaries 9 and curve 16 (cICP)")));
        assert_eq!(of_code(1, 13), None);
        let mut jpeg = Vec::new();
        let mut encoder = JpegEncoder::new(&mut jpeg);
        encoder.set_icc_profile(ColorProfile::new_display_p3().encode().unwrap()).unwrap();
        encoder.write_image(&[0; 192], 8, 8, image::ExtendedColorType::Rgb8).unwrap();
        says(jpeg, "Display P3");
    }
}
