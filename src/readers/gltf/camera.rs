//! Cameras, and their animation as a camera path.

use super::animation::Track;
use super::document::GltfFile;
use super::nodes::Placed;
use super::pose::Pose;
use super::transform::Place;
use crate::draft::{DEFAULT_RESOLUTION, DraftCamera, DraftView, Shot};
use crate::error::SceneError;
use crate::findings::Findings;
use base::math::{right_of, unflattened, unit};
use glam::{DMat4, DVec3};
use gltf_json::camera::{Camera, Type};
use gltf_json::validation::Checked;
use scene::{MAX_FRAMES, Projection};

/// Default frames per second of animations. glTF counts in seconds.
pub(crate) const FRAMES_PER_SECOND: f64 = 24.0;

/// Cameras of a file, and its transform to the world.
pub(super) struct Viewer<'a> {
    pub document: &'a GltfFile,
    pub tree: &'a [Placed],
    pub pose: &'a Pose,
    pub to_world: DMat4,
    pub fps: f64,
}

impl Viewer<'_> {
    /// Returns the shot of the file's first camera that is not hidden, or of the one that `wanted` names or numbers
    /// from 1.
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
        let chosen = match wanted {
            None => cameras.iter().find(|(at, _)| !self.tree[*at].place.is_hidden()).or(cameras.first()),
            Some(wanted) => {
                let number = wanted.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
                let by_name = cameras
                    .iter()
                    .find(|(at, camera)| name(*at) == wanted || camera.name.as_deref() == Some(wanted));
                let camera = by_name.or_else(|| cameras.get(number?));
                let unknown = || {
                    let remedy = match cameras.len() {
                        0 => "the model has none: leave --camera out".to_owned(),
                        _ => format!("--camera chooses among {}", names(&cameras)),
                    };
                    self.document.place.no_camera(wanted, remedy)
                };
                Some(camera.ok_or_else(unknown)?)
            }
        };
        let Some(&(at, camera)) = chosen else { return Ok(None) };
        if self.tree[at].place.is_hidden() {
            let what = "a camera has a scale of 0";
            report.note(what, "it is used all the same: scales do not change cameras", name(at));
        }
        if cameras.len() > 1 && wanted.is_none() {
            let what = format!("there are {} cameras: {}", cameras.len(), names(&cameras));
            let fallback = match cameras.first().is_some_and(|(first, _)| *first == at) {
                true => "the first is used; choose another with --camera",
                false => "the first without a scale of 0 is used; choose another with --camera",
            };
            report.note(&what, fallback, "");
        }
        let lens = self.lens(at, camera)?;
        let resolution = lens.resolution();
        let still = self.camera(&self.tree[at].place, &lens, resolution)?;
        let path = self.path(at, &lens, resolution)?;
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
            let camera = self.camera(&self.tree[at].place, &lens, resolution)?;
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
        Lens::read(camera)
            .ok_or_else(|| self.document.wrong(format!("the camera {} has no lens", self.name(at))))
    }

    /// Returns one camera per frame of the animation, if the animation moves the camera.
    fn path(&self, at: usize, lens: &Lens, resolution: [u32; 2]) -> Result<Vec<DraftCamera>, SceneError> {
        let chain: Vec<usize> = self.chain(at).collect();
        let moves = |&at: &usize| self.pose.clip.of_node(self.tree[at].node).any(Track::moves);
        if !chain.iter().any(moves) {
            return Ok(Vec::new());
        }
        let frames = self.pose.clip.frames(self.fps);
        if frames > MAX_FRAMES {
            return Err(self.document.wrong(format!("the camera's animation takes {frames} frames")));
        }
        let frame = |i: usize| self.camera(&self.moved(&chain, i as f64 / self.fps), lens, resolution);
        (0..frames).map(frame).collect()
    }

    /// Returns a node of the tree, and those above it.
    fn chain(&self, at: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(at), |&at| self.tree[at].parent)
    }

    /// Returns the place of the first node in a chain of parents at a time in seconds.
    fn moved(&self, chain: &[usize], time: f64) -> Place {
        let local = |at: usize| self.pose.local_at(self.document, self.tree[at].node, Some(time));
        chain.iter().rev().fold(Place::default(), |place, &at| place.child(&local(at)))
    }

    fn camera(&self, place: &Place, lens: &Lens, resolution: [u32; 2]) -> Result<DraftCamera, SceneError> {
        let axes = unflattened(self.to_world) * place.axes;
        let forward = unit(axes.transform_vector3(DVec3::NEG_Z));
        let right = forward.and_then(|forward| right_of(forward, axes.transform_vector3(DVec3::Y)));
        let origin = (self.to_world * place.to_file).transform_point3(DVec3::ZERO);
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
    fn read(camera: &Camera) -> Option<Lens> {
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
