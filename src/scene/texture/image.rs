//! Image textures, stored as linear colour.

use super::texels::Texels;
use base::math::{Rgb, luminance};
use glam::{DVec3, Mat3, Vec2};

/// Index into [`Textures`](super::Textures).
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
    /// Repetition.
    Repeat,
    /// Repetition, mirrored at each edge.
    Mirror,
    /// Colour of the nearest edge texel.
    Clamp,
}

/// An image over texture coordinates. The bottom of the image is at v = 0.
#[derive(Clone, Debug)]
pub struct Texture {
    /// Name for reports.
    pub name: String,
    /// Number of columns.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
    /// Linear colour, top row first.
    pub texels: Texels,
    /// Interpolation between texels.
    pub filter: Filter,
    /// Extension of the texture beyond [0, 1]².
    pub wrap: Wrap,
    /// Matrix that is applied to the homogeneous texture coordinates first.
    pub to_uv: Mat3,
}

impl Texture {
    /// Returns the colour at texture coordinates `uv`.
    pub fn lookup(&self, uv: Vec2) -> Rgb {
        let uv = self.to_uv.transform_point2(uv);
        let (x, y) = (uv.x * self.width as f32, (1.0 - uv.y) * self.height as f32);
        match self.filter {
            Filter::Nearest => self.texels.get(self.column(x.floor() as i64), self.row(y.floor() as i64)),
            Filter::Bilinear => {
                let ([x0, x1], fx) = neighbours(x - 0.5);
                let ([y0, y1], fy) = neighbours(y - 0.5);
                let [left, right] = [x0, x1].map(|x| self.column(x));
                let [top, bottom] = [y0, y1].map(|y| self.row(y));
                let between = |y| self.texels.get(left, y).lerp(self.texels.get(right, y), fx);
                between(top).lerp(between(bottom), fy)
            }
        }
    }

    /// Returns the number of a square of texels that [`Texture::lookup`] reads at `uv`, for [`Texels::peek`].
    #[inline]
    pub fn square(&self, uv: Vec2) -> usize {
        let uv = self.to_uv.transform_point2(uv);
        let (x, y) = (uv.x * self.width as f32, (1.0 - uv.y) * self.height as f32);
        self.texels.square(self.column(x.floor() as i64), self.row(y.floor() as i64))
    }

    /// Returns the derivatives of the luminance by u and v at `uv`, for linear interpolation.
    pub fn luminance_gradient(&self, uv: Vec2) -> Vec2 {
        let at = self.to_uv.transform_point2(uv);
        let ([x0, x1], fx) = neighbours(at.x * self.width as f32 - 0.5);
        let ([y0, y1], fy) = neighbours((1.0 - at.y) * self.height as f32 - 0.5);
        let [left, right] = [x0, x1].map(|x| self.column(x));
        let [top, bottom] = [y0, y1].map(|y| self.row(y));
        let texel = |x, y| luminance(self.texels.get(x, y));
        let [t00, t10, t01, t11] =
            [texel(left, top), texel(right, top), texel(left, bottom), texel(right, bottom)];
        let along_x = (t10 - t00) * (1.0 - fy) + (t11 - t01) * fy;
        let along_y = (t01 - t00) * (1.0 - fx) + (t11 - t10) * fx;
        let gradient = Vec2::new(along_x * self.width as f32, -along_y * self.height as f32);
        let [u, v] = [self.to_uv.x_axis, self.to_uv.y_axis].map(|axis| axis.truncate());
        Vec2::new(gradient.dot(u), gradient.dot(v))
    }

    /// Returns the mean of the texels; white if there are none.
    pub fn mean(&self) -> Rgb {
        if self.texels.is_empty() {
            return Rgb::ONE;
        }
        let sum = self.texels.iter().fold(DVec3::ZERO, |sum, texel| sum + texel.as_dvec3());
        (sum / self.texels.len() as f64).as_vec3()
    }

    #[inline]
    fn column(&self, x: i64) -> usize {
        self.wrap.index(x, self.width)
    }

    #[inline]
    fn row(&self, y: i64) -> usize {
        self.wrap.index(y, self.height)
    }
}

/// Returns the indices of the texels on both sides of a position, and the interpolation weight of the second. The
/// choice does not matter far out, where floats have no fraction or overflow the integers.
#[inline]
fn neighbours(position: f32) -> ([i64; 2], f32) {
    let floor = position.floor();
    let first = floor as i64;
    ([first, first.wrapping_add(1)], (position - floor).max(0.0))
}

impl Wrap {
    /// Returns the index among `n` texels that stands for index `i`.
    #[inline]
    fn index(self, i: i64, n: usize) -> usize {
        // The usual case, without a division.
        if (i as u64) < n as u64 {
            return i as usize;
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_as_large_as_may_be_have_a_colour() {
        let texels = Texels::new(2, &[Rgb::ZERO, Rgb::X, Rgb::Y, Rgb::Z]);
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            for filter in [Filter::Bilinear, Filter::Nearest] {
                let (texels, to_uv) = (texels.clone(), Mat3::from_scale(Vec2::splat(1e9)));
                let texture = Texture { name: "t".into(), width: 2, height: 2, texels, filter, wrap, to_uv };
                for uv in [1e-9, 1e9, -1e12, 1e25, 3e38, -3e38] {
                    let uv = Vec2::new(uv, 0.3);
                    assert!(
                        texture.lookup(uv).is_finite() && !texture.luminance_gradient(uv).is_nan(),
                        "{uv}"
                    );
                }
            }
        }
    }
}
