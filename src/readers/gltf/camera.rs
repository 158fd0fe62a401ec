//! Cameras, and their animation as a camera path.

use super::animation::{self, Track};
use super::document::GltfFile;
use super::nodes::{Local, Placed};
use super::report::Findings;
use crate::draft::{DEFAULT_RESOLUTION, DraftCamera, DraftView, Shot};
use crate::error::SceneError;
use base::math::{right_of, unit};
use glam::{DMat4, DVec3};
use gltf_json::animation::{Channel, Property};
use gltf_json::camera::{Camera, Type};
use gltf_json::validation::Checked;
use scene::{MAX_FRAMES, Projection};

/// Default frames per second of animations. glTF counts in seconds.
pub(crate) const FRAMES_PER_SECOND: f64 = 24.0;

/// Cameras of a file, and its transform to the world.
pub(super) struct Viewer<'a> {
    pub document: &'a GltfFile,
    pub tree: &'a [Placed],
    pub to_world: DMat4,
    pub fps: f64,
    /// True if the pose of the model is that of a time.
    pub is_posed: bool,
}

impl Viewer<'_> {
    /// Returns the shot of the file's first camera, or of the one that `wanted` names or numbers from 1.
    ///
    /// Returns `None` for files without cameras.
    pub fn shot(&self, wanted: Option<&str>, report: &mut Findings) -> Result<Option<Shot>, SceneError> {
        let cameras = self.cameras()?;
        let name = |at: usize| self.name(at);
        // Lists numbers and names; a camera without name has a number only.
        let names = |cameras: &[(usize, &Camera)]| {
            let named = |(i, (at, _)): (usize, &(usize, &Camera))| match name(*at) {
                "" => (i + 1).to_string(),
                name => format!("{} ({name})", i + 1),
            };
            cameras.iter().enumerate().map(named).collect::<Vec<_>>().join(", ")
        };
        let found = match wanted {
            None => cameras.first(),
            Some(wanted) => {
                let number = wanted.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
                let by_name = cameras
                    .iter()
                    .find(|(at, camera)| name(*at) == wanted || camera.name.as_deref() == Some(wanted));
                let found = by_name.or_else(|| cameras.get(number?));
                let unknown = || {
                    let remedy = match cameras.len() {
                        0 => "the model has none: leave --camera out".to_owned(),
                        _ => format!("--camera chooses among {}", names(&cameras)),
                    };
                    self.document.place.no_camera(wanted, remedy)
                };
                Some(found.ok_or_else(unknown)?)
            }
        };
        let Some(&(at, camera)) = found else {
            self.report_still(|_| false, report);
            return Ok(None);
        };
        if cameras.len() > 1 && wanted.is_none() {
            let what = format!("there are {} cameras: {}", cameras.len(), names(&cameras));
            report.note(&what, "the first is used; choose another with --camera", "");
        }
        let lens = self.lens(at, camera)?;
        let resolution = lens.resolution();
        let still = self.camera(&self.tree[at].to_file, &lens, resolution)?;
        let path = self.path(at, &lens, resolution, report)?;
        let names = cameras.iter().map(|(at, _)| name(*at).to_owned()).collect();
        Ok(Some(Shot { camera: still, names, fits: false, path, resolution, crop: None }))
    }

    /// Returns all cameras of the file in their order, each with the size of its film.
    pub fn views(&self) -> Result<Vec<Result<DraftView, SceneError>>, SceneError> {
        let view = |(at, camera): (usize, &Camera)| {
            let lens = self.lens(at, camera)?;
            let resolution = lens.resolution();
            let name = match self.name(at) {
                "" => camera.name.as_deref().unwrap_or_default(),
                name => name,
            };
            let camera = self.camera(&self.tree[at].to_file, &lens, resolution)?;
            Ok(DraftView { name: name.to_owned(), is_path: false, camera, resolution: Some(resolution) })
        };
        Ok(self.cameras()?.into_iter().map(view).collect())
    }

    /// Returns the cameras of the file, each with the index of its node in the tree.
    fn cameras(&self) -> Result<Vec<(usize, &Camera)>, SceneError> {
        let nodes = &self.document.root.nodes;
        let of_node = |(at, placed): (usize, &Placed)| nodes[placed.node].camera.map(|index| (at, index));
        let cameras = self.tree.iter().enumerate().filter_map(of_node);
        cameras.map(|(at, index)| Ok((at, self.document.get(index, "camera")?))).collect()
    }

    /// Returns the name of a node of the tree, or nothing.
    fn name(&self, at: usize) -> &str {
        self.document.root.nodes[self.tree[at].node].name.as_deref().unwrap_or_default()
    }

    fn lens(&self, at: usize, camera: &Camera) -> Result<Lens, SceneError> {
        Lens::of(camera)
            .ok_or_else(|| self.document.wrong(format!("the camera {} has no lens", self.name(at))))
    }

    /// Returns one camera per frame, if an animation moves the camera.
    fn path(
        &self,
        at: usize,
        lens: &Lens,
        resolution: [u32; 2],
        report: &mut Findings,
    ) -> Result<Vec<DraftCamera>, SceneError> {
        let chain: Vec<usize> = std::iter::successors(Some(at), |&at| self.tree[at].parent).collect();
        let is_on_the_way = |node: usize| chain.iter().any(|&at| self.tree[at].node == node);
        self.report_still(is_on_the_way, report);
        let mut of_camera: Option<Vec<Track>> = None;
        for animation in &self.document.root.animations {
            let name = animation.name.as_deref().unwrap_or_default();
            let mut tracks = animation::tracks(self.document, animation, is_on_the_way)?;
            tracks.retain(Track::moves);
            if !self.is_posed && tracks.len() < animation.channels.len() {
                let what = "the animation of anything but the camera is not supported";
                report.lacks(
                    what,
                    "it stands still; --frame chooses its pose, or `time` of a mesh in a TOML scene",
                    name,
                );
            }
            match (tracks.is_empty(), &of_camera) {
                (true, _) => {}
                (false, None) => of_camera = Some(tracks),
                (false, Some(_)) => {
                    report.lacks("a second animation of the camera", "the first is used", name)
                }
            }
        }
        let Some(tracks) = of_camera else { return Ok(Vec::new()) };
        let start = tracks.iter().map(|track| track.span()[0]).fold(f32::INFINITY, f32::min);
        let end = tracks.iter().map(|track| track.span()[1]).fold(f32::NEG_INFINITY, f32::max);
        let frames = (((f64::from(end) - f64::from(start)) * self.fps).round() + 1.0) as usize;
        if frames > MAX_FRAMES {
            return Err(self.document.wrong(format!("the camera's animation takes {frames} frames")));
        }
        let frame = |i: usize| {
            let time = f64::from(start) + i as f64 / self.fps;
            self.camera(&self.moved(&chain, &tracks, time), lens, resolution)
        };
        (0..frames).map(frame).collect()
    }

    /// Reports animations that move anything but the camera, which nodes for which `is_on_the_way` holds carry.
    fn report_still(&self, is_on_the_way: impl Fn(usize) -> bool, report: &mut Findings) {
        let is_still = |channel: &Channel| {
            let moves = !matches!(channel.target.path, Checked::Valid(Property::MorphTargetWeights));
            !(moves && is_on_the_way(channel.target.node.value()))
        };
        // The first animation of a model that is posed is read.
        for animation in self.document.root.animations.iter().skip(usize::from(self.is_posed)) {
            if animation.channels.iter().any(is_still) {
                let name = animation.name.as_deref().unwrap_or_default();
                let what = "the animation of anything but the camera is not supported";
                report.lacks(
                    what,
                    "it stands still; --frame chooses its pose, or `time` of a mesh in a TOML scene",
                    name,
                );
            }
        }
    }

    /// Returns the transform of the first node in a chain of parents to the file's coordinates, at a time in seconds.
    fn moved(&self, chain: &[usize], tracks: &[Track], time: f64) -> DMat4 {
        chain.iter().rev().fold(DMat4::IDENTITY, |to_file, &at| {
            let node = self.tree[at].node;
            let mut local = Local::of(&self.document.root.nodes[node]);
            tracks.iter().filter(|track| track.node == node).for_each(|track| track.apply(&mut local, time));
            to_file * local.matrix()
        })
    }

    fn camera(&self, to_file: &DMat4, lens: &Lens, resolution: [u32; 2]) -> Result<DraftCamera, SceneError> {
        let to_world = self.to_world * *to_file;
        let forward = unit(to_world.transform_vector3(DVec3::NEG_Z));
        let right = forward.and_then(|forward| right_of(forward, to_world.transform_vector3(DVec3::Y)));
        let origin = to_world.transform_point3(DVec3::ZERO);
        let (Some(forward), Some(right), true) = (forward, right, origin.is_finite()) else {
            return Err(self.document.wrong("the camera looks nowhere".into()));
        };
        let Lens { half_height, aspect: _, near, far, projection } = *lens;
        if !(half_height > 0.0 && half_height.is_finite() && near >= 0.0 && near < far) {
            let what = format!("half height {half_height}, near {near} and far {far} make no valid view");
            return Err(self.document.wrong(what));
        }
        let tan_half_x = half_height * f64::from(resolution[0]) / f64::from(resolution[1]);
        let placed =
            DraftCamera { origin, forward, right, up: right.cross(forward), ..DraftCamera::default() };
        Ok(DraftCamera { tan_half_x, near, far, projection, ..placed })
    }
}

