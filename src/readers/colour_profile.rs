//! Colour profiles of image files, whose colours are converted to sRGB.
//!
//! Profiles stand in chunks of PNG (`cICP`, `iCCP`, `sRGB`, `gAMA` and `cHRM`, the first of which counts), and as ICC
//! profiles in JPEG and WebP. A profile counts as sRGB if it maps codes to about the colours that they have in sRGB. So
//! do exponents of 2.2.
//!
//! glTF (2.0 specification, section 3.8.3) and Mitsuba read all images as sRGB, whatever their profiles.

use super::error::{Location, Warning};
use glam::{DMat3, DVec3};
use image::{DynamicImage, ImageBuffer, ImageDecoder, ImageReader};
use moxcms::{
    Chromaticity, CicpColorPrimaries, CicpProfile, CmsError, ColorPrimaries, ColorProfile, DataColorSpace,
    Layout, MatrixCoefficients, TransferCharacteristics, Transform16BitExecutor, TransformOptions,
    curve_from_gamma,
};
use png::{Info, ScaledFloat};
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

/// Maximum difference of a linear value from that of sRGB. An exponent of 2.2 differs by up to 0.011, with rounding.
const MAX_DIFFERENCE: f32 = 0.015;
/// Greatest code of 16 bits.
const MAX_CODE: f32 = 65535.0;

/// Matrix from CIE XYZ to linear Rec. 709 (IEC 61966-2-1).
pub(crate) const XYZ_TO_RGB: DMat3 = DMat3::from_cols(
    DVec3::new(3.240479, -0.969256, 0.055648),
    DVec3::new(-1.537150, 1.875991, -0.204043),
    DVec3::new(-0.498535, 0.041556, 1.057311),
);

