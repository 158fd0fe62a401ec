//! Scattering of a surface: a Lambert base, up to three lobes above it, and an optional clear coat.
//!
//! Every material of the supported formats is one of these combinations, so a stage that handles base, lobes
//! and coat handles them all: `plastic` is a base under a coat with a mirror lobe, `roughplastic` the same
//! with a rough lobe, `conductor` a mirror lobe alone. [`Principled`] is a combination of its own. Any of them may
//! have gaps ([`Material::opacity`]).

use super::principled::Principled;
use super::relief::Relief;
use super::texture::TextureId;
use base::math::Rgb;
use std::ops::Mul;

/// Index into [`super::Scene::materials`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct MaterialId(pub u32);

/// Colour or number that may vary over the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Parameter<T> {
    /// The same everywhere.
    Constant(T),
    /// The texture's value times `scale`; a number takes the luminance of each texel.
    Textured {
        /// Index of the texture.
        texture: TextureId,
        /// Factor on every texel.
        scale: T,
    },
}

/// Share of the light that is scattered, per channel.
pub type Reflectance = Parameter<Rgb>;

/// Microfacet roughness α.
pub type Roughness = Parameter<f32>;

/// Number from 0 to 1.
pub type Share = Parameter<f32>;

impl<T: Copy + Mul<Output = T>> Parameter<T> {
    /// Returns the parameter where each texture has the value `texel` of it.
    #[inline]
    pub fn value(&self, texel: impl FnOnce(TextureId) -> T) -> T {
        match *self {
            Parameter::Constant(value) => value,
            Parameter::Textured { texture, scale } => texel(texture) * scale,
        }
    }

    /// True if it varies over the surface.
    pub fn is_textured(&self) -> bool {
        matches!(self, Parameter::Textured { .. })
    }
}

impl<T> From<T> for Parameter<T> {
    fn from(value: T) -> Parameter<T> {
        Parameter::Constant(value)
    }
}

impl Reflectance {
    /// Returns the parameter times a factor.
    pub fn times(self, factor: Rgb) -> Reflectance {
        match self {
            Reflectance::Constant(value) => Reflectance::Constant(value * factor),
            Reflectance::Textured { texture, scale } => {
                Reflectance::Textured { texture, scale: scale * factor }
            }
        }
    }

    /// No reflection anywhere.
    pub const BLACK: Reflectance = Reflectance::Constant(Rgb::ZERO);
}

impl Default for Reflectance {
    fn default() -> Reflectance {
        Reflectance::BLACK
    }
}

/// Material: base and lobes, seen from one side or two. The default is black.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Material {
    /// Name for reports.
    pub name: String,
    /// True: the side away from the normal behaves as the front does. False: it is black
    /// (except for glass, which always has two sides).
    pub two_sided: bool,
    /// Albedo of the Lambert base, before the coat takes its share; zero where there is none.
    pub diffuse: Reflectance,
    /// Dielectric interface over the base, as rough as the first rough lobe.
    pub coat: Option<Coat>,
    /// Lobes besides the base: up to five, of which those of glass count for two. More are ignored.
    pub lobes: Vec<Lobe>,
    /// Base and lobes in terms of other parameters; base, coat and lobes above are left out where it is given.
    pub principled: Option<Box<Principled>>,
    /// Another material that is mixed with this one; of its own, base and lobes count.
    pub blend: Option<Box<Blend>>,
    /// Share of the surface that is there, of either side; light passes the rest straight. `None`: all of it.
    pub opacity: Option<Share>,
    /// Relief, which turns the shading normals.
    pub relief: Option<Relief>,
}

impl Material {
    /// Returns every colour.
    pub fn reflectances_mut(&mut self) -> Vec<&mut Reflectance> {
        let mut all = vec![&mut self.diffuse];
        all.extend(self.principled.as_mut().map(|principled| &mut principled.base_color));
        all.extend(self.blend.iter_mut().flat_map(|blend| blend.other.reflectances_mut()));
        for lobe in &mut self.lobes {
            match lobe {
                Lobe::Rough { scale, .. } | Lobe::Anisotropic { scale, .. } | Lobe::Mirror { scale, .. } => {
                    all.push(scale)
                }
                Lobe::Dielectric { reflectance, transmittance, .. }
                | Lobe::RoughDielectric { reflectance, transmittance, .. } => {
                    all.extend([reflectance, transmittance])
                }
            }
        }
        all
    }

    /// Returns the material's own parts and, in turn, those of the ones mixed with it.
    pub fn parts(&self) -> impl Iterator<Item = &Material> {
        std::iter::successors(Some(self), |material| material.blend.as_ref().map(|blend| &blend.other))
    }

    /// Angle from u, in radians, along which it scatters light otherwise than across; `None` if it is isotropic. Of
    /// several that are mixed, that of the first.
    pub fn anisotropy_angle(&self) -> Option<f32> {
        self.parts().find_map(|part| {
            let of_lobe = |lobe: &Lobe| matches!(lobe, Lobe::Anisotropic { .. }).then_some(0.0);
            let principled = part.principled.as_ref().filter(|p| p.anisotropic != 0.0);
            let of_principled = principled.map(|p| p.anisotropic_rotation);
            of_principled.or_else(|| part.lobes.iter().find_map(of_lobe))
        })
    }

