//! `lightsplat merge`: merges images of one view with different seeds.
//!
//! An image is weighted by its number of samples, per pixel if it was interrupted.

use super::args::MergeArgs;
use super::exit::Failure;
use super::outputs::{Inputs, OutputCheck, check_outputs};
use super::{picture, talk};
use anyhow::anyhow;
use base::film::metrics::{rel_mse_of_variance, standard_error};
use base::film::{ExrFile, Image, Metadata, SAMPLES, Shown, Weight, write_png};
use render::denoise::{NOISY, NOISY_VARIANCE};
use render::method::path::PartialImage;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Layer of the variance of the pixels.
const VARIANCE: &str = "variance";
/// Facts that do not apply to a merged image.
const OWN: [&str; 3] = ["job", "render_seconds", "threads"];

/// Runs the command.
pub fn run(args: MergeArgs) -> Result<(), Failure> {
    let png = args.png.file(&args.output);
    check_outputs(Some(&args.output), png.as_deref(), OutputCheck::default())?;
    Inputs::new(&args.inputs).check_apart([&args.output].into_iter().chain(&png).map(PathBuf::as_path))?;
    let mut files = Vec::new();
    for path in &args.inputs {
        files.push((path.as_path(), noisy(path)?));
    }
    let facts: Vec<Metadata> = files.iter().map(|(_, file)| file.metadata()).collect();
    let Summands { seeds, weights } = Summands::check(&files, &facts)?;
    let mut files = files.into_iter().map(|(_, mut file)| {
        file.remove_layer(SAMPLES);
        file
    });
    let Some(mut merged) = files.next() else { return Ok(()) };
    merged.merge(&files.collect::<Vec<_>>(), &weights, &[VARIANCE]).map_err(Failure::input)?;
    let color = merged.color().map_err(Failure::input)?;
    renew_facts(&mut merged, &color);
    merged.set("seed", seeds.join(","));
    count_samples(&mut merged, &weights, color.pixels.len());
    let mut said = format!("wrote {}, merged from {} images", args.output.display(), weights.len());
    let mut written = vec![args.output.clone()];
    let alpha = merged.alpha();
    let shown = Shown { color: &color, alpha: alpha.as_ref() };
    let look = args.png.tone.tone().look(shown);
    if let Some(path) = &png {
        merged.set("png_exposure", f64::from(look.stops()));
        merged.set("png_view", look.curve.name());
        said += &format!(", and {} ({})", path.display(), look.said());
    }
    merged.write(&args.output).map_err(Failure::output)?;
    if let Some(path) = png {
        write_png(&path, shown, look).map_err(Failure::output)?;
        written.push(path);
    }
    talk::wrote(&said, &written);
    Ok(())
}

/// Seeds and weights of the images that are merged.
#[derive(Default)]
struct Summands {
    /// Seeds of all images.
    seeds: Vec<String>,
    /// Weight of each image.
    weights: Vec<Weight>,
}

impl Summands {
    /// Checks that the images show one view by one method, with different seeds. `facts` has the metadata of each.
    fn check(files: &[(&Path, ExrFile)], facts: &[Metadata]) -> Result<Summands, Failure> {
        let mut all = Summands::default();
        for ((path, file), own) in files.iter().zip(facts) {
            let refuse = |reason: String| Err(Failure::input(anyhow!("{}: {reason}", path.display())));
            let Some(spp) = own.number("spp").filter(|spp| *spp > 0.0) else {
                return refuse(
                    "the file does not state its number of samples; merge only images of lightsplat"
                        .to_owned(),
                );
            };
            if let Some(difference) = difference((&files[0].1, &facts[0]), (file, own)) {
                return refuse(format!("its {difference} differs from {}", files[0].0.display()));
            }
            for seed in own_seeds(own) {
                if all.seeds.contains(&seed) {
                    return refuse(format!(
                        "another image also has seed {seed}; render one of the two with another --seed"
                    ));
                }
                all.seeds.push(seed);
            }
            let by_pixel = file.numbers(SAMPLES).map(|own| Weight::ByPixel(own.pixels));
            all.weights.push(by_pixel.unwrap_or(Weight::Uniform(spp)));
        }
        Ok(all)
    }
}

