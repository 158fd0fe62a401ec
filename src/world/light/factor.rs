//! Factors on the emission of a mesh that vary over it: a texture of the radiance, and an opacity.

use super::distribution::DiscreteDistribution;
use base::math::{Rgb, luminance};
use base::sampling::{owen_sobol_2d, uniform_triangle};
use glam::Vec2;
use scene::{Attribute, AttributeId, Mesh, Scene, Share, TextureId, Textures, interpolated};

/// Number of points that the mean over a mesh is taken over.
const POINTS: u32 = 4096;

/// Seed of these points.
const SEED: u32 = 0x0a1e_a001;

/// Factor on the emission of a mesh.
#[derive(Clone, Debug)]
pub(super) struct EmissionFactor {
    textures: Textures,
    /// Texture of the radiance.
    colour: Option<TextureId>,
    /// Share of the surface that is there, if textured.
    opacity: Option<Share>,
    /// Texture coordinates of each triangle's corners; empty if the mesh has none.
    uvs: Vec<[Vec2; 3]>,
    /// Values at each triangle's corners of the attributes that the textures look up.
    attributes: Vec<(AttributeId, Vec<[Rgb; 3]>)>,
}

impl EmissionFactor {
    /// Collects what varies over a mesh; `None` if nothing does. A constant opacity is left out.
    pub fn new(
        scene: &Scene,
        mesh: &Mesh,
        colour: Option<TextureId>,
        opacity: Option<Share>,
    ) -> Option<EmissionFactor> {
        let opacity = opacity.filter(Share::is_textured);
        if colour.is_none() && opacity.is_none() {
            return None;
        }
        let uvs = match mesh.uvs.as_slice() {
            [] => Vec::new(),
            uvs => mesh.triangles.iter().map(|vertices| vertices.map(|i| uvs[i as usize])).collect(),
        };
        let of_opacity = opacity.and_then(|opacity| match opacity {
            Share::Textured { texture, .. } => Some(texture),
            Share::Constant(_) => None,
        });
        let named = |id: TextureId| scene.textures.attribute(id).map(|texture| texture.attribute);
        let named: Vec<AttributeId> = colour.into_iter().chain(of_opacity).filter_map(named).collect();
        let corners = |found: &Attribute| {
            let of_triangles = mesh.triangles.iter().enumerate();
            (found.id, of_triangles.map(|(t, vertices)| found.values.corners(t, vertices)).collect())
        };
        let attributes =
            mesh.attributes.iter().filter(|found| named.contains(&found.id)).map(corners).collect();
        Some(EmissionFactor { textures: scene.textures.clone(), colour, opacity, uvs, attributes })
    }

    /// Returns true if the opacity varies.
    pub fn has_opacity(&self) -> bool {
        self.opacity.is_some()
    }

    /// Returns the factor at barycentric weights `b` of a triangle's corners 1 and 2.
    #[inline]
    pub fn at(&self, triangle: u32, b: Vec2) -> Rgb {
        let uv = match self.uvs.get(triangle as usize) {
            Some(corners) => interpolated(*corners, b),
            None => b,
        };
        let attribute = |id| {
            let own = self.attributes.iter().find(|(own, _)| *own == id);
            let corners = own.and_then(|(_, corners)| corners.get(triangle as usize));
            corners.map_or(Rgb::ONE, |corners| interpolated(*corners, b))
        };
        let colour = self.colour.map_or(Rgb::ONE, |id| self.textures.lookup(id, uv, attribute));
        match &self.opacity {
            Some(opacity) => colour * opacity.share(|id| self.textures.lookup(id, uv, attribute)),
            None => colour,
        }
    }

    /// Returns the mean over the mesh, whose triangles are chosen in proportion to area. `colour` is the mean of the
    /// radiance's texture. The result is 0 only if a texture is black: small spots that all points miss keep a small
    /// part.
    pub fn mean_over(&self, triangles: &DiscreteDistribution, colour: Rgb) -> Rgb {
        let point = |i: u32| {
            let u = owen_sobol_2d(i, SEED);
            let (triangle, rest) = triangles.sample(u.x);
            self.at(triangle as u32, uniform_triangle(Vec2::new(rest, u.y)))
        };
        let mean = |id: TextureId| self.textures.by_id(id).map_or(Rgb::ONE, |texture| texture.mean());
        let opacity = self.opacity.map_or(1.0, |opacity| opacity.value(|id| luminance(mean(id))));
        let missed = colour * (opacity / POINTS as f32);
        let sum: Rgb = (0..POINTS).map(point).sum();
        (sum / POINTS as f32).max(missed)
    }
}
