//! Scattering of a surface: a Lambert base, up to three lobes above it, and an optional clear coat.
//!
//! Every material of the supported formats is such a combination. For instance, `plastic` is a base under a coat with a
//! mirror lobe, and `conductor` a mirror lobe alone. [`Principled`] has parameters of its own. Any material may have an
//! opacity ([`Material::opacity`]).

use super::parameter::{Reflectance, Roughness, Share};
use super::principled::Principled;
use super::texture::TextureId;
use base::math::Rgb;

/// Index into [`super::Scene::materials`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct MaterialId(pub u32);

/// A material. The default is black.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Material {
    /// Name for reports.
    pub name: String,
    /// True if the back scatters as the front does. Else the back is black, except for glass.
    pub two_sided: bool,
    /// Albedo of the Lambert base, without the coat's transmittance; zero without a base.
    pub diffuse: Reflectance,
    /// Dielectric interface over the base. The first rough lobe determines its roughness.
    pub coat: Option<Coat>,
    /// Lobes besides the base: up to five; lobes of glass count twice. Further lobes are ignored.
    pub lobes: Vec<Lobe>,
    /// Principled parameters. They replace base, coat and lobes above.
    pub principled: Option<Box<Principled>>,
    /// Material that is mixed with this one. Only its base and lobes count.
    pub blend: Option<Box<Blend>>,
    /// Opacity of either side; light passes the remaining share straight. `None` stands for an opaque surface.
    pub opacity: Option<Share>,
    /// Relief, which changes the shading normals.
    pub relief: Option<Relief>,
    /// Rules for the relief where it leans away.
    pub relief_rules: ReliefRules,
    /// Absorption coefficient σ of what is inside solid glass, per channel and per unit of length of the scene.
    ///
    /// Light that goes the way d inside keeps the share exp(-σ d).
    pub absorption: Option<Rgb>,
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

    /// Returns the material, and in turn the materials mixed with it.
    pub fn parts(&self) -> impl Iterator<Item = &Material> {
        std::iter::successors(Some(self), |material| material.blend.as_ref().map(|blend| &blend.other))
    }

    /// Returns the angle from u in radians of the axis of anisotropy, and the texture of directions that replace u;
    /// `None` if isotropic.
    ///
    /// In a mixture, the first anisotropic material counts.
    pub fn anisotropy_axis(&self) -> Option<(f32, Option<TextureId>)> {
        self.parts().find_map(|part| {
            let of_lobe = |lobe: &Lobe| matches!(lobe, Lobe::Anisotropic { .. }).then_some((0.0, None));
            let principled = part.principled.as_ref().filter(|p| p.anisotropic != Share::Constant(0.0));
            let of_principled = principled.map(|p| (p.anisotropic_rotation, p.anisotropic_direction));
            of_principled.or_else(|| part.lobes.iter().find_map(of_lobe))
        })
    }

    /// Returns the absorption coefficient inside, if the material is of solid glass that absorbs.
    ///
    /// In a mixture, the first material that absorbs counts.
    pub fn interior_absorption(&self) -> Option<Rgb> {
        let is_solid =
            |lobe: &Lobe| matches!(lobe, Lobe::Dielectric { thin: false, .. } | Lobe::RoughDielectric { .. });
        let transmits = |principled: &Principled| principled.spec_trans != Share::Constant(0.0);
        self.parts().find_map(|part| {
            let is_glass =
                part.lobes.iter().any(is_solid) || part.principled.as_deref().is_some_and(transmits);
            part.absorption.filter(|absorption| is_glass && *absorption != Rgb::ZERO)
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

    /// Returns every roughness of the lobes.
    pub fn alphas_mut(&mut self) -> Vec<&mut Roughness> {
        let mut all = Vec::new();
        for lobe in &mut self.lobes {
            match lobe {
                Lobe::Rough { alpha, .. } | Lobe::RoughDielectric { alpha, .. } => all.push(alpha),
                Lobe::Anisotropic { alpha, .. } => all.extend(alpha),
                Lobe::Mirror { .. } | Lobe::Dielectric { .. } => {}
            }
        }
        all.extend(self.blend.iter_mut().flat_map(|blend| blend.other.alphas_mut()));
        all
    }

    /// Lists the textures of colours, shares and roughness.
    pub fn textures(&self) -> Vec<TextureId> {
        let mut material = self.clone();
        let mut all: Vec<TextureId> =
            material.reflectances_mut().into_iter().filter_map(|colour| colour.texture()).collect();
        all.extend(material.shares_mut().into_iter().filter_map(|share| share.texture()));
        all.extend(material.alphas_mut().into_iter().filter_map(|alpha| alpha.texture()));
        all
    }

    /// True if the roughness of a lobe is textured, or its direction. A mixed-in material does not count.
    pub fn has_textured_roughness(&self) -> bool {
        let of_principled = |p: &Principled| {
            p.roughness.is_textured() || p.anisotropic.is_textured() || p.anisotropic_direction.is_some()
        };
        self.principled.as_deref().is_some_and(of_principled)
            || self.lobes.iter().any(|lobe| match lobe {
                Lobe::Rough { alpha, .. } | Lobe::RoughDielectric { alpha, .. } => alpha.is_textured(),
                Lobe::Anisotropic { alpha, .. } => alpha.iter().any(Roughness::is_textured),
                Lobe::Mirror { .. } | Lobe::Dielectric { .. } => false,
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
                Lobe::Anisotropic { alpha, scale, .. } => {
                    alpha.iter().any(Roughness::is_textured) || scale.is_textured()
                }
                Lobe::Mirror { scale, .. } => scale.is_textured(),
                Lobe::Dielectric { reflectance, transmittance, .. } => {
                    reflectance.is_textured() || transmittance.is_textured()
                }
                Lobe::RoughDielectric { alpha, reflectance, transmittance, .. } => {
                    alpha.is_textured() || reflectance.is_textured() || transmittance.is_textured()
                }
            })
    }
}

/// Mixture with another material. If the bases lie under different coats, the coat of the first covers both.
#[derive(Clone, Debug, PartialEq)]
pub struct Blend {
    /// Share of the other material.
    pub weight: Share,
    /// The other material.
    pub other: Material,
}

/// Smooth or rough dielectric interface over the Lambert base, as in Mitsuba's `plastic` and `roughplastic`.
///
/// The base is attenuated by the transmittance in and out, and by internal reflection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coat {
    /// Interior over exterior index of refraction.
    pub eta: f32,
    /// True if internal scattering shifts the base's colour: `1 - albedo * F_dr` per channel instead of `1 - F_dr`.
    pub nonlinear: bool,
}

/// Part of a material besides the Lambert base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lobe {
    /// Isotropic microfacet reflection.
    Rough {
        /// Microfacet distribution.
        distribution: Distribution,
        /// Roughness α.
        alpha: Roughness,
        /// Reflectance of a facet.
        fresnel: Fresnel,
        /// Factor on the lobe.
        scale: Reflectance,
    },
    /// Microfacet reflection with different roughness along u and v. Without texture coordinates, u is any direction.
    Anisotropic {
        /// Microfacet distribution.
        distribution: Distribution,
        /// Roughness α along u, and along v.
        alpha: [Roughness; 2],
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
    /// Smooth glass, which reflects and refracts.
    Dielectric {
        /// Interior over exterior index of refraction; the interior is behind the normal.
        eta: f32,
        /// True for a sheet with two interfaces close to each other.
        ///
        /// Transmitted light goes straight on, after any number of internal reflections.
        thin: bool,
        /// Factor on reflection.
        reflectance: Reflectance,
        /// Factor on refraction. Radiance also scales by 1/η² on entering the denser side.
        transmittance: Reflectance,
    },
    /// Rough glass, which reflects and refracts at microfacets.
    RoughDielectric {
        /// Microfacet distribution.
        distribution: Distribution,
        /// Roughness α.
        alpha: Roughness,
        /// Interior over exterior index of refraction; the interior is behind the normal.
        eta: f32,
        /// Factor on reflection.
        reflectance: Reflectance,
        /// Factor on refraction.
        transmittance: Reflectance,
    },
}

/// Microfacet distribution, with Smith's separable shadowing as in Mitsuba.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distribution {
    /// Distribution of Trowbridge and Reitz.
    Ggx,
    /// Distribution of Beckmann.
    Beckmann,
}

