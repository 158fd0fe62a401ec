//! Budget of a picture: processor time of the default method by step, and the time that Embree alone needs for rays
//! like those of the eye pass.
//!
//! The picture is rendered as `render` does it, on one thread, without the pilot that chooses the method. Each round
//! renders it with another seed, so that no virtual lights are reused, then traces the stored packets ([`bare`]).
//!
//! Units: microseconds of processor time per pixel; rays per pixel; nanoseconds per ray.

mod bare;
mod packets;
mod picture;
mod round;
mod tables;

use super::{Benchmark, Context, Kind, Table};
use bare::Bare;
use packets::Source;
use picture::Picture;
use render::method::Method;
use round::Round;
use world::view::{Framing, View};

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "budget",
    about: "Processor time of an image by step, and time of Embree alone for rays as in its eye pass",
    kind: Kind::Parts { needs_scene: true, run },
};

/// Maximum number of rounds. A picture takes seconds.
const MAX_ROUNDS: usize = 3;

fn run(context: &Context) -> Vec<Table> {
    match rounds(context) {
        Ok(rounds) => tables::all(&rounds),
        Err(error) => {
            (context.say)(&error);
            Vec::new()
        }
    }
}

/// Renders and measures in turns.
fn rounds(context: &Context) -> Result<Vec<Round>, String> {
    let Some(session) = context.session else { return Ok(Vec::new()) };
    let view = View::new(&session.cameras, &Framing::default()).map_err(|error| error.to_string())?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|error| error.to_string())?;
    let count = context.settings.repeats.clamp(1, MAX_ROUNDS);
    let mut rounds = Vec::with_capacity(count);
    for round in 0..count {
        (context.say)(&format!("picture {} of {count}", round + 1));
        let mut method = Method::default();
        method.set_seed(round as u32);
        let picture = pool.install(|| Picture::render(session, &view, method))?;
        let light_samples = picture.light_samples();
        let source =
            Source { world: &session.world, view: &view, sampling: method.sampling(), light_samples };
        rounds.push(Round { bare: Bare::measure(&source), picture });
    }
    Ok(rounds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::stats::Stage;
    use readers::LoadOptions;
    use render::session::Session;
    use std::path::Path;

    #[test]
    fn packets_hold_about_the_rays_of_the_eye_pass() {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/cornell.toml");
        let session = Session::open(&scene, &LoadOptions::default()).unwrap().session;
        let framing = Framing { resolution: Some([48, 32]), ..Framing::default() };
        let view = View::new(&session.cameras, &framing).unwrap();
        let method = Method::default();
        let picture = Picture::render(&session, &view, method).unwrap();
        let light_samples = picture.light_samples();
        let source =
            Source { world: &session.world, view: &view, sampling: method.sampling(), light_samples };
        let Round { bare, picture } = Round { bare: Bare::measure(&source), picture };
        assert_eq!(bare.eye.rays as f64, picture.pixels * f64::from(method.spp()));
        // Extra samples and pilots come on top of the rays of the packets.
        let per_sample = picture.rays(Stage::EyePass).shadows / picture.eye_rays();
        let found = bare.shadow.rays as f64 / bare.eye.rays as f64;
        assert!(found > 0.5 * per_sample && found < 1.1 * per_sample, "{found} {per_sample}");
        assert!(picture.all_rays().hits > picture.eye_rays());
        assert!(picture.step(Stage::EyePass) < picture.seconds && picture.rest() < picture.seconds);
    }
}
