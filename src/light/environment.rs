//! Light from infinitely far: evaluation and sampling in proportion to the bilinear radiance.
//!
//! A map is sampled by its cells: the squares between four texels (the first and last row lie at the poles),
//! chosen by the mean luminance of their corners times the sine of their latitude, then within a cell by the
//! bilinear luminance itself. So the density is proportional to [`EnvironmentLight::radiance`] up to the
//! variation of the sine over one row, and a sun one texel wide costs no variance.

use super::distribution::DiscreteDistribution;
use crate::math::{LANES, Rgb, Vec2x16, Vec3x16, lanes_in, luminance};
use crate::sampling::uniform_sphere;
use crate::scene::{Environment, EnvironmentMap};
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, PI, TAU};

/// The environment with its sampling distributions.
#[derive(Clone, Debug)]
pub struct EnvironmentLight {
    source: EnvironmentRadiance,
    /// Mean luminance over the sphere, W/(sr m²).
    mean_luminance: f32,
}

#[derive(Clone, Debug)]
enum EnvironmentRadiance {
    Constant(Rgb),
    Map { map: EnvironmentMap, rows: DiscreteDistribution, columns: Vec<DiscreteDistribution> },
}

/// A direction drawn from the environment.
#[derive(Clone, Copy, Debug)]
pub struct EnvironmentSample {
    /// Unit world direction towards the environment.
    pub direction: Vec3,
    /// Radiance arriving from that direction.
    pub radiance: Rgb,
    /// Density by solid angle.
    pub pdf: f32,
}

impl EnvironmentLight {
    /// Builds the distributions; `None` if the environment is black.
    pub fn new(environment: &Environment) -> Option<EnvironmentLight> {
        let light = match environment {
            Environment::Constant(radiance) => EnvironmentLight {
                source: EnvironmentRadiance::Constant(*radiance),
                mean_luminance: luminance(*radiance),
            },
            Environment::Map(map) => {
                let cells: Vec<Vec<f32>> = (0..row_count(map))
                    .map(|row| {
                        let (low, high) = row_span(map, row);
                        // The exact share of the sphere between the two latitudes.
                        let weight = ((PI * low).cos() - (PI * high).cos()).max(0.0);
                        (0..map.width)
                            .map(|x| luminance(corners(map, x, row).iter().sum()) * 0.25 * weight)
                            .collect()
                    })
                    .collect();
                let columns: Vec<DiscreteDistribution> =
                    cells.into_iter().map(DiscreteDistribution::new).collect();
                let rows = DiscreteDistribution::new(columns.iter().map(|c| c.total() as f32));
                let mean_luminance = rows.total() as f32 / (2.0 * map.width as f32);
                EnvironmentLight {
                    source: EnvironmentRadiance::Map { map: map.clone(), rows, columns },
                    mean_luminance,
                }
            }
        };
        (light.mean_luminance > 0.0 && light.mean_luminance.is_finite()).then_some(light)
    }

    /// Mean luminance over the sphere of directions.
    pub fn mean_luminance(&self) -> f32 {
        self.mean_luminance
    }

    /// Radiance arriving from the unit world direction `d`.
    pub fn radiance(&self, d: Vec3) -> Rgb {
        match &self.source {
            EnvironmentRadiance::Constant(radiance) => *radiance,
            EnvironmentRadiance::Map { map, .. } => {
                let place = locate(map, d);
                bilinear(corners(map, place.x, place.row), place.f)
            }
        }
    }

    /// Radiance arriving from the unit world direction `d`, and the density with which
    /// [`EnvironmentLight::sample`] draws it.
    pub fn radiance_pdf(&self, d: Vec3) -> (Rgb, f32) {
        self.radiance_pdf16(&Vec3x16::splat(d), 1)[0]
    }

    /// [`EnvironmentLight::radiance_pdf`] in the lanes of `wanted`, which wait for memory together: a large
    /// map lies outside the caches, and look-ups one after the other would take most of a render's time.
    pub fn radiance_pdf16(&self, d: &Vec3x16, wanted: u16) -> [(Rgb, f32); LANES] {
        let EnvironmentRadiance::Map { map, rows, columns } = &self.source else {
            return [(self.radiance(Vec3::Z), 0.25 * FRAC_1_PI); LANES];
        };
        let places = each(wanted, |i| locate(map, d.get(i)));
        let cells = each(wanted, |i| {
            rows.probability(places[i].row) * columns[places[i].row].probability(places[i].x)
        });
        let corners = each(wanted, |i| corners(map, places[i].x, places[i].row));
        each(wanted, |i| {
            let local = map.to_local * d.get(i);
            let sin_theta = (local.x * local.x + local.z * local.z).sqrt();
            let radiance = bilinear(corners[i], places[i].f);
            (radiance, cells[i] * density(corners[i], radiance) / cell_solid_angle(map, sin_theta))
        })
    }

