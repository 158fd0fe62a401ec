//! Features: properties of the visible surfaces by pixel, for denoisers and compositing.
//!
//! | feature | layer | value of a pixel |
//! |---|---|---|
//! | albedo | `albedo.R`, `.G`, `.B` | mean share of light that is reflected, through mirrors and glass |
//! | normal | `normal.X`, `.Y`, `.Z` | mean unit shading normal towards the viewer, in world space; 0 if none |
//! | geometric-normal | `geometricNormal.X`, ... | the same of the triangles |
//! | position | `position.X`, ... | mean position in the coordinates of the scene's file |
//! | depth | `depth.Z` | distance along the camera's axis, of the nearest sample; 10^10 where nothing is |
//! | material | `materialId` | 1 + number of the nearest sample's material; 0 where nothing is |
//! | object | `objectId` | the same of its mesh |
//! | alpha | `A` | share of samples that meet a surface |
//!
//! A sample's features are those of the surface that most of its light comes from: where mirrors or smooth glass are
//! met, the surfaces seen in or behind them, to which distances are added up. Where most comes from the environment,
//! they are those of the first mirror or glass. Its albedo is the sum over all surfaces seen, by their shares of the
//! light: the Fresnel blend that Open Image Denoise asks for. Rough lobes count as reflecting, however sharp they
//! are.
//!
//! Positions are averaged over the samples that meet a surface, albedo and normals over all.

use super::chain::{ChainCounts, Follow, Met, Vertex, trace};
use crate::embree::{Hits16, Ray, Rays16};
use crate::film::{Image, Layer};
use crate::math::{LANES, Rgb, first_lanes, lanes_in};
use crate::paths::Look;
use crate::progress::Control;
use crate::sampling::Sampler;
use crate::view::View;
use crate::world::{Surface, World};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::str::FromStr;

/// Pixels along the edge of the square that one task looks through.
const TILE: u32 = 16;

/// Maximum number of samples a pixel. Features have little noise, but a denoiser repeats what they have along edges: 32
/// instead of 16 are worth .2 dB to denoised paths of 64 samples.
const MAX_SAMPLES: u32 = 32;

/// Longest chain of mirrors and glass in edges.
const MAX_EDGES: u32 = 64;

/// Depth where there is no surface: Blender's.
const NO_DEPTH: f32 = 1e10;

/// A quantity of the surfaces in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// Share of light that is reflected.
    Albedo,
    /// Shading normal.
    Normal,
    /// Normal of the triangle.
    GeometricNormal,
    /// Position in the coordinates of the scene's file.
    Position,
    /// Distance along the camera's axis.
    Depth,
    /// Number of the material.
    Material,
    /// Number of the mesh.
    Object,
    /// Share of samples that meet a surface.
    Alpha,
}

impl Feature {
    /// All features.
    pub const ALL: [Feature; 8] = [
        Feature::Albedo,
        Feature::Normal,
        Feature::GeometricNormal,
        Feature::Position,
        Feature::Depth,
        Feature::Material,
        Feature::Object,
        Feature::Alpha,
    ];

    /// The name by which users ask for it.
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
        }
    }
}

/// Any of the features.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Features(u8);

impl Features {
    /// True if there is none.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// These and another.
    pub fn with(self, feature: Feature) -> Features {
        Features(self.0 | 1 << feature as u8)
    }

    /// True if a feature is one of them.
    pub fn contains(self, feature: Feature) -> bool {
        self.0 & 1 << feature as u8 != 0
    }
}

impl FromIterator<Feature> for Features {
    fn from_iter<I: IntoIterator<Item = Feature>>(features: I) -> Features {
        features.into_iter().fold(Features::default(), Features::with)
    }
}

/// Reason why a name is not that of a feature.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no feature `{name}`; there are {}", Feature::ALL.map(Feature::name).join(", "))]
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

/// The eye samples whose features are wanted: those of a picture.
#[derive(Clone, Copy, Debug)]
pub struct FeatureSettings {
    /// Estimand of a pixel.
    pub look: Look,
    /// Eye samples a pixel; the first few are enough.
    pub spp: u32,
    /// The seed that chose them.
    pub seed: u32,
}

/// The layers of the features wanted, over the view's window; black where cancelled.
pub fn features(
    world: &World,
    view: &View,
    settings: &FeatureSettings,
    wanted: Features,
    control: &Control,
) -> Vec<Layer> {
    let window = &view.window;
    let tiles: Vec<Vec<Pixel>> = (0..window.tile_count(TILE))
        .into_par_iter()
        .map(|tile| {
            if control.is_cancelled() {
                return Vec::new();
            }
            window
                .tile(tile, TILE)
                .map(|at| Pixel::new(world, view, settings, window.film_pixel(at)))
                .collect()
        })
        .collect();
    let mut pixels: Vec<Pixel> = vec![Pixel::default(); window.pixel_count() as usize];
    for (tile, found) in tiles.into_iter().enumerate() {
        for (pixel, [x, y]) in found.into_iter().zip(window.tile(tile, TILE)) {
            pixels[(y * window.width + x) as usize] = pixel;
        }
    }
    let pixels = Image { width: window.width, height: window.height, pixels };
    let samples = settings.samples() as f32;
    let centre = world.scene.centre;
    let position = |p: &Pixel| match p.surfaces {
        0 => Vec3::ZERO,
        n => (centre + p.position / f64::from(n)).as_vec3(),
    };
    let layer = |feature: Feature| match feature {
        Feature::Albedo => Layer::color("albedo", pixels.map(|p| p.albedo / samples)),
        Feature::Normal => Layer::vector("normal", pixels.map(|p| p.normal / samples)),
        Feature::GeometricNormal => {
            Layer::vector("geometricNormal", pixels.map(|p| p.geometric_normal / samples))
        }
        Feature::Position => Layer::vector("position", pixels.map(position)),
        Feature::Depth => Layer::scalar("depth.Z", pixels.map(|p| p.nearest.map_or(NO_DEPTH, |n| n.depth))),
        Feature::Material => Layer::id("materialId", pixels.map(|p| p.nearest.map_or(0, |n| n.material + 1))),
        Feature::Object => Layer::id("objectId", pixels.map(|p| p.nearest.map_or(0, |n| n.mesh + 1))),
        Feature::Alpha => Layer::scalar("A", pixels.map(|p| p.surfaces as f32 / samples)),
    };
    Feature::ALL.into_iter().filter(|feature| wanted.contains(*feature)).map(layer).collect()
}

