//! Area lights: the emitting triangles of one mesh, sampled uniformly by area.

use super::distribution::DiscreteDistribution;
use base::math::{F32x16, Rgb, U32x16, luminance};
use base::sampling::uniform_triangle;
use glam::{Vec2, Vec3};
use scene::{
    AttributeTexture, AttributeValues, Emission, Mesh, Scene, Texture, TextureId, Textures, interpolated,
};

/// A mesh that emits.
#[derive(Clone, Debug)]
pub struct AreaLight {
    /// Index of the mesh.
    pub mesh: u32,
    /// Emission of the mesh.
    pub emission: Emission,
    /// Total area of the triangles.
    pub area: f32,
    /// Flux of all emitting sides as luminance, W; the mean of a texture represents it.
    pub power: f32,
    /// Maximum radiance of any channel at any point.
    greatest: f32,
    triangles: DiscreteDistribution,
    /// First corner, two edges and unit normal of each triangle.
    shapes: Vec<[Vec3; 4]>,
    /// Texture of the emission, if there is one.
    texture: Option<EmissionTexture>,
}

/// Texture that scales the emission of a mesh.
#[derive(Clone, Debug)]
struct EmissionTexture {
    textures: Textures,
    id: TextureId,
    /// Texture coordinates of each triangle's corners; empty if the mesh has none.
    uvs: Vec<[Vec2; 3]>,
    /// Values of an attribute at each triangle's corners; empty if the texture is no attribute of the mesh.
    attribute: Vec<[Rgb; 3]>,
}

impl EmissionTexture {
    /// Collects the texture coordinates of mesh `index`.
    fn new(scene: &Scene, index: u32, id: TextureId) -> EmissionTexture {
        let mesh = &scene.meshes[index as usize];
        let uvs = match mesh.uvs.as_slice() {
            [] => Vec::new(),
            uvs => mesh.triangles.iter().map(|vertices| vertices.map(|i| uvs[i as usize])).collect(),
        };
        let named = scene.textures.attribute(id).map(|texture| texture.attribute);
        let values = mesh.attributes.iter().find(|attribute| Some(attribute.id) == named);
        let corners = |values: &AttributeValues| {
            (0..).zip(&mesh.triangles).map(|(t, v)| values.corners(t, v)).collect()
        };
        let attribute = values.map_or(Vec::new(), |attribute| corners(&attribute.values));
        EmissionTexture { textures: scene.textures.clone(), id, uvs, attribute }
    }

    /// Returns the factor on the emission at barycentric weights `b` of a triangle.
    fn factor(&self, triangle: u32, b: Vec2) -> Rgb {
        let uv = match self.uvs.get(triangle as usize) {
            Some([u0, u1, u2]) => *u0 * (1.0 - b.x - b.y) + *u1 * b.x + *u2 * b.y,
            None => b,
        };
        let attribute = |_| self.attribute.get(triangle as usize).map_or(Rgb::ONE, |at| interpolated(*at, b));
        self.textures.lookup(self.id, uv, attribute)
    }
}

/// A point on an area light.
#[derive(Clone, Copy, Debug)]
pub struct AreaPoint {
    /// Triangle of the light's mesh.
    pub triangle: u32,
    /// Position relative to the scene's centre.
    pub position: Vec3,
    /// Unit geometric normal of the front.
    pub normal: Vec3,
    /// Barycentric weights of corners 1 and 2.
    pub barycentric: Vec2,
}

/// Returns unit normal and area of a triangle; a zero normal if it has no area.
pub fn normal_and_area(corners: [Vec3; 3]) -> (Vec3, f32) {
    let [a, b, c] = corners;
    let cross = (b - a).cross(c - a);
    let length = cross.length();
    if length > 1e-15 && length < 1e15 {
        return (cross.normalize_or_zero(), 0.5 * length);
    }
    // The squared length is out of the range of f32.
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let cross = (b - a).cross(c - a);
    (cross.normalize_or_zero().as_vec3(), (0.5 * cross.length()) as f32)
}

impl AreaLight {
    /// Builds the light of mesh `index`; `None` if it emits nothing.
    pub fn new(scene: &Scene, index: u32) -> Option<AreaLight> {
        let mesh = &scene.meshes[index as usize];
        let emission = mesh.emission?;
        let shapes: Vec<(Vec3, f32)> =
            (0..mesh.triangles.len()).map(|t| normal_and_area(mesh.corners(t))).collect();
        let triangles = DiscreteDistribution::new(shapes.iter().map(|s| s.1));
        let area = triangles.total() as f32;
        let (mean_texture, greatest) =
            emission.texture.map_or((Rgb::ONE, Rgb::ONE), |texture| mean_and_greatest(scene, mesh, texture));
        let sides = if emission.two_sided { 2.0 } else { 1.0 };
        let power = luminance(emission.radiance * mean_texture) * area * std::f32::consts::PI * sides;
        if !(power > 0.0 && power.is_finite()) {
            return None;
        }
        Some(AreaLight {
            mesh: index,
            emission,
            area,
            power,
            greatest: (emission.radiance * greatest).max_element(),
            texture: emission.texture.map(|id| EmissionTexture::new(scene, index, id)),
            triangles,
            shapes: (0..mesh.triangles.len())
                .map(|t| {
                    let [a, b, c] = mesh.corners(t);
                    [a, b - a, c - a, shapes[t].0]
                })
                .collect(),
        })
    }