/// Projection of a camera.
#[derive(Clone, Copy)]
struct Lens {
    /// Tangent of half the vertical field of view; half the film's height for a parallel projection.
    half_height: f64,
    aspect: Option<f64>,
    near: f64,
    far: f64,
    projection: Projection,
}

impl Lens {
    fn of(camera: &Camera) -> Option<Lens> {
        match (&camera.type_, &camera.perspective, &camera.orthographic) {
            (Checked::Valid(Type::Perspective), Some(lens), _) => {
                let fov = f64::from(lens.yfov);
                Some(Lens {
                    half_height: if fov < std::f64::consts::PI { (0.5 * fov).tan() } else { f64::NAN },
                    aspect: lens.aspect_ratio.map(f64::from),
                    near: f64::from(lens.znear),
                    far: lens.zfar.map_or(f64::INFINITY, f64::from),
                    projection: Projection::Pinhole,
                })
            }
            (Checked::Valid(Type::Orthographic), _, Some(film)) => Some(Lens {
                half_height: f64::from(film.ymag).abs(),
                aspect: Some(f64::from(film.xmag / film.ymag).abs()),
                near: f64::from(film.znear),
                far: f64::from(film.zfar),
                projection: Projection::Parallel,
            }),
            _ => None,
        }
    }

    /// Returns a film of the default area in the camera's aspect ratio.
    fn resolution(&self) -> [u32; 2] {
        let [width, height] = DEFAULT_RESOLUTION.map(f64::from);
        match self.aspect.filter(|aspect| (0.01..=100.0).contains(aspect)) {
            Some(aspect) => {
                [(width * height * aspect).sqrt(), (width * height / aspect).sqrt()].map(|n| n.round() as u32)
            }
            None => DEFAULT_RESOLUTION,
        }
    }
}
