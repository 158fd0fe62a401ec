//! Area lights: the emitting triangles of one mesh, sampled uniformly by area.

use super::distribution::DiscreteDistribution;
use super::factor::EmissionFactor;
use base::math::{F32x16, Rgb, U32x16, luminance};
use base::sampling::uniform_triangle;
use glam::{Vec2, Vec3};
use scene::{AttributeTexture, Emission, Mesh, Scene, Share, Texture, TextureId};

/// A mesh that emits.
#[derive(Clone, Debug)]
pub struct AreaLight {
    /// Index of the mesh.
    pub mesh: u32,
    /// Emission of the mesh, times its opacity if that is the same everywhere.
    pub emission: Emission,
    /// Total area of the triangles.
    pub area: f32,
    /// Flux of all emitting sides as luminance, W; the mean of texture times opacity represents it.
    pub power: f32,
    /// Maximum radiance of any channel at any point, if the mesh were opaque.
    greatest: f32,
    triangles: DiscreteDistribution,
    shapes: Vec<TriangleShape>,
    /// Factor that varies over the mesh, if there is one.
    factor: Option<EmissionFactor>,
}

/// A triangle of an area light.
#[derive(Clone, Copy, Debug)]
pub struct TriangleShape {
    /// First corner.
    pub corner: Vec3,
    /// Edges from the first corner to the others.
    pub edges: [Vec3; 2],
    /// Unit normal.
    pub normal: Vec3,
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
        let mut emission = mesh.emission?;
        let shapes: Vec<(Vec3, f32)> =
            (0..mesh.triangles.len()).map(|t| normal_and_area(mesh.corners(t))).collect();
        let triangles = DiscreteDistribution::new(shapes.iter().map(|s| s.1));
        let area = triangles.total() as f32;
        if !(area > 0.0) {
            return None;
        }
        let (mean_texture, greatest) =
            emission.texture.map_or((Rgb::ONE, Rgb::ONE), |texture| mean_and_greatest(scene, mesh, texture));
        let greatest = (emission.radiance * greatest).max_element();
        // Gaps do not shine.
        let material = scene.materials.get(mesh.material.0 as usize);
        let opacity = material.and_then(|material| material.opacity);
        if let Some(Share::Constant(share)) = opacity {
            emission.radiance *= share.clamp(0.0, 1.0);
        }
        let factor = EmissionFactor::new(scene, mesh, emission.texture, opacity);
        let mean = match &factor {
            Some(factor) if factor.has_opacity() => factor.mean_over(&triangles, mean_texture),
            _ => mean_texture,
        };
        let sides = if emission.two_sided { 2.0 } else { 1.0 };
        let power = luminance(emission.radiance * mean) * area * std::f32::consts::PI * sides;
        if !(power > 0.0 && power.is_finite()) {
            return None;
        }
        Some(AreaLight {
            mesh: index,
            emission,
            area,
            power,
            greatest,
            factor,
            triangles,
            shapes: (0..mesh.triangles.len())
                .map(|t| {
                    let [a, b, c] = mesh.corners(t);
                    TriangleShape { corner: a, edges: [b - a, c - a], normal: shapes[t].0 }
                })
                .collect(),
        })
    }

    /// Samples a point uniformly by area; density 1/area.
    #[inline]
    pub fn sample(&self, u: Vec2) -> AreaPoint {
        let (triangle, TriangleShape { corner, edges: [e1, e2], normal }, u) = self.choose_triangle(u);
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
    pub(super) fn choose_triangle(&self, u: Vec2) -> (u32, TriangleShape, Vec2) {
        let (triangle, rest) = self.triangles.sample(u.x);
        (triangle as u32, self.shapes[triangle], Vec2::new(rest, u.y))
    }

    /// Returns the triangles that [`AreaLight::choose_triangle`] chooses in sixteen lanes, and the first of the random
    /// numbers that it returns.
    #[inline]
    pub(super) fn choose_triangles16(&self, u: &F32x16) -> (U32x16, F32x16) {
        self.triangles.sample16(u)
    }

    /// Returns emitted radiance relative to the maximum of the light, if it were opaque, from 0 to 1.
    pub fn relative(&self, emitted: Rgb) -> Rgb {
        (emitted / self.greatest).min(Rgb::ONE)
    }

    /// Returns all triangles.
    pub(super) fn shapes(&self) -> &[TriangleShape] {
        &self.shapes
    }

    /// Returns true if the radiance varies over the mesh.
    #[inline]
    pub(super) fn varies(&self) -> bool {
        self.factor.is_some()
    }

    /// Returns the factor on the emission at a point of a triangle.
    #[inline]
    pub(super) fn factor(&self, triangle: u32, barycentric: Vec2) -> Rgb {
        self.factor.as_ref().map_or(Rgb::ONE, |factor| factor.at(triangle, barycentric))
    }

    /// Returns the radiance that leaves a point of the light towards the unit vector `out`.
    #[inline]
    pub fn radiance(&self, point: &AreaPoint, out: Vec3) -> Rgb {
        self.emitted(point.triangle, point.barycentric, point.normal, out)
    }

    /// Returns the radiance that leaves a triangle towards the unit vector `out`. The point is given by barycentric
    /// weights of corners 1 and 2, and by the unit geometric normal there.
    #[inline]
    pub fn emitted(&self, triangle: u32, barycentric: Vec2, normal: Vec3, out: Vec3) -> Rgb {
        if !self.emission.two_sided && normal.dot(out) <= 0.0 {
            return Rgb::ZERO;
        }
        self.emission.radiance * self.factor(triangle, barycentric)
    }
}

/// Returns the mean of a texture on a mesh, and the maximum of each channel. Those of a product are products.
fn mean_and_greatest(scene: &Scene, mesh: &Mesh, texture: TextureId) -> (Rgb, Rgb) {
    let Some(AttributeTexture { attribute, image, .. }) = scene.textures.attribute(texture) else {
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