/// Reflectance of a smooth interface by angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fresnel {
    /// Reflectance 1 at every angle.
    One,
    /// Dielectric of a relative index of refraction.
    Dielectric(f32),
    /// Conductor of index `eta + i k`, per channel.
    Conductor {
        /// Real part of the index.
        eta: Rgb,
        /// Imaginary part of the index.
        k: Rgb,
    },
    /// Schlick's approximation between two reflectances.
    Schlick {
        /// Reflectance at normal incidence.
        normal: Rgb,
        /// Reflectance at grazing incidence.
        edge: f32,
    },
}

/// Rules for a relief where it leans away from the viewer or from light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReliefRules {
    /// True if a normal that leans away from the viewer is mirrored at the shading normal.
    pub mirrors: bool,
    /// True if the bumps shadow each other, as microfacets do.
    pub shadows: bool,
}

/// Relief of a surface, from the raw texels of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relief {
    /// Normals in the frame of the texture coordinates: x along ∂p/∂u, z along the shading normal.
    ///
    /// Texels from 0 to 1 stand for coordinates from -1 to 1.
    Normals {
        /// The texture.
        texture: TextureId,
        /// Factor on x and y.
        strength: f32,
        /// True if y points along growing v, as in glTF with v upwards. Else y completes a right-handed frame, as in
        /// Mitsuba, also if the texture is mirrored.
        y_along_v: bool,
    },
    /// Heights above the surface, from the luminance of texels.
    Heights {
        /// The texture.
        texture: TextureId,
        /// Height of a texel of 1, in the scene's unit.
        scale: f32,
    },
}