    /// Samples a point uniformly by area; density 1/area.
    #[inline]
    pub fn sample(&self, u: Vec2) -> AreaPoint {
        let (triangle, [corner, e1, e2, normal], u) = self.choose_triangle(u);
        let barycentric = uniform_triangle(u);
        AreaPoint {
            triangle,
            position: corner + e1 * barycentric.x + e2 * barycentric.y,
            normal,
            barycentric,
        }
    }

    /// Chooses a triangle in proportion to its area. Returns its index, its first corner, the edges from there and the
    /// unit normal, and random numbers to choose a point on it.
    #[inline]
    pub(super) fn choose_triangle(&self, u: Vec2) -> (u32, [Vec3; 4], Vec2) {
        let (triangle, rest) = self.triangles.sample(u.x);
        (triangle as u32, self.shapes[triangle], Vec2::new(rest, u.y))
    }

    /// Returns the triangles that [`AreaLight::choose_triangle`] chooses in sixteen lanes, and the first of the random
    /// numbers that it returns.
    #[inline]
    pub(super) fn choose_triangles16(&self, u: &F32x16) -> (U32x16, F32x16) {
        self.triangles.sample16(u)
    }

    /// Returns emitted radiance relative to the maximum of the light, from 0 to 1.
    pub fn relative(&self, emitted: Rgb) -> Rgb {
        (emitted / self.greatest).min(Rgb::ONE)
    }

    /// Returns first corner, two edges and unit normal of each triangle.
    pub(super) fn shapes(&self) -> &[[Vec3; 4]] {
        &self.shapes
    }

    /// Returns the factor of the texture on the emission at a point of a triangle.
    #[inline]
    pub(super) fn texture(&self, triangle: u32, barycentric: Vec2) -> Rgb {
        self.texture.as_ref().map_or(Rgb::ONE, |texture| texture.factor(triangle, barycentric))
    }

    /// Returns the radiance that leaves a point of the light towards the unit vector `out`.
    #[inline]
    pub fn radiance(&self, point: &AreaPoint, out: Vec3) -> Rgb {
        let factor = |_| self.texture(point.triangle, point.barycentric);
        emitted(&self.emission, point.normal, out, factor)
    }
}

/// Returns the mean of a texture on a mesh, and the maximum of each channel. Those of a product are products.
fn mean_and_greatest(scene: &Scene, mesh: &Mesh, texture: TextureId) -> (Rgb, Rgb) {
    let Some(AttributeTexture { attribute, image }) = scene.textures.attribute(texture) else {
        return of_texels(scene, texture);
    };
    let (mean, greatest) = image.map_or((Rgb::ONE, Rgb::ONE), |image| of_texels(scene, image));
    let Some(found) = mesh.attributes.iter().find(|found| found.id == *attribute) else {
        return (mean, greatest);
    };
    let (sum, area) = mesh.integrate_attribute(*attribute);
    let of_attribute = found.values.all().iter().copied().fold(Rgb::ZERO, Rgb::max);
    (mean * (sum / area).as_vec3(), greatest * of_attribute)
}

/// Returns the mean of an image's texels, and the maximum of each channel.
fn of_texels(scene: &Scene, image: TextureId) -> (Rgb, Rgb) {
    let Some(Texture { texels, .. }) = scene.textures.by_id(image) else { return (Rgb::ONE, Rgb::ONE) };
    let mean = texels.iter().sum::<Rgb>() / texels.len().max(1) as f32;
    (mean, texels.iter().fold(Rgb::ZERO, Rgb::max))
}

/// Returns the radiance that a point of an emitter with the geometric normal `normal` emits towards `out`. `factor`
/// looks the texture up.
#[inline]
pub fn emitted(emission: &Emission, normal: Vec3, out: Vec3, factor: impl FnOnce(TextureId) -> Rgb) -> Rgb {
    if !emission.two_sided && normal.dot(out) <= 0.0 {
        return Rgb::ZERO;
    }
    emission.radiance * emission.texture.map_or(Rgb::ONE, factor)
}
