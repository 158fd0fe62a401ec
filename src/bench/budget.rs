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
use base::stats::{Stage, Stats};
use render::method::Method;
use render::session::{Goal, Session};
use std::error::Error;
use std::path::Path;
use world::view::{Framing, View};

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "budget",
    about: "Processor time of an image by step, and the part of it within Embree and the denoiser",
    kind: Kind::Parts(run),
};

/// Maximum number of rounds. An image takes seconds.
const MAX_ROUNDS: usize = 3;

/// Figures of each kind of query, in the order of [`meter::Query::ALL`].
const FIGURES: [&str; 6] =
    ["eye rays/pixel", "ns/ray", "other closest hits/pixel", "ns/hit", "shadow rays/pixel", "ns/shadow ray"];

/// An image with the times and queries of its steps.
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
        Ok(images) => vec![table(&images)],
        Err(error) => {
            (context.say)(&error.to_string());
            Vec::new()
        }
    }
}

/// Renders an image per round, on one thread.
fn images(context: &Context) -> Result<Vec<Image>, Box<dyn Error>> {
    let session = context.session;
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

    /// Returns the seconds within Embree.
    fn of_embree(&self) -> f64 {
        self.queries.iter().map(|kind| kind.seconds).sum()
    }
}

/// Writes the files that `render` writes.
fn write(film: &Film, folder: &Path) -> Result<(), String> {
    let look = Look { factor: 1.0, curve: ToneCurve::default(), automatic: None };
    write_exr(&folder.join("a.exr"), film).map_err(|error| error.to_string())?;
    write_png(&folder.join("a.png"), &film.color, look).map_err(|error| error.to_string())
}

/// Returns the times and queries of all steps.
fn table(images: &[Image]) -> Table {
    let nothing = [Metered::default(); 3];
    let step =
        |stage: Stage| row(images, stage.name(), |image| (image.step(stage), image.stats.metered(stage)));
    let mut rows: Vec<Row> = Stage::ALL.into_iter().map(step).collect();
    rows.push(row(images, "rest", |image| (image.rest(), nothing)));
    rows.push(row(images, "total", |image| (image.seconds, image.queries)));
    rows.push(row(images, "Embree", |image| (image.of_embree(), image.queries)));
    let foreign = |image: &Image| (image.of_embree() + image.step(Stage::Denoise), nothing);
    rows.push(row(images, "Embree and denoiser", foreign));
    rows.retain(|row| row.rate.median > 0.0);
    Table {
        title: "Budget",
        about: "Processor time of the default method on one thread, in at most three rounds, and Embree's queries, of \
                which one of thirteen is timed. Eye rays are packets of similar rays. Ratio to the total.",
        labels: &["part"],
        unit: "us/pixel",
        figures: &FIGURES,
        rows,
        ..Table::default()
    }
}

/// Returns the row of a part of the images, which takes some seconds and has some queries.
fn row(images: &[Image], label: &str, part: impl Fn(&Image) -> (f64, [Metered; 3])) -> Row {
    let values = |of: &dyn Fn(&Image) -> f64| images.iter().map(of).collect::<Vec<f64>>();
    let samples = values(&|image| 1e6 * part(image).0 / image.pixels);
    let ratios = values(&|image| part(image).0 / image.seconds);
    let figures = (0..3).flat_map(|kind| {
        let rays = values(&|image| part(image).1[kind].rays / image.pixels);
        let price = values(&|image| 1e9 * part(image).1[kind].seconds / part(image).1[kind].rays.max(1.0));
        [rays, price].map(|values| Some(Spread::new(&values).median).filter(|median| *median > 0.0))
    });
    Row {
        labels: vec![label.to_owned()],
        ratio: Spread::new(&ratios),
        rate: Spread::new(&samples),
        samples,
        figures: figures.collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::stats::Counter;
    use readers::LoadOptions;

    #[test]
    fn the_meter_counts_the_rays_that_steps_report() {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/cornell.toml");
        let session = Session::open(&scene, &LoadOptions::default()).unwrap().session;
        let framing = Framing { resolution: Some([48, 32]), ..Framing::default() };
        let view = View::new(&session.cameras, &framing).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let image = Image::render(&session, &view, Method::default(), folder.path()).unwrap();
        let count = |name: &str| match image.stats.get(name) {
            Some(Counter::Count(n)) => n as f64,
            _ => 0.0,
        };
        let [eye_rays, hits, shadows] = image.stats.metered(Stage::EyePass).map(|kind| kind.rays);
        let near = |rays: f64, name: &str| (rays / count(name) - 1.0).abs() < 0.1;
        assert!(near(eye_rays + hits, "Eye/closest-hit rays"), "{eye_rays} {hits}");
        assert!(near(shadows, "Eye/shadow rays") && image.queries[2].rays > shadows, "{shadows}");
        let steps =
            ["Eye", "Records", "Lightcut", "Compensation"].map(|step| count(&format!("{step}/shadow rays")));
        let all = steps.iter().sum::<f64>() + count("Rays/shadow");
        assert!((image.queries[2].rays / all - 1.0).abs() < 0.1, "{} {all}", image.queries[2].rays);
        let of_embree = image.of_embree();
        assert!(of_embree > 0.0 && of_embree < image.seconds && image.rest() < image.seconds);
        assert!(table(&[image]).rows.len() > 8);
    }
}
