//! Requirements of a scene: materials, specular chains, light trees and textures, and an estimate of their memory.
//!
//! A stage that a scene does not require is not built.

use super::material::{Lobe, Material};
use super::parameter::{Reflectance, Roughness};
use super::{DeltaLight, Environment, Group, Mesh, Scene};
use serde::Serialize;
use std::fmt;

/// Estimated bytes per triangle of Embree's MEDIUM-quality hierarchy, with its copy of the indices.
pub const BVH_BYTES_PER_TRIANGLE: usize = 110;

/// Estimated bytes per place of a group: three copies of its transform, and its part of the hierarchy.
pub const INSTANCE_BYTES: usize = 3 * 48 + 80;

/// Bytes per seen mesh in tables.
pub const SEEN_MESH_BYTES: usize = 24;

/// Bytes per texel of an environment, and of the cumulative sums over it.
pub const ENVIRONMENT_TEXEL_BYTES: u64 = 12 + 12 + 8;

/// Number of materials in use, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct MaterialKinds {
    /// Lambert base alone.
    pub diffuse: usize,
    /// Rough lobe, with or without a base.
    pub glossy: usize,
    /// Base under a smooth coat.
    pub plastic: usize,
    /// Base under a rough coat.
    pub rough_plastic: usize,
    /// Mirrors.
    pub mirror: usize,
    /// Glass, smooth or rough.
    pub glass: usize,
    /// Principled materials.
    pub principled: usize,
}

/// Light trees that are not empty.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Trees {
    /// Point and spot lights, and projectors.
    pub omni: bool,
    /// Area lights.
    pub oriented: bool,
    /// Directional lights.
    pub directional: bool,
    /// The environment.
    pub environment: bool,
    /// Reflected light.
    pub indirect: bool,
}

/// Estimated memory, in bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Memory {
    /// Vertices with their attributes, and indices, Embree's copy included.
    pub geometry: usize,
    /// The hierarchy over the triangles.
    pub hierarchy: usize,
    /// Textures with mip maps, and the environment with its distributions.
    pub pictures: usize,
}

impl Memory {
    /// Returns the sum.
    pub fn total(&self) -> usize {
        self.geometry + self.hierarchy + self.pictures
    }
}

/// Requirements of a scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Requirements {
    /// Materials in use, by kind.
    pub materials: MaterialKinds,
    /// True if the eye pass has to follow mirrors, glass or smooth coats.
    pub specular_chains: bool,
    /// True if records need more than irradiance.
    pub glossy: bool,
    /// Fraction of the surface area with a rough lobe.
    pub glossy_area_share: f64,
    /// Fraction of the surface area with a mirror lobe or of glass.
    pub specular_area_share: f64,
    /// Minimum roughness α of a rough lobe.
    pub smallest_alpha: Option<f32>,
    /// True if a back side scatters or emits.
    pub two_sided: bool,
    /// Light trees that are not empty.
    pub trees: Trees,
    /// Number of textures in use.
    pub textures: usize,
    /// Number of attributes of meshes in use, such as vertex colours.
    pub attributes: usize,
    /// Number of stored triangles.
    pub triangles: usize,
    /// Number of seen triangles. Triangles of instances count at each place.
    pub seen_triangles: usize,
    /// Number of places of groups that are stored once.
    pub instances: usize,
    /// Number of triangles that emit.
    pub emitting_triangles: usize,
    /// Number of lights: area, point, spot and directional lights, and one for the environment with its discs.
    pub lights: usize,
    /// Surface area, in squares of the scene's unit.
    pub area: f64,
    /// Diagonal of the box around all triangles.
    pub diagonal: f64,
    /// Estimated memory, in bytes.
    pub memory: Memory,
}

