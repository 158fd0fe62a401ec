//! Emitters of light: emitting triangles, point, spot and directional lights, and the environment with the discs before
//! it, sampled.
//!
//! [`Emitters`] is built once from the scene. Next-event estimation chooses one emitter in proportion to a
//! rough irradiance at the shaded point, down a tree where they are many, then samples that emitter; the light pass
//! chooses by power.

mod area;
mod distribution;
mod environment;
mod learned;
mod packet;
mod regions;
mod select;
#[cfg(test)]
mod tests;
mod tree;

pub use area::{AreaLight, AreaPoint, emitted};
pub use distribution::DiscreteDistribution;
pub use environment::{EnvironmentLight, EnvironmentSample, LearnedSky, Looks};
pub use learned::Learned;
pub use regions::Regions;
pub use select::Receivers16;
pub use tree::{LampLooks, LearnedLamps};

use base::math::{F32x16, LANES, Rgb, U32x16, Vec3x16, luminance, mask_of};
use glam::Vec3;
use scene::{DeltaLight, Scene};
use std::f32::consts::PI;
use tree::EmitterBounds;

/// Mark of a mesh that is no light in [`Emitters::light_of_mesh`].
const NO_LIGHT: u32 = u32::MAX;

/// Ratio of radius to distance below which an emitter looks small.
const SMALL: f32 = 0.3;

/// Minimum number of lamps of which some may be hidden from most points.
const MIN_HIDDEN: usize = 8;

/// Maximum number of area lights of which that is tested.
const MAX_TESTED: usize = 32;

/// All emitters of a scene. Emitter indices count area lights, then delta lights, then the environment.
#[derive(Clone, Debug)]
pub struct Emitters {
    /// Emitting meshes.
    pub areas: Vec<AreaLight>,
    /// Point, spot and directional lights.
    pub deltas: Vec<DeltaLight>,
    /// The environment with the discs before it; `None` if black.
    pub environment: Option<EnvironmentLight>,
    light_of_mesh: Vec<u32>,
    /// Spheres around the emitting meshes: centre and squared radius.
    spheres: Vec<(Vec3, f32)>,
    selection: select::Selection,
}

/// Light arriving at a point from a sampled point of one emitter.
#[derive(Clone, Copy, Debug)]
pub struct DirectSample {
    /// Unit vector from the point to the emitter.
    pub direction: Vec3,
    /// Distance to the emitter; infinite for directional lights and the environment.
    pub distance: f32,
    /// Unit geometric normal of the emitting surface; zero where there is no surface.
    pub normal: Vec3,
    /// Radiance towards the point; for delta lights the irradiance facing the light.
    pub radiance: Rgb,
    /// Density by solid angle including the choice of the emitter; for delta lights that choice's probability.
    pub pdf: f32,
    /// True if no other technique can sample this light.
    pub delta: bool,
}

impl Emitters {
    /// Collects the emitters of a scene whose bounds have the given diagonal.
    pub fn new(scene: &Scene, diagonal: f32) -> Emitters {
        let areas: Vec<AreaLight> =
            (0..scene.meshes.len() as u32).filter_map(|i| AreaLight::new(scene, i)).collect();
        let mut light_of_mesh = vec![NO_LIGHT; scene.meshes.len()];
        for (i, light) in areas.iter().enumerate() {
            light_of_mesh[light.mesh as usize] = i as u32;
        }
        let environment = EnvironmentLight::new(scene.environment.as_ref(), &scene.discs);
        let deltas = scene.lights.clone();
        let extents = [diagonal, scene.extent(diagonal)];
        let selection = select::Selection::new(&areas, &deltas, environment.as_ref(), extents);
        let sphere = |light: &AreaLight| {
            let EmitterBounds { low, high, .. } = EmitterBounds::of_area(light);
            (0.5 * (low + high), 0.25 * (high - low).length_squared())
        };
        let spheres = areas.iter().map(sphere).collect();
        Emitters { spheres, areas, deltas, environment, light_of_mesh, selection }
    }

    /// Returns true if a mesh is a light.
    #[inline]
    pub fn is_light(&self, mesh: u32) -> bool {
        self.light_of_mesh[mesh as usize] != NO_LIGHT
    }

    /// The light that a mesh is; `None` if it is none.
    #[inline]
    pub fn area(&self, mesh: u32) -> Option<&AreaLight> {
        self.areas.get(self.light_of_mesh[mesh as usize] as usize)
    }

    /// Returns area lights, each with the centre and squared radius of a sphere around it.
    pub fn areas_and_spheres(&self) -> impl Iterator<Item = (&AreaLight, (Vec3, f32))> {
        self.areas.iter().zip(self.spheres.iter().copied())
    }

    /// Returns true if a ray can meet an emitter by chance.
    #[inline]
    pub fn are_hittable(&self) -> bool {
        !self.areas.is_empty() || self.environment.is_some()
    }

    /// Returns true if there are several emitters, of which some may contribute more to the image than others.
    pub fn may_be_uneven(&self) -> bool {
        self.areas.len() + self.deltas.len() + usize::from(self.environment.is_some()) > 1
    }

    /// Returns true if lamps are so many that it pays to learn which are seen from where.
    pub fn may_hide(&self) -> bool {
        self.areas.len() + self.deltas.len() >= MIN_HIDDEN
    }

