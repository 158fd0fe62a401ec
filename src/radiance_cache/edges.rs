//! Derivatives of irradiance due to occluders that hide and reveal their background.
//!
//! As the receiver moves by δ, the edge of an occluder at distance z_c moves before its background at z_d by
//! the angle (1/z_c - 1/z_d) δ, and a sliver of background appears or goes. Its radiance times its cosine is
//! the term missing from gradients of constant visibility; the light of the occluder itself is part of those.
//! Continuous surfaces, smooth or creased, have no such edges.
//!
//! Paper: Ward and Heckbert 1992 and Krivanek et al. 2005 for the integrals along cells' boundaries;
//! Schwarzhaupt, Jensen and Jarosz, *Practical Hessian-Based Error Control for Irradiance Caching*, 2012, for
//! the use of both derivatives.
//!
//! Deviations: radiance comes from the cut's clusters, spread over the cells of the surface they lie on, not
//! from shading the hits of the rays. Second derivatives are an upper estimate: the background's radiance is
//! taken to change by all of itself within one cell.

use super::probe::{Probes, SECTORS};
use crate::math::{Rgb, luminance};
use glam::{Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Distance of a light from the plane of a cell's surface, relative to its distance from the receiver, at which
/// the light is no longer taken to lie on that surface.
const ON_SURFACE: f32 = 0.05;

/// Share that even a cell of quite another surface keeps: something must take the light.
const ELSEWHERE: f32 = 1e-4;

/// Light seen in each cell.
#[derive(Clone, Debug)]
pub struct CellLight {
    /// Irradiance from the cell.
    irradiance: Vec<Rgb>,
}

/// Derivatives of the irradiance by the motion of occluders' edges.
#[derive(Clone, Copy, Debug, Default)]
pub struct EdgeDerivatives {
    /// Gradient per channel, tangential, in the probes' frame.
    pub gradient: [Vec2; 3],
    /// Second derivatives uu, uv, vv of the luminance: an upper estimate.
    pub hessian: [f32; 3],
}

/// Between two cells.
struct Edge {
    cells: [usize; 2],
    /// From the first cell to the second.
    across: Vec2,
    /// Integral of the cosine along it.
    length: f32,
    /// Angle between the cells' centres.
    width: f32,
}

impl CellLight {
    /// No light in any cell of `probes`.
    pub fn new(probes: &Probes) -> CellLight {
        CellLight { irradiance: vec![Rgb::ZERO; probes.cells()] }
    }

    /// Adds `irradiance` from a light at `offset` from the receiver in the probes' frame; `None` for light from
    /// infinitely far along `direction`.
    pub fn add(&mut self, probes: &Probes, direction: Vec3, offset: Option<Vec3>, irradiance: Rgb) {
        let (ring, sector) = probes.coordinates(direction);
        let (ring, sector) = (ring - 0.5, sector - 0.5);
        let (j, k) = (ring.floor(), sector.floor());
        let (along_j, along_k) = (ring - j, sector - k);
        let mut cells = [0; 4];
        let mut weights = [0.0; 4];
        for i in 0..4 {
            let (dj, dk) = (i >> 1, i & 1);
            let row = (j as i32 + dj as i32).clamp(0, probes.rings as i32 - 1) as usize;
            let column = (k as i32 + dk as i32).rem_euclid(SECTORS as i32) as usize;
            cells[i] = row * SECTORS + column;
            let near =
                if dj == 1 { along_j } else { 1.0 - along_j } * if dk == 1 { along_k } else { 1.0 - along_k };
            weights[i] = near * (belonging(probes.plane[cells[i]], offset) + ELSEWHERE);
        }
        let sum: f32 = weights.iter().sum();
        for (cell, weight) in cells.into_iter().zip(weights) {
            self.irradiance[cell] += irradiance * (weight / sum);
        }
    }

    /// Sums the contributions of the edges between cells.
    pub fn edges(&self, probes: &Probes) -> EdgeDerivatives {
        let mut sum = EdgeDerivatives::default();
        let rings = probes.rings as f32;
        let root = |share: usize| (share as f32 / rings).sqrt();
        let sector = TAU / SECTORS as f32;
        // Chord over arc: the mean of a direction over a sector.
        let chord = (0.5 * sector).sin() / (0.5 * sector);
        for ring in 0..probes.rings {
            let (sin_in, sin_out) = (root(ring), root(ring + 1));
            let cos_out = (1.0 - sin_out * sin_out).max(0.0).sqrt();
            let sin_mid = ((ring as f32 + 0.5) / rings).sqrt();
            for k in 0..SECTORS {
                let cell = ring * SECTORS + k;
                // To the next sector: ∫cosθ dθ along the meridian.
                let next = ring * SECTORS + (k + 1) % SECTORS;
                let (sin_phi, cos_phi) = probes.azimuth(k as f32 + 1.0).sin_cos();
                let across = Vec2::new(-sin_phi, cos_phi);
                let (length, width) = (sin_out - sin_in, sector * sin_mid);
                self.add_edge(probes, &Edge { cells: [cell, next], across, length, width }, &mut sum);
                // To the next ring: cosθ along the parallel, and cosθ for the tilt of the motion.
                if ring + 1 < probes.rings {
                    let outer = cell + SECTORS;
                    let across = Vec2::from_angle(probes.azimuth(k as f32 + 0.5));
                    let length = cos_out * cos_out * sin_out * sector * chord;
                    let width = ((ring as f32 + 1.5) / rings).sqrt().asin() - sin_mid.asin();
                    self.add_edge(probes, &Edge { cells: [cell, outer], across, length, width }, &mut sum);
                }
            }
        }
        sum
    }

    /// Adds the contribution of an edge.
    #[inline]
    fn add_edge(&self, probes: &Probes, edge: &Edge, sum: &mut EdgeDerivatives) {
        let &Edge { cells: [a, b], across, length, width } = edge;
        let parallax = parallax(probes, a, b);
        if parallax == 0.0 {
            return;
        }
        // Motion towards the background reveals more of it.
        let (far, across) = if parallax > 0.0 { (b, across) } else { (a, -across) };
        let radiance = self.irradiance[far] * (probes.cells() as f32 / PI);
        let rate = parallax.abs() * length;
        for c in 0..3 {
            sum.gradient[c] += across * (radiance[c] * rate);
        }
        let second = luminance(radiance) * rate * parallax.abs() / width;
        sum.hessian[0] += second * across.x * across.x;
        sum.hessian[1] += second * across.x * across.y;
        sum.hessian[2] += second * across.y * across.y;
    }
}

/// 1/z of cell `a`'s surface less that of cell `b`'s at the boundary between them; 0 if the surfaces meet there.
#[inline]
fn parallax(probes: &Probes, a: usize, b: usize) -> f32 {
    let (at_a, at_b) = (probes.direction[a], probes.direction[b]);
    let between = probes.plane[a] - probes.plane[b];
    // Each cell's surface against the other's plane, at both rays: if they cross on the way, the surfaces meet.
    let (first, last) = (between.dot(at_a), between.dot(at_b));
    let direct = probes.inverse[a] - probes.inverse[b];
    if first * last <= 0.0 || first * direct < 0.0 {
        return 0.0;
    }
    // Backgrounds are mostly flat; the plane of an occluder that curves away tells nothing about its edge.
    let boundary = (at_a + at_b).normalize_or_zero();
    if direct > 0.0 {
        (probes.inverse[a] - probes.plane[b].dot(boundary)).clamp(0.0, probes.inverse[a])
    } else {
        -(probes.inverse[b] - probes.plane[a].dot(boundary)).clamp(0.0, probes.inverse[b])
    }
}

/// Tests whether a light may lie on the surface of `plane` (see [`Probes::plane`]): 1 if it does.
#[inline]
fn belonging(plane: Vec3, offset: Option<Vec3>) -> f32 {
    let Some(offset) = offset else {
        return if plane == Vec3::ZERO { 1.0 } else { 0.0 };
    };
    if plane == Vec3::ZERO {
        return 0.0;
    }
    // n·q/h - 1 is the distance from the plane in units of h; in units of the light's distance it lacks h/|q|.
    let off = (plane.dot(offset) - 1.0) / (plane.length() * offset.length());
    let relative = off * (1.0 / ON_SURFACE);
    let fall = 1.0 / (1.0 + relative * relative);
    fall * fall
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::candidate;
    use super::*;
    use crate::scene::Scene;
    use crate::world::World;

    /// Probes of an empty scene, then with a surface straight above in every cell for which `height` gives one.
    fn probes(height: impl Fn(usize) -> Option<f32>) -> Probes {
        let world = World::new(Scene::default(), 1).expect("the world is built");
        let mut probes = Probes::trace(&world, &candidate(Vec3::ZERO, Vec3::Z).point, 256, 0);
        for cell in 0..probes.cells() {
            if let Some(height) = height(cell) {
                probes.plane[cell] = Vec3::Z / height;
                probes.inverse[cell] = probes.direction[cell].z / height;
            }
        }
        probes
    }

    #[test]
    fn all_light_goes_to_cells_and_most_to_those_of_its_surface() {
        let probes = probes(|cell| (cell % SECTORS < 8).then_some(2.0));
        let mut light = CellLight::new(&probes);
        for (i, &direction) in probes.direction.iter().enumerate() {
            let offset = (i % 3 != 0).then(|| direction * (2.0 / direction.z));
            light.add(&probes, direction, offset, Rgb::ONE);
        }
        let total: f32 = light.irradiance.iter().map(|irradiance| irradiance.x).sum();
        assert!((total - probes.cells() as f32).abs() < 1e-2, "{total}");
        let mut light = CellLight::new(&probes);
        // Between sectors 7 and 8, of which only the former sees the surface.
        let direction = 0.5 * (probes.direction[5 * SECTORS + 7] + probes.direction[5 * SECTORS + 8]);
        light.add(&probes, direction.normalize(), Some(direction * (2.0 / direction.z)), Rgb::ONE);
        let on: f32 = (0..probes.rings).map(|ring| light.irradiance[ring * SECTORS + 7].x).sum();
        assert!(on > 0.999, "{on}");
    }

    #[test]
    fn one_plane_has_no_edges_and_a_step_has_them_where_it_is() {
        let lit = |probes: &Probes| {
            let mut light = CellLight::new(probes);
            for (cell, irradiance) in light.irradiance.iter_mut().enumerate() {
                *irradiance = Rgb::splat(if cell % SECTORS < 8 { 1.0 } else { 0.0 });
            }
            light.edges(probes)
        };
        let flat = lit(&probes(|_| Some(2.0)));
        assert_eq!((flat.gradient, flat.hessian), ([Vec2::ZERO; 3], [0.0; 3]));
        // A lit ceiling at height 2 over one half, behind a black one at height 1 over the other.
        let step = probes(|cell| Some(if cell % SECTORS < 8 { 2.0 } else { 1.0 }));
        let found = lit(&step);
        // Towards the lit half more of it comes out from behind the edge.
        let middle = step.azimuth(4.0);
        let towards = found.gradient[0].dot(Vec2::from_angle(middle));
        // Radiance · (1/1 - 1/2) · ∫cos²θ dθ along the edge, from horizon to horizon: π/2.
        let radiance = step.cells() as f32 / PI;
        let expected = radiance * 0.5 * PI * 0.5;
        assert!((towards / expected - 1.0).abs() < 0.02, "{towards} against {expected}");
        assert!(found.hessian[0] + found.hessian[2] > 0.0);
    }
}
