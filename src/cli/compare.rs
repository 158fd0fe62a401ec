//! `lightsplat compare`: error measures of an image against a reference, and a heatmap of the error.

use super::args::{CompareArgs, HeatmapError};
use super::exit::Failure;
use super::outputs::{Inputs, check_name};
use super::{picture, talk};
use base::film::metrics::{self, Comparison, Variances, ZTest};
use base::film::{ExrFile, Image, ImageError, atomic, heatmap, write_srgb8};
use base::math::Rgb;
use std::fmt::Write;
use std::path::Path;

/// Runs the command.
pub fn run(args: CompareArgs) -> Result<(), Failure> {
    if let Some(path) = &args.heatmap {
        check_name(path, "png", "--heatmap", "for PNG")?;
        atomic::check_writable(path).map_err(Failure::output)?;
        let variances = args.variance_a.iter().chain(&args.variance_b);
        Inputs::new([&args.test, &args.reference].into_iter().chain(variances))
            .check_apart([path.as_path()])?;
    }
    let (test, test_variance) = read(&args.test, args.variance_a.as_deref())?;
    let (reference, reference_variance) = read(&args.reference, args.variance_b.as_deref())?;
    let variances = Variances { test: test_variance.as_ref(), reference: reference_variance.as_ref() };
    let comparison = metrics::compare(&test, &reference, variances).map_err(Failure::input)?;
    if args.json {
        talk::print(&format!("{}\n", serde_json::json!(comparison)))?;
    } else {
        talk::print(&to_text(&comparison))?;
    }
    if let Some(path) = &args.heatmap {
        let exposure = comparison.exposure as f32;
        let error = match args.heatmap_of {
            HeatmapError::Flip => metrics::flip_map(&test, &reference, exposure),
            HeatmapError::Relative => metrics::relative_error_map(&test, &reference),
        };
        let panel = heatmap::heatmap(&test, &reference, &error, exposure);
        write_srgb8(path, [panel.width, panel.height], &panel.bytes).map_err(Failure::output)?;
        talk::note(&format!("wrote {}", path.display()));
    }
    Ok(())
}

/// Reads an image and the variance of its pixels: from `variance` if given, else from a layer of the image.
fn read(path: &Path, variance: Option<&Path>) -> Result<(Image, Option<Image>), Failure> {
    let file = ExrFile::read(path).map_err(Failure::input)?;
    if file.metadata().text("partial") == Some("true") {
        talk::warning(&format!("{} is partial: its rendering was interrupted", path.display()));
    }
    let image = finite(file.color().and_then(|image| file.to_rec_709(image)), path, "")?;
    let variance = match variance {
        Some(path) => Some(not_negative(ExrFile::read(path).and_then(|file| file.color()), path, "")?),
        None if file.layers().iter().any(|layer| layer == "variance") => {
            Some(not_negative(file.layer("variance"), path, "variance")?)
        }
        None => None,
    };
    Ok((image, variance))
}

/// Replaces values of a layer that are not finite, with a warning.
fn finite(image: Result<Image, ImageError>, path: &Path, layer: &str) -> Result<Image, Failure> {
    let mut image = image.map_err(Failure::input)?;
    picture::mend(path, layer, &mut image);
    Ok(image)
}

/// Replaces negative variances by 0, with a warning.
fn not_negative(image: Result<Image, ImageError>, path: &Path, layer: &str) -> Result<Image, Failure> {
    let mut image = finite(image, path, layer)?;
    let negative = image.pixels.iter().filter(|variance| variance.min_element() < 0.0).count();
    if negative > 0 {
        talk::warning(&format!(
            "variances of {negative} pixels in {} are negative and count as 0",
            path.display()
        ));
        image.pixels.iter_mut().for_each(|variance| *variance = variance.max(Rgb::ZERO));
    }
    Ok(image)
}

fn to_text(c: &Comparison) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<31}{value}");
    };
    line("relMSE", format!("{:.6e}", c.rel_mse));
    line("relMSE without the worst 0.1 %", format!("{:.6e}", c.rel_mse_trimmed));
    if let Some(explained) = c.reference_rel_mse {
        line("  due to noise of the reference", format!("{explained:.6e}"));
    }
    line("RMSE", format!("{:.6e}", c.rmse));
    line("PSNR [dB]", c.psnr.map_or("identical on screen".to_owned(), |p| format!("{p:.3}")));
    line("FLIP", format!("{:.5}", c.flip));
    let ratio = |r: Option<f64>| r.map_or("-".to_owned(), |r| format!("{r:.5}"));
    line("mean ratio R, G, B", c.mean_ratio.map(ratio).join("  "));
    if let Some(errors) = c.mean_ratio_std_error {
        line("  standard error", errors.map(ratio).join("  "));
    }
    match c.z_test {
        Some(z) => line("z-test", z_text(&z)),
        None => line("z-test", "needs the variances of both images".to_owned()),
    }
    if let Some(z) = c.z_test_blocks {
        line(&format!("  of {0}x{0} pixels", metrics::BLOCK), z_text(&z));
    }
    line("exposure", format!("x{:.4e} ({:+.2} EV)", c.exposure, c.exposure.log2()));
    text
}

fn z_text(z: &ZTest) -> String {
    format!(
        "{}: {:.3} % of the tests pass (required {:.2} %), mean z² {:.3}",
        if z.passed { "passed" } else { "FAILED" },
        100.0 * z.share_passed,
        100.0 * metrics::SHARE_REQUIRED,
        z.mean_z_squared
    )
}
