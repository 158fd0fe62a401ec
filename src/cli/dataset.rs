//! `lightsplat dataset`: renders many models from random cameras in random light.
//!
//! The command writes a list of cameras per model and a job file, and renders the entries of the job file as a batch.
//! An entry has the views of a model in one light.

use super::batch::{BatchRun, Manner};
use super::dataset_args::DatasetArgs;
use super::exit::{self, Failure};
use super::reading_args::given_light;
use super::shell::Shell;
use super::values::Resolution;
use super::{batch_file, files, info_lists, talk, threads};
use anyhow::{Context, anyhow};
use base::sampling::Sampler;
use rayon::prelude::*;
use readers::{LoadOptions, UpAxis, ViewList, fnv1a, is_built_in, load};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf, absolute};
use toml::Table;

/// Width and height of images without --size, in pixels.
const SIZE: [u32; 2] = [256, 256];

/// Horizontal field of view of random cameras without --fov, in degrees.
const FOV: f64 = 40.0;

/// A model of a data set.
struct Model {
    /// File, or name of a built-in scene.
    path: PathBuf,
    /// Name of its folder.
    folder: String,
    /// Light of each view, as an index into the lights.
    lights: Vec<usize>,
    /// Box around it.
    bounds: Value,
}

/// Runs the command.
pub fn run(args: DatasetArgs) -> Result<(), Failure> {
    talk::start(args.picture.progress, args.picture.loudness(), "dataset");
    args.picture.reading.check_unplaced("random cameras", args.cameras.is_some())?;
    if args.picture.dry_run {
        return Err(Failure::usage(anyhow!(
            "--dry-run writes nothing, and a data set needs its lists of cameras; use --plan, and lightsplat batch \
             jobs.toml --dry-run"
        )));
    }
    fs::create_dir_all(&args.output)
        .with_context(|| format!("cannot make {}", args.output.display()))
        .map_err(Failure::output)?;
    let threads = threads::count(args.picture.threads);
    let plan = Plan::new(&args)?;
    let named: Vec<(PathBuf, String)> = args.models.iter().cloned().zip(folders(&args.models)).collect();
    let models: Vec<Result<Model, Failure>> = threads::pool(threads)?
        .install(|| named.into_par_iter().map(|(path, folder)| plan.model(path, folder)).collect());
    let (mut kept, mut left_out) = (Vec::new(), Vec::new());
    for (path, model) in args.models.iter().zip(models) {
        match model {
            Ok(model) => kept.push(model),
            Err(failure) => {
                talk::error(&failure.within(path));
                left_out.push(path.display().to_string());
            }
        }
    }
    let jobs = args.output.join("jobs.toml");
    files::save(&jobs, plan.jobs(&kept).as_bytes())?;
    let metadata = format!("{:#}\n", plan.metadata(&kept, &left_out));
    files::save(&args.output.join("metadata.json"), metadata.as_bytes())?;
    let done = match args.plan || kept.is_empty() {
        true => Ok(()),
        false => {
            let more: &[&str] = if args.picture.resume { &["--resume"] } else { &[] };
            let jobs_at_once = args.jobs.map_or(threads, |jobs| jobs.get());
            let manner = Manner { jobs: jobs_at_once, dry_run: false, progress: args.picture.progress };
            BatchRun::new(manner)?.run(batch_file::read(&jobs, more)?, threads)
        }
    };
    let is_stopped = done.as_ref().is_err_and(|failure| failure.code() != exit::IN_PART);
    if left_out.is_empty() || is_stopped {
        return done;
    }
    let more = done.map_or_else(|failure| format!("; {failure}"), |()| String::new());
    Err(Failure::in_part(anyhow!(
        "{} of {} models cannot be read and are left out: {}{more}",
        left_out.len(),
        args.models.len(),
        left_out.join(", ")
    )))
}

/// Returns the name of each model's folder: the name of its file. Equal names get numbers.
fn folders(models: &[PathBuf]) -> Vec<String> {
    let mut uses: BTreeMap<String, usize> = BTreeMap::new();
    let mut name = |path: &PathBuf| {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let count = uses.entry(stem.to_lowercase()).or_default();
        *count += 1;
        if *count > 1 { format!("{stem}_{count}") } else { stem }
    };
    models.iter().map(&mut name).collect()
}

/// Choices for all models of a data set.
struct Plan<'a> {
    args: &'a DatasetArgs,
    reading: LoadOptions,
    /// Lights as values of `env`; none for the light of the models.
    lights: Vec<String>,
    /// Cameras of all models, if they are not random.
    list: Option<ViewList>,
    size: [u32; 2],
    seed: u32,
}