impl Requirements {
    /// Computes the requirements of `scene`.
    pub fn new(scene: &Scene) -> Requirements {
        let mut r = Requirements { textures: scene.textures.len(), ..Requirements::default() };
        let mut used = vec![false; scene.materials.len()];
        let (mut glossy_area, mut specular_area) = (0.0, 0.0);
        let mut reflects = false;
        for (mesh, factor) in scene.meshes.iter().zip(scene.area_factors()) {
            let area = area(mesh) * factor;
            r.area += area;
            r.triangles += mesh.triangles.len();
            r.memory.geometry += geometry_bytes(mesh);
            r.attributes += mesh.attributes.len();
            if let Some(emission) = mesh.emission {
                r.emitting_triangles += mesh.triangles.len();
                r.lights += 1;
                r.two_sided |= emission.two_sided;
                r.trees.oriented = true;
            }
            let Some(material) = scene.materials.get(mesh.material.0 as usize) else { continue };
            if let Some(used) = used.get_mut(mesh.material.0 as usize) {
                *used = true;
            }
            let rough = |lobe: &Lobe| matches!(lobe, Lobe::Rough { .. } | Lobe::Anisotropic { .. });
            let is_glossy =
                material.parts().any(|part| part.principled.is_some() || part.lobes.iter().any(rough));
            glossy_area += if is_glossy { area } else { 0.0 };
            specular_area += if material.lobes.iter().all(rough) { 0.0 } else { area };
            reflects |= stores_light(material);
        }
        for (material, _) in scene.materials.iter().zip(&used).filter(|(_, used)| **used) {
            r.count(material, scene);
        }
        r.specular_chains = r.materials.mirror + r.materials.glass + r.materials.plastic > 0;
        r.glossy = r.materials.glossy + r.materials.rough_plastic + r.materials.principled > 0;
        if r.area > 0.0 {
            r.glossy_area_share = glossy_area / r.area;
            r.specular_area_share = specular_area / r.area;
        }
        r.area *= scene.unit() * scene.unit();
        r.diagonal = diagonal(scene) * scene.unit();
        r.seen_triangles = scene.seen_triangle_count();
        r.instances = scene.groups.iter().map(|group| group.placements.len()).sum();
        r.count_lights(scene);
        r.trees.indirect = r.lights > 0 && reflects && scene.max_depth.is_none_or(|depth| depth > 2);
        r.memory.hierarchy = BVH_BYTES_PER_TRIANGLE * r.triangles + instance_bytes(scene);
        r.memory.pictures = scene.textures.iter().map(|t| t.texels.bytes() / 3 * 4).sum();
        if let Some(Environment::Map(map)) = &scene.environment {
            r.memory.pictures += ENVIRONMENT_TEXEL_BYTES as usize * map.radiance.len();
        }
        r
    }

    /// Counts the lights that are not meshes.
    fn count_lights(&mut self, scene: &Scene) {
        for light in &scene.lights {
            match light {
                DeltaLight::Point { .. } | DeltaLight::Spot { .. } | DeltaLight::Projector { .. } => {
                    self.trees.omni = true;
                }
                DeltaLight::Directional { .. } => self.trees.directional = true,
            }
        }
        self.trees.environment = scene.environment.is_some() || !scene.discs.is_empty();
        self.lights += scene.lights.len() + usize::from(self.trees.environment);
    }

    fn count(&mut self, material: &Material, scene: &Scene) {
        self.two_sided |= material.two_sided && !is_glass(material);
        let kinds = &mut self.materials;
        let kind = match (material.lobes.first(), &material.coat) {
            _ if material.principled.is_some() => &mut kinds.principled,
            _ if is_glass(material) => &mut kinds.glass,
            (None | Some(Lobe::Dielectric { .. } | Lobe::RoughDielectric { .. }), _) => &mut kinds.diffuse,
            (Some(Lobe::Rough { .. } | Lobe::Anisotropic { .. }), Some(_)) => &mut kinds.rough_plastic,
            (Some(Lobe::Rough { .. } | Lobe::Anisotropic { .. }), None) => &mut kinds.glossy,
            (Some(Lobe::Mirror { .. }), Some(_)) => &mut kinds.plastic,
            (Some(Lobe::Mirror { .. }), None) => &mut kinds.mirror,
        };
        *kind += 1;
        for lobe in &material.lobes {
            let least =
                |alpha: &Roughness| alpha.value(|id| scene.luminance_range(id).map_or(1.0, |(low, _)| low));
            let alpha = match lobe {
                Lobe::Rough { alpha, .. } | Lobe::RoughDielectric { alpha, .. } => least(alpha),
                Lobe::Anisotropic { alpha: [u, v], .. } => least(u).min(least(v)),
                Lobe::Mirror { .. } | Lobe::Dielectric { .. } => continue,
            };
            self.smallest_alpha = Some(self.smallest_alpha.map_or(alpha, |a| a.min(alpha)));
        }
    }
}

/// True if the material scatters light in all directions, so that reflected light is stored.
fn stores_light(material: &Material) -> bool {
    let black = |r: &Reflectance| matches!(r, Reflectance::Constant(c) if c.max_element() <= 0.0);
    let glossy = |lobe: &Lobe| matches!(lobe, Lobe::Rough { scale, .. } | Lobe::Anisotropic { scale, .. } if !black(scale));
    let stores =
        |part: &Material| part.principled.is_some() || !black(&part.diffuse) || part.lobes.iter().any(glossy);
    material.parts().any(stores)
}