    /// Returns every share.
    pub fn shares_mut(&mut self) -> Vec<&mut Share> {
        let mut all = Vec::from_iter(&mut self.opacity);
        all.extend(self.principled.iter_mut().flat_map(|principled| principled.shares_mut()));
        if let Some(blend) = &mut self.blend {
            all.push(&mut blend.weight);
            all.extend(blend.other.shares_mut());
        }
        all
    }

    /// True if the roughness of a lobe is textured, a blended material's left out.
    pub fn has_textured_roughness(&self) -> bool {
        self.principled.as_ref().is_some_and(|principled| principled.roughness.is_textured())
            || self.lobes.iter().any(|lobe| match lobe {
                Lobe::Rough { alpha, .. } | Lobe::RoughDielectric { alpha, .. } => alpha.is_textured(),
                Lobe::Anisotropic { .. } | Lobe::Mirror { .. } | Lobe::Dielectric { .. } => false,
            })
    }

    /// True if any parameter is textured.
    pub fn is_textured(&self) -> bool {
        self.diffuse.is_textured()
            || self.relief.is_some()
            || self
                .blend
                .as_ref()
                .is_some_and(|blend| blend.weight.is_textured() || blend.other.is_textured())
            || self.opacity.is_some_and(|opacity| opacity.is_textured())
            || self.principled.as_ref().is_some_and(|principled| principled.is_textured())
            || self.lobes.iter().any(|lobe| match lobe {
                Lobe::Rough { alpha, scale, .. } => alpha.is_textured() || scale.is_textured(),
                Lobe::Anisotropic { scale, .. } | Lobe::Mirror { scale, .. } => scale.is_textured(),
                Lobe::Dielectric { reflectance, transmittance, .. } => {
                    reflectance.is_textured() || transmittance.is_textured()
                }
                Lobe::RoughDielectric { alpha, reflectance, transmittance, .. } => {
                    alpha.is_textured() || reflectance.is_textured() || transmittance.is_textured()
                }
            })
    }
}

/// Mixture with another material. Where the bases of both lie under coats that differ, that of the first covers both.
#[derive(Clone, Debug, PartialEq)]
pub struct Blend {
    /// Share of the other material.
    pub weight: Share,
    /// The other material.
    pub other: Material,
}

/// Smooth or rough dielectric interface over the Lambert base, as Mitsuba's `plastic` and
/// `roughplastic` define it: the base is attenuated by the transmittance in and out and by internal reflection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coat {
    /// Interior over exterior index of refraction.
    pub eta: f32,
    /// True if internal scattering shifts the base's colour (`1 - albedo * F_dr` per channel) or not (`1 - F_dr`).
    pub nonlinear: bool,
}

/// Part of a material besides the Lambert base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lobe {
    /// Isotropic microfacet reflection.
    Rough {
        /// Microfacet distribution.
        distribution: Distribution,
        /// Roughness.
        alpha: Roughness,
        /// Reflectance of a facet.
        fresnel: Fresnel,
        /// Factor on the lobe.
        scale: Reflectance,
    },
    /// Microfacet reflection of another roughness along u than along v, texture coordinates. Where a mesh has none, u
    /// is any direction.
    Anisotropic {
        /// Microfacet distribution.
        distribution: Distribution,
        /// Roughness along u, and along v.
        alpha: [f32; 2],
        /// Reflectance of a facet.
        fresnel: Fresnel,
        /// Factor on the lobe.
        scale: Reflectance,
    },
    /// Perfect mirror.
    Mirror {
        /// Reflectance by angle.
        fresnel: Fresnel,
        /// Factor on the lobe.
        scale: Reflectance,
    },
    /// Smooth glass: reflects and refracts.
    Dielectric {
        /// Interior over exterior index of refraction; the interior is behind the normal.
        eta: f32,
        /// True for a sheet with an interface on either side, so close to each other that light which passes it, and is
        /// reflected between them any number of times, goes straight on.
        thin: bool,
        /// Factor on reflection.
        reflectance: Reflectance,
        /// Factor on refraction (radiance also scales by 1/η² as it enters the denser side).
        transmittance: Reflectance,
    },
    /// Rough glass: reflects and refracts by microfacets.
    RoughDielectric {
        /// Microfacet distribution.
        distribution: Distribution,
        /// Roughness.
        alpha: Roughness,
        /// Interior over exterior index of refraction; the interior is behind the normal.
        eta: f32,
        /// Factor on reflection.
        reflectance: Reflectance,
        /// Factor on refraction.
        transmittance: Reflectance,
    },
}

/// Microfacet distributions, both with Smith's separable shadowing as Mitsuba uses it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distribution {
    /// Trowbridge-Reitz.
    Ggx,
    /// Beckmann.
    Beckmann,
}

/// Reflectance of a smooth interface by angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fresnel {
    /// 1 at every angle; the lobe's scale says the rest.
    One,
    /// Dielectric of the given relative index of refraction.
    Dielectric(f32),
    /// Conductor of index `eta + i k`, per channel.
    Conductor {
        /// Real part.
        eta: Rgb,
        /// Absorption.
        k: Rgb,
    },
    /// Schlick's approximation between two reflectances.
    Schlick {
        /// At normal incidence.
        normal: Rgb,
        /// At grazing incidence.
        edge: f32,
    },
}
