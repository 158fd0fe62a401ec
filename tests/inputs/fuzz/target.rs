//! A case: a file, read in place of one of a scene's, and the scene rendered.

use super::mutate::Random;
use super::seeds::corpus;
use crate::sound::assert_sound;
use lightsplat::film::{ExrFile, Pixels};
use lightsplat::math::Rgb;
use lightsplat::method::Method;
use lightsplat::progress::Control;
use lightsplat::readers::{EnvironmentChoice, Lighting, LoadOptions, Loaded, SceneError, ViewList, load};
use lightsplat::session::{FrameError, Goal, Remark, Session};
use lightsplat::view::{Framing, View};
use lightsplat::walk::{RetentionLimits, Walk};
use std::fs;
use std::path::{Component, Path, PathBuf};
use std::process::{Command, Stdio};

/// Number of triangles beyond which a scene is not rendered.
const MAX_TRIANGLES: usize = 300_000;

/// Scenes that hold a file of each kind, by the file's name.
fn scenes() -> Vec<(String, String)> {
    let head = "resolution = [8, 8]\ncamera = { origin = [0, 1, 5], target = [0, 0, 0] }\n\
        environment = { radiance = 1 }\nmaterial = [{ name = \"m\", kind = \"diffuse\", reflectance = 0.5 }]\n";
    let mut scenes = Vec::new();
    for mesh in ["obj", "ply", "serialized"] {
        let own = if mesh == "obj" { "mesh = [{ file = \"case.obj\" }, " } else { "mesh = [" };
        let text = format!("{head}{own}{{ file = \"case.{mesh}\", material = \"m\" }}]\n");
        scenes.push((format!("of-{mesh}.toml"), text));
    }
    scenes.push(("of-mtl.toml".to_owned(), format!("{head}mesh = [{{ file = \"of-mtl.obj\" }}]\n")));
    let materials = ["slab", "tiles", "mirror", "glass", "brick", "plaster"]
        .map(|name| format!("usemtl {name}\nf 1/1 2/2 3/3\n"));
    let library =
        format!("mtllib case.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n{}", materials.concat());
    scenes.push(("of-mtl.obj".to_owned(), library));
    for picture in ["png", "jpg", "bmp", "tga", "hdr", "exr"] {
        let text = format!(
            "resolution = [8, 8]\ncamera = {{ origin = [0, 1, 5], target = [0, 0, 0] }}\n\
            environment = {{ file = \"case.{picture}\" }}\nmaterial = [{{ name = \"m\", kind = \"roughplastic\", \
            diffuse = \"case.{picture}\", alpha = \"case.{picture}\", opacity = \"case.{picture}\", \
            normal_map = \"case.{picture}\" }}]\nmesh = [{{ shape = \"cube\", material = \"m\" }}]\n"
        );
        scenes.push((format!("of-{picture}.toml"), text));
    }
    let spectrum = "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"constant\"/>\
        <shape type=\"cube\"><bsdf type=\"diffuse\"><spectrum name=\"reflectance\" filename=\"case.spd\"/></bsdf>\
        </shape></scene>";
    scenes.push(("of-spd.xml".to_owned(), spectrum.to_owned()));
    scenes
}

/// Returns options for reading without a map of the sky, which takes longer than all else of a small file.
pub fn without_sky() -> LoadOptions {
    let environment = Some(EnvironmentChoice::Constant(Rgb::ONE));
    LoadOptions { lighting: Lighting { environment, ..Lighting::default() }, ..LoadOptions::default() }
}

/// Folder with the corpus and scenes for cases.
pub struct Workplace {
    folder: PathBuf,
    /// A scene that saved walks go through.
    session: Session,
}

impl Workplace {
    /// Fills the folder, which is empty then but for them.
    pub fn new(folder: PathBuf) -> Workplace {
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        for file in fs::read_dir(corpus("valid")).unwrap() {
            let path = file.unwrap().path();
            fs::copy(&path, folder.join(path.file_name().unwrap())).unwrap();
        }
        scenes().into_iter().for_each(|(name, text)| fs::write(folder.join(name), text).unwrap());
        let path = folder.join("void.toml");
        let session = Session::open(&path, &LoadOptions::default()).unwrap().session;
        Workplace { folder, session }
    }

    /// File of the case at hand.
    pub fn case(&self, extension: &str) -> PathBuf {
        self.folder.join("case").with_extension(extension)
    }

    /// Loads the scene that the case is, or is a part of.
    pub fn load(&self, extension: &str, options: &LoadOptions) -> Result<Loaded, SceneError> {
        let scene = match extension {
            // Without triangles, a mesh alone is an error.
            "toml" | "xml" | "gltf" | "glb" | "stl" => self.case(extension),
            "spd" => self.folder.join("of-spd.xml"),
            other => self.folder.join(format!("of-{other}.toml")),
        };
        // Every other case stores instances, which are copied where triangles are few.
        let length = fs::metadata(&scene).map_or(0, |file| file.len());
        let most_copied = options.most_copied.or(length.is_multiple_of(2).then_some(0));
        load(&scene, &LoadOptions { most_copied, ..options.clone() })
    }

