//! `lightsplat denoise`: denoises an image file. Everything else in the file stays.

use super::denoise_args::DenoiseFileArgs;
use super::exit::Failure;
use super::outputs::{Inputs, OutputCheck, check_outputs};
use super::{picture, talk, threads};
use anyhow::anyhow;
use base::film::{ExrFile, Image, ImageError, Shown, write_png};
use render::denoise::{Denoiser, Guides, NOISY, NOISY_VARIANCE, guides};
use std::path::PathBuf;

/// Runs the command.
pub fn run(args: DenoiseFileArgs) -> Result<(), Failure> {
    let input = &args.input;
    let output = args.output.clone().unwrap_or_else(|| input.with_extension("denoised.exr"));
    let png = args.png.file(&output);
    check_outputs(Some(&output), png.as_deref(), OutputCheck::default())?;
    Inputs::new([input]).check_apart([&output].into_iter().chain(&png).map(PathBuf::as_path))?;
    let mut file = ExrFile::read(input).map_err(Failure::input)?;
    file.check_whole().map_err(Failure::input)?;
    if let Some(library) = file.metadata().text("denoised").filter(|library| *library != "false") {
        return Err(Failure::input(anyhow!(
            "{} is already denoised, with {library}; denoise the noisy image instead",
            input.display()
        )));
    }
    let mut color = file.color().map_err(Failure::input)?;
    picture::mend(input, "", &mut color);
    let channels = file.channels();
    let guide = |names: &[&str]| -> Result<Option<(String, Image)>, ImageError> {
        let Some(name) = guides::layer(&channels, names) else { return Ok(None) };
        let mut image = file.layer(&name)?;
        picture::mend(input, &name, &mut image);
        Ok(Some((name, image)))
    };
    let albedo = guide(&guides::ALBEDO).map_err(Failure::input)?;
    // The library does not use normals without albedo.
    let normal = if albedo.is_some() { guide(&guides::NORMAL).map_err(Failure::input)? } else { None };
    let guides = Guides {
        albedo: albedo.as_ref().map(|(_, image)| image),
        normal: normal.as_ref().map(|(_, image)| image),
        // Guides of other renderers may be noisy, especially in blurred reflections.
        noise_free: file.metadata().text("method").is_some(),
        keeps_background: true,
    };
    let (library, clean) = threads::pool(threads::count(args.threads))?
        .install(|| {
            let denoiser = Denoiser::load()?;
            Ok((denoiser.name(), denoiser.denoise(&color, &guides, args.quality())?))
        })
        .map_err(|error: render::denoise::DenoiseError| Failure::render(error))?;
    let guided_by: Vec<&str> =
        [&albedo, &normal].into_iter().flatten().map(|(name, _)| name.as_str()).collect();

    file.replace_color(&clean, args.keep_noisy.then_some(NOISY)).map_err(Failure::input)?;
    file.rename_layer("variance", NOISY_VARIANCE);
    for fact in ["standard_error", "relative_mse_of_noise"] {
        file.rename_fact(fact, &format!("noisy_{fact}"));
    }
    file.set("denoised", library.as_str());
    let mut said = format!("wrote {}", output.display());
    let (color, alpha) = (file.to_rec_709(clean).map_err(Failure::input)?, file.alpha());
    let shown = Shown { color: &color, alpha: alpha.as_ref() };
    let exposed = png.map(|path| (path, args.png.tone.tone().look(shown)));
    if let Some((path, look)) = &exposed {
        file.set("png_exposure", f64::from(look.stops()));
        file.set("png_view", look.curve.name());
        said += &format!(" and {} ({})", path.display(), look.said());
    }
    file.write(&output).map_err(Failure::output)?;
    if let Some((path, look)) = &exposed {
        write_png(path, shown, *look).map_err(Failure::output)?;
    }
    let guided_by = if guided_by.is_empty() { "no layer".to_owned() } else { guided_by.join(" and ") };
    talk::note(&format!("denoised with {library}, guided by {guided_by}"));
    talk::note(&said);
    Ok(())
}
