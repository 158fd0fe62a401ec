//! Features: properties of the visible surfaces per pixel, for denoisers and compositing.
//!
//! | feature | layer | value of a pixel |
//! |---|---|---|
//! | albedo | `albedo.R`, `.G`, `.B` | mean reflected share of light, through mirrors and glass; emitters: see below |
//! | normal | `normal.X`, `.Y`, `.Z` | mean shading normal towards the viewer, in world space; 0 without a surface |
//! | geometric-normal | `geometricNormal.X`, ... | mean unit normal of the triangles, likewise |
//! | position | `position.X`, ... | mean position in the coordinates of the scene's file |
//! | depth | `depth.Z` | distance along the camera's axis, of the nearest sample; 10^10 without a surface |
//! | material | `materialId` | 1 + index of the nearest sample's material; 0 without a surface |
//! | object | `objectId` | 1 + index of the nearest sample's mesh; 0 without a surface |
//! | alpha | `A` | share of the pixel that surfaces cover, without gaps in them |
//! | crypto-object | `CryptoObject00`, ... | names of meshes with their shares of the pixel (see [`super::Masks`]) |
//! | crypto-material | `CryptoMaterial00`, ... | names of materials, likewise |
//!
//! A sample's features are those of the surface that contributes most of its light. At mirrors and smooth glass these
//! are the surfaces seen in or behind them, at the summed distance. If the environment contributes most, they are
//! those of the first mirror or glass. The albedo is the sum over all surfaces seen, weighted by their shares of the
//! light: the Fresnel blend that Open Image Denoise asks for. Rough lobes count as reflecting, however sharp they are.
//!
//! The albedo of an emitter is the emitted radiance over the maximum of its mesh in any channel, if that exceeds the
//! reflectance. This preserves the image on a sign and the hue of a plain lamp. Otherwise a denoiser would blur the
//! former and take the edges of the latter for noise.
//!
//! Positions are averaged over the samples that hit a surface, albedo and normals over all samples. So normals are
//! shorter than 1 where samples differ.
//!
//! [`Averaging::First`] averages nothing. It describes the surface that the ray through the pixel's middle hits first,
//! also if that is a mirror or glass. Alpha is a share nevertheless.

use super::cryptomatte::Masks;
use super::seen::{FeatureSampler, FeatureSettings, PixelFeatures};
use super::tiles::{by_tiles, pixels_between};
use base::film::{Image, Layer};
use base::math::Rgb;
use base::progress::Control;
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::str::FromStr;
use world::World;
use world::view::View;

/// Depth without a surface: Blender's value.
pub const NO_DEPTH: f32 = 1e10;

/// Name of the layer of depth.
pub const DEPTH: &str = "depth.Z";

/// Quantity of the visible surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// Share of light that is reflected, or relative emission.
    Albedo,
    /// Shading normal.
    Normal,
    /// Normal of the triangle.
    GeometricNormal,
    /// Position in the coordinates of the scene's file.
    Position,
    /// Distance along the camera's axis.
    Depth,
    /// Index of the material.
    Material,
    /// Index of the mesh.
    Object,
    /// Share of the pixel that surfaces cover.
    Alpha,
    /// Share of the pixel that each mesh covers.
    CryptoObject,
    /// Share of the pixel that each material covers.
    CryptoMaterial,
}

impl Feature {
    /// All features.
    pub const ALL: [Feature; 10] = [
        Feature::Albedo,
        Feature::Normal,
        Feature::GeometricNormal,
        Feature::Position,
        Feature::Depth,
        Feature::Material,
        Feature::Object,
        Feature::Alpha,
        Feature::CryptoObject,
        Feature::CryptoMaterial,
    ];

    /// Returns the name that users type.
    pub fn name(self) -> &'static str {
        match self {
            Feature::Albedo => "albedo",
            Feature::Normal => "normal",
            Feature::GeometricNormal => "geometric-normal",
            Feature::Position => "position",
            Feature::Depth => "depth",
            Feature::Material => "material",
            Feature::Object => "object",
            Feature::Alpha => "alpha",
            Feature::CryptoObject => "crypto-object",
            Feature::CryptoMaterial => "crypto-material",
        }
    }

    /// Returns the masks that the feature is, if it is any.
    pub fn masks(self) -> Option<Masks> {
        match self {
            Feature::CryptoObject => Some(Masks::Objects),
            Feature::CryptoMaterial => Some(Masks::Materials),
            _ => None,
        }
    }
}

/// Samples of a pixel that its features describe.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Averaging {
    /// All samples.
    #[default]
    Mean,
    /// The first hit of the ray through the pixel's middle.
    First,
}

/// Set of features.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Features(u16);

impl Features {
    /// Returns true if the set is empty.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns the set with another feature.
    pub fn with(self, feature: Feature) -> Features {
        Features(self.0 | 1 << feature as u8)
    }

    /// Returns true if a feature is in the set.
    pub fn contains(self, feature: Feature) -> bool {
        self.0 & 1 << feature as u8 != 0
    }
}