/// Converts an sRGB value to linear (IEC 61966-2-1).
pub(crate) fn srgb_to_linear(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Conversion of colours to sRGB.
pub(crate) struct Conversion {
    transform: Arc<Transform16BitExecutor>,
    is_grey: bool,
}

/// Returns a warning if the image `path` has a colour profile that cannot be used; `place` refers to it.
pub(crate) fn warning(bytes: &[u8], path: &Path, place: &Location) -> Option<Warning> {
    if ignores_profiles(place) {
        return None;
    }
    let error = profile(bytes).and_then(|own| own.as_ref().map(conversion).transpose()).err();
    let what = |error| format!("{}: the colour profile cannot be used: {error}", path.display());
    error.map(|error| {
        Warning::new(place.clone(), what(error), "colours count as sRGB; convert the image to sRGB")
    })
}

/// Returns the conversion of an image from its colour profile; `None` if its colours count as sRGB.
pub(crate) fn to_srgb(bytes: &[u8], place: &Location) -> Option<Conversion> {
    if ignores_profiles(place) {
        return None;
    }
    let conversion = conversion(&profile(bytes).ok()??).ok()?;
    (!conversion.is_small()).then_some(conversion)
}

/// True for formats whose rules are that images are sRGB.
fn ignores_profiles(place: &Location) -> bool {
    let format = place.path.extension().unwrap_or_default().to_ascii_lowercase();
    ["gltf", "glb", "xml"].iter().any(|ignoring| format == *ignoring)
}

/// Returns the colour profile of an image, if it has one.
fn profile(bytes: &[u8]) -> Result<Option<ColorProfile>, CmsError> {
    let icc = if bytes.starts_with(b"\x89PNG") {
        let Ok(reader) = png::Decoder::new(Cursor::new(bytes)).read_info() else { return Ok(None) };
        let info = reader.info();
        match &info.icc_profile {
            Some(icc) if info.coding_independent_code_points.is_none() => Some(icc.to_vec()),
            _ => return of_chunks(info),
        }
    } else if bytes.starts_with(b"\xFF\xD8\xFF") || bytes.starts_with(b"RIFF") {
        // JPEG and WebP. Other formats have no profile, or one that is hardly ever there.
        let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().ok();
        let mut decoder = reader.and_then(|reader| reader.into_decoder().ok());
        decoder.as_mut().and_then(|decoder| decoder.icc_profile().ok()?)
    } else {
        None
    };
    icc.map(|icc| ColorProfile::new_from_slice(&icc)).transpose()
}

/// Returns the profile that chunks of PNG other than `iCCP` describe.
fn of_chunks(info: &Info) -> Result<Option<ColorProfile>, CmsError> {
    if let Some(code) = info.coding_independent_code_points {
        return Ok(Some(ColorProfile::new_from_cicp(CicpProfile {
            color_primaries: CicpColorPrimaries::try_from(code.color_primaries)?,
            transfer_characteristics: TransferCharacteristics::try_from(code.transfer_function)?,
            matrix_coefficients: MatrixCoefficients::Identity,
            full_range: code.is_video_full_range_image,
        })));
    }
    if info.srgb.is_some() || (info.gama_chunk.is_none() && info.chrm_chunk.is_none()) {
        return Ok(None);
    }
    let mut profile = ColorProfile::new_srgb();
    // Code points would count before the curves.
    profile.cicp = None;
    if let Some(own) = info.chrm_chunk {
        let of = |(x, y): (ScaledFloat, ScaledFloat)| Chromaticity { x: x.into_value(), y: y.into_value() };
        let primaries = ColorPrimaries { red: of(own.red), green: of(own.green), blue: of(own.blue) };
        profile.update_rgb_colorimetry(of(own.white).to_xyyb(), primaries);
    }
    if let Some(gamma) = info.gama_chunk {
        let curve = curve_from_gamma(1.0 / gamma.into_value());
        let curves = [&mut profile.red_trc, &mut profile.green_trc, &mut profile.blue_trc];
        curves.into_iter().for_each(|own| *own = Some(curve.clone()));
    }
    Ok(Some(profile))
}

fn conversion(profile: &ColorProfile) -> Result<Conversion, CmsError> {
    let is_grey = profile.color_space == DataColorSpace::Gray;
    let layout = if is_grey { Layout::Gray } else { Layout::Rgb };
    let (srgb, options) = (ColorProfile::new_srgb(), TransformOptions::default());
    Ok(Conversion {
        transform: profile.create_transform_16bit(layout, &srgb, Layout::Rgb, options)?,
        is_grey,
    })
}

impl Conversion {
    /// Returns the image with its colours in sRGB. Colours beyond sRGB are clipped.
    pub fn apply(&self, image: &DynamicImage) -> Option<DynamicImage> {
        let codes = if self.is_grey { image.to_luma16().into_raw() } else { image.to_rgb16().into_raw() };
        let mut converted = vec![0; 3 * image.width() as usize * image.height() as usize];
        self.transform.transform(&codes, &mut converted).ok()?;
        ImageBuffer::from_raw(image.width(), image.height(), converted).map(DynamicImage::ImageRgb16)
    }

    /// True if colours stay about as they are.
    fn is_small(&self) -> bool {
        let linear = |code: u16| srgb_to_linear(f32::from(code) / MAX_CODE);
        let greys = (1..16).map(|step| [step << 12; 3]);
        let colours = [[200, 60, 40], [60, 200, 40], [40, 60, 200], [220, 210, 90]]
            .map(|rgb| rgb.map(|code| code << 8));
        greys.chain(colours).all(|[r, g, b]| {
            let code = if self.is_grey { [g; 3] } else { [r, g, b] };
            let (used, mut mapped) = (if self.is_grey { 1 } else { 3 }, [0; 3]);
            self.transform.transform(&code[..used], &mut mapped).is_ok()
                && code.iter().zip(mapped).all(|(a, b)| (linear(*a) - linear(b)).abs() <= MAX_DIFFERENCE)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decode::{Channel, decode};
    use crate::{LoadOptions, load};
    use base::math::Rgb;
    use glam::Mat3;
    use image::codecs::jpeg::JpegEncoder;
    use image::codecs::png::PngEncoder;
    use image::{DynamicImage, ImageEncoder, ImageFormat, RgbImage};
    use png::{CodingIndependentCodePoints, ScaledFloat, SourceChromaticities, SrgbRenderingIntent};

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

    fn is_converted(bytes: &[u8]) -> bool {
        to_srgb(bytes, &Location::file(Path::new("s.toml"))).is_some()
    }

    #[test]
    fn profiles_of_srgb_change_nothing() {
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
            assert!(!is_converted(&file));
        }
        let jpeg = DynamicImage::from(RgbImage::new(8, 8));
        let mut bytes = Cursor::new(Vec::new());
        jpeg.write_to(&mut bytes, ImageFormat::Jpeg).unwrap();
        assert!(!is_converted(bytes.get_ref()) && !is_converted(b"RIFF"));
    }

    /// Returns the colour of the pixel of a file that a scene names.
    fn colour(bytes: &[u8], scene: &str) -> Rgb {
        let place = Location::file(Path::new(scene));
        decode(bytes, Channel::Colour, Path::new("a"), &place).unwrap().texels.get(0, 0)
    }

    #[test]
    fn colours_of_other_profiles_are_converted() {
        let code = [200, 60, 40].map(|code| code as f32 / 255.0);
        let srgb = Rgb::from(code.map(srgb_to_linear));
        let near = |bytes: &[u8], expected: Rgb| {
            let found = colour(bytes, "s.toml");
            assert!((found - expected).abs().max_element() < 2e-3, "{found}, not {expected}");
            assert_eq!(colour(bytes, "a.xml"), colour(&png(|_| ()), "a.xml"));
            assert_eq!(warning(bytes, Path::new("a"), &Location::file(Path::new("s.toml"))), None);
        };
        let linear = |info: &mut Info| info.source_gamma = Some(ScaledFloat::new(1.0));
        near(&png(linear), Rgb::from(code));
        // Linear Rec. 709 from linear Display P3 (SMPTE EG 432-1), whose curve is that of sRGB.
        let of_p3 = Mat3::from_cols_array(&[
            1.22494, -0.04206, -0.01964, -0.22494, 1.04206, -0.07864, 0.0, 0.0, 1.09827,
        ]);
        near(&with_icc(&ColorProfile::new_display_p3()), (of_p3 * srgb).max(Rgb::ZERO));
        let p3 = SourceChromaticities::new((0.3127, 0.329), (0.68, 0.32), (0.265, 0.69), (0.15, 0.06));
        near(&png(|info| info.source_chromaticities = Some(p3)), (of_p3 * srgb).max(Rgb::ZERO));
        let mut info = Info::with_size(1, 1);
        let mut of_code = |color_primaries, transfer_function| {
            info.coding_independent_code_points = Some(CodingIndependentCodePoints {
                color_primaries,
                transfer_function,
                matrix_coefficients: 0,
                is_video_full_range_image: true,
            });
            conversion(&of_chunks(&info).unwrap().unwrap()).unwrap().is_small()
        };
        assert!(of_code(1, 13) && !of_code(12, 13) && !of_code(9, 13));
        let mut jpeg = Vec::new();
        let mut encoder = JpegEncoder::new(&mut jpeg);
        encoder.set_icc_profile(ColorProfile::new_display_p3().encode().unwrap()).unwrap();
        encoder.write_image(&[0; 192], 8, 8, image::ExtendedColorType::Rgb8).unwrap();
        assert!(is_converted(&jpeg));
        let grey = grey(1.0).encode().unwrap();
        let mut bytes = Vec::new();
        let mut encoder = PngEncoder::new(&mut bytes);
        encoder.set_icc_profile(grey).unwrap();
        encoder.write_image(&[51], 1, 1, image::ExtendedColorType::L8).unwrap();
        assert!((colour(&bytes, "s.toml") - Rgb::splat(0.2)).abs().max_element() < 2e-3);
    }

    #[test]
    fn a_profile_that_cannot_be_used_is_named_once_and_for_colours_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.toml");
        let damaged = png(|info| info.icc_profile = Some(vec![1, 2, 3].into()));
        std::fs::write(folder.path().join("a.png"), &damaged).unwrap();
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
        assert!(named("reflectance = 0.5, normal_map = \"a.png\"").is_empty());
        let one = named(
            "reflectance = \"a.png\", opacity = { file = \"a.png\", wrap = \"mirror\" }, normal_map = \"a.png\"",
        );
        assert!(one.len() == 1 && one[0].contains("a.png: the colour profile cannot be used"), "{one:?}");
        let of = |scene: &str| warning(&damaged, Path::new("a.png"), &Location::file(Path::new(scene)));
        assert!(of("a.mtl").is_some() && of("a.xml").is_none() && of("a.GLB").is_none());
        assert_eq!(colour(&damaged, "s.toml"), colour(&png(|_| ()), "s.toml"));
    }
}
