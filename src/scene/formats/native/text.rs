//! The native format as text: the keys of each table. Any other key is an error, so that a misspelt one
//! cannot pass unnoticed.

use serde::Deserialize;
use toml::Spanned;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneText {
    pub name: Option<String>,
    pub generator: Option<Spanned<String>>,
    pub max_depth: Option<u32>,
    pub resolution: Option<Spanned<PairText>>,
    pub camera: Option<Spanned<CameraText>>,
    #[serde(default)]
    pub material: Vec<Spanned<MaterialText>>,
    #[serde(default)]
    pub mesh: Vec<Spanned<MeshText>>,
    #[serde(default)]
    pub light: Vec<Spanned<LightText>>,
    pub environment: Option<Spanned<EnvironmentText>>,
    pub sky: Option<Spanned<SkyText>>,
}

/// Two whole numbers, no more: the parser's own arrays would leave out what follows.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Vec<u32>")]
pub(super) struct PairText(pub [u32; 2]);

impl TryFrom<Vec<u32>> for PairText {
    type Error = &'static str;

    fn try_from(numbers: Vec<u32>) -> Result<PairText, &'static str> {
        numbers.try_into().map(PairText).map_err(|_| "expected an array of length 2")
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraText {
    pub origin: Option<[f64; 3]>,
    pub target: Option<[f64; 3]>,
    pub up: Option<[f64; 3]>,
    pub fov: Option<f64>,
    pub fov_axis: Option<Spanned<String>>,
    pub near: Option<f64>,
    pub far: Option<f64>,
    pub aperture_radius: Option<f64>,
    pub focus_distance: Option<f64>,
    pub film_width: Option<f64>,
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
    pub origin: [f64; 3],
    pub target: [f64; 3],
    pub up: Option<[f64; 3]>,
    pub fov: Option<f64>,
}

/// All keys of all kinds of material; `material` checks which kind allows which.
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
    pub distribution: Option<String>,
    pub ior: Option<f64>,
    pub nonlinear: Option<bool>,
    pub preset: Option<String>,
    pub eta: Option<ColourText>,
    pub k: Option<ColourText>,
    pub thin: Option<bool>,
    pub opacity: Option<NumberText>,
    pub normal_map: Option<MapText>,
    pub bump_map: Option<MapText>,
    pub base_color: Option<ColourText>,
    pub metallic: Option<NumberText>,
    pub roughness: Option<NumberText>,
    pub spec_tint: Option<NumberText>,
    pub spec_trans: Option<NumberText>,
    pub sheen: Option<NumberText>,
    pub sheen_tint: Option<NumberText>,
    pub clearcoat: Option<NumberText>,
    pub clearcoat_gloss: Option<f64>,
}

/// A colour: the same in every place that takes one.
#[derive(Clone, Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "expected a number, [r, g, b], \"#rrggbb\", { colour = ..., scale = ... } or a picture"
)]
pub(super) enum ColourText {
    Grey(f64),
    Rgb([f64; 3]),
    /// Hexadecimal after `#`, else the name of a picture.
    Named(String),
    /// A colour times a factor.
    Scaled {
        colour: Box<ColourText>,
        scale: f64,
    },
    Texture(TextureText),
}

/// A number, or the name of a picture with or without how to read it.
#[derive(Clone, Debug, Deserialize)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "expected a number, a picture's name or { file = \"...\" }"
)]
pub(super) enum NumberText {
    Number(f64),
    Picture(String),
    Texture(TextureText),
}

/// The name of a picture, with or without how to read it.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "expected a picture's name or { file = \"...\" }")]
pub(super) enum MapText {
    Picture(String),
    Texture(TextureText),
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
    pub scale: Option<f64>,
    /// Repetitions along u and v.
    pub tiles: Option<[f64; 2]>,
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
    /// Groups of an OBJ file, or nodes of a glTF model, that are asked for.
    pub group: Option<NamesText>,
    /// Those that are left out.
    pub except: Option<NamesText>,
    /// Units of a glTF model's lights for one here.
    pub lumens_per_watt: Option<f64>,
    /// Frames a second of a glTF model's animation.
    pub fps: Option<f64>,
    pub material: Option<Spanned<String>>,
    #[serde(default)]
    pub transform: Vec<Spanned<StepText>>,
    pub emission: Option<ColourText>,
    #[serde(default)]
    pub emission_two_sided: bool,
    #[serde(default)]
    pub flip_normals: bool,
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
    pub translate: Option<[f64; 3]>,
    pub matrix: Option<[f64; 16]>,
}

#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "expected a number or [x, y, z]")]
pub(super) enum ScaleText {
    Uniform(f64),
    Axes([f64; 3]),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RotateText {
    pub axis: [f64; 3],
    pub angle: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightText {
    pub kind: String,
    pub position: Option<[f64; 3]>,
    pub target: Option<[f64; 3]>,
    pub intensity: Option<ColourText>,
    pub inner_angle: Option<f64>,
    pub outer_angle: Option<f64>,
    pub direction: Option<[f64; 3]>,
    pub irradiance: Option<ColourText>,
    pub angle: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EnvironmentText {
    pub radiance: Option<ColourText>,
    pub file: Option<String>,
    pub scale: Option<f64>,
    pub rotate_y: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SkyText {
    pub up: Option<[f64; 3]>,
    pub sun_direction: Option<[f64; 3]>,
    pub date: Option<toml::value::Datetime>,
    /// Latitude to the north and longitude to the east, degrees.
    pub place: Option<[f64; 2]>,
    pub turbidity: Option<f64>,
    pub albedo: Option<ColourText>,
    pub scale: Option<f64>,
    pub sun_scale: Option<f64>,
    /// Diameter of the sun, degrees.
    pub sun_angle: Option<f64>,
    /// Degrees from north of the scene to that of the place, counter-clockwise.
    pub rotate_y: Option<f64>,
}
