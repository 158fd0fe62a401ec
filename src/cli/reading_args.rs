//! Options of reading a scene: its camera and light, and changes of both.

use super::exit::Failure;
use super::values::scale;
use anyhow::anyhow;
use clap::{Args, ValueEnum};
use glam::DVec3;
use readers::{EnvironmentChoice, Lens, Lighting, LoadOptions, Looks, UpAxis, Viewpoint};
use std::path::Path;

/// Options of reading a scene.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Scene, light and camera")]
pub struct ReadingArgs {
    /// Environment that replaces the environment of the scene: an image, a colour or a sky. An image is a
    /// latitude-longitude map (EXR, HDR). A colour is 0.5, R,G,B or #rrggbb. `sky` is a clear sky with its sun, and
    /// `sky,AZIMUTH,ELEVATION` places the sun in degrees. Azimuth 0 is the front, 90 the right
    #[arg(long, value_name = "FILE|COLOUR|sky")]
    env: Option<EnvironmentChoice>,
    /// Rotation of --env about the upward axis in degrees, counter-clockwise seen from above
    #[arg(long, value_name = "DEGREES", requires = "env", value_parser = angle)]
    env_rotate: Option<f64>,
    /// Background of the image. With none, the environment lights the scene, and appears in mirrors and through glass.
    /// Where the camera would see it, RGB and the layer A of the OpenEXR file are 0. The PNG has an alpha channel
    #[arg(long, value_enum, value_name = "BACKGROUND", default_value_t)]
    background: Background,
    /// Do not add a sky to a model without lights
    #[arg(long)]
    no_default_light: bool,
    /// Camera of the scene, by number (counted from 1) or by name [default: 1]
    #[arg(short, long, value_name = "N|NAME")]
    camera: Option<String>,
    /// Position of the camera, in units of the scene. Without --look-at, the camera looks at the middle of the scene
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    look_from: Option<DVec3>,
    /// Point that the camera looks at
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    look_at: Option<DVec3>,
    /// Horizontal field of view in degrees
    #[arg(long, value_name = "DEGREES", value_parser = angle)]
    fov: Option<f64>,
    /// Azimuth of a camera that frames the whole scene, in degrees. 0 is the front, 90 the right
    #[arg(long, value_name = "DEGREES", value_parser = angle, conflicts_with_all = ["look_from", "look_at"])]
    azimuth: Option<f64>,
    /// Elevation of a camera that frames the whole scene, in degrees above the horizon
    #[arg(long, value_name = "DEGREES", value_parser = elevation, conflicts_with_all = ["look_from", "look_at"])]
    elevation: Option<f64>,
    /// Upward axis for the options of camera and light [default: y; z for STL]
    #[arg(long, value_enum, value_name = "AXIS")]
    up: Option<UpAxisName>,
    /// Value of the parameter `$NAME` of a Mitsuba scene, which replaces its `<default>`. May be repeated
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE", value_parser = definition)]
    define: Vec<(String, String)>,
    /// Units of the lamps of a glTF model, candela or lux, that count for 1 W/sr or 1 W/m² [default: as its exporter
    /// writes them]
    #[arg(long, value_name = "N", value_parser = scale)]
    lumens_per_watt: Option<f32>,
    /// Render glass of a glTF model without a volume as thin walls, even if Blender wrote a closed mesh
    #[arg(long)]
    thin_glass: bool,
    /// Radius of the lens of all cameras, in units of the scene: what is not in focus is blurred
    #[arg(long, value_name = "RADIUS", value_parser = scale)]
    aperture: Option<f32>,
    /// Distance in focus along the axis of the camera [default: the surface in the middle of the image]
    #[arg(long, value_name = "DISTANCE", value_parser = scale, requires = "aperture")]
    focus: Option<f32>,
    /// Render all surfaces as grey clay. Emitters and holes stay
    #[arg(long)]
    clay: bool,
    /// Show only meshes with this name, or with a material of this name. `*` stands for any characters. May be repeated
    #[arg(long, value_name = "NAME")]
    show: Vec<String>,
    /// Leave out meshes with this name, or with a material of this name. May be repeated
    #[arg(long, value_name = "NAME")]
    hide: Vec<String>,
    /// Number of triangles up to which instances are copied. Copies are traced faster, and instances take less memory
    /// [default: 1000000]
    #[arg(long, value_name = "TRIANGLES")]
    max_copied: Option<u64>,
    /// Fail, instead of warning, if the scene has an unsupported feature or the image is black
    #[arg(long)]
    pub strict: bool,
}

/// Background of the image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Background {
    /// The environment
    #[default]
    Environment,
    /// Nothing: the image is transparent there
    None,
}

/// Upward axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum UpAxisName {
    /// The front of the scene is +z
    Y,
    /// The front of the scene is -y
    Z,
}

/// Azimuth and elevation of the default camera, in degrees.
const AROUND: [f64; 2] = [30.0, 20.0];

/// Returns a light as a value of --env. The file of a map has its full path.
pub fn given_light(light: &EnvironmentChoice) -> String {
    match light {
        EnvironmentChoice::Map(path) => {
            std::path::absolute(path).unwrap_or(path.clone()).to_string_lossy().into_owned()
        }
        EnvironmentChoice::Constant(radiance) => format!("{},{},{}", radiance.x, radiance.y, radiance.z),
        EnvironmentChoice::Sky([azimuth, elevation]) => format!("sky,{azimuth},{elevation}"),
    }
}

