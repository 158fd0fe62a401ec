//! Tables that materials of a scene share.

use super::base::RoughCoat;
use super::lobe::{AnisotropicLobe, Grazing, GrazingKind};
use super::microfacet::Microfacets;
use super::table::{AngleTable, albedo_table};
use base::math::Rgb;
use scene::Fresnel;
use std::sync::Arc;

/// Tables by roughness and index of refraction.
#[derive(Default)]
pub(super) struct Tables {
    coats: Vec<(Microfacets, f32, Arc<RoughCoat>)>,
    /// Coats that take the light that they reflect.
    layers: Vec<(Microfacets, f32, Arc<RoughCoat>)>,
    albedos: Vec<(Microfacets, Fresnel, Arc<AngleTable<Rgb>>)>,
    /// Anisotropic lobes and their albedos.
    anisotropic: Vec<(AnisotropicLobe, Arc<AngleTable<Rgb>>)>,
    /// Retroreflection by roughness.
    retros: Vec<(f32, Grazing)>,
}

/// Number of albedos of anisotropic lobes of textured roughness between a roughness and its double.
const ALBEDOS_PER_OCTAVE: f32 = 2.0;

impl Tables {
    /// Returns the tables of a rough coat.
    pub fn coat(&mut self, facets: Microfacets, eta: f32) -> Arc<RoughCoat> {
        if let Some((_, _, coat)) = self.coats.iter().find(|c| c.0 == facets && c.1 == eta) {
            return coat.clone();
        }
        let coat = Arc::new(RoughCoat::new(&facets, eta));
        self.coats.push((facets, eta, coat.clone()));
        coat
    }

    /// Returns the tables of dielectric microfacets that take the light that they reflect from a base below.
    pub fn layer(&mut self, facets: Microfacets, eta: f32) -> Arc<RoughCoat> {
        if let Some((_, _, layer)) = self.layers.iter().find(|l| l.0 == facets && l.1 == eta) {
            return layer.clone();
        }
        let layer = Arc::new(RoughCoat::over(&self.albedo(facets, Fresnel::Dielectric(eta))));
        self.layers.push((facets, eta, layer.clone()));
        layer
    }

    /// Returns the albedo by angle of an anisotropic lobe. If `is_level`, the lobe is one of many of a textured
    /// roughness, and that of a lobe of about the same roughness is returned. It guides sampling.
    pub fn anisotropic_albedo(&mut self, lobe: &AnisotropicLobe, is_level: bool) -> Arc<AngleTable<Rgb>> {
        let rounded = |alpha: f32| ((alpha.log2() * ALBEDOS_PER_OCTAVE).round() / ALBEDOS_PER_OCTAVE).exp2();
        let near = if is_level { lobe.with_alpha(lobe.alpha().map(rounded)) } else { lobe.clone() };
        if let Some((_, albedo)) = self.anisotropic.iter().find(|(other, _)| *other == near) {
            return albedo.clone();
        }
        let albedo = Arc::new(near.albedo_table());
        self.anisotropic.push((near, albedo.clone()));
        albedo
    }

    /// Returns the retroreflection of a rough base.
    pub fn retro(&mut self, roughness: f32) -> Grazing {
        if let Some((_, retro)) = self.retros.iter().find(|(other, _)| *other == roughness) {
            return retro.clone();
        }
        let retro = Grazing::new(GrazingKind::Retro { roughness });
        self.retros.push((roughness, retro.clone()));
        retro
    }

    /// Returns the albedo by angle of microfacets.
    pub fn albedo(&mut self, facets: Microfacets, fresnel: Fresnel) -> Arc<AngleTable<Rgb>> {
        if let Some((_, _, albedo)) = self.albedos.iter().find(|a| a.0 == facets && a.1 == fresnel) {
            return albedo.clone();
        }
        let albedo = Arc::new(albedo_table(&facets, &fresnel));
        self.albedos.push((facets, fresnel, albedo.clone()));
        albedo
    }
}
