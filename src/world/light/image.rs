//! Images that point lights project: textures of spot lights, and projectors.
//!
//! A direction is given by the place where it meets the plane at distance 1 before the light. The image covers a
//! rectangle of that plane. Its power and the density of photons come from cells of the image.
//!
//! Source: Mitsuba 3.9.1, plugins `spot` and `projector`.
//! Units: intensities in W/sr, flux in W.

use super::distribution::DiscreteDistribution;
use base::math::{Rgb, luminance};
use glam::{Mat3, Vec2, Vec3};
use scene::{DeltaLight, Projector, SpotImage, Texture, TextureId, Textures};
use std::f32::consts::PI;

/// Minimum and maximum number of cells along each edge of an image.
const SIDES: [usize; 2] = [32, 128];

/// Maximum number of lookups along the edge of a cell.
const MAX_LOOKUPS: usize = 8;

/// Share of photons whose place on the image is uniform, so that no detail is left out.
const UNIFORM: f32 = 0.1;

/// Light that a point sends through an image.
#[derive(Clone, Debug)]
pub struct ImageLight {
    textures: Textures,
    /// Texture; `None` for an image of 1.
    texture: Option<TextureId>,
    /// Transform of world directions to the light's frame, whose z axis goes through the image's centre.
    to_local: Mat3,
    /// Half width and half height of the image on the plane at distance 1.
    half: Vec2,
    /// Inner and outer angle of a spot light; `None` for a projector.
    cone: Option<[f32; 2]>,
    /// Intensity for an image of 1, on the axis.
    intensity: Rgb,
    /// Number of cells along each edge.
    side: usize,
    /// Cells by flux, as luminance.
    cells: DiscreteDistribution,
    /// Maximum of the intensity, by channel.
    pub peak: Rgb,
    /// Flux as luminance.
    pub power: f32,
    /// Maximum angle between the axis and emitted light, radians.
    pub angle: f32,
    /// True if the image has no hue.
    pub is_grey: bool,
}

impl ImageLight {
    /// Returns the image that a light projects; `None` if there is none.
    pub fn new(light: &DeltaLight, textures: &Textures) -> Option<ImageLight> {
        match *light {
            DeltaLight::Spot { intensity, inner_angle, outer_angle, image: Some(image), .. } => {
                let SpotImage { texture, to_local } = image;
                let half = Vec2::splat(outer_angle.tan());
                let cone = Some([inner_angle, outer_angle]);
                Some(ImageLight::build(Some(texture), textures, (to_local, half), cone, intensity))
            }
            DeltaLight::Projector { projector, .. } => {
                let Projector { intensity, texture, to_local, .. } = projector;
                let size =
                    texture.and_then(|id| textures.by_id(id)).map(|t| (t.width as f32, t.height as f32));
                let (width, height) = size.unwrap_or((1.0, 1.0));
                let tan_x = projector.tan_half_x(width / height);
                let half = Vec2::new(tan_x, tan_x * height / width);
                Some(ImageLight::build(texture, textures, (to_local, half), None, intensity))
            }
            _ => None,
        }
    }

    fn build(
        texture: Option<TextureId>,
        textures: &Textures,
        (to_local, half): (Mat3, Vec2),
        cone: Option<[f32; 2]>,
        intensity: Rgb,
    ) -> ImageLight {
        let image = texture.and_then(|id| textures.by_id(id));
        let side = image.map_or(SIDES[0], |image| image.width.max(image.height).clamp(SIDES[0], SIDES[1]));
        let most = image.map_or(Rgb::ONE, |image| image.texels.iter().fold(Rgb::ZERO, Rgb::max));
        let is_grey = image
            .is_none_or(|image| image.texels.iter().all(|texel| texel.x == texel.y && texel.y == texel.z));
        let corner = (1.0 + half.length_squared()).sqrt();
        let mut light = ImageLight {
            textures: textures.clone(),
            texture,
            to_local,
            half,
            cone,
            intensity,
            side,
            cells: DiscreteDistribution::new([]),
            peak: intensity * most * if cone.is_some() { 1.0 } else { corner * corner * corner },
            power: 0.0,
            angle: cone.map_or(corner.recip().acos(), |[_, outer]| outer),
            is_grey,
        };
        let flux: Vec<f32> = (0..side * side).map(|cell| light.flux_of_cell(cell, image)).collect();
        light.power = flux.iter().map(|flux| f64::from(*flux)).sum::<f64>() as f32;
        light.cells = DiscreteDistribution::new(flux);
        light
    }

