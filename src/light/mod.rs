//! What shines: emitting triangles, point, spot and directional lights, and the environment, sampled.
//!
//! [`Emitters`] is built once from the scene. Next-event estimation chooses one emitter in proportion to a
//! rough irradiance at the shaded point, then samples that emitter; the light pass chooses by power.

mod area;
mod distribution;
mod environment;
mod select;

pub use area::{AreaLight, AreaPoint, emitted, normal_and_area};
pub use distribution::Distribution;
pub use environment::{EnvironmentLight, EnvironmentSample};

use crate::math::{Rgb, luminance};
use crate::scene::{DeltaLight, Scene};
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// Marks a mesh that is no light in [`Emitters::light_of_mesh`].
const NO_LIGHT: u32 = u32::MAX;

/// All emitters of a scene. Emitter indices count area lights, then delta lights, then the environment.
#[derive(Clone, Debug)]
pub struct Emitters {
    /// Emitting meshes.
    pub areas: Vec<AreaLight>,
    /// Point, spot and directional lights.
    pub deltas: Vec<DeltaLight>,
    /// The environment, unless black.
    pub environment: Option<EnvironmentLight>,
    light_of_mesh: Vec<u32>,
    selection: select::Selection,
}

/// Light arriving at a point from one sampled place of one emitter.
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
    /// Whether no other technique can sample this light.
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
        let environment = scene.environment.as_ref().and_then(EnvironmentLight::new);
        let deltas = scene.lights.clone();
        let selection = select::Selection::new(&areas, &deltas, environment.as_ref(), diagonal);
        Emitters { areas, deltas, environment, light_of_mesh, selection }
    }

    /// Whether nothing shines.
    pub fn is_empty(&self) -> bool {
        self.areas.is_empty() && self.deltas.is_empty() && self.environment.is_none()
    }

    /// Samples light arriving at `x`, on a surface whose reflecting side has normal `n`; `None` if the
    /// chosen emitter sends nothing there. Visibility is not looked at.
    #[inline]
    pub fn sample_direct(
        &self,
        scene: &Scene,
        x: Vec3,
        n: Vec3,
        u_choice: f32,
        u: Vec2,
    ) -> Option<DirectSample> {
        let environment = || self.environment.as_ref()?.sample(u);
        self.sample_direct_with(scene, x, n, u_choice, u, environment)
    }

    /// [`Emitters::sample_direct`] with the environment's sample for `u` given by the caller, who may have
    /// drawn many at once.
    #[inline]
    pub fn sample_direct_with(
        &self,
        scene: &Scene,
        x: Vec3,
        n: Vec3,
        u_choice: f32,
        u: Vec2,
        environment: impl FnOnce() -> Option<EnvironmentSample>,
    ) -> Option<DirectSample> {
        let (index, choice) = self.selection.sample(self, x, n, u_choice)?;
        if let Some(light) = self.areas.get(index) {
            let point = light.sample(u);
            let offset = point.position - x;
            let dist_sq = offset.length_squared();
            let distance = dist_sq.sqrt();
            let direction = offset / distance;
            let cos = point.normal.dot(direction).abs();
            let pdf = choice * dist_sq / (light.area * cos);
            let radiance = light.radiance(scene, &point, -direction);
            let useful = pdf.is_finite() && pdf > 0.0 && radiance != Rgb::ZERO;
            return useful.then_some(DirectSample {
                direction,
                distance,
                normal: point.normal,
                radiance,
                pdf,
                delta: false,
            });
        }
        if let Some(light) = self.deltas.get(index - self.areas.len()) {
            let (direction, distance, irradiance) = delta_irradiance(light, x);
            let useful = irradiance != Rgb::ZERO && irradiance.is_finite();
            return useful.then_some(DirectSample {
                direction,
                distance,
                normal: Vec3::ZERO,
                radiance: irradiance,
                pdf: choice,
                delta: true,
            });
        }
        let s = environment()?;
        Some(DirectSample {
            direction: s.direction,
            distance: f32::INFINITY,
            normal: Vec3::ZERO,
            radiance: s.radiance,
            pdf: choice * s.pdf,
            delta: false,
        })
    }

    /// Density with which [`Emitters::sample_direct`] at `x` draws a point of mesh `mesh` that lies at
    /// `distance` and shows its surface under `cos` (either sign); zero if the mesh is no light.
    #[inline]
    pub fn pdf_area(&self, x: Vec3, n: Vec3, mesh: u32, distance: f32, cos: f32) -> f32 {
        let index = self.light_of_mesh[mesh as usize];
        if index == NO_LIGHT {
            return 0.0;
        }
        let light = &self.areas[index as usize];
        let pdf = distance * distance / (light.area * cos.abs());
        if pdf.is_finite() { self.selection.probability(self, x, n, index as usize) * pdf } else { 0.0 }
    }

    /// Probability with which [`Emitters::sample_direct`] at `x` chooses the environment.
    #[inline]
    pub fn environment_choice(&self, x: Vec3, n: Vec3) -> f32 {
        let index = self.areas.len() + self.deltas.len();
        self.selection.probability(self, x, n, index)
    }
}

/// Direction and distance to a delta light from `x`, and the irradiance it gives a surface facing it.
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

/// Flux of a delta light as luminance; a directional light by the disk of the given radius it shines through.
pub fn delta_power(light: &DeltaLight, scene_radius: f32) -> f32 {
    match *light {
        DeltaLight::Point { intensity, .. } => 4.0 * PI * luminance(intensity),
        DeltaLight::Spot { intensity, inner_angle, outer_angle, .. } => {
            // Full inside, linear in angle outside: the mean of both cones' solid angles is near enough.
            let cone = |a: f32| 2.0 * PI * (1.0 - a.cos());
            0.5 * (cone(inner_angle) + cone(outer_angle)) * luminance(intensity)
        }
        DeltaLight::Directional { irradiance, .. } => {
            PI * scene_radius * scene_radius * luminance(irradiance)
        }
    }
}