impl Plan<'_> {
    fn new(args: &DatasetArgs) -> Result<Plan<'_>, Failure> {
        let reading = args.picture.reading.clone().options();
        let list = args.cameras.as_ref().map(|list| ViewList::read(list, &reading));
        let given = args.picture.reading.env();
        Ok(Plan {
            args,
            lights: args.light.iter().chain(given).map(given_light).collect(),
            list: list.transpose().map_err(Failure::input)?,
            reading,
            size: args.picture.resolution.map_or(SIZE, |size: Resolution| size.pixels(SIZE)),
            seed: args.method.method()?.seed(),
        })
    }

    /// Chooses the cameras and lights of a model, and writes its list of cameras.
    fn model(&self, path: PathBuf, folder: String) -> Result<Model, Failure> {
        let scene = load(&path, &self.reading).map_err(Failure::input)?.scene;
        let up = self.reading.upward(&path).unwrap_or(UpAxis::Y);
        let shell = Shell::around(&scene, up)
            .ok_or_else(|| Failure::input(anyhow!("there is no triangle; name another model")))?;
        let seed = fnv1a(folder.as_bytes()) as u32 ^ self.seed;
        let numbers = self.list.as_ref().map(|list| list.numbers().to_owned());
        let numbers = numbers.unwrap_or_else(|| (1..=self.args.views.get()).collect());
        let light = |number: &usize| {
            let mut sampler = Sampler::new(!seed, *number as u32);
            ((sampler.next_1d() * self.lights.len() as f32) as usize).min(self.lights.len().saturating_sub(1))
        };
        let lights: Vec<usize> = numbers.iter().map(light).collect();
        let model = Model { path, folder, lights, bounds: info_lists::bounds(&scene) };
        if self.list.is_none() {
            let own = self.args.output.join(&model.folder);
            fs::create_dir_all(&own)
                .with_context(|| format!("cannot make {}", own.display()))
                .map_err(Failure::output)?;
            let list = self.transforms(&model, &shell, seed);
            files::save(&own.join("transforms.json"), format!("{list:#}\n").as_bytes())?;
        }
        Ok(model)
    }

    /// Returns the random cameras of a model.
    fn transforms(&self, model: &Model, shell: &Shell, seed: u32) -> Value {
        let fov = self.reading.viewpoint.fov.unwrap_or(FOV).to_radians();
        let [width, height] = self.size.map(f64::from);
        // The narrower side of the image holds the whole model.
        let narrow = (0.5 * fov).tan() * (height / width).min(1.0);
        let frame = |number: usize| {
            let mut sampler = Sampler::new(seed, number as u32);
            let (around, along) = (sampler.next_2d(), sampler.next_1d());
            let pose = shell.pose(around, along, [self.args.elevations, self.args.distances], narrow);
            let mut frame = json!({ "file_path": format!("{number:04}.png"), "transform_matrix": pose });
            let light = model.lights.get(number - 1).and_then(|light| self.lights.get(*light));
            if let Some(light) = light {
                frame["light"] = light.as_str().into();
            }
            frame
        };
        let focal = 0.5 * width / (0.5 * fov).tan();
        json!({
            "camera_angle_x": fov,
            "fl_x": focal, "fl_y": focal, "cx": 0.5 * width, "cy": 0.5 * height,
            "w": self.size[0], "h": self.size[1],
            "frames": (1..=model.lights.len()).map(frame).collect::<Vec<Value>>(),
        })
    }

    /// Returns the job file, with an entry per model and light.
    fn jobs(&self, models: &[Model]) -> String {
        let mut options = self.args.options.clone();
        let [width, height] = self.size;
        options.insert("resolution".to_owned(), format!("{width}x{height}").into());
        let entries = models.iter().flat_map(|model| {
            (0..self.lights.len().max(1)).filter_map(|light| self.entry(model, light)).collect::<Vec<Table>>()
        });
        let pictures = toml::Value::Array(entries.map(toml::Value::Table).collect());
        Table::from_iter([("options".to_owned(), options.into()), ("picture".to_owned(), pictures)])
            .to_string()
    }

    /// Returns the entry of a model's views in one light; `None` if there is none.
    fn entry(&self, model: &Model, light: usize) -> Option<Table> {
        let numbers = match &self.list {
            Some(list) => list.numbers().to_owned(),
            None => (1..=model.lights.len()).collect(),
        };
        let lit = numbers.iter().zip(&model.lights).filter(|(_, of_view)| **of_view == light);
        let only: Vec<String> = lit.map(|(number, _)| number.to_string()).collect();
        if only.is_empty() {
            return None;
        }
        let full = |path: &Path| absolute(path).unwrap_or(path.to_owned()).to_string_lossy().into_owned();
        let is_name = is_built_in(&model.path) && !model.path.is_file();
        let scene = if is_name { model.path.to_string_lossy().into_owned() } else { full(&model.path) };
        let own_list = || format!("{}/transforms.json", model.folder);
        let views = self.args.cameras.as_deref().map_or_else(own_list, full);
        let keys =
            [("scene", scene), ("views", views), ("output", model.folder.clone()), ("only", only.join(","))];
        let light = self.lights.get(light).map(|light| ("env", light.clone()));
        Some(keys.into_iter().chain(light).map(|(key, value)| (key.to_owned(), value.into())).collect())
    }

    /// Returns the facts about the data set.
    fn metadata(&self, models: &[Model], left_out: &[String]) -> Value {
        let model = |model: &Model| {
            let lights: Vec<Option<&String>> =
                model.lights.iter().map(|light| self.lights.get(*light)).collect();
            json!({
                "model": model.path.to_string_lossy(),
                "folder": model.folder,
                "bounds": model.bounds,
                "views": model.lights.len(),
                "lights": lights,
            })
        };
        json!({
            "program": concat!("lightsplat ", env!("CARGO_PKG_VERSION")),
            "seed": self.seed,
            "size": self.size,
            "cameras": self.args.cameras,
            "distances": self.args.distances,
            "elevations": self.args.elevations,
            "models": models.iter().map(model).collect::<Vec<Value>>(),
            "left_out": left_out,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_of_one_name_have_folders_of_their_own() {
        let models = ["a/chair.glb", "b/Chair.obj", "lamp.glb"].map(PathBuf::from);
        assert_eq!(folders(&models), ["chair", "Chair_2", "lamp"]);
    }
}