    /// Samples a direction in proportion to luminance; `None` where the density vanishes.
    pub fn sample(&self, u: Vec2) -> Option<EnvironmentSample> {
        self.sample16(&Vec2x16 { x: [u.x; LANES], y: [u.y; LANES] }, 1)[0]
    }

    /// [`EnvironmentLight::sample`] in the lanes of `wanted`; `None` in the others. The lanes wait for memory together.
    pub fn sample16(&self, u: &Vec2x16, wanted: u16) -> [Option<EnvironmentSample>; LANES] {
        let EnvironmentRadiance::Map { map, rows, columns } = &self.source else {
            let (radiance, pdf) = (self.radiance(Vec3::Z), 0.25 * FRAC_1_PI);
            return each(wanted, |i| {
                Some(EnvironmentSample { direction: uniform_sphere(u.get(i)), radiance, pdf })
            });
        };
        let found = each(wanted, |i| rows.sample(u.y[i]));
        let row = |i: usize| &columns[found[i].0];
        let brackets = each(wanted, |i| row(i).bracket(u.x[i]));
        let brackets = each(wanted, |i| row(i).halve(u.x[i], brackets[i]));
        let places = each(wanted, |i| row(i).search(u.x[i], brackets[i]));
        let corners = each(wanted, |i| corners(map, places[i].0, found[i].0));
        each(wanted, |i| {
            let ((y, rest_y), (x, rest_x)) = (found[i], places[i]);
            let f = sample_bilinear(corners[i].map(luminance), Vec2::new(rest_x, rest_y));
            let cell = rows.probability(y) * columns[y].probability(x);
            direction_in(map, y, x, f, corners[i], cell)
        })
    }
}

/// Applies `f` to each lane in `wanted`.
#[inline(always)]
fn each<T: Copy + Default>(wanted: u16, mut f: impl FnMut(usize) -> T) -> [T; LANES] {
    let mut values = [T::default(); LANES];
    for lane in lanes_in(wanted) {
        values[lane] = f(lane);
    }
    values
}

/// Returns the sample at position `f` of a cell that is chosen with probability `cell`.
fn direction_in(
    map: &EnvironmentMap,
    row: usize,
    x: usize,
    f: Vec2,
    corners: [Rgb; 4],
    cell: f32,
) -> Option<EnvironmentSample> {
    let theta = PI * (row as f32 + f.y) / row_count(map) as f32;
    let phi = TAU * (x as f32 + 0.5 + f.x) / map.width as f32;
    let (sin_theta, cos_theta) = theta.sin_cos();
    let (sin_phi, cos_phi) = phi.sin_cos();
    let local = Vec3::new(sin_phi * sin_theta, cos_theta, -cos_phi * sin_theta);
    // The map's frame is a rotation, so the transpose is the inverse.
    let direction = (map.to_local.transpose() * local).normalize();
    let radiance = bilinear(corners, f);
    let pdf = cell * density(corners, radiance) / cell_solid_angle(map, sin_theta);
    (pdf > 0.0 && pdf.is_finite()).then_some(EnvironmentSample { direction, radiance, pdf })
}

/// A cell of the map and the position in it.
#[derive(Clone, Copy, Default)]
struct CellPosition {
    x: usize,
    row: usize,
    f: Vec2,
}

/// Rows of cells: one fewer than rows of texels.
fn row_count(map: &EnvironmentMap) -> usize {
    map.height.max(2) - 1
}

/// Returns the latitudes, over π, that bound row `row` of cells.
fn row_span(map: &EnvironmentMap, row: usize) -> (f32, f32) {
    let rows = row_count(map) as f32;
    (row as f32 / rows, (row + 1) as f32 / rows)
}

/// Solid angle per unit of the cell's own square, at the given sine of the latitude.
fn cell_solid_angle(map: &EnvironmentMap, sin_theta: f32) -> f32 {
    (TAU / map.width as f32) * (PI / row_count(map) as f32) * sin_theta.max(1e-7)
}

/// Position of direction `d` in the map.
fn locate(map: &EnvironmentMap, d: Vec3) -> CellPosition {
    let local = map.to_local * d;
    let u = local.x.atan2(-local.z) / TAU;
    let x = (u - u.floor()) * map.width as f32 - 0.5;
    let column = x.floor();
    let rows = row_count(map);
    let y = local.y.clamp(-1.0, 1.0).acos() * FRAC_1_PI * rows as f32;
    let row = (y as usize).min(rows - 1);
    let f = Vec2::new(x - column, (y - row as f32).clamp(0.0, 1.0));
    CellPosition { x: (column as i64).rem_euclid(map.width as i64) as usize, row, f }
}

