//! `lightsplat merge`: one picture of several of the same view by different seeds, each counting as much as it has
//! samples, pixel by pixel where it was interrupted.

use super::args::MergeArgs;
use super::exit::Failure;
use super::outputs::{Inputs, check_outputs};
use super::talk;
use anyhow::anyhow;
use base::film::metrics::{rel_mse_of_variance, standard_error};
use base::film::{ExrFile, Metadata, SAMPLES, Weight, write_png};
use render::denoise::{NOISY, NOISY_VARIANCE};
use render::method::path::Begun;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Layer of the variance of pixels' means.
const VARIANCE: &str = "variance";
/// Facts that are one picture's own.
const OWN: [&str; 3] = ["job", "render_seconds", "threads"];

/// Runs the command.
pub fn run(args: MergeArgs) -> Result<(), Failure> {
    let png = args.png.file(&args.output);
    check_outputs(&args.output, png.as_deref(), false)?;
    Inputs::new(&args.inputs).check_apart([&args.output].into_iter().chain(&png).map(PathBuf::as_path))?;
    let mut files = Vec::new();
    for path in &args.inputs {
        files.push((path.as_path(), noisy(path)?));
    }
    let facts: Vec<Metadata> = files.iter().map(|(_, file)| file.metadata()).collect();
    let mut seeds: Vec<String> = Vec::new();
    let mut weights = Vec::new();
    for ((path, file), own) in files.iter().zip(&facts) {
        let refuse = |reason: String| Err(Failure::input(anyhow!("{}: {reason}", path.display())));
        let Some(spp) = own.number("spp").filter(|spp| *spp > 0.0) else {
            return refuse(
                "it does not say how many samples it has; only pictures of this program do".to_owned(),
            );
        };
        let first = args.inputs[0].display();
        if let Some(difference) = difference((&files[0].1, &facts[0]), (file, own)) {
            return refuse(format!("its {difference} is not that of {first}"));
        }
        for seed in own_seeds(own) {
            if seeds.contains(&seed) {
                return refuse(format!(
                    "a picture before it has the seed {seed} too: render it with another --seed"
                ));
            }
            seeds.push(seed);
        }
        weights.push(file.numbers(SAMPLES).map_or(Weight::Whole(spp), |own| Weight::ByPixel(own.pixels)));
    }
    let mut files = files.into_iter().map(|(_, mut file)| {
        file.remove_layer(SAMPLES);
        file
    });
    let Some(mut merged) = files.next() else { return Ok(()) };
    merged.merge(&files.collect::<Vec<_>>(), &weights, &[VARIANCE]).map_err(Failure::input)?;
    let color = merged.color().map_err(Failure::input)?;
    if let Ok(variance) = merged.layer(VARIANCE) {
        merged.set("standard_error", standard_error(&variance));
        merged.set("relative_mse_of_noise", rel_mse_of_variance(&variance, &color));
    }
    OWN.iter().for_each(|fact| merged.remove_fact(fact));
    let own: Vec<String> = facts[0].iter().map(|(key, _)| key.to_owned()).collect();
    own.iter().filter(|key| key.starts_with("verified_")).for_each(|key| merged.remove_fact(key));
    merged.set("seed", seeds.join(","));
    count_samples(&mut merged, &weights, color.pixels.len());
    let mut said = format!("wrote {}, merged of {} pictures", args.output.display(), weights.len());
    let mut written = vec![args.output.clone()];
    let factor = args.png.exposure.factor(&color);
    if let Some(path) = &png {
        merged.set("png_exposure", f64::from(factor.log2()));
        said += &format!(", and {} (exposure {:+.2} EV)", path.display(), factor.log2());
    }
    merged.write(&args.output).map_err(Failure::output)?;
    if let Some(path) = png {
        write_png(&path, &color, factor).map_err(Failure::output)?;
        written.push(path);
    }
    talk::wrote(&said, &written);
    Ok(())
}

/// A picture, as it was before denoising.
fn noisy(path: &Path) -> Result<ExrFile, Failure> {
    let mut file = ExrFile::read(path).map_err(Failure::input)?;
    let facts = file.metadata();
    let refuse = |reason: &str| Err(Failure::input(anyhow!("{}: {reason}", path.display())));
    if facts.text("partial") == Some("true") && file.numbers(SAMPLES).is_none() {
        return refuse(
            "its rendering was interrupted, and it does not say how many samples its pixels have: only --method path \
             does; render the rest by the same command with --resume",
        );
    }
    Begun::remove_squares(&mut file);
    if facts.text("denoised").is_some_and(|library| library != "false") {
        let Ok(noisy) = file.layer(NOISY) else {
            return refuse(
                "it is denoised, and means of such pictures keep what the denoiser made of the noise: render it with \
                 --no-denoise or --keep-noisy, and denoise the merged picture by `lightsplat denoise`",
            );
        };
        file.replace_color(&noisy, None).map_err(Failure::input)?;
        file.remove_layer(NOISY);
        file.rename_layer(NOISY_VARIANCE, VARIANCE);
    }
    file.remove_fact("denoised");
    Ok(file)
}

/// States the samples of a merged picture: their number, or its mean, and those of each pixel, where they differ. The
/// picture is partial where a pixel has none.
fn count_samples(merged: &mut ExrFile, weights: &[Weight], pixels: usize) {
    let samples = |pixel| weights.iter().map(|weight| weight.of(pixel)).sum::<f64>();
    let all: Vec<f64> = (0..pixels).map(samples).collect();
    merged.set("spp", all.iter().sum::<f64>() / pixels.max(1) as f64);
    merged.set("partial", if all.contains(&0.0) { "true" } else { "false" });
    if all.iter().any(|n| *n != all[0]) {
        merged.add_numbers(SAMPLES, all.into_iter().map(|n| n as u32).collect());
    }
}

/// Seeds of a picture: several, if it has been merged.
fn own_seeds(facts: &Metadata) -> Vec<String> {
    match facts.text("seed") {
        Some(seeds) => seeds.split(',').map(str::to_owned).collect(),
        None => vec![facts.number("seed").unwrap_or_default().to_string()],
    }
}

/// First thing in which two pictures differ that have to be of one view and one method.
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
        ("film or crop", a.0.window() != b.0.window()),
        ("method", a.1.text("method") != b.1.text("method")),
        ("sharpening, which interrupted pictures lack,", a.1.text("sharpened") != b.1.text("sharpened")),
        ("setting, besides --seed and --spp,", settings(a.1) != settings(b.1)),
    ];
    differs.into_iter().find(|(_, differs)| *differs).map(|(what, _)| what)
}
