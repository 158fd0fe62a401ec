//! Keys of each table of the native format.
//!
//! Any other key is an error, so that misspelt keys are reported.

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneText {
    pub name: Option<String>,
    pub generator: Option<Spanned<String>>,
    pub max_depth: Option<Spanned<u32>>,
    pub hide_emitters: Option<bool>,
    pub resolution: Option<Spanned<FixedArray<u32, 2>>>,
    pub camera: Option<Spanned<CameraText>>,
    #[serde(default)]
    pub material: Vec<Spanned<MaterialText>>,
    #[serde(default)]
    pub mesh: Vec<Spanned<MeshText>>,
    #[serde(default)]
    pub instance: Vec<Spanned<InstanceText>>,
    #[serde(default)]
    pub light: Vec<Spanned<LightText>>,
    pub environment: Option<Spanned<EnvironmentText>>,
    pub sky: Option<Spanned<SkyText>>,
}

/// A number in the range of f32.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Number(pub f64);

impl TryFrom<f64> for Number {
    type Error = &'static str;

    fn try_from(number: f64) -> Result<Number, &'static str> {
        (number as f32)
            .is_finite()
            .then_some(Number(number))
            .ok_or("expected a number from -3.4e38 to 3.4e38")
    }
}

/// An array of exactly `N` values. The parser's own arrays ignore surplus values.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Vec<T>")]
#[serde(bound(deserialize = "T: Deserialize<'de>"))]
pub(super) struct FixedArray<T, const N: usize>(pub [T; N]);

impl<T, const N: usize> TryFrom<Vec<T>> for FixedArray<T, N> {
    type Error = String;

    fn try_from(values: Vec<T>) -> Result<FixedArray<T, N>, String> {
        values.try_into().map(FixedArray).map_err(|_| format!("expected an array of length {N}"))
    }
}

/// An array of numbers.
pub(super) type NumberArray<const N: usize> = FixedArray<Number, N>;

impl From<Number> for f64 {
    fn from(number: Number) -> f64 {
        number.0
    }
}

impl From<NumberArray<2>> for [f64; 2] {
    fn from(numbers: NumberArray<2>) -> [f64; 2] {
        numbers.0.map(f64::from)
    }
}

impl From<NumberArray<3>> for DVec3 {
    fn from(numbers: NumberArray<3>) -> DVec3 {
        DVec3::from(numbers.0.map(f64::from))
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraText {
    pub origin: Option<NumberArray<3>>,
    pub target: Option<NumberArray<3>>,
    pub up: Option<NumberArray<3>>,
    pub fov: Option<Number>,
    pub fov_axis: Option<Spanned<String>>,
    pub near: Option<f64>,
    pub far: Option<f64>,
    pub aperture_radius: Option<Number>,
    pub focus_distance: Option<Number>,
    pub film_width: Option<Number>,
    pub filter: Option<Spanned<String>>,
    pub path: Option<Spanned<PathText>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PathText {
    pub frames: Option<usize>,
    pub keys: Vec<Spanned<KeyText>>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KeyText {
    pub frame: Option<usize>,
    pub origin: NumberArray<3>,
    pub target: NumberArray<3>,
    pub up: Option<NumberArray<3>>,
    pub fov: Option<Number>,
}

/// Keys of all kinds of material; `material` checks which kind allows which.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialText {
    pub name: String,
    pub kind: String,
    pub two_sided: Option<bool>,
    pub reflectance: Option<ColourText>,
    pub diffuse: Option<ColourText>,
    pub specular: Option<ColourText>,
    pub transmittance: Option<ColourText>,
    pub alpha: Option<NumberText>,
    pub alpha_v: Option<NumberText>,
    pub distribution: Option<String>,
    pub ior: Option<Number>,
    pub nonlinear: Option<bool>,
    pub preset: Option<String>,
    pub eta: Option<ColourText>,
    pub k: Option<ColourText>,
    pub thin: Option<bool>,
    pub attenuation_colour: Option<ColourText>,
    pub attenuation_distance: Option<Number>,
    pub opacity: Option<NumberText>,
    pub normal_map: Option<MapText>,
    pub bump_map: Option<MapText>,
    pub base_color: Option<ColourText>,
    pub metallic: Option<NumberText>,
    pub roughness: Option<NumberText>,
    pub anisotropic: Option<NumberText>,
    pub spec_tint: Option<NumberText>,
    pub spec_trans: Option<NumberText>,
    pub sheen: Option<NumberText>,
    pub sheen_tint: Option<NumberText>,
    pub clearcoat: Option<NumberText>,
    pub clearcoat_gloss: Option<Number>,
    pub first: Option<String>,
    pub second: Option<String>,
    pub weight: Option<NumberText>,
    pub base: Option<String>,
}

/// A colour, in any of its forms.
#[derive(Clone, Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "expected a number, [r, g, b], \"#rrggbb\", { colour = ..., scale = ... }, { attribute = \"...\" } or an image"
)]
pub(super) enum ColourText {
    Grey(Number),
    Rgb(NumberArray<3>),
    /// Hexadecimal digits after `#`, or the name of an image.
    Named(String),
    /// A colour times a factor.
    Scaled {
        colour: Box<ColourText>,
        scale: Number,
    },
    Attribute(AttributeText),
    Texture(TextureText),
}

/// A number, an image with or without options, or an attribute.
#[derive(Clone, Debug, Deserialize)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "expected a number, an image's name, { file = \"...\" } or { attribute = \"...\" }"
)]
pub(super) enum NumberText {
    Number(Number),
    File(String),
    Attribute(AttributeText),
    Texture(TextureText),
}