/// Radiance at the corners of a cell: top left, top right, bottom left, bottom right.
fn corners(map: &EnvironmentMap, x: usize, row: usize) -> [Rgb; 4] {
    let right = if x + 1 == map.width { 0 } else { x + 1 };
    let top = row * map.width;
    let bottom = (row + 1).min(map.height - 1) * map.width;
    [top + x, top + right, bottom + x, bottom + right].map(|i| map.radiance[i])
}

fn bilinear([a, b, c, d]: [Rgb; 4], f: Vec2) -> Rgb {
    a.lerp(b, f.x).lerp(c.lerp(d, f.x), f.y)
}

/// Density over the cell's square in proportion to the bilinear luminance, where that is `radiance`.
fn density(corners: [Rgb; 4], radiance: Rgb) -> f32 {
    let mean = 0.25 * luminance(corners.iter().sum());
    if mean > 0.0 { luminance(radiance) / mean } else { 0.0 }
}

fn sample_bilinear([a, b, c, d]: [f32; 4], u: Vec2) -> Vec2 {
    let y = sample_linear(a + b, c + d, u.y);
    let x = sample_linear(a + (c - a) * y, b + (d - b) * y, u.x);
    Vec2::new(x, y)
}

/// Inverse of the distribution whose density goes linearly from `a` to `b`.
fn sample_linear(a: f32, b: f32, u: f32) -> f32 {
    if a + b <= 0.0 {
        return u;
    }
    let root = (a * a + (b * b - a * a) * u).max(0.0).sqrt();
    (u * (a + b) / (a + root)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::owen_sobol_2d;
    use glam::Mat3;

    fn map() -> EnvironmentMap {
        let (width, height) = (16, 8);
        let mut radiance: Vec<Rgb> =
            (0..width * height).map(|i| Rgb::splat(0.1 + (i * 37 % 11) as f32 * 0.05)).collect();
        radiance[3 * width + 15] = Rgb::new(500.0, 400.0, 300.0);
        EnvironmentMap { width, height, radiance, to_local: Mat3::from_rotation_y(0.7) }
    }

    #[test]
    fn density_integrates_to_one_and_estimates_the_mean() {
        let light = EnvironmentLight::new(&Environment::Map(map())).unwrap();
        let n = 1 << 18;
        let (mut mass, mut uniform_mean, mut sampled_mean) = (0.0f64, 0.0f64, 0.0f64);
        for i in 0..n {
            let u = owen_sobol_2d(i, 3);
            let d = uniform_sphere(u);
            mass += light.radiance_pdf(d).1 as f64 * 4.0 * std::f64::consts::PI;
            uniform_mean += luminance(light.radiance(d)) as f64;
            let s = light.sample(u).unwrap();
            assert!((light.radiance(s.direction) - s.radiance).length() < 1e-2 * s.radiance.length());
            sampled_mean += (luminance(s.radiance) / s.pdf) as f64 / (4.0 * std::f64::consts::PI);
        }
        let n = n as f64;
        assert!((mass / n - 1.0).abs() < 0.01, "{}", mass / n);
        assert!((uniform_mean / sampled_mean - 1.0).abs() < 0.01);
        // The weight of the mean in closed form uses cell means, not the sine inside a cell.
        assert!((sampled_mean / n / light.mean_luminance() as f64 - 1.0).abs() < 0.02);
    }

    #[test]
    fn a_one_texel_sun_costs_little_variance() {
        let light = EnvironmentLight::new(&Environment::Map(map())).unwrap();
        let weights: Vec<f64> = (0..4096)
            .filter_map(|i| light.sample(owen_sobol_2d(i, 5)))
            .map(|s| (luminance(s.radiance) / s.pdf) as f64)
            .collect();
        let mean = weights.iter().sum::<f64>() / weights.len() as f64;
        let worst = weights.iter().fold(0.0f64, |m, w| m.max(*w));
        assert!(worst < 2.0 * mean, "worst weight {worst}, mean {mean}");
    }

    #[test]
    fn one_pixel_map_is_constant() {
        let map = EnvironmentMap {
            width: 1,
            height: 1,
            radiance: vec![Rgb::new(1.0, 2.0, 3.0)],
            to_local: Mat3::IDENTITY,
        };
        let light = EnvironmentLight::new(&Environment::Map(map)).unwrap();
        for i in 0..64 {
            let s = light.sample(owen_sobol_2d(i, 1)).unwrap();
            assert!((s.radiance - Rgb::new(1.0, 2.0, 3.0)).length() < 1e-5);
        }
    }
}