impl FromIterator<Feature> for Features {
    fn from_iter<I: IntoIterator<Item = Feature>>(features: I) -> Features {
        features.into_iter().fold(Features::default(), Features::with)
    }
}

/// Error: a name is not that of a feature.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no layer `{name}`; layers are {}", Feature::ALL.map(Feature::name).join(", "))]
pub struct UnknownFeature {
    name: String,
}

impl FromStr for Feature {
    type Err = UnknownFeature;

    fn from_str(name: &str) -> Result<Feature, UnknownFeature> {
        let named = Feature::ALL.into_iter().find(|feature| feature.name() == name);
        named.ok_or_else(|| UnknownFeature { name: name.to_owned() })
    }
}

/// Surfaces seen through the pixels of a window.
pub struct SeenPixels {
    pixels: Image<PixelFeatures>,
}

/// Surface that fills a pixel and its surroundings.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct EvenSurface {
    /// Mean position relative to the scene's centre.
    pub position: Vec3,
    /// Unit shading normal towards the viewer.
    pub normal: Vec3,
    /// Index of the mesh.
    pub mesh: u32,
}

impl SeenPixels {
    /// Samples the pixels of the view's window; pixels are empty once cancelled.
    pub fn new(world: &World, view: &View, settings: &FeatureSettings, control: &Control) -> SeenPixels {
        let look =
            |first, last| FeatureSampler { world, view, settings }.pixels(settings.rule(), first, last);
        SeenPixels { pixels: by_tiles(view, control, look) }
    }

    /// Finds the first hits of the rays through the middles of the pixels; pixels are empty once cancelled.
    pub fn first_hits(
        world: &World,
        view: &View,
        settings: &FeatureSettings,
        control: &Control,
    ) -> SeenPixels {
        let sampler = FeatureSampler { world, view, settings };
        let look = |first, last| pixels_between(first, last).map(|pixel| sampler.first_hit(pixel)).collect();
        SeenPixels { pixels: by_tiles(view, control, look) }
    }

    /// Returns the surface that fills a pixel and its surroundings evenly and shows no clear reflections; `None` if
    /// there is none.
    pub fn even_surface(&self, pixel: usize) -> Option<EvenSurface> {
        let pixel = &self.pixels.pixels[pixel];
        let fills = pixel.is_even && !pixel.reflects && pixel.surfaces == pixel.samples;
        let nearest = pixel.nearest.filter(|_| fills)?;
        let position = (pixel.position / f64::from(pixel.surfaces)).as_vec3();
        let normal = pixel.normal.try_normalize()?;
        Some(EvenSurface { position, normal, mesh: nearest.mesh })
    }

    /// Returns the distance of a pixel's nearest surface along the camera's axis; 10^10 without a surface.
    pub fn depth(&self, pixel: usize) -> f32 {
        self.pixels.pixels[pixel].nearest.map_or(NO_DEPTH, |nearest| nearest.depth)
    }

    /// Returns the mean albedo of a pixel.
    pub fn albedo(&self, pixel: usize) -> Rgb {
        let pixel = &self.pixels.pixels[pixel];
        pixel.albedo / pixel.samples.max(1) as f32
    }

    /// Returns the layers of the requested features, without masks.
    pub fn layers(&self, world: &World, wanted: Features) -> Vec<Layer> {
        let pixels = &self.pixels;
        let (centre, unit) = (world.scene.centre, world.scene.unit());
        let position = |p: &PixelFeatures| match p.surfaces {
            0 => Vec3::ZERO,
            n => (centre + p.position / f64::from(n) * unit).as_vec3(),
        };
        let depth = |p: &PixelFeatures| p.nearest.map_or(NO_DEPTH, |n| (f64::from(n.depth) * unit) as f32);
        let layer = |feature: Feature| {
            Some(match feature {
                Feature::Albedo => Layer::color("albedo", pixels.map(|p| p.albedo / p.samples as f32)),
                Feature::Normal => Layer::vector("normal", pixels.map(|p| p.normal / p.samples as f32)),
                Feature::GeometricNormal => {
                    Layer::vector("geometricNormal", pixels.map(|p| p.geometric_normal / p.samples as f32))
                }
                Feature::Position => Layer::vector("position", pixels.map(position)),
                Feature::Depth => Layer::scalar(DEPTH, pixels.map(depth)),
                Feature::Material => {
                    Layer::id("materialId", pixels.map(|p| p.nearest.map_or(0, |n| n.material + 1)))
                }
                Feature::Object => Layer::id("objectId", pixels.map(|p| p.nearest.map_or(0, |n| n.mesh + 1))),
                Feature::Alpha => Layer::scalar("A", pixels.map(|p| p.covered / p.samples as f32)),
                // Masks have samples of their own.
                Feature::CryptoObject | Feature::CryptoMaterial => return None,
            })
        };
        Feature::ALL.into_iter().filter(|feature| wanted.contains(*feature)).filter_map(layer).collect()
    }
}