    /// Reads the case; returns its scene, if it is a part of one that loads. Models have a sky if it is rendered.
    pub fn read(&self, extension: &str, is_rendered: bool) -> Option<Loaded> {
        let case = self.case(extension);
        match extension {
            "records" => {
                let records = fs::read(case).unwrap();
                let walk =
                    Walk::restored(&self.session, Goal::default(), RetentionLimits::default(), &records);
                let _ = walk.map(|walk| walk.save());
                return None;
            }
            "job" => {
                self.batch(&case);
                return None;
            }
            "json" => {
                self.views(&case);
                return None;
            }
            _ => {}
        }
        if extension == "exr"
            && let Ok(file) = ExrFile::read(&self.case(extension))
        {
            let _ = (file.color(), file.metadata(), file.window(), file.camera());
            file.layers().iter().for_each(|layer| _ = file.layer(layer));
        }
        let has_sky = is_rendered || !matches!(extension, "gltf" | "glb" | "stl");
        match self.load(extension, &if has_sky { LoadOptions::default() } else { without_sky() }) {
            Ok(loaded) => {
                assert_sound(&loaded);
                Some(loaded)
            }
            Err(error) => {
                assert!(error.to_string().contains("; "), "an error without a remedy: {error}");
                None
            }
        }
    }

    /// Reads a list of cameras, whose images stay below their folder.
    fn views(&self, list: &Path) {
        let read = ViewList::read(list, &LoadOptions::default());
        let placed = read.and_then(|list| {
            let is_below =
                |name: &PathBuf| name.components().all(|part| matches!(part, Component::Normal(_)));
            assert!(list.file_names().iter().all(is_below), "{:?}", list.file_names());
            list.in_scene(&self.session.world.scene)
        });
        match placed {
            Ok(views) => assert!(views.iter().all(|view| view.camera.forward.is_normalized()), "{views:?}"),
            Err(error) => assert!(error.to_string().contains("; "), "an error without a remedy: {error}"),
        }
    }

    /// Reads a job file by the command, which ends with an error.
    fn batch(&self, job: &Path) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lightsplat"));
        command.current_dir(&self.folder).args(["batch", "--threads", "1", "--progress", "none"]).arg(job);
        let code =
            command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status().unwrap().code();
        assert!(matches!(code, Some(0 | 2..=5)), "the command ends with {code:?}");
    }
}

/// Prepares a scene for rendering, unless it is too large.
pub fn session_of(loaded: Loaded) -> Option<Session> {
    let triangles: usize = loaded.scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    if triangles > MAX_TRIANGLES {
        return None;
    }
    Session::of(loaded.scene, loaded.cameras).ok()
}

/// Renders a scene on a few pixels, by a method picked.
pub fn render(session: &Session, random: &mut Random) {
    let frames = session.cameras.path.len();
    let mut method = *random.pick(&Method::all().collect::<Vec<_>>());
    for (key, value) in [
        ("spp", "1"),
        ("vpls", "200"),
        ("direct_vpls", "64"),
        ("photons", "500"),
        ("gather_rays", "64"),
        ("probe_rays", "64"),
        ("least_cell", "8"),
        ("max_depth", "64"),
    ] {
        // Methods have some of them.
        let _ = method.set(key, value);
    }
    let frame = (frames > 0 && random.below(2) == 0).then(|| 1 + random.below(frames));
    let framing = Framing { frame, resolution: Some([8, 8]), crop: None };
    let view = View::new(&session.cameras, &framing).unwrap();
    let goal = Goal { method, denoise: Some(false), ..Goal::default() };
    let frame = match session.frame(&view, &goal, &Control::new()) {
        Ok(frame) => frame,
        Err(FrameError::Memory { .. } | FrameError::Unplannable(_)) => return,
        Err(error) => panic!("{error}"),
    };
    let name = method.name();
    assert!(frame.film.color.pixels.iter().all(|pixel| pixel.is_finite()), "{name}");
    for layer in &frame.film.layers {
        let is_finite = match &layer.pixels {
            Pixels::Color(image) | Pixels::Vector(image) => image.pixels.iter().all(|p| p.is_finite()),
            Pixels::Scalar(image) => image.pixels.iter().all(|p| p.is_finite()),
            Pixels::Ranks(image) => image.pixels.iter().flatten().all(|share| share.is_finite()),
            Pixels::Id(_) => true,
        };
        assert!(is_finite, "{name}: layer {}", layer.name);
    }
    for remark in &frame.remarks {
        let (Remark::Note(text) | Remark::Warning(text)) = remark;
        assert!(!text.contains("this is a defect"), "{name}: {text}");
    }
}