    /// Returns the radiant intensity in the unit direction `away`.
    #[inline]
    pub fn intensity(&self, away: Vec3) -> Rgb {
        let local = self.to_local * away;
        if !(local.z > 0.0) {
            return Rgb::ZERO;
        }
        let at = Vec2::new(local.x, local.y) / (local.z * self.half);
        let shape = match self.cone {
            Some([inner, outer]) => spot_falloff(local.z, inner, outer),
            None if at.abs().max_element() <= 1.0 => (local.z * local.z * local.z).recip(),
            None => 0.0,
        };
        if shape > 0.0 { self.intensity * self.texel(at) * shape } else { Rgb::ZERO }
    }

    /// Samples a direction; returns it, and the solid angle that it stands for.
    pub fn sample(&self, u: Vec2) -> (Vec3, f32) {
        let side = self.side as f32;
        let at = if u.x < UNIFORM || self.cells.is_empty() {
            Vec2::new((u.x / UNIFORM).min(1.0 - f32::EPSILON), u.y)
        } else {
            let (cell, rest) =
                self.cells.sample(((u.x - UNIFORM) / (1.0 - UNIFORM)).clamp(0.0, 1.0 - f32::EPSILON));
            (Vec2::new((cell % self.side) as f32, (cell / self.side) as f32) + Vec2::new(rest, u.y)) / side
        };
        let on_plane = (2.0 * at - 1.0) * self.half;
        let local = on_plane.extend(1.0);
        let length_sq = local.length_squared();
        let place = (at * side).as_uvec2().min(glam::UVec2::splat(self.side as u32 - 1));
        let cell = place.y as usize * self.side + place.x as usize;
        let by_cells = (1.0 - UNIFORM) * self.cells.probability(cell) * side * side;
        let density = if self.cells.is_empty() { 1.0 } else { UNIFORM + by_cells };
        let area = 4.0 * self.half.x * self.half.y / density;
        let direction = (self.to_local.transpose() * local).normalize();
        (direction, area / (length_sq * length_sq.sqrt()))
    }

    /// Returns the texel at a place of the image, whose edges lie at ±1.
    #[inline]
    fn texel(&self, at: Vec2) -> Rgb {
        let uv = Vec2::new(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y);
        let image = self.texture.and_then(|id| self.textures.by_id(id));
        image.map_or(Rgb::ONE, |image| image.lookup(uv)).max(Rgb::ZERO)
    }

    /// Estimates the flux through a cell.
    fn flux_of_cell(&self, cell: usize, image: Option<&Texture>) -> f32 {
        let side = self.side as f32;
        let size = image.map_or(1, |image| image.width.max(image.height));
        let lookups = size.div_ceil(self.side).clamp(2, MAX_LOOKUPS);
        let corner = Vec2::new((cell % self.side) as f32, (cell / self.side) as f32);
        let mut sum = 0.0;
        for i in 0..lookups * lookups {
            let within = Vec2::new((i % lookups) as f32 + 0.5, (i / lookups) as f32 + 0.5) / lookups as f32;
            let local = ((2.0 * (corner + within) / side - 1.0) * self.half).extend(1.0);
            let length_sq = local.length_squared();
            let away = (self.to_local.transpose() * local).normalize();
            let flux = luminance(self.intensity(away)) / (length_sq * length_sq.sqrt());
            sum += if flux.is_finite() { flux } else { 0.0 };
        }
        sum * 4.0 * self.half.x * self.half.y / (side * side * (lookups * lookups) as f32)
    }

    /// Mean intensity over the directions within [`ImageLight::angle`], as luminance.
    pub fn mean_intensity(&self) -> f32 {
        self.power / (2.0 * PI * (1.0 - self.angle.cos())).max(f32::MIN_POSITIVE)
    }

    /// Unit vector through the image's centre.
    pub fn axis(&self) -> Vec3 {
        self.to_local.transpose() * Vec3::Z
    }
}

/// Returns the share of a spot's axial intensity at the given cosine to its axis.
#[inline]
pub fn spot_falloff(cos: f32, inner_angle: f32, outer_angle: f32) -> f32 {
    let angle = cos.clamp(-1.0, 1.0).acos();
    if angle <= inner_angle {
        1.0
    } else if angle >= outer_angle {
        0.0
    } else {
        (outer_angle - angle) / (outer_angle - inner_angle)
    }
}
