//! Tables that materials of a scene share.

use super::albedo::albedo_table;
use super::base::RoughCoat;
use super::microfacet::Microfacets;
use super::table::AngleTable;
use base::math::Rgb;
use scene::Fresnel;
use std::sync::Arc;

/// Tables by roughness and index of refraction.
#[derive(Default)]
pub(super) struct Tables {
    coats: Vec<(Microfacets, f32, Arc<RoughCoat>)>,
    albedos: Vec<(Microfacets, Fresnel, Arc<AngleTable<Rgb>>)>,
}

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
