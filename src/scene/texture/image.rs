//! Image textures, stored as linear colour.

use super::texels::Texels;
use crate::attribute::AttributeId;
use base::math::{Rgb, luminance};
use glam::{DVec3, Mat3, Vec2};

/// Points along a texel's side for the mean of a cut texture.
const CUT_STEPS: usize = 4;

/// Share of the threshold by which a value may fall short, so that means of equal texels are as the texels.
const CUT_SLACK: f32 = 1e-6;

/// Index into [`Textures`](super::Textures).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureId(pub u32);

/// Interpolation between texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// Linear between the centres of the four nearest texels.
    Bilinear,
    /// As [`Filter::Bilinear`], and then cut: 1 from this value on, else 0.
    ///
    /// Every lookup gives 0 or 1, so that borders of masks are sharp. A cut texture has no mip maps: the cut of a mean
    /// is not the mean of what was cut.
    Cut(f32),
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
            Filter::Bilinear => self.interpolated(x, y),
            Filter::Cut(from) => cut(self.interpolated(x, y), from),
        }
    }

    /// Returns the colour between the centres of the four texels around a position, in texels.
    #[inline(always)]
    fn interpolated(&self, x: f32, y: f32) -> Rgb {
        let ([x0, x1], fx) = neighbours(x - 0.5);
        let ([y0, y1], fy) = neighbours(y - 0.5);
        let [left, right] = [x0, x1].map(|x| self.column(x));
        let [top, bottom] = [y0, y1].map(|y| self.row(y));
        let between = |y| self.texels.get(left, y).lerp(self.texels.get(right, y), fx);
        between(top).lerp(between(bottom), fy)
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

    /// Returns true if every lookup is black.
    pub fn is_black(&self) -> bool {
        match self.filter {
            Filter::Cut(from) => self.texels.all(|texel| cut(texel, from) == Rgb::ZERO),
            Filter::Bilinear | Filter::Nearest => self.texels.all(|texel| texel.max_element() <= 0.0),
        }
    }

    /// Returns the mean of the texels; white if there are none. Of a cut texture, it is the mean of what was cut.
    pub fn mean(&self) -> Rgb {
        if self.texels.is_empty() {
            return Rgb::ONE;
        }
        if let Filter::Cut(from) = self.filter {
            return self.cut_mean(from);
        }
        let sum = self.texels.iter().fold(DVec3::ZERO, |sum, texel| sum + texel.as_dvec3());
        (sum / self.texels.len() as f64).as_vec3()
    }

    /// Returns the mean of a texture that is cut at `from`, by [`CUT_STEPS`]² points per texel. The texels' centres are
    /// among them: these hold the extremes, so that no gap is missed.
    fn cut_mean(&self, from: f32) -> Rgb {
        let at = |texel: usize, step: usize| texel as f32 + step as f32 / CUT_STEPS as f32;
        let mut sum = DVec3::ZERO;
        for y in 0..self.height {
            for x in 0..self.width {
                let texel = |i: i64| {
                    let (column, row) = (self.column(x as i64 + i % 3 - 1), self.row(y as i64 + i / 3 - 1));
                    cut(self.texels.get(column, row), from)
                };
                // Between equal texels nothing changes.
                let own = texel(4);
                if (0..9).all(|i| texel(i) == own) {
                    sum += own.as_dvec3();
                    continue;
                }
                let steps = (0..CUT_STEPS * CUT_STEPS).map(|i| [i % CUT_STEPS, i / CUT_STEPS]);
                let point = |[i, j]: [usize; 2]| cut(self.interpolated(at(x, i), at(y, j)), from).as_dvec3();
                sum += steps.map(point).sum::<DVec3>() / (CUT_STEPS * CUT_STEPS) as f64;
            }
        }
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

/// Returns 1 where a value reaches `from`, up to rounding, else 0.
#[inline]
pub(super) fn cut(value: Rgb, from: f32) -> Rgb {
    Rgb::select(value.cmpge(Rgb::splat(from * (1.0 - CUT_SLACK))), Rgb::ONE, Rgb::ZERO)
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

/// First of the ids of attribute textures.
const FIRST: u32 = 1 << 31;

/// Texture that is an attribute of the mesh, or the product of an attribute and an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttributeTexture {
    /// The attribute.
    pub attribute: AttributeId,
    /// The image.
    pub image: Option<TextureId>,
    /// Value from which on the texture is 1, and below which it is 0. Masks alone have one.
    pub cut: Option<f32>,
}

impl TextureId {
    /// Returns the id of the attribute texture of a number.
    pub fn of_attribute(number: usize) -> TextureId {
        TextureId(FIRST | number as u32)
    }

    /// Returns the number of the attribute texture; `None` for an image.
    #[inline]
    pub fn attribute_number(self) -> Option<usize> {
        (self.0 >= FIRST).then_some((self.0 ^ FIRST) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_as_large_as_may_be_have_a_colour() {
        let texels = Texels::new(2, &[Rgb::ZERO, Rgb::X, Rgb::Y, Rgb::Z]);
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            for filter in [Filter::Bilinear, Filter::Nearest, Filter::Cut(0.5)] {
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

    #[test]
    fn masks_are_cut_after_interpolation() {
        let grey = |codes: &[u8]| {
            let texels: Vec<[u8; 4]> = codes.iter().map(|code| [*code; 4]).collect();
            Texels::coded(2, &texels, std::array::from_fn(|code| code as f32 / 255.0))
        };
        let mask = |codes: &[u8], from: f32| Texture {
            name: "mask".into(),
            width: 2,
            height: codes.len() / 2,
            texels: grey(codes),
            filter: Filter::Cut(from),
            wrap: Wrap::Clamp,
            to_uv: Mat3::IDENTITY,
        };
        // Alpha is 0 at u = 1/4 and 1 at u = 3/4, so that it passes the threshold t at 1/4 + t / 2.
        for from in [0.1, 0.5, 0.9] {
            let texture = mask(&[0, 255, 0, 255], from);
            for i in 0..1000 {
                let u = (i as f32 + 0.5) / 1000.0;
                let expected = f32::from(u8::from(u >= 0.25 + 0.5 * from));
                assert_eq!(texture.lookup(Vec2::new(u, 0.3)), Rgb::splat(expected), "{u} {from}");
            }
            let mean = texture.mean().x;
            assert!((mean - (0.75 - 0.5 * from)).abs() < 0.126, "{mean} {from}");
        }
        // Texels at the threshold are there, and so is all between them.
        let full = mask(&[180; 4], 180.0 / 255.0);
        for i in 0..1000 {
            let uv = Vec2::new(0.618 * i as f32, 0.414 * i as f32).fract();
            assert_eq!(full.lookup(uv), Rgb::ONE, "{uv}");
        }
        assert!(full.mean() == Rgb::ONE && !full.is_black());
        let none = mask(&[179; 4], 180.0 / 255.0);
        assert!(none.mean() == Rgb::ZERO && none.is_black());
        assert_eq!(mask(&[0; 4], 0.0).lookup(Vec2::ZERO), Rgb::ONE);
        // A gap of one texel is not missed.
        let gap = mask(&[255, 255, 255, 127], 0.5).mean().x;
        assert!(gap < 1.0 && gap > 0.8, "{gap}");
    }
}
