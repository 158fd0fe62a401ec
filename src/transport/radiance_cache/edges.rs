//! Derivatives of irradiance due to occluders that hide and reveal their background.
//!
//! As the receiver moves by δ, the edge of an occluder at distance z_c moves before its background at z_d by the angle
//! (1/z_c - 1/z_d) δ. A sliver of background appears or disappears. Its radiance times its cosine is the term missing
//! from gradients at constant visibility; the light of the occluder itself is part of those. Continuous surfaces,
//! smooth or creased, have no such edges.
//!
//! Paper: Ward and Heckbert 1992 and Krivanek et al. 2005 for the integrals along the boundaries of cells;
//! Schwarzhaupt, Jensen and Jarosz, *Practical Hessian-Based Error Control for Irradiance Caching*, 2012, for the use
//! of both derivatives.
//!
//! Deviations: radiance comes from the clusters of the cut, spread over the cells of the surface they lie on, not from
//! shading the hits of the rays. Second derivatives are an upper estimate: the background's radiance is assumed to
//! change by its full value within one cell.

use super::probe::{Probes, SECTORS};
use base::math::{Rgb, luminance};
use glam::{Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Distance of a light from the plane of a cell's surface at which its weight there falls to a quarter, relative to
/// its distance from the receiver.
const PLANE_TOLERANCE: f32 = 0.05;

/// Minimum weight of a cell, so that some cell gets the light.
const MIN_CELL_WEIGHT: f32 = 1e-4;

/// Maximum relative difference of inverse distances at which two cells count as seeing one plane.
const SAME_PLANE: f32 = 1e-3;

/// Light arriving through each cell.
#[derive(Clone, Debug)]
pub struct CellLight {
    /// Irradiance per cell.
    irradiance: Vec<Rgb>,
}

/// Derivatives of the irradiance due to the motion of occluders' edges.
#[derive(Clone, Copy, Debug, Default)]
pub struct EdgeDerivatives {
    /// Gradient per channel, tangential, in the probes' frame.
    pub gradient: [Vec2; 3],
    /// Second derivatives uu, uv, vv of the luminance, as an upper estimate.
    pub hessian: [f32; 3],
}

/// Edge between two cells.
struct Edge {
    cells: [usize; 2],
    /// Direction from the first cell to the second.
    across: Vec2,
    /// Integral of the cosine along the edge.
    length: f32,
    /// Angle between the cells' centres.
    width: f32,
}

impl CellLight {
    /// Returns cells of `probes` without light.
    pub fn new(probes: &Probes) -> CellLight {
        CellLight { irradiance: vec![Rgb::ZERO; probes.cells()] }
    }

    /// Adds `irradiance` from a light in a direction of the probes' frame with azimuth `turns` (in turns). `inverse`
    /// is the inverse of its distance, 0 if it is infinitely far.
    #[inline]
    pub fn add(&mut self, probes: &Probes, direction: Vec3, turns: f32, inverse: f32, irradiance: Rgb) {
        let (ring, sector) = probes.coordinates(direction, turns);
        let (ring, sector) = (ring - 0.5, sector - 0.5);
        let (j, k) = (ring.floor(), sector.floor());
        let (along_j, along_k) = (ring - j, sector - k);
        let (j, k) = (j as i32, k as i32);
        let last = probes.rings as i32 - 1;
        let rows = [j, j + 1].map(|row| row.clamp(0, last) as usize * SECTORS);
        let columns = [k, k + 1].map(|column| column.rem_euclid(SECTORS as i32) as usize);
        let cells = [rows[0] + columns[0], rows[0] + columns[1], rows[1] + columns[0], rows[1] + columns[1]];
        let near = [
            (1.0 - along_j) * (1.0 - along_k),
            (1.0 - along_j) * along_k,
            along_j * (1.0 - along_k),
            along_j * along_k,
        ];
        let mut off = [0.0; 4];
        for (off, cell) in off.iter_mut().zip(cells) {
            let height = probes.height[cell];
            // n·q/h - 1 is the distance from the plane in units of h. The factor h/|q| converts it to the light's
            // distance.
            let relative = (probes.plane[cell].dot(direction) - inverse) * height * (1.0 / PLANE_TOLERANCE);
            // Infinitely distant light belongs to cells without a surface.
            *off = if (inverse == 0.0) == (height == 0.0) { relative } else { f32::INFINITY };
        }
        let mut weights = [0.0; 4];
        for i in 0..4 {
            let fall = 1.0 / (1.0 + off[i] * off[i]);
            weights[i] = near[i] * (fall * fall + MIN_CELL_WEIGHT);
        }
        let scale = 1.0 / (weights[0] + weights[1] + weights[2] + weights[3]);
        for (cell, weight) in cells.into_iter().zip(weights) {
            self.irradiance[cell] += irradiance * (weight * scale);
        }
    }

    /// Sums the contributions of all edges between cells.
    pub fn edges(&self, probes: &Probes) -> EdgeDerivatives {
        let mut sum = EdgeDerivatives::default();
        let rings = probes.rings as f32;
        let root = |share: usize| (share as f32 / rings).sqrt();
        let sector = TAU / SECTORS as f32;
        // Ratio of chord to arc: mean of a direction over a sector.
        let chord = (0.5 * sector).sin() / (0.5 * sector);
        let azimuths = |offset: f32| -> [Vec2; SECTORS] {
            std::array::from_fn(|k| Vec2::from_angle(probes.azimuth(k as f32 + offset)))
        };
        let (middles, ends) = (azimuths(0.5), azimuths(1.0));
        for ring in 0..probes.rings {
            let (sin_in, sin_out) = (root(ring), root(ring + 1));
            let cos_out = (1.0 - sin_out * sin_out).max(0.0).sqrt();
            let sin_mid = ((ring as f32 + 0.5) / rings).sqrt();
            let to_outer = ((ring as f32 + 1.5) / rings).min(1.0).sqrt().asin() - sin_mid.asin();
            for k in 0..SECTORS {
                let cell = ring * SECTORS + k;
                // Edge to the next sector: ∫cosθ dθ along the meridian.
                let next = ring * SECTORS + (k + 1) % SECTORS;
                let across = ends[k].perp();
                let (length, width) = (sin_out - sin_in, sector * sin_mid);
                self.add_edge(probes, &Edge { cells: [cell, next], across, length, width }, &mut sum);
                // Edge to the next ring: one cosθ along the parallel, one for the tilt of the motion.
                if ring + 1 < probes.rings {
                    let outer = cell + SECTORS;
                    let (across, width) = (middles[k], to_outer);
                    let length = cos_out * cos_out * sin_out * sector * chord;
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

/// Returns 1/z of cell `a`'s surface minus that of cell `b`'s at their boundary; 0 if the surfaces meet there.
#[inline]
fn parallax(probes: &Probes, a: usize, b: usize) -> f32 {
    let (at_a, at_b) = (probes.direction[a], probes.direction[b]);
    let between = probes.plane[a] - probes.plane[b];
    // The surfaces meet if each crosses the other's plane between the two rays.
    let (first, last) = (between.dot(at_a), between.dot(at_b));
    let direct = probes.inverse[a] - probes.inverse[b];
    // Two cells of one plane differ only by rounding.
    let same = SAME_PLANE * probes.inverse[a].max(probes.inverse[b]);
    if first * last <= 0.0 || first * direct < 0.0 || first.abs().min(last.abs()) <= same {
        return 0.0;
    }
    // Backgrounds are mostly flat. The plane of an occluder that curves away says nothing about its edge.
    let boundary = (at_a + at_b).normalize_or_zero();
    if direct > 0.0 {
        (probes.inverse[a] - probes.plane[b].dot(boundary)).clamp(0.0, probes.inverse[a])
    } else {
        -(probes.inverse[b] - probes.plane[a].dot(boundary)).clamp(0.0, probes.inverse[b])
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::candidate;
    use super::super::probe::azimuths16;
    use super::*;
    use base::math::Vec3x16;
    use scene::Scene;
    use world::World;

    /// Probes of an empty scene, then with a surface straight above in every cell for which `height` gives one.
    fn probes(height: impl Fn(usize) -> Option<f32>) -> Probes {
        let world = World::new(Scene::default(), 1).expect("the world is built");
        let point = candidate(Vec3::ZERO, Vec3::Z).point;
        let mut probes = Probes::trace(&world, &[(point, 0)], 256).remove(0);
        for cell in 0..probes.cells() {
            if let Some(height) = height(cell) {
                probes.set(cell, height / probes.direction[cell].z, Vec3::Z);
            }
        }
        probes
    }

    fn turns(direction: Vec3) -> f32 {
        azimuths16(&Vec3x16::splat(direction))[0]
    }

    #[test]
    fn all_light_goes_to_cells_and_most_to_those_of_its_surface() {
        let probes = probes(|cell| (cell % SECTORS < 8).then_some(2.0));
        let mut light = CellLight::new(&probes);
        for (i, &direction) in probes.direction.iter().enumerate() {
            let inverse = if i % 3 != 0 { direction.z / 2.0 } else { 0.0 };
            light.add(&probes, direction, turns(direction), inverse, Rgb::ONE);
        }
        let total: f32 = light.irradiance.iter().map(|irradiance| irradiance.x).sum();
        assert!((total - probes.cells() as f32).abs() < 1e-2, "{total}");
        let mut light = CellLight::new(&probes);
        // Between sectors 7 and 8, of which only the former sees the surface.
        let direction = (probes.direction[5 * SECTORS + 7] + probes.direction[5 * SECTORS + 8]).normalize();
        light.add(&probes, direction, turns(direction), direction.z / 2.0, Rgb::ONE);
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