    /// Learns which of the lamps are seen from where; `None` if nearly all are from everywhere.
    pub fn learn_lamps(&self, looks: &LampLooks) -> Option<LearnedLamps> {
        self.selection.learn(looks)
    }

    /// Lanes from which all emitters that a ray can meet look so small that directions drawn from a diffuse surface
    /// hardly ever find them.
    #[inline]
    pub fn look_small(&self, at: Receivers16) -> u16 {
        if self.environment.is_some() || self.areas.len() > MAX_TESTED {
            return 0;
        }
        let mut small = [1; LANES];
        for (centre, radius_sq) in &self.spheres {
            for i in 0..LANES {
                let dist_sq = centre.distance_squared(at.position.get(i));
                small[i] &= u32::from(*radius_sq < SMALL * SMALL * dist_sq);
            }
        }
        mask_of(&small)
    }

    /// Lanes whose rays, of unit direction, may meet an emitting surface.
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
                // The slack covers rounding, on the way to spheres far away too.
                let reach_sq = 1.01 * radius_sq + 1e-9 * to_centre.length_squared();
                met[i] |= u32::from(!(to_centre.distance_squared(nearest) > reach_sq));
            }
        }
        mask_of(&met)
    }

    /// Densities with which [`Emitters::sample_direct`] at `at` draws points of the meshes `mesh` at
    /// `distance` whose normals have the cosine `cos` (either sign) to the ray; zero where a mesh is no
    /// light.
    #[inline]
    pub fn pdf_areas(&self, at: Receivers16, mesh: &U32x16, distance: &F32x16, cos: &F32x16) -> F32x16 {
        let lights = mesh.map(|mesh| self.light_of_mesh[mesh as usize]);
        let index = lights.map(|light| if light == NO_LIGHT { 0 } else { light });
        let lit = mask_of(&lights.map(|light| u32::from(light != NO_LIGHT)));
        let choice = self.selection.probability(self, at, &index, lit);
        std::array::from_fn(|i| {
            if lights[i] == NO_LIGHT {
                return 0.0;
            }
            let pdf = distance[i] * distance[i] / (self.areas[lights[i] as usize].area * cos[i].abs());
            if pdf.is_finite() { choice[i] * pdf } else { 0.0 }
        })
    }

    /// Probability with which [`Emitters::sample_direct`] at `at` chooses the environment.
    #[inline]
    pub fn environment_choice(&self, at: Receivers16) -> F32x16 {
        self.selection.probability(self, at, &[self.environment_index(); LANES], u16::MAX)
    }

    fn environment_index(&self) -> u32 {
        (self.areas.len() + self.deltas.len()) as u32
    }
}

impl EnvironmentSample {
    /// Makes a direct sample of it, for an emitter chosen with probability `choice`.
    #[inline]
    fn direct(&self, choice: f32) -> DirectSample {
        DirectSample {
            direction: self.direction,
            distance: f32::INFINITY,
            normal: Vec3::ZERO,
            radiance: self.radiance,
            pdf: choice * self.pdf,
            delta: false,
        }
    }
}

/// Samples the light at `x` from a delta light chosen with probability `choice`.
#[inline]
fn sample_delta(light: &DeltaLight, x: Vec3, choice: f32) -> Option<DirectSample> {
    let (direction, distance, irradiance) = delta_irradiance(light, x);
    let useful = irradiance != Rgb::ZERO && irradiance.is_finite();
    let normal = Vec3::ZERO;
    useful.then_some(DirectSample {
        direction,
        distance,
        normal,
        radiance: irradiance,
        pdf: choice,
        delta: true,
    })
}

/// Returns direction and distance to a delta light from `x`, and its irradiance on a surface facing it.
#[inline]
pub fn delta_irradiance(light: &DeltaLight, x: Vec3) -> (Vec3, f32, Rgb) {
    match *light {
        DeltaLight::Point { position, intensity } => {
            let offset = position - x;
            let distance = offset.length();
            (offset / distance, distance, intensity / (distance * distance))
        }
        DeltaLight::Spot { position, direction, intensity, inner_angle, outer_angle } => {
            let offset = position - x;
            let distance = offset.length();
            let to_light = offset / distance;
            let falloff = spot_falloff(direction.dot(-to_light), inner_angle, outer_angle);
            (to_light, distance, intensity * (falloff / (distance * distance)))
        }
        DeltaLight::Directional { direction, irradiance } => (-direction, f32::INFINITY, irradiance),
    }
}

/// Share of a spot's axial intensity at the given cosine to its axis.
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

/// Flux of a delta light as luminance; of a directional light, through a disk of the given radius.
pub fn delta_power(light: &DeltaLight, scene_radius: f32) -> f32 {
    match *light {
        DeltaLight::Point { intensity, .. } => 4.0 * PI * luminance(intensity),
        DeltaLight::Spot { intensity, inner_angle, outer_angle, .. } => {
            // Full inside, linear in angle outside: approximated by the mean of both cones' solid angles.
            let cone = |a: f32| 2.0 * PI * (1.0 - a.cos());
            0.5 * (cone(inner_angle) + cone(outer_angle)) * luminance(intensity)
        }
        DeltaLight::Directional { irradiance, .. } => {
            PI * scene_radius * scene_radius * luminance(irradiance)
        }
    }
}