/// Computes the error of a merged image from its variance, and removes facts that do not apply to it.
fn renew_facts(merged: &mut ExrFile, color: &Image) {
    if let Ok(variance) = merged.layer(VARIANCE) {
        merged.set("standard_error", standard_error(&variance));
        merged.set("relative_mse_of_noise", rel_mse_of_variance(&variance, color));
    }
    OWN.iter().for_each(|fact| merged.remove_fact(fact));
    let all: Vec<String> = merged.metadata().iter().map(|(key, _)| key.to_owned()).collect();
    all.iter().filter(|key| key.starts_with("verified_")).for_each(|key| merged.remove_fact(key));
}

/// Reads an image; returns it without denoising.
fn noisy(path: &Path) -> Result<ExrFile, Failure> {
    let mut file = ExrFile::read(path).map_err(Failure::input)?;
    file.check_whole().map_err(Failure::input)?;
    picture::mend_all(path, &mut file);
    let facts = file.metadata();
    let refuse = |reason: &str| Err(Failure::input(anyhow!("{}: {reason}", path.display())));
    if facts.text("partial") == Some("true") && file.numbers(SAMPLES).is_none() {
        return refuse(
            "its rendering was interrupted, and it lacks the samples of each pixel, which images of --method path have; \
             render the rest with the same command and --resume",
        );
    }
    PartialImage::remove_squares(&mut file);
    if facts.text("denoised").is_some_and(|library| library != "false") {
        let Ok(noisy) = file.layer(NOISY) else {
            return refuse(
                "the image is denoised, and merging does not remove errors of the denoiser; render it with --no-denoise or \
                 --set keep-noisy=on, and denoise the merged image with `lightsplat denoise`",
            );
        };
        file.replace_color(&noisy, None).map_err(Failure::input)?;
        file.remove_layer(NOISY);
        file.rename_layer(NOISY_VARIANCE, VARIANCE);
    }
    file.remove_fact("denoised");
    Ok(file)
}

/// Stores the mean number of samples of a merged image, and the number of each pixel if they differ.
///
/// The image is partial if a pixel has no sample.
fn count_samples(merged: &mut ExrFile, weights: &[Weight], pixels: usize) {
    let samples = |pixel| weights.iter().map(|weight| weight.at(pixel)).sum::<f64>();
    let all: Vec<f64> = (0..pixels).map(samples).collect();
    merged.set("spp", all.iter().sum::<f64>() / pixels.max(1) as f64);
    merged.set("partial", if all.contains(&0.0) { "true" } else { "false" });
    if all.iter().any(|n| *n != all[0]) {
        merged.add_numbers(SAMPLES, all.into_iter().map(|n| n as u32).collect());
    }
}

/// Returns the seeds of an image. A merged image has several.
fn own_seeds(facts: &Metadata) -> Vec<String> {
    match facts.text("seed") {
        Some(seeds) => seeds.split(',').map(str::to_owned).collect(),
        None => vec![facts.number("seed").unwrap_or_default().to_string()],
    }
}

/// Returns the first property in which two images differ that must be of one view and one method.
fn difference(a: (&ExrFile, &Metadata), b: (&ExrFile, &Metadata)) -> Option<&'static str> {
    let settings = |facts: &Metadata| -> Option<Value> {
        let mut settings: Value = serde_json::from_str(facts.text("settings")?).ok()?;
        for own in ["seed", "spp"] {
            settings.as_object_mut()?.remove(own);
        }
        Some(settings)
    };
    let differs = [
        ("scene", a.1.text("scene_hash") != b.1.text("scene_hash")),
        ("camera or frame", a.0.camera() != b.0.camera() || a.1.number("frame") != b.1.number("frame")),
        ("size or crop", a.0.window() != b.0.window()),
        ("method", a.1.text("method") != b.1.text("method")),
        ("sharpening, which interrupted images lack,", a.1.text("sharpened") != b.1.text("sharpened")),
        ("setting, besides --seed and --spp,", settings(a.1) != settings(b.1)),
    ];
    differs.into_iter().find(|(_, differs)| *differs).map(|(what, _)| what)
}
