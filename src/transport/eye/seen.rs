//! Surfaces seen through pixels, for their features.
//!
//! A pixel gets no more than four samples if these and those of its eight neighbours are nearly equal.

use super::chain::{ChainTracer, ChainVertex, EdgeEnd, Follow};
use super::counts::EyeCounts;
use crate::paths::Estimand;
use base::math::{Cone, LANES, Rgb, first_lanes};
use base::sampling::Sampler;
use embree::{Hits16, Ray, Rays16};
use glam::{DVec3, Vec2, Vec3};
use world::material::Bsdf;
use world::view::View;
use world::{Surface, World, beyond};

/// Maximum number of samples per pixel. Features have little noise, but denoised images inherit it along edges.
const MAX_SAMPLES: u32 = 32;

/// Number of samples of pixels in which the samples are nearly equal.
pub(super) const FIRST_SAMPLES: u32 = 4;

/// Rule by which pixels get more samples than the first few.
#[derive(Clone, Copy, Debug)]
pub(super) struct MoreSamples {
    /// Number of samples of pixels that get more.
    pub samples: u32,
    /// Maximum difference of a normal's coordinates between samples that count as equal.
    pub max_difference: f32,
    /// Maximum difference of albedo between samples that count as equal.
    pub max_albedo_difference: f32,
    /// Minimum difference of albedo between pixels on both sides of an edge.
    pub albedo_edge: f32,
    /// True if pixels beside those whose samples differ get more samples, too.
    pub beside_others: bool,
}

/// Maximum difference between samples that count as equal, for layers.
const MAX_SAMPLE_DIFFERENCE: f32 = 0.02;

/// Minimum difference of a normal's coordinates, and for layers of albedo, between pixels on both sides of an edge.
const MIN_EDGE_DIFFERENCE: f32 = 0.1;

/// Maximum length of a chain through mirrors and glass, in edges.
const MAX_EDGES: u32 = 64;

/// Eye samples whose features are requested: those of an image.
#[derive(Clone, Copy, Debug)]
pub struct FeatureSettings {
    /// Estimand of a pixel.
    pub estimand: Estimand,
    /// Eye samples per pixel, of which the first few are enough.
    pub spp: u32,
    /// Random seed of the samples.
    pub seed: u32,
}

impl FeatureSettings {
    /// Returns the rule for layers.
    pub(super) fn rule(&self) -> MoreSamples {
        MoreSamples {
            samples: self.spp.clamp(1, MAX_SAMPLES),
            max_difference: MAX_SAMPLE_DIFFERENCE,
            max_albedo_difference: MAX_SAMPLE_DIFFERENCE,
            albedo_edge: MIN_EDGE_DIFFERENCE,
            beside_others: true,
        }
    }
}

/// Sums over a pixel's samples.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PixelFeatures {
    /// Sum of albedos.
    pub albedo: Rgb,
    /// Sum of shading normals.
    pub normal: Vec3,
    /// Sum of triangle normals.
    pub geometric_normal: Vec3,
    /// Sum of positions relative to the scene's centre.
    pub position: DVec3,
    /// Number of samples that hit a surface.
    pub surfaces: u32,
    /// Sum of the shares of samples that surfaces cover.
    pub covered: f32,
    /// Features of the nearest sample.
    pub nearest: Option<Nearest>,
    /// Number of samples.
    pub samples: u32,
    /// True if a sample hits mirrors, glass, or lobes nearly as sharp, whose reflections move over the surface.
    pub reflects: bool,
    /// True if the samples, and those of the neighbours, are nearly equal.
    pub is_even: bool,
    /// Maximum difference of a sample's normal from those before it; infinite between meshes.
    difference: f32,
    /// Maximum difference of a sample's albedo from those before it.
    albedo_difference: f32,
}

/// Features that are not averaged, of the nearest sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    /// Distance along the camera's axis.
    pub depth: f32,
    /// Index of its material.
    pub material: u32,
    /// Index of its mesh.
    pub mesh: u32,
}

/// Sampler of the features of pixels.
pub(super) struct FeatureSampler<'a> {
    /// Scene.
    pub world: &'a World,
    /// Camera and film.
    pub view: &'a View,
    /// Samples.
    pub settings: &'a FeatureSettings,
}

