//! Budget of an image: processor time of the default method by step, and the part of it within Embree and the denoiser.
//!
//! The image is rendered as `render` does it, on one thread, without the pilot that chooses the method. Each round has
//! another seed, so that no virtual lights are reused. The meter ([`base::stats::meter`]) counts all queries of Embree,
//! and times a part of them.
//!
//! Units: microseconds of processor time per pixel; rays per pixel; nanoseconds per ray.

use super::measure::Clock;
use super::{Benchmark, Context, Kind, Row, Spread, Table};
use base::film::{Film, Look, ToneCurve, write_exr, write_png};
use base::progress::Control;
use base::stats::meter::{self, Metered};
use base::stats::{Counter, Stage, Stats};
use render::method::Method;
use render::session::{Goal, Session};
use std::error::Error;
use std::path::Path;
use world::view::{Framing, View};

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "budget",
    about: "Processor time of an image by step, and the part of it within Embree and the denoiser",
    kind: Kind::Parts { needs_scene: true, run },
};

/// Maximum number of rounds. An image takes seconds.
const MAX_ROUNDS: usize = 3;

/// Parts of the estimate, in the order of [`meter::Query::ALL`].
const EYE_PASS: [&str; 3] = ["eye pass: eye rays", "eye pass: other closest hits", "eye pass: shadow rays"];
const OTHERS: [&str; 3] =
    ["other steps: coherent closest hits", "other steps: other closest hits", "other steps: shadow rays"];

/// An image with the times of its steps and the numbers of its rays.
struct Image {
    stats: Stats,
    /// Queries of all steps.
    queries: [Metered; 3],
    /// Processor seconds from the scene's file to the image's files.
    seconds: f64,
    pixels: f64,
}

fn run(context: &Context) -> Vec<Table> {
    match images(context) {
        Ok(images) if images.is_empty() => Vec::new(),
        Ok(images) => vec![steps(&images), embree(&images)],
        Err(error) => {
            (context.say)(&error.to_string());
            Vec::new()
        }
    }
}

/// Renders an image per round, on one thread.
fn images(context: &Context) -> Result<Vec<Image>, Box<dyn Error>> {
    let Some(session) = context.session else { return Ok(Vec::new()) };
    let view = View::new(&session.cameras, &Framing::default())?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let count = context.settings.repeats.clamp(1, MAX_ROUNDS);
    let folder = tempfile::tempdir()?;
    let mut images = Vec::with_capacity(count);
    for round in 0..count {
        (context.say)(&format!("image {} of {count}", round + 1));
        let mut method = Method::default();
        method.set_seed(round as u32);
        images.push(pool.install(|| Image::render(session, &view, method, folder.path()))?);
    }
    Ok(images)
}

impl Image {
    /// Renders an image and writes it into a folder.
    fn render(session: &Session, view: &View, method: Method, folder: &Path) -> Result<Image, String> {
        let start = Clock::Process.seconds();
        let goal = Goal { method, ..Goal::default() };
        meter::start();
        let frame = session.frame(view, &goal, &Control::new());
        let queries = meter::stop();
        let frame = frame.map_err(|error| error.to_string())?;
        let mut stats = frame.stats;
        stats.time(Stage::Write, || write(&frame.film, folder))?;
        let seconds = Clock::Process.seconds() - start;
        stats.merge(&session.stats);
        let loading: f64 = session.stats.stages().map(|(_, time)| time.cpu_seconds).sum();
        let pixels = view.window.pixel_count() as f64;
        Ok(Image { stats, queries, seconds: seconds + loading, pixels })
    }

    /// Returns the processor seconds of a step.
    fn step(&self, stage: Stage) -> f64 {
        self.stats.stage(stage).map_or(0.0, |time| time.cpu_seconds)
    }

    /// Returns the processor seconds outside all steps.
    fn rest(&self) -> f64 {
        (self.seconds - Stage::ALL.map(|stage| self.step(stage)).iter().sum::<f64>()).max(0.0)
    }

    /// Returns the queries of the eye pass, and of all other steps.
    fn queries(&self) -> [[Metered; 3]; 2] {
        let eye = self.stats.metered(Stage::EyePass);
        let mut others = self.queries;
        others.iter_mut().zip(eye).for_each(|(all, eye)| {
            *all = Metered { rays: all.rays - eye.rays, seconds: (all.seconds - eye.seconds).max(0.0) };
        });
        [eye, others]
    }

    /// Returns the closest-hit rays and the shadow rays that a step reports.
    fn rays(&self, stage: Stage) -> [f64; 2] {
        let count = |name: &str| match self.stats.get(name) {
            Some(Counter::Count(n)) => n as f64,
            _ => 0.0,
        };
        let eye = count("Eye/closest-hit rays");
        match stage {
            Stage::EyePass => [eye, count("Eye/shadow rays")],
            Stage::LightPass => [count("Rays/closest hit") - eye, count("Rays/shadow")],
            Stage::Records => [0.0, count("Records/shadow rays")],
            Stage::Render => [0.0, count("Lightcut/shadow rays") + count("Compensation/shadow rays")],
            _ => [0.0; 2],
        }
    }
}

/// Writes the files that `render` writes.
fn write(film: &Film, folder: &Path) -> Result<(), String> {
    let look = Look { factor: 1.0, curve: ToneCurve::default(), automatic: None };
    write_exr(&folder.join("a.exr"), film).map_err(|error| error.to_string())?;
    write_png(&folder.join("a.png"), &film.color, look).map_err(|error| error.to_string())
}

