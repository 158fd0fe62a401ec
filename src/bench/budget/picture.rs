//! A picture, with the times of its steps and the numbers of its rays.

use crate::measure::Clock;
use base::film::{Film, Look, ToneCurve, write_exr, write_png};
use base::progress::Control;
use base::stats::{Counter, Stage, Stats};
use render::method::Method;
use render::session::{Goal, Session};
use world::view::View;

/// Times and counters of a picture.
pub struct Picture {
    stats: Stats,
    /// Processor seconds from the scene's file to the picture's files.
    pub seconds: f64,
    /// Number of pixels.
    pub pixels: f64,
    /// Samples per pixel that the method was asked for.
    pub spp: u32,
}

/// Numbers of rays by kind.
#[derive(Clone, Copy, Default)]
pub struct RayNumbers {
    /// Closest-hit rays.
    pub hits: f64,
    /// Shadow rays.
    pub shadows: f64,
}

impl Picture {
    /// Renders a picture and writes it to a temporary folder.
    pub fn render(session: &Session, view: &View, method: Method) -> Result<Picture, String> {
        let start = Clock::Process.seconds();
        let goal = Goal { method, ..Goal::default() };
        let frame = session.frame(view, &goal, &Control::new()).map_err(|error| error.to_string())?;
        let mut stats = frame.stats;
        stats.time(Stage::Write, || write(&frame.film))?;
        let mut seconds = Clock::Process.seconds() - start;
        stats.merge(&session.stats);
        seconds += session.stats.stages().map(|(_, time)| time.cpu_seconds).sum::<f64>();
        Ok(Picture { stats, seconds, pixels: view.window.pixel_count() as f64, spp: method.spp() })
    }

    /// Returns the processor seconds of a step.
    pub fn step(&self, stage: Stage) -> f64 {
        self.stats.stage(stage).map_or(0.0, |time| time.cpu_seconds)
    }

    /// Returns the processor seconds outside all steps.
    pub fn rest(&self) -> f64 {
        let steps: f64 = self.stats.stages().map(|(_, time)| time.cpu_seconds).sum();
        (self.seconds - steps).max(0.0)
    }

    /// Returns the rays that a step reports.
    pub fn rays(&self, stage: Stage) -> RayNumbers {
        let of = |names: &[&str]| names.iter().map(|name| self.count(name)).sum::<f64>();
        let eye = self.count("Eye/closest-hit rays");
        match stage {
            Stage::EyePass => RayNumbers { hits: eye, shadows: of(&["Eye/shadow rays"]) },
            Stage::LightPass => {
                RayNumbers { hits: of(&["Rays/closest hit"]) - eye, shadows: of(&["Rays/shadow"]) }
            }
            Stage::Records => RayNumbers { hits: 0.0, shadows: of(&["Records/shadow rays"]) },
            Stage::Render => {
                let names = ["Lightcut/shadow rays", "Compensation/shadow rays"];
                RayNumbers { hits: 0.0, shadows: of(&names) }
            }
            _ => RayNumbers::default(),
        }
    }

    /// Returns the rays of all steps.
    pub fn all_rays(&self) -> RayNumbers {
        Stage::ALL.into_iter().map(|stage| self.rays(stage)).fold(RayNumbers::default(), |sum, rays| {
            RayNumbers { hits: sum.hits + rays.hits, shadows: sum.shadows + rays.shadows }
        })
    }

    /// Returns the number of eye rays, those of extra samples included.
    pub fn eye_rays(&self) -> f64 {
        f64::from(self.spp) * self.pixels + self.count("Eye/extra samples")
    }

    /// Returns the number of light samples at a surface that the eye pass sees.
    pub fn light_samples(&self) -> u32 {
        (self.count("Eye/light samples") as u32).max(1)
    }

    fn count(&self, name: &str) -> f64 {
        match self.stats.get(name) {
            Some(Counter::Count(n)) => n as f64,
            _ => 0.0,
        }
    }
}

/// Writes the files that `render` writes.
fn write(film: &Film) -> Result<(), String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    write_exr(&folder.path().join("a.exr"), film).map_err(|error| error.to_string())?;
    let look = Look { factor: 1.0, curve: ToneCurve::default(), automatic: None };
    write_png(&folder.path().join("a.png"), &film.color, look).map_err(|error| error.to_string())
}