/// An image with or without options.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "expected an image's name or { file = \"...\" }")]
pub(super) enum MapText {
    File(String),
    Texture(TextureText),
}

/// An attribute of the mesh, such as vertex colours.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AttributeText {
    pub attribute: String,
    /// Factor on every value.
    pub scale: Option<Number>,
    /// Image to multiply with.
    pub image: Option<MapText>,
}

impl AttributeText {
    /// Returns the factor on every value.
    pub fn scale(&self) -> f64 {
        self.scale.map_or(1.0, f64::from)
    }
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TextureText {
    pub file: String,
    pub wrap: Option<WrapText>,
    pub filter: Option<FilterText>,
    #[serde(default)]
    pub raw: bool,
    /// Factor on every texel.
    pub scale: Option<Number>,
    /// Repetitions along u and v.
    pub tiles: Option<NumberArray<2>>,
}

impl TextureText {
    /// Returns the factor on every texel.
    pub fn scale(&self) -> f64 {
        self.scale.map_or(1.0, f64::from)
    }
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum WrapText {
    Repeat,
    Mirror,
    Clamp,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum FilterText {
    Bilinear,
    Nearest,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshText {
    pub part: Option<String>,
    pub file: Option<String>,
    pub shape: Option<String>,
    /// Index of the mesh in a `.serialized` file.
    pub index: Option<usize>,
    /// Groups of an OBJ file, or nodes of a glTF model, to read.
    pub group: Option<NamesText>,
    /// Groups or nodes to leave out.
    pub except: Option<NamesText>,
    /// Units of a glTF model's lights per unit of the renderer.
    pub lumens_per_watt: Option<Number>,
    /// True if glass of a glTF model without a volume is thin, even if Blender wrote a closed mesh.
    pub thin_glass: Option<bool>,
    /// Frames per second of a glTF model's animation.
    pub fps: Option<Number>,
    /// Time in seconds of a glTF model's animation whose pose the model takes.
    pub time: Option<Number>,
    pub material: Option<Spanned<String>>,
    #[serde(default)]
    pub transform: Vec<Spanned<StepText>>,
    pub emission: Option<ColourText>,
    #[serde(default)]
    pub emission_two_sided: bool,
    #[serde(default)]
    pub flip_normals: bool,
    /// Group whose instances show the mesh.
    pub member_of: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InstanceText {
    pub group: Spanned<String>,
    #[serde(default)]
    pub transform: Vec<Spanned<StepText>>,
    pub places: Option<Spanned<PlacesText>>,
    /// Group whose instances show this instance.
    pub member_of: Option<String>,
}

/// Matrices, or a file of them.
#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "expected the name of a file, or a list of lists of 12 or 16 numbers")]
pub(super) enum PlacesText {
    File(String),
    List(Vec<Vec<Number>>),
}

#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "expected a name or a list of names")]
pub(super) enum NamesText {
    One(String),
    Several(Vec<String>),
}

/// One step of a transform; exactly one key.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StepText {
    pub scale: Option<ScaleText>,
    pub rotate: Option<RotateText>,
    pub translate: Option<NumberArray<3>>,
    pub matrix: Option<NumberArray<16>>,
}

#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "expected a number or [x, y, z]")]
pub(super) enum ScaleText {
    Uniform(Number),
    Axes(NumberArray<3>),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RotateText {
    pub axis: NumberArray<3>,
    pub angle: Number,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightText {
    pub kind: String,
    pub position: Option<NumberArray<3>>,
    pub target: Option<NumberArray<3>>,
    pub intensity: Option<ColourText>,
    pub inner_angle: Option<Number>,
    pub outer_angle: Option<Number>,
    pub direction: Option<NumberArray<3>>,
    pub irradiance: Option<ColourText>,
    pub angle: Option<Number>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EnvironmentText {
    pub radiance: Option<ColourText>,
    pub file: Option<String>,
    pub scale: Option<Number>,
    pub rotate_y: Option<Number>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SkyText {
    pub up: Option<NumberArray<3>>,
    pub sun_direction: Option<NumberArray<3>>,
    pub date: Option<toml::value::Datetime>,
    /// Latitude (north) and longitude (east), in degrees.
    pub place: Option<NumberArray<2>>,
    pub turbidity: Option<Number>,
    pub albedo: Option<ColourText>,
    pub scale: Option<Number>,
    pub sun_scale: Option<Number>,
    /// Diameter of the sun, in degrees.
    pub sun_angle: Option<Number>,
    /// Angle from north of the scene to north of the place, counter-clockwise, in degrees.
    pub rotate_y: Option<Number>,
}
