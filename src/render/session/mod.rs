//! A session: a scene that is ready to render, and its frames.
//!
//! The session holds all that frames share. A [`Goal`] sets how a frame is rendered, what its settings are planned for,
//! and how its error is measured. A [`RenderedFrame`] holds the image and all that is reported about it.

mod context;
mod error;
mod finish;
mod finishing_time;
mod former;
mod frame;
mod frame_report;
mod goal;
mod next_frame;
mod notes;
mod planned;
mod render;
mod report;

pub use error::FrameError;
pub use finish::Finish;
pub(crate) use former::{Former, VisibleDifferences, WalkState};
pub use frame::{Remark, RenderedFrame};
pub use goal::{ErrorLimit, Goal, PlanGoal, TimeGoal};

pub use transport::eye::{Averaging, DEPTH, Feature, Features, NO_DEPTH, UnknownFeature};

use crate::method::LightStore;
use base::stats::{Stage, Stats};
use embree::EmbreeError;
use glam::Vec2;
use readers::{Lens, LoadOptions, Loaded, SanitizeReport, SceneError, Warning, load};
use scene::{Camera, Cameras, Projection, Scene};
use std::path::{Path, PathBuf};
use world::World;
use world::view::View;

/// A scene prepared for rendering, with the cameras of its file.
pub struct Session {
    /// The scene, its acceleration structure, materials and emitters.
    pub world: World,
    /// The cameras of the scene's file.
    pub cameras: Cameras,
    /// Hash over the bytes of all source files; 0 for a scene made in memory.
    pub hash: u64,
    /// Times of loading and building.
    pub stats: Stats,
    /// Virtual lights of the last frame.
    lights: LightStore,
    /// Lens of all cameras, if the options of reading have one.
    lens: Option<Lens>,
}

/// A session, and reports of reading its scene.
pub struct Opened {
    /// The session.
    pub session: Session,
    /// Warnings about features that were replaced, in the order of the description.
    pub warnings: Vec<Warning>,
    /// Report of repairs.
    pub repairs: SanitizeReport,
    /// True if the options ask for a frame of a model whose meshes or lights move.
    pub moves: bool,
}

/// Reason why a session cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// The scene cannot be read.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The acceleration structure cannot be built.
    #[error("cannot build {}", path.display())]
    Build {
        /// The scene's file.
        path: PathBuf,
        /// Embree's reason.
        source: EmbreeError,
    },
}

impl Session {
    /// Reads the scene at `path` and prepares it for rendering, on the threads of the current pool.
    ///
    /// # Errors
    /// If the scene cannot be read, or its acceleration structure cannot be built.
    pub fn open(path: &Path, options: &LoadOptions) -> Result<Opened, OpenError> {
        let mut stats = Stats::new();
        let Loaded { scene, cameras, warnings, repairs, hash, moves, .. } =
            stats.time(Stage::Load, || load(path, options))?;
        let session = Session::build(scene, cameras, stats)
            .map_err(|source| OpenError::Build { path: path.to_owned(), source })?;
        let mut session = Session { hash, lens: options.viewpoint.lens, ..session };
        session.cameras.still = session.through_lens(session.cameras.still);
        let path = session.cameras.path.iter().map(|camera| session.through_lens(*camera));
        session.cameras.path = path.collect();
        Ok(Opened { session, warnings, repairs, moves })
    }

    /// Prepares a scene made in memory for rendering, on the threads of the current pool.
    ///
    /// # Errors
    /// If the acceleration structure cannot be built.
    pub fn of(scene: Scene, cameras: Cameras) -> Result<Session, EmbreeError> {
        Session::build(scene, cameras, Stats::new())
    }

    fn build(scene: Scene, cameras: Cameras, mut stats: Stats) -> Result<Session, EmbreeError> {
        let world = stats.time(Stage::Build, || World::new(scene, rayon::current_num_threads()))?;
        Ok(Session { world, cameras, hash: 0, stats, lights: LightStore::default(), lens: None })
    }

    /// Returns a camera with the lens of all cameras. Without a distance, the surface in the middle of the image is in
    /// focus. A parallel projection stays, and a camera that sees nothing there.
    pub(crate) fn through_lens(&self, camera: Camera) -> Camera {
        let Some(lens) = self.lens.filter(|_| camera.projection != Projection::Parallel) else {
            return camera;
        };
        let scale = 1.0 / self.world.scene.unit();
        let ray = View::whole(Camera { projection: Projection::Pinhole, ..camera }, [1, 1]);
        let ray = ray.primary_ray([0, 0], Vec2::splat(0.5));
        let in_middle = || Some(self.world.intersect(&ray)?.t * ray.direction.dot(camera.forward));
        let distance = lens.focus.map(|focus| (focus * scale) as f32).or_else(in_middle);
        let radius = (lens.radius * scale) as f32;
        distance
            .map_or(camera, |distance| Camera { projection: Projection::Lens { radius, distance }, ..camera })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::{Method, vpl};
    use base::progress::Control;
    use base::stats::Counter;
    use world::view::{Framing, View};

    #[test]
    fn frames_of_a_session_share_lights_and_have_the_bits_of_single_frames() {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/cornell.toml");
        let open = || Session::open(&scene, &LoadOptions::default()).unwrap().session;
        let mut settings = vpl::Settings { spp: 1, ..vpl::Settings::reconstruction() };
        settings.light.indirect = 2000;
        let goal = |settings| Goal { method: Method::Vpl(settings), ..Goal::default() };
        let framing = |crop| Framing { resolution: Some([32, 32]), crop, ..Framing::default() };
        let session = open();
        let frame = |session: &Session, settings, crop| {
            let view = View::new(&session.cameras, &framing(crop)).unwrap();
            session.frame(&view, &goal(settings), &Control::new()).unwrap()
        };
        let lights = |frame: &RenderedFrame| frame.stats.get("VPLs/total");
        let first = frame(&session, settings, None);
        assert!(matches!(lights(&first), Some(Counter::Count(n)) if n > 2000));
        let crop = Some([[5, 7], [20, 10]]);
        let second = frame(&session, settings, crop);
        assert_eq!(lights(&second), None);
        assert_eq!(second.film.color, frame(&open(), settings, crop).film.color);
        // Other settings make other lights.
        settings.light.indirect = 3000;
        assert!(lights(&frame(&session, settings, None)).is_some());
    }
}