impl FeatureSampler<'_> {
    /// Returns the features of the film pixels from `first` to `last`. All samples are taken if the first few differ,
    /// in the pixel or between neighbours.
    pub fn pixels(&self, rule: MoreSamples, first: [u32; 2], last: [u32; 2]) -> Vec<PixelFeatures> {
        let samples = rule.samples;
        // Neighbours outside the window are sampled too, so that a crop has the features of the full image.
        let film = self.view.window.film;
        let (left, top) = (first[0].saturating_sub(1), first[1].saturating_sub(1));
        let (right, bottom) = ((last[0] + 1).min(film[0] - 1), (last[1] + 1).min(film[1] - 1));
        let all: Vec<[u32; 2]> = (top..=bottom).flat_map(|y| (left..=right).map(move |x| [x, y])).collect();
        let at = |[x, y]: [u32; 2]| ((y - top) * (right - left + 1) + x - left) as usize;
        let mut pixels = vec![PixelFeatures::default(); all.len()];
        let few = samples.min(FIRST_SAMPLES);
        let begun = (0..pixels.len()).flat_map(|pixel| (0..few).map(move |sample| (pixel, sample)));
        self.add(&all, &mut pixels, begun);
        let inside = || (first[1]..=last[1]).flat_map(|y| (first[0]..=last[0]).map(move |x| [x, y]));
        let near =
            |from: u32, first: u32, last: u32| from.saturating_sub(1).max(first)..=(from + 1).min(last);
        let differs = |&[x, y]: &[u32; 2]| {
            let pixel = &pixels[at([x, y])];
            pixel.varies(&rule)
                || near(y, top, bottom).any(|y| {
                    near(x, left, right).any(|x| {
                        let other = &pixels[at([x, y])];
                        match other.varies(&rule) {
                            true => rule.beside_others,
                            false => pixel.is_beside_edge(other, rule.albedo_edge),
                        }
                    })
                })
        };
        let again: Vec<usize> = inside().filter(differs).map(at).collect();
        inside().for_each(|pixel| pixels[at(pixel)].is_even = true);
        again.iter().for_each(|pixel| pixels[*pixel].is_even = false);
        let rest = again.into_iter().flat_map(|pixel| (few..samples).map(move |sample| (pixel, sample)));
        self.add(&all, &mut pixels, rest);
        inside().map(|pixel| pixels[at(pixel)]).collect()
    }

    /// Returns the features of the surface that the ray through the middle of a pixel hits first.
    pub fn first_hit(&self, pixel: [u32; 2]) -> PixelFeatures {
        let (world, cone) = (self.world, self.view.cone(1));
        let mut ray = world.behind_hidden(self.view.primary_ray(pixel, Vec2::splat(0.5)));
        let (mut seen, mut distance) = (SeenSurfaces::default(), 0.0);
        let cos = ray.direction.dot(self.view.camera.forward);
        for _ in 0..MAX_EDGES {
            let Some(mut surface) = world.intersect(&ray) else { break };
            distance += surface.t;
            surface.footprint = ray.direction * cone.width_at(distance);
            let (bsdf, out) = (world.bsdf(&surface), -ray.direction);
            if bsdf.gaps() > 0.5 {
                ray = beyond(&ray, surface.position, surface.normal, surface.t);
                continue;
            }
            let vertex = ChainVertex { surface, bsdf, out, throughput: Rgb::ONE, depth: 1, distance };
            seen.meet(world, vertex, &bsdf);
            break;
        }
        let mut pixel = PixelFeatures::default();
        pixel.add(world, &seen, cos);
        pixel
    }

    /// Adds samples, each given by the index of its pixel and its number there.
    pub fn add(
        &self,
        film_pixels: &[[u32; 2]],
        pixels: &mut [PixelFeatures],
        mut samples: impl Iterator<Item = (usize, u32)>,
    ) {
        let cone = self.view.cone(self.settings.spp);
        loop {
            let (mut packet, mut count) = ([(0, 0); LANES], 0);
            for sample in samples.by_ref().take(LANES) {
                packet[count] = sample;
                count += 1;
            }
            if count == 0 {
                return;
            }
            let (mut rays, mut samplers) = (Rays16::default(), [Sampler::new(0, 0); LANES]);
            for (lane, &(pixel, sample)) in packet.iter().enumerate() {
                let FeatureSettings { estimand, seed, .. } = *self.settings;
                let (sampler, jitter) = estimand.eye_sampler(film_pixels[pixel], seed, sample);
                let (seed, sample) = estimand.numbers(seed, sample);
                let ray = self.view.sample_ray(film_pixels[pixel], jitter, seed, sample);
                rays.set(lane, &self.world.behind_hidden(ray));
                samplers[lane] = sampler;
            }
            let (valid, mut hits) = (first_lanes(count), Hits16::default());
            let hit_lanes = self.world.accel.closest_hit16(&rays, valid, true, &mut hits);
            let surfaces = (hit_lanes != 0).then(|| {
                hits.repeat(hit_lanes.trailing_zeros() as usize, !hit_lanes);
                self.world.surfaces(&hits)
            });
            for (lane, (pixel, _)) in packet.iter().enumerate().take(count) {
                let ray = rays.get(lane);
                let surface = surfaces.as_ref().filter(|_| hit_lanes >> lane & 1 != 0).map(|s| s.get(lane));
                let seen = surface.map_or_else(SeenSurfaces::default, |surface| {
                    SeenSurfaces::new(self.world, &ray, cone, surface, &mut samplers[lane])
                });
                pixels[*pixel].add(self.world, &seen, ray.direction.dot(self.view.camera.forward));
            }
        }
    }
}

