//! All emitters of a scene.

use super::area::AreaLight;
use super::delta::DeltaEmitter;
use super::environment::EnvironmentLight;
use super::learned::Learned;
use super::observed::Observed;
use super::receivers::Receivers16;
use super::select::EmitterChoice;
use super::tree::EmitterBounds;
use base::math::{F32x16, LANES, U32x16, Vec3x16, mask_of};
use glam::Vec3;
use scene::{DeltaLight, Scene};

/// Entry of [`Emitters::light_of_mesh`] for a mesh that does not emit.
const NO_LIGHT: u32 = u32::MAX;

/// Ratio of an emitter's radius to the scene's below which its light comes from few directions.
const FEW_DIRECTIONS: f32 = 0.1;

/// Minimum number of emitters for which visibility is learned.
const MIN_HIDDEN: usize = 8;

/// Maximum number of area lights whose spheres are tested one by one.
const MAX_TESTED: usize = 32;

/// All emitters of a scene. Their indices count area lights, then delta lights, then the environment.
#[derive(Clone, Debug)]
pub struct Emitters {
    /// Emitting meshes.
    pub areas: Vec<AreaLight>,
    /// Point, spot and directional lights, and projectors.
    pub deltas: Vec<DeltaEmitter>,
    /// The environment with the discs before it; `None` if black.
    pub environment: Option<EnvironmentLight>,
    /// Index of the area light of each seen mesh.
    light_of_mesh: Vec<u32>,
    /// Spheres around the emitting meshes: centre and squared radius.
    spheres: Vec<(Vec3, f32)>,
    /// See [`Emitters::send_from_few_directions`].
    few_directions: bool,
    pub(super) choice: EmitterChoice,
}

impl Emitters {
    /// Collects the emitters of a scene whose bounds have the given diagonal.
    pub fn new(scene: &Scene, diagonal: f32) -> Emitters {
        let areas: Vec<AreaLight> =
            (0..scene.own_mesh_count() as u32).filter_map(|i| AreaLight::new(scene, i)).collect();
        // Meshes in groups do not emit.
        let mut light_of_mesh = vec![NO_LIGHT; scene.seen().count()];
        for (i, light) in areas.iter().enumerate() {
            light_of_mesh[light.mesh as usize] = i as u32;
        }
        let environment = EnvironmentLight::new(scene.environment.as_ref(), &scene.discs);
        let prepare = |light: &DeltaLight| DeltaEmitter::new(*light, &scene.textures);
        let deltas: Vec<DeltaEmitter> = scene.lights.iter().map(prepare).collect();
        let extents = [diagonal, scene.extent(diagonal)];
        let choice = EmitterChoice::new(&areas, &deltas, environment.as_ref(), extents);
        let sphere = |light: &AreaLight| {
            let EmitterBounds { low, high, .. } = EmitterBounds::of_area(light);
            (0.5 * (low + high), 0.25 * (high - low).length_squared())
        };
        let spheres: Vec<(Vec3, f32)> = areas.iter().map(sphere).collect();
        let radii_sq = areas.iter().zip(&spheres).map(|(light, (_, radius_sq))| (light.power, *radius_sq));
        let of_deltas = deltas.iter().map(|light| (light.power(0.5 * diagonal), 0.0));
        let few_directions =
            environment.is_none() && radii_are_small(radii_sq.chain(of_deltas), 0.5 * diagonal);
        Emitters { spheres, areas, deltas, environment, light_of_mesh, few_directions, choice }
    }

    /// Returns true if a mesh emits.
    #[inline]
    pub fn is_light(&self, mesh: u32) -> bool {
        self.light_of_mesh[mesh as usize] != NO_LIGHT
    }

    /// Returns the area light of a mesh; `None` if it does not emit.
    #[inline]
    pub fn area(&self, mesh: u32) -> Option<&AreaLight> {
        self.areas.get(self.light_of_mesh[mesh as usize] as usize)
    }

    /// Lists the area lights, each with the centre and squared radius of a sphere around it.
    pub fn areas_and_spheres(&self) -> impl Iterator<Item = (&AreaLight, (Vec3, f32))> {
        self.areas.iter().zip(self.spheres.iter().copied())
    }