fn is_glass(material: &Material) -> bool {
    let of_glass = |lobe: &Lobe| matches!(lobe, Lobe::Dielectric { .. } | Lobe::RoughDielectric { .. });
    material.parts().any(|part| part.lobes.iter().any(of_glass))
}

fn area(mesh: &Mesh) -> f64 {
    let mut double_area = 0.0;
    for t in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(t).map(|p| p.as_dvec3());
        double_area += (b - a).cross(c - a).length();
    }
    0.5 * double_area
}

/// Returns the diagonal of the box around all triangles; 0 without any.
fn diagonal(scene: &Scene) -> f64 {
    let boxes = scene.seen_bounds(|_| true).into_iter();
    let around = boxes.reduce(|[a, b], [low, high]| [a.min(low), b.max(high)]);
    around.map_or(0.0, |[low, high]| (high.as_dvec3() - low.as_dvec3()).length())
}

/// Returns the bytes of instances, in the scene, for hits and in the hierarchy.
fn instance_bytes(scene: &Scene) -> usize {
    let of_group = |g: &Group| g.placements.len() * (INSTANCE_BYTES + SEEN_MESH_BYTES * g.meshes.len());
    scene.groups.iter().map(of_group).sum()
}

/// Returns the bytes of a mesh in the scene, and of its copy for the hierarchy.
fn geometry_bytes(mesh: &Mesh) -> usize {
    2 * 12 * (mesh.positions.len() + mesh.triangles.len())
        + 12 * mesh.normals.len()
        + 8 * mesh.uvs.len()
        + 16 * mesh.tangents.len()
        + 12 * mesh.attributes.iter().map(|attribute| attribute.values.all().len()).sum::<usize>()
}

/// Returns a list of texts, or "none".
fn list(texts: impl Iterator<Item = String>) -> String {
    let texts: Vec<String> = texts.collect();
    if texts.is_empty() { "none".into() } else { texts.join(", ") }
}

impl Requirements {
    /// Returns the kinds of materials with their numbers, as a text.
    fn material_list(&self) -> String {
        let m = &self.materials;
        let kinds = [
            (m.diffuse, "diffuse"),
            (m.glossy, "glossy"),
            (m.plastic, "plastic"),
            (m.rough_plastic, "rough plastic"),
            (m.mirror, "mirror"),
            (m.glass, "glass"),
            (m.principled, "principled"),
        ];
        list(kinds.iter().filter(|kind| kind.0 > 0).map(|(n, what)| format!("{n} {what}")))
    }

    /// Returns the light trees that the scene needs, as a text.
    fn tree_list(&self) -> String {
        let t = &self.trees;
        let trees = [
            (t.omni, "omni"),
            (t.oriented, "oriented"),
            (t.directional, "directional"),
            (t.environment, "environment"),
            (t.indirect, "indirect"),
        ];
        list(trees.iter().filter(|tree| tree.0).map(|tree| tree.1.to_owned()))
    }
}

impl fmt::Display for Requirements {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let alpha = self.smallest_alpha.map_or(String::new(), |a| format!(", smallest alpha {a}"));
        let yes = |b: bool| if b { "yes" } else { "no" };
        writeln!(f, "materials        {}", self.material_list())?;
        writeln!(
            f,
            "glossy           {} ({:.1} % of the area{alpha})",
            yes(self.glossy),
            100.0 * self.glossy_area_share
        )?;
        writeln!(
            f,
            "specular chains  {} ({:.1} % of the area)",
            yes(self.specular_chains),
            100.0 * self.specular_area_share
        )?;
        writeln!(f, "two-sided        {}", yes(self.two_sided))?;
        writeln!(f, "light trees      {}", self.tree_list())?;
        writeln!(f, "lights           {} ({} emitting triangles)", self.lights, self.emitting_triangles)?;
        writeln!(f, "textures         {}", self.textures)?;
        if self.attributes > 0 {
            writeln!(f, "mesh attributes  {}", self.attributes)?;
        }
        match self.instances {
            0 => writeln!(f, "triangles        {}", self.triangles)?,
            count => writeln!(
                f,
                "triangles        {} stored, {} seen in {count} instances and elsewhere",
                self.triangles, self.seen_triangles
            )?,
        }
        writeln!(f, "area, diagonal   {:.6}, {:.6}", self.area, self.diagonal)?;
        let mib = |bytes: usize| bytes as f64 / f64::from(1 << 20);
        write!(
            f,
            "memory           about {:.1} MiB (geometry {:.1}, hierarchy {:.1}, images {:.1})",
            mib(self.memory.total()),
            mib(self.memory.geometry),
            mib(self.memory.hierarchy),
            mib(self.memory.pictures)
        )
    }
}