/// Returns the median over all images.
fn median(images: &[Image], value: impl Fn(&Image) -> f64) -> f64 {
    Spread::of(&images.iter().map(value).collect::<Vec<_>>()).median
}

/// Returns a row of a part of an image that takes some seconds, with its ratio to the total.
fn row(images: &[Image], label: &str, figures: &[f64], seconds: impl Fn(&Image) -> f64) -> Row {
    let ratios: Vec<f64> = images.iter().map(|image| seconds(image) / image.seconds).collect();
    let samples: Vec<f64> = images.iter().map(|image| 1e6 * seconds(image) / image.pixels).collect();
    let figures = figures.iter().map(|figure| (*figure > 0.0).then_some(*figure)).collect();
    let (ratio, rate) = (Spread::of(&ratios), Spread::of(&samples));
    Row { labels: vec![label.to_owned()], ratio, rate, samples, figures }
}

fn table(title: &str, about: &str, figures: [&str; 2], mut rows: Vec<Row>) -> Table {
    rows.retain(|row| row.rate.median > 0.0);
    Table {
        title: title.to_owned(),
        about: about.to_owned(),
        labels: vec!["part".to_owned()],
        unit: "us/pixel".to_owned(),
        figures: figures.map(str::to_owned).into(),
        rows,
        warnings: Vec::new(),
    }
}

/// Returns the times and rays of all steps.
fn steps(images: &[Image]) -> Table {
    let rays = |stages: &[Stage]| {
        let of_kind =
            |image: &Image, kind: usize| stages.iter().map(|stage| image.rays(*stage)[kind]).sum::<f64>();
        [0, 1].map(|kind| median(images, |image| of_kind(image, kind) / image.pixels))
    };
    let of_stage = |stage: Stage| row(images, stage.name(), &rays(&[stage]), |image| image.step(stage));
    let mut rows: Vec<Row> = Stage::ALL.into_iter().map(of_stage).collect();
    rows.push(row(images, "rest", &[0.0; 2], Image::rest));
    rows.push(row(images, "total", &rays(&Stage::ALL), |image| image.seconds));
    table(
        "Steps",
        "Processor time of the default method on one thread, in at most three rounds. Ratio to the total.",
        ["closest-hit rays/pixel", "shadow rays/pixel"],
        rows,
    )
}

/// Returns the times within Embree and the denoiser.
fn embree(images: &[Image]) -> Table {
    let queries = |label: &str, chosen: &dyn Fn(&Image) -> Vec<Metered>| {
        let sum = |image: &Image| {
            chosen(image).iter().fold(Metered::default(), |sum, part| Metered {
                rays: sum.rays + part.rays,
                seconds: sum.seconds + part.seconds,
            })
        };
        let rays = median(images, |image| sum(image).rays / image.pixels);
        let price = median(images, |image| 1e9 * sum(image).seconds / sum(image).rays.max(1.0));
        row(images, label, &[rays, price], |image| sum(image).seconds)
    };
    let mut rows = Vec::new();
    for (step, labels) in [EYE_PASS, OTHERS].into_iter().enumerate() {
        let kinds = labels.into_iter().enumerate();
        rows.extend(kinds.map(|(kind, label)| queries(label, &|image| vec![image.queries()[step][kind]])));
    }
    rows.push(queries("eye pass: all rays", &|image| image.queries()[0].into()));
    rows.push(queries("Embree", &|image| image.queries.into()));
    let denoising = |image: &Image| image.step(Stage::Denoise);
    let of_embree = |image: &Image| image.queries.iter().map(|part| part.seconds).sum::<f64>();
    rows.push(row(images, "denoiser", &[0.0; 2], denoising));
    rows.push(row(images, "Embree and denoiser", &[0.0; 2], |image| of_embree(image) + denoising(image)));
    table(
        "Embree and denoiser",
        "Time of Embree's queries, of which one of thirteen is timed, and of the denoiser. Eye rays are packets of \
         similar rays. Ratio to the total.",
        ["rays/pixel", "ns/ray"],
        rows,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use readers::LoadOptions;

    #[test]
    fn the_meter_counts_the_rays_that_steps_report() {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/cornell.toml");
        let session = Session::open(&scene, &LoadOptions::default()).unwrap().session;
        let framing = Framing { resolution: Some([48, 32]), ..Framing::default() };
        let view = View::new(&session.cameras, &framing).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let image = Image::render(&session, &view, Method::default(), folder.path()).unwrap();
        let [eye, others] = image.queries();
        let [hits, shadows] = image.rays(Stage::EyePass);
        let near = |found: f64, expected: f64| (found / expected - 1.0).abs() < 0.1;
        assert!(
            near(eye[0].rays + eye[1].rays, hits) && near(eye[2].rays, shadows),
            "{eye:?} {hits} {shadows}"
        );
        let all = Stage::ALL.map(|stage| image.rays(stage)[1]).iter().sum::<f64>();
        assert!(near(eye[2].rays + others[2].rays, all), "{others:?} {all}");
        let of_embree: f64 = image.queries.iter().map(|part| part.seconds).sum();
        assert!(of_embree > 0.0 && of_embree < image.seconds && image.rest() < image.seconds);
    }
}