    /// Returns true if a ray can hit an emitter.
    #[inline]
    pub fn are_hittable(&self) -> bool {
        !self.areas.is_empty() || self.environment.is_some()
    }

    /// Returns true if light reaches most points from small solid angles, so that light samples of neighbouring points
    /// are nearly parallel. Queries of such segments should be marked as coherent.
    #[inline]
    pub fn send_from_few_directions(&self) -> bool {
        self.few_directions
    }

    /// Returns true if there is light from infinitely far.
    pub fn have_far(&self) -> bool {
        let is_directional = |delta: &DeltaEmitter| matches!(delta.light, DeltaLight::Directional { .. });
        self.environment.is_some() || self.deltas.iter().any(is_directional)
    }

    /// Returns true if there are enough emitters to learn their visibility.
    pub fn may_hide(&self) -> bool {
        self.areas.len() + self.deltas.len() >= MIN_HIDDEN
    }

    /// Returns observers at some positions, which have seen nothing yet.
    pub fn observed_from(&self, positions: &[Vec3]) -> Observed {
        Observed::new(positions, self.choice.fewest_observers(positions.len()))
    }

    /// Learns from what observers have seen.
    pub fn learn(&self, observed: &Observed) -> Learned {
        Learned {
            sky: self.environment.as_ref().map(|environment| environment.learn(observed)),
            emitters: self.choice.learn(observed),
            regions: observed.regions.clone(),
        }
    }

    /// Returns the lanes whose rays, of unit direction, may hit an emitting surface.
    #[inline]
    pub fn may_be_met(&self, origin: &Vec3x16, direction: &Vec3x16) -> u16 {
        if self.areas.len() > MAX_TESTED {
            return u16::MAX;
        }
        let mut met = [0; LANES];
        for (centre, radius_sq) in &self.spheres {
            for i in 0..LANES {
                let to_centre = *centre - origin.get(i);
                let nearest = direction.get(i) * to_centre.dot(direction.get(i)).max(0.0);
                // The slack covers rounding, also on the way to distant spheres.
                let reach_sq = 1.01 * radius_sq + 1e-9 * to_centre.length_squared();
                met[i] |= u32::from(!(to_centre.distance_squared(nearest) > reach_sq));
            }
        }
        mask_of(&met)
    }

    /// Returns the densities with which [`Emitters::sample_direct`] at `at` samples points of the meshes `mesh` at
    /// `distance`. `cos` are the cosines, of either sign, between the normals and the ray. Densities are zero for
    /// meshes that do not emit.
    #[inline]
    pub fn pdf_areas(&self, at: Receivers16, mesh: &U32x16, distance: &F32x16, cos: &F32x16) -> F32x16 {
        let lights = mesh.map(|mesh| self.light_of_mesh[mesh as usize]);
        let index = lights.map(|light| if light == NO_LIGHT { 0 } else { light });
        let lit = mask_of(&lights.map(|light| u32::from(light != NO_LIGHT)));
        let choice = self.choice.probability(at, &index, lit);
        std::array::from_fn(|i| {
            if lights[i] == NO_LIGHT {
                return 0.0;
            }
            let pdf = distance[i] * distance[i] / (self.areas[lights[i] as usize].area * cos[i].abs());
            if pdf.is_finite() { choice[i] * pdf } else { 0.0 }
        })
    }

    /// Returns the probability with which [`Emitters::sample_direct`] at `at` chooses the environment.
    #[inline]
    pub fn environment_choice(&self, at: Receivers16) -> F32x16 {
        self.choice.probability(at, &[self.environment_index(); LANES], u16::MAX)
    }

    /// Returns the index of the environment.
    pub(super) fn environment_index(&self) -> u32 {
        (self.areas.len() + self.deltas.len()) as u32
    }
}

/// Returns true if emitters of the given powers and squared radii look small, on average by power, from the distance
/// `radius`.
fn radii_are_small(emitters: impl Iterator<Item = (f32, f32)>, radius: f32) -> bool {
    let add = |(all, sum): (f64, f64), (power, radius_sq): (f32, f32)| {
        (all + f64::from(power), sum + f64::from(power) * f64::from(radius_sq))
    };
    let (power, sum) = emitters.fold((0.0, 0.0), add);
    sum <= power * f64::from(FEW_DIRECTIONS * radius).powi(2)
}
