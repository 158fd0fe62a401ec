//! Base and lobes of a material of the scene.

use super::base::{BaseModel, CoatInterface};
use super::colours::{BlendColours, LayerColours};
use super::lobe::{
    AnisotropicLobe, Interface, LobeModel, MAX_LOBES, Mirror, Passage, RoughInterface, RoughLobe,
};
use super::microfacet::Microfacets;
use super::model::Colours;
use super::principled::PrincipledColours;
use super::roughness::RoughnessValues;
use super::tables::Tables;
use scene::{Lobe, Material, Reflectance, Share};

/// Base and lobes, and their colours before textures are looked up.
pub(super) struct Layers {
    pub colours: LayerColours,
    pub base: BaseModel,
    /// True if the base is black.
    pub black: bool,
    /// True if there is a coat on the base.
    pub coated: bool,
    pub lobes: Vec<LobeModel>,
}

impl Layers {
    /// Builds base and lobes of a material, of which at most `most` lobes are used.
    pub fn new(material: &Material, roughness: RoughnessValues, most: usize, tables: &mut Tables) -> Layers {
        let first = match &material.principled {
            Some(principled) => {
                let (colours, interface, lobes) = PrincipledColours::new(principled, roughness, most, tables);
                let base = BaseModel::new(None, interface);
                let colours = LayerColours::Principled(colours);
                Layers { colours, base, black: false, coated: true, lobes }
            }
            None => Layers::of_lobes(material, roughness, most, tables),
        };
        let Some(blend) = &material.blend else { return first };
        let left = most - first.lobes.len();
        first.blend(blend.weight, Layers::new(&blend.other, roughness, left, tables))
    }

    /// Returns the mixture with another material, whose share is `weight`.
    fn blend(self, weight: Share, other: Layers) -> Layers {
        let base = if self.black { other.base.clone() } else { self.base.clone() };
        let mut lobes = self.lobes;
        let first = lobes.len();
        lobes.extend(other.lobes);
        let parts = [(self.colours, self.base), (other.colours, other.base)];
        Layers {
            colours: LayerColours::Blend(Box::new(BlendColours { weight, parts, first })),
            base,
            black: self.black && other.black,
            coated: self.coated || other.coated,
            lobes,
        }
    }

    /// Builds base and lobes of a material that is neither principled nor mixed.
    fn of_lobes(material: &Material, roughness: RoughnessValues, most: usize, tables: &mut Tables) -> Layers {
        let mut colours = Colours { base: material.diffuse, scales: [Reflectance::BLACK; MAX_LOBES] };
        let mut lobes = Vec::new();
        for (lobe, scale) in material.lobes.iter().flat_map(|lobe| models(lobe, &roughness)) {
            if let Some(slot) = colours.scales[..most].get_mut(lobes.len()) {
                *slot = scale;
                lobes.push(lobe);
            }
        }
        // Nothing lies beneath an interface that light passes.
        let black = material.diffuse == Reflectance::BLACK || lobes.iter().any(LobeModel::transmits);
        if black {
            colours.base = Reflectance::BLACK;
        }
        let coat = material.coat.filter(|_| !black);
        let coat_facets = material.lobes.iter().find_map(|lobe| match lobe {
            Lobe::Rough { distribution, alpha, .. } => {
                Some(Microfacets::new(*distribution, roughness.alpha_of_coat(alpha)))
            }
            _ => None,
        });
        let interface = match (coat, coat_facets) {
            (None, _) => CoatInterface::None,
            (Some(coat), Some(facets)) => CoatInterface::Rough(tables.coat(facets, coat.eta)),
            (Some(coat), None) => CoatInterface::Smooth(coat.eta),
        };
        let base = BaseModel::new(coat, interface);
        let colours = LayerColours::Layers(colours, lobes.len().min(MAX_LOBES));
        Layers { colours, base, black, coated: coat.is_some(), lobes }
    }
}

/// Returns the models that stand for a lobe of the scene, each with its factor: two for an interface, else one.
fn models(lobe: &Lobe, roughness: &RoughnessValues) -> Vec<(LobeModel, Reflectance)> {
    match *lobe {
        Lobe::Rough { distribution, alpha, fresnel, scale } => {
            let facets = Microfacets::new(distribution, roughness.alpha(&alpha));
            vec![(LobeModel::Rough(RoughLobe::new(facets, fresnel)), scale)]
        }
        Lobe::Anisotropic { distribution, alpha, fresnel, scale } => {
            let alpha = alpha.map(|alpha| roughness.alpha(&alpha));
            vec![(LobeModel::Anisotropic(AnisotropicLobe::new(distribution, alpha, fresnel)), scale)]
        }
        Lobe::Mirror { fresnel, scale } => vec![(LobeModel::Mirror(Mirror { fresnel }), scale)],
        Lobe::RoughDielectric { distribution, alpha, eta, reflectance, transmittance } if eta != 1.0 => {
            let facets = Microfacets::new(distribution, roughness.alpha(&alpha));
            let model = |passage| {
                LobeModel::RoughInterface(RoughInterface { facets, eta, passage, inside_only: false })
            };
            vec![(model(Passage::Reflection), reflectance), (model(Passage::Refraction), transmittance)]
        }
        Lobe::Dielectric { eta, reflectance, transmittance, .. }
        | Lobe::RoughDielectric { eta, reflectance, transmittance, .. } => {
            let thin = matches!(lobe, Lobe::Dielectric { thin: true, .. });
            let model = |passage| LobeModel::Interface(Interface { eta, thin, passage });
            vec![(model(Passage::Reflection), reflectance), (model(Passage::Refraction), transmittance)]
        }
    }
}