impl ReadingArgs {
    /// Returns the light that replaces the light of the scene.
    pub fn env(&self) -> Option<&EnvironmentChoice> {
        self.env.as_ref()
    }

    /// Returns the options of the scene reader.
    pub fn options(self) -> LoadOptions {
        let around = match (self.azimuth, self.elevation) {
            (None, None) => None,
            (azimuth, elevation) => Some([azimuth.unwrap_or(AROUND[0]), elevation.unwrap_or(AROUND[1])]),
        };
        LoadOptions {
            strict: self.strict,
            frame: None,
            camera: self.camera,
            parameters: self.define,
            lighting: Lighting {
                environment: self.env,
                rotation: self.env_rotate.unwrap_or(0.0),
                no_default: self.no_default_light,
                hides_background: self.background == Background::None,
            },
            viewpoint: Viewpoint {
                from: self.look_from,
                at: self.look_at,
                fov: self.fov,
                around,
                turntable: None,
                lens: self
                    .aperture
                    .map(|radius| Lens { radius: radius.into(), focus: self.focus.map(f64::from) }),
            },
            looks: Looks { clay: self.clay, show: self.show, hide: self.hide },
            most_copied: self.max_copied,
            lumens_per_watt: self.lumens_per_watt,
            thin_glass: self.thin_glass,
            up: self.up.map(|axis| match axis {
                UpAxisName::Y => UpAxis::Y,
                UpAxisName::Z => UpAxis::Z,
            }),
        }
    }
}

impl ReadingArgs {
    /// Refuses options that place or choose the camera of a still, for a command that renders other `cameras`. With
    /// `has_lenses`, those cameras have fields of view of their own.
    ///
    /// # Errors
    /// If there is such an option.
    pub fn check_unplaced(&self, cameras: &str, has_lenses: bool) -> Result<(), Failure> {
        let given = [
            ("--look-from", self.look_from.is_some()),
            ("--look-at", self.look_at.is_some()),
            ("--azimuth", self.azimuth.is_some()),
            ("--elevation", self.elevation.is_some()),
            ("--fov", has_lenses && self.fov.is_some()),
        ];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(Failure::usage(anyhow!(
                "{option} changes the camera of a still, and this command renders {cameras}; leave {option} out, or use \
                 lightsplat render"
            ))),
            None => Ok(()),
        }
    }

    /// Returns the options of the scene reader for a frame of the scene at `path`. Models of glTF alone have poses.
    pub fn options_at(self, path: &Path, frame: Option<usize>) -> LoadOptions {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        let has_poses = extension.is_some_and(|extension| matches!(extension.as_str(), "glb" | "gltf"));
        LoadOptions { frame: frame.filter(|_| has_poses), ..self.options() }
    }
}

fn definition(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("write NAME=VALUE")?;
    if name.is_empty() { Err("the name is empty".into()) } else { Ok((name.to_owned(), value.to_owned())) }
}

fn number(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|number: &f64| number.is_finite())
}

fn angle(text: &str) -> Result<f64, String> {
    number(text).filter(|angle| angle.abs() <= 36e3).ok_or_else(|| "expected an angle in degrees".to_owned())
}

fn elevation(text: &str) -> Result<f64, String> {
    let angle = number(text).filter(|angle| angle.abs() <= 90.0);
    angle.ok_or_else(|| "expected an angle from -90 to 90 degrees".to_owned())
}

fn point(text: &str) -> Result<DVec3, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(number).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
        _ => Err("expected three numbers like 0,1.5,-4".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct Alone {
        #[command(flatten)]
        reading: ReadingArgs,
    }

    fn options(words: &str) -> Result<LoadOptions, String> {
        let parsed = Alone::try_parse_from(["x"].into_iter().chain(words.split_whitespace()));
        parsed.map(|alone| alone.reading.options()).map_err(|error| error.to_string())
    }

    #[test]
    fn light_and_camera_reach_the_reader() {
        let found =
            options("--env sky,10,20 --env-rotate 90 --look-from -1,2,3 --look-at 0,0,0 --fov 60 --up z");
        let found = found.unwrap();
        assert_eq!(found.lighting.environment, Some(EnvironmentChoice::Sky([10.0, 20.0])));
        assert_eq!((found.lighting.rotation, found.up), (90.0, Some(UpAxis::Z)));
        assert_eq!(found.viewpoint.from, Some(DVec3::new(-1.0, 2.0, 3.0)));
        let found = options("--lumens-per-watt 12.5 --thin-glass").unwrap();
        assert_eq!((found.lumens_per_watt, found.thin_glass), (Some(12.5), true));
        assert_eq!(options("--azimuth=-45").unwrap().viewpoint.around, Some([-45.0, 20.0]));
        assert!(options("--background none").unwrap().lighting.hides_background);
        assert_eq!(options("").unwrap(), LoadOptions::default());
    }

    #[test]
    fn wrong_light_and_cameras_are_refused() {
        for bad in [
            "--env -1",
            "--env-rotate 3",
            "--look-from 1,2",
            "--azimuth 1 --look-from 1,2,3",
            "--elevation 91",
            "--fov x",
            "--lumens-per-watt 0",
            "--up x",
        ] {
            assert!(options(bad).is_err(), "{bad}");
        }
    }
}