impl PixelFeatures {
    /// Adds a sample whose first edge has the cosine `cos` with the camera's axis.
    fn add(&mut self, world: &World, seen: &SeenSurfaces, cos: f32) {
        let vertex = seen.main.or(seen.first).filter(|_| seen.passed < 1.0);
        let towards =
            |vertex: &ChainVertex, normal: Vec3| if normal.dot(vertex.out) < 0.0 { -normal } else { normal };
        let normal = vertex.map_or(Vec3::ZERO, |vertex| towards(&vertex, vertex.surface.frame.normal));
        if self.samples > 0 {
            let off = |value: Vec3, sum: Vec3| (value - sum / self.samples as f32).abs().max_element();
            let mesh = vertex.map(|vertex| vertex.surface.mesh);
            let is_same = mesh == self.nearest.map(|nearest| nearest.mesh);
            let by_normal = if is_same { off(normal, self.normal) } else { f32::INFINITY };
            let by_albedo = off(seen.albedo, self.albedo);
            self.difference = self.difference.max(by_normal);
            self.albedo_difference = self.albedo_difference.max(by_albedo);
        }
        self.samples += 1;
        self.reflects |= seen.reflects;
        self.albedo += seen.albedo;
        let Some(vertex) = vertex else { return };
        let surface = &vertex.surface;
        self.normal += normal;
        self.geometric_normal += towards(&vertex, surface.normal);
        self.position += surface.position.as_dvec3();
        self.surfaces += 1;
        self.covered += 1.0 - seen.passed;
        let depth = vertex.distance * cos;
        if self.nearest.is_none_or(|nearest| depth < nearest.depth) {
            let material = world.material(surface.mesh).0;
            self.nearest = Some(Nearest { depth, material, mesh: surface.mesh });
        }
    }

    /// Returns true if an edge lies between two pixels whose own samples are nearly equal.
    fn is_beside_edge(&self, other: &PixelFeatures, albedo_edge: f32) -> bool {
        let (n, m) = (self.samples as f32, other.samples as f32);
        let differ = |a: Vec3, b: Vec3, least: f32| (a / n - b / m).abs().max_element() > least;
        let mesh = |pixel: &PixelFeatures| pixel.nearest.map(|nearest| nearest.mesh);
        mesh(self) != mesh(other)
            || differ(self.albedo, other.albedo, albedo_edge)
            || differ(self.normal, other.normal, MIN_EDGE_DIFFERENCE)
    }

    /// Returns true if samples differ by more than a rule allows.
    fn varies(&self, rule: &MoreSamples) -> bool {
        self.difference > rule.max_difference || self.albedo_difference > rule.max_albedo_difference
    }
}

/// Surfaces that an eye sample sees.
#[derive(Default)]
struct SeenSurfaces<'w> {
    albedo: Rgb,
    first: Option<ChainVertex<'w>>,
    /// Surface that contributes most of the light; `None` for the environment.
    main: Option<ChainVertex<'w>>,
    /// Share of the light from `main`.
    share: f32,
    /// Share of the sample that passes gaps in surfaces and hits nothing.
    passed: f32,
    /// True if the sample hits mirrors, glass or sharp lobes.
    reflects: bool,
}