impl FeatureSettings {
    fn samples(&self) -> u32 {
        self.spp.clamp(1, MAX_SAMPLES)
    }
}

/// Sums over a pixel's samples.
#[derive(Clone, Copy, Debug, Default)]
struct Pixel {
    albedo: Rgb,
    normal: Vec3,
    geometric_normal: Vec3,
    /// Relative to the scene's centre.
    position: DVec3,
    /// Samples that meet a surface.
    surfaces: u32,
    nearest: Option<Nearest>,
}

/// Features of the nearest sample, where they are not averaged.
#[derive(Clone, Copy, Debug)]
struct Nearest {
    depth: f32,
    material: u32,
    mesh: u32,
}

impl Pixel {
    /// Features of a pixel of the film.
    fn new(world: &World, view: &View, settings: &FeatureSettings, film_pixel: [u32; 2]) -> Pixel {
        let mut pixel = Pixel::default();
        let samples: Vec<u32> = (0..settings.samples()).collect();
        for samples in samples.chunks(LANES) {
            let (mut rays, mut samplers) = (Rays16::default(), [Sampler::new(0, 0); LANES]);
            for lane in 0..LANES {
                let sample = samples.get(lane).copied().unwrap_or(samples[0]);
                let (sampler, jitter) = settings.look.eye_sampler(film_pixel, settings.seed, sample);
                rays.set(lane, &view.primary_ray(film_pixel, jitter));
                samplers[lane] = sampler;
            }
            let (valid, mut hits) = (first_lanes(samples.len()), Hits16::default());
            let found = world.accel.closest_hit16(&rays, valid, true, &mut hits);
            if found == 0 {
                continue;
            }
            hits.repeat(found.trailing_zeros() as usize, !found);
            let surfaces = world.surfaces(&hits);
            for lane in lanes_in(found) {
                let ray = rays.get(lane);
                let seen = Seen::new(world, &ray, surfaces.get(lane), &mut samplers[lane]);
                pixel.add(world, &seen, ray.direction.dot(view.camera.forward));
            }
        }
        pixel
    }

    /// Adds a sample whose first edge has the cosine `cos` to the camera's axis.
    fn add(&mut self, world: &World, seen: &Seen, cos: f32) {
        self.albedo += seen.albedo;
        let Some(vertex) = seen.main.or(seen.first) else { return };
        let surface = &vertex.surface;
        let towards = |normal: Vec3| if normal.dot(vertex.out) < 0.0 { -normal } else { normal };
        self.normal += towards(surface.frame.normal);
        self.geometric_normal += towards(surface.normal);
        self.position += surface.position.as_dvec3();
        self.surfaces += 1;
        let depth = vertex.distance * cos;
        if self.nearest.is_none_or(|nearest| depth < nearest.depth) {
            let material = world.scene.meshes[surface.mesh as usize].material.0;
            self.nearest = Some(Nearest { depth, material, mesh: surface.mesh });
        }
    }
}

/// Surfaces that an eye sample sees.
#[derive(Default)]
struct Seen<'w> {
    albedo: Rgb,
    first: Option<Vertex<'w>>,
    /// Surface whose light counts most; `None` for the environment.
    main: Option<Vertex<'w>>,
    /// Its share.
    share: f32,
}

impl<'w> Seen<'w> {
    /// Surfaces seen along an eye ray, of which `surface` is the first.
    fn new(world: &'w World, ray: &Ray, surface: Surface, sampler: &mut Sampler) -> Seen<'w> {
        let mut seen = Seen::default();
        let bsdf = world.bsdf(&surface);
        if bsdf.has_delta() {
            let visit = |met| seen.meet(world, met);
            trace(world, *ray, (MAX_EDGES, Follow::Delta), sampler, &mut ChainCounts::default(), visit);
        } else {
            let (out, throughput, distance) = (-ray.direction, Rgb::ONE, surface.t);
            let vertex = Vertex { surface, bsdf, out, throughput, depth: 1, distance };
            seen.meet(world, Met::Surface(vertex));
        }
        seen
    }

    fn meet(&mut self, world: &'w World, met: Met<'w>) {
        match met {
            Met::Nothing { throughput } => {
                if throughput.max_element() > self.share {
                    (self.share, self.main) = (throughput.max_element(), None);
                }
            }
            Met::Surface(vertex) => {
                self.first = self.first.or(Some(vertex));
                let whole = world.bsdf(&vertex.surface);
                let albedo = whole.albedo(vertex.surface.frame.to_local(vertex.out));
                self.albedo += vertex.throughput * albedo.min(Rgb::ONE);
                let passes_on = whole.has_delta() && albedo == Rgb::ZERO;
                if !passes_on && vertex.throughput.max_element() > self.share {
                    (self.share, self.main) = (vertex.throughput.max_element(), Some(vertex));
                }
            }
        }
    }
}
