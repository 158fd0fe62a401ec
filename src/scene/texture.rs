//! Image textures, stored as linear colour.

use crate::math::Rgb;
use glam::{DVec3, Mat3, Vec2};

/// Index into [`super::Scene::textures`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureId(pub u32);

/// Interpolation between texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// Linear between the centres of the four nearest texels.
    Bilinear,
    /// The nearest texel.
    Nearest,
}

/// Extension of the texture beyond [0, 1]².
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    Repeat,
    /// The image mirrored at each edge.
    Mirror,
    /// The edge texel.
    Clamp,
}

/// An image over texture coordinates; v = 0 is the bottom row of the image.
#[derive(Clone, Debug)]
pub struct Texture {
    /// Name for reports.
    pub name: String,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Linear colour, row-major, top row first.
    pub texels: Vec<Rgb>,
    /// Interpolation between texels.
    pub filter: Filter,
    /// Extension of the texture beyond [0, 1]².
    pub wrap: Wrap,
    /// Applied to the texture coordinates (homogeneous) first.
    pub to_uv: Mat3,
}

impl Texture {
    /// Returns the colour at texture coordinates `uv`.
    pub fn lookup(&self, uv: Vec2) -> Rgb {
        let uv = self.to_uv.transform_point2(uv);
        let (x, y) = (uv.x * self.width as f32, (1.0 - uv.y) * self.height as f32);
        match self.filter {
            Filter::Nearest => self.texel(x.floor() as i64, y.floor() as i64),
            Filter::Bilinear => {
                let (x, y) = (x - 0.5, y - 0.5);
                let (x0, y0) = (x.floor(), y.floor());
                let (fx, fy) = (x - x0, y - y0);
                let (x0, y0) = (x0 as i64, y0 as i64);
                let top = self.texel(x0, y0).lerp(self.texel(x0 + 1, y0), fx);
                let bottom = self.texel(x0, y0 + 1).lerp(self.texel(x0 + 1, y0 + 1), fx);
                top.lerp(bottom, fy)
            }
        }
    }

    /// Returns the mean of the texels; white without any.
    pub fn mean(&self) -> Rgb {
        if self.texels.is_empty() {
            return Rgb::ONE;
        }
        let sum = self.texels.iter().fold(DVec3::ZERO, |sum, t| sum + t.as_dvec3());
        (sum / self.texels.len() as f64).as_vec3()
    }

    #[inline]
    fn texel(&self, x: i64, y: i64) -> Rgb {
        let x = self.wrap.index(x, self.width);
        let y = self.wrap.index(y, self.height);
        self.texels[y * self.width + x]
    }
}

impl Wrap {
    #[inline]
    fn index(self, i: i64, n: usize) -> usize {
        let n = n as i64;
        let i = match self {
            Wrap::Repeat => i.rem_euclid(n),
            Wrap::Clamp => i.clamp(0, n - 1),
            Wrap::Mirror => {
                let m = i.rem_euclid(2 * n);
                if m < n { m } else { 2 * n - 1 - m }
            }
        };
        i as usize
    }
}