impl<'w> SeenSurfaces<'w> {
    /// Returns the surfaces seen along an eye ray whose first hit is `surface`.
    fn new(
        world: &'w World,
        ray: &Ray,
        cone: Cone,
        mut surface: Surface,
        sampler: &mut Sampler,
    ) -> SeenSurfaces<'w> {
        surface.footprint = ray.direction * cone.width_at(surface.t);
        let mut seen = SeenSurfaces::default();
        let bsdf = world.bsdf(&surface);
        if bsdf.has_delta() {
            let visit = |met| match met {
                EdgeEnd::Nothing { throughput, on_eye_ray } => seen.miss(throughput, on_eye_ray),
                EdgeEnd::Surface(vertex) => seen.meet(world, vertex, &world.bsdf(&vertex.surface)),
            };
            let chains = ChainTracer { world, cone, max_depth: MAX_EDGES, follow: Follow::Delta };
            chains.trace(*ray, sampler, &mut EyeCounts::default(), visit);
        } else {
            let (out, throughput, distance) = (-ray.direction, Rgb::ONE, surface.t);
            let vertex = ChainVertex { surface, bsdf, out, throughput, depth: 1, distance };
            seen.meet(world, vertex, &bsdf);
        }
        seen
    }

    /// Adds an edge that hits nothing.
    fn miss(&mut self, throughput: Rgb, on_eye_ray: bool) {
        if on_eye_ray {
            self.passed = (self.passed + throughput.max_element()).min(1.0);
        }
        if throughput.max_element() > self.share {
            (self.share, self.main) = (throughput.max_element(), None);
        }
    }

    /// Adds a surface with its BSDF, of which the vertex may have a part.
    fn meet(&mut self, world: &World, vertex: ChainVertex<'w>, whole: &Bsdf) {
        self.first = self.first.or(Some(vertex));
        self.reflects |= whole.has_delta() || !whole.sharp_lobes().is_empty();
        let albedo = world.guide_albedo(&vertex.surface, whole, vertex.out);
        self.albedo += vertex.throughput * albedo;
        let passes_on = whole.has_delta() && albedo == Rgb::ZERO;
        if !passes_on && vertex.throughput.max_element() > self.share {
            (self.share, self.main) = (vertex.throughput.max_element(), Some(vertex));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::Camera;
    use world::testkit::*;

    const SPP: u32 = 32;

    /// A bright triangle before a wall, whose edges cross pixels at all places.
    fn triangle() -> WorldAndView {
        let mut scene = scene(Camera { tan_half_x: 0.5, ..Camera::default() }, [40, 40]);
        let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
        let white = add_material(&mut scene, diffuse(Rgb::splat(0.9)));
        scene.meshes.push(quad(Vec3::new(-9.0, -9.0, -2.0), Vec3::X * 18.0, Vec3::Y * 18.0, grey));
        let mut small = quad(Vec3::new(-0.31, -0.27, -1.0), Vec3::X * 0.53, Vec3::new(0.1, 0.47, 0.0), white);
        small.triangles.truncate(1);
        scene.meshes.push(small);
        world(scene)
    }

    #[test]
    fn pixels_at_edges_have_all_samples_and_others_few() {
        let world = triangle();
        let settings = FeatureSettings { estimand: Estimand::Pixels, spp: SPP, seed: 3 };
        let looking = FeatureSampler { world: &world, view: &world.view, settings: &settings };
        let pixels = looking.pixels(settings.rule(), [0, 0], [39, 39]);
        let (mut crossed, mut flat) = (0, 0);
        for (i, pixel) in pixels.iter().enumerate() {
            let at = [i as u32 % 40, i as u32 / 40];
            let mut sum = Rgb::ZERO;
            for sample in 0..SPP {
                let (_, jitter) = Estimand::Pixels.eye_sampler(at, 3, sample);
                let surface = world.intersect(&world.view.primary_ray(at, jitter)).expect("a surface");
                sum += world.bsdf(&surface).base_brdf() * std::f32::consts::PI;
            }
            let expected = sum / SPP as f32;
            let found = pixel.albedo / pixel.samples as f32;
            assert!((found - expected).abs().max_element() < 1e-5, "{at:?}: {found} {expected}");
            crossed += usize::from(pixel.samples == SPP);
            flat += usize::from(pixel.samples == FIRST_SAMPLES);
        }
        assert!(crossed > 100 && flat > 1000 && crossed + flat == 1600, "{crossed} {flat}");
        // A part of the film has the same.
        let part = looking.pixels(settings.rule(), [7, 9], [12, 30]);
        for (i, pixel) in part.iter().enumerate() {
            let whole = &pixels[(9 + i / 6) * 40 + 7 + i % 6];
            assert_eq!((pixel.samples, pixel.albedo), (whole.samples, whole.albedo));
        }
    }
}
