//! Short rays from up to sixteen points at once, and the surfaces that they meet.
//!
//! Deviations: rays end at thin sheets of glass, which shadow rays to virtual lights pass. So light clamped of virtual
//! lights close behind a pane stays lost.

use super::Compensation;
use super::near_surface::NearSurface;
use base::math::{Frame, LANES, Rgb, lanes_in, luminance};
use base::sampling::{cosine_hemisphere, owen_sobol_2d};
use embree::{Hit, Hits16, Ray, Rays16};
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;
use world::SurfacePoint;
use world::shadow;

/// Salt of the seed for directions.
const SALT: u32 = 0x5eed;

/// Point whose virtual lights are limited.
#[derive(Clone, Copy, Debug)]
pub struct ClampedPoint {
    /// Position and normals.
    pub point: SurfacePoint,
    /// Maximum geometry term of an indirect virtual light; none if it is not positive and finite.
    pub bound: f32,
    /// True if light from area lights is compensated too.
    pub direct: bool,
    /// Maximum number of edges that light may take to the point.
    pub edges: u16,
}

/// Traces `count` rays from each of the first sixteen points. Calls `met` with the number of the point and every
/// surface with light that virtual lights lack, ray by ray, then in order of the points. Returns the number of rays.
pub fn trace(
    c: &Compensation,
    points: &[ClampedPoint],
    count: u32,
    mut met: impl FnMut(usize, NearSurface),
) -> u64 {
    let points = &points[..points.len().min(LANES)];
    let reach_sq = |p: &ClampedPoint| {
        let clamped = if p.bound > 0.0 && p.bound.is_finite() { 1.0 / p.bound } else { 0.0 };
        clamped.max(if p.direct { c.max_near_sq } else { 0.0 })
    };
    let valid = (0..points.len()).filter(|&l| reach_sq(&points[l]) > 0.0).fold(0u16, |mask, l| mask | 1 << l);
    if valid == 0 {
        return 0;
    }
    let frames: Vec<Frame> = points.iter().map(|p| Frame::from_normal(p.point.normal)).collect();
    let mut rays = Rays16::default();
    let mut hits = Hits16::default();
    let seed = c.lights.seed ^ SALT;
    for index in 0..count {
        let local = cosine_hemisphere(owen_sobol_2d(index, seed));
        for lane in lanes_in(valid) {
            let SurfacePoint { position, geometric_normal, .. } = points[lane].point;
            let start = shadow::ray_from(position, geometric_normal, frames[lane].to_world(local));
            rays.set(lane, &Ray { t_far: reach_sq(&points[lane]).sqrt(), ..start });
        }
        // The rays of a packet are as coherent as the frames of the points.
        for lane in lanes_in(c.world.accel.closest_hit16(&rays, valid, true, &mut hits)) {
            if let Some(near) =
                weighed(c, &hits.get(lane), frames[lane].to_world(local), local.z, &points[lane])
            {
                met(lane, near);
            }
        }
    }
    u64::from(valid.count_ones() * count)
}

/// Returns the surface hit, unless no light is lacking there.
fn weighed(
    c: &Compensation,
    hit: &Hit,
    direction: Vec3,
    cos: f32,
    point: &ClampedPoint,
) -> Option<NearSurface> {
    let distance = hit.t;
    let bound = if point.bound > 0.0 { point.bound } else { f32::INFINITY };
    let dist_sq = distance * distance;
    let lit_sq = if point.direct { c.lights.near_sq[hit.geometry as usize] } else { 0.0 };
    // An upper bound of G, before the surface is looked up.
    if cos <= bound * dist_sq && lit_sq <= dist_sq {
        return None;
    }
    let world = c.world;
    let surface = world.surface(hit);
    // Virtual lights radiate by the cosine to the geometric normal.
    let geometry = cos * surface.normal.dot(direction).abs() / dist_sq;
    let mut near = NearSurface {
        surface,
        distance,
        cos,
        normal: surface.frame.normal,
        weight: Rgb::ZERO,
        emitted: Rgb::ZERO,
    };
    if surface.frame.normal.dot(direction) > 0.0 {
        near.normal = -near.normal;
    }
    if geometry > bound {
        let out = surface.frame.to_local(-direction);
        near.weight = world.bsdf(&surface).diffuse_albedo(out) * ((1.0 - bound / geometry) * FRAC_1_PI);
    }
    if lit_sq > dist_sq {
        near.emitted = world.emitted(&surface, -direction) * (1.0 - dist_sq / lit_sq);
    }
    let light = near.weight + near.emitted;
    (luminance(light) > 0.0 && light.is_finite()).then_some(near)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lights::{LightTrees, Lights};
    use base::progress::Control;
    use std::f32::consts::PI;
    use world::World;
    use world::testkit::{add_material, camera, diffuse, emitting, quad, scene, world};

    const ALBEDO: f32 = 0.6;
    const RADIANCE: f32 = 3.0;
    /// Height of the ceiling over the point.
    const HEIGHT: f32 = 0.5;
    const NONE: f32 = f32::INFINITY;

    /// A wide ceiling that shines down, and nothing else.
    fn ceiling() -> World {
        let mut scene = scene(camera(Vec3::ZERO, Vec3::Z, 1.0), [1, 1]);
        let grey = add_material(&mut scene, diffuse(Rgb::splat(ALBEDO)));
        let corner = Vec3::new(-50.0, -50.0, HEIGHT);
        let down = quad(corner, Vec3::Y * 100.0, Vec3::X * 100.0, grey);
        scene.meshes.push(emitting(down, Rgb::splat(RADIANCE)));
        world(scene).world
    }

    /// Estimates of the reflected and of the emitted light that a point below the ceiling lacks, by many rays.
    fn lacking(bound: f32, near_sq: f32) -> [f32; 2] {
        estimates(bound, near_sq, 4096, 0)
    }

    /// Estimates by π/N Σ over `count` rays of a seed.
    fn estimates(bound: f32, near_sq: f32, count: u32, seed: u32) -> [f32; 2] {
        let world = ceiling();
        let trees = LightTrees::build(&[], Vec::new(), world.diagonal, &Control::new());
        let (diagonal, near) = (world.diagonal, vec![near_sq]);
        let lights = Lights { trees, near_sq: near, intensities: None, diagonal, seed, vpls: 0, rays: 0 };
        let c = Compensation::new(&world, &lights);
        let point = SurfacePoint { position: Vec3::ZERO, normal: Vec3::Z, geometric_normal: Vec3::Z };
        let mut sums = [0.0; 2];
        let clamped = ClampedPoint { point, bound, direct: near_sq > 0.0, edges: u16::MAX };
        trace(&c, &[clamped], count, |_, near| {
            sums[0] += luminance(near.weight);
            sums[1] += luminance(near.emitted);
        });
        sums.map(|sum| sum * PI / count as f32)
    }

    /// Under a ceiling at height h, G = cos⁴θ/h² and cos²θ is uniform, so that the mean of max(0, 1 - b/G) is
    /// (1 - √b h)².
    #[test]
    fn the_part_of_the_geometry_term_above_the_bound_comes_back() {
        for root in [0.1f32, 0.4, 0.8] {
            let bound = (root / HEIGHT).powi(2);
            let expected = ALBEDO * (1.0 - root).powi(2);
            let [reflected, emitted] = lacking(bound, 0.0);
            assert!((reflected - expected).abs() < 0.01 * ALBEDO, "{root}: {reflected} for {expected}");
            assert_eq!(emitted, 0.0);
        }
        // Nothing lies as near as b^(-1/2).
        assert_eq!(lacking(1.01 / (HEIGHT * HEIGHT), 0.0), [0.0; 2]);
    }

    #[test]
    fn errors_of_few_directions_average_out_over_seeds() {
        const SEEDS: u32 = 256;
        let root = 0.4f32;
        let by = |seed| estimates((root / HEIGHT).powi(2), 0.0, 4, seed)[0];
        let expected = ALBEDO * (1.0 - root).powi(2);
        let errors: Vec<f32> = (0..SEEDS).map(|seed| by(seed) / expected - 1.0).collect();
        let mean = errors.iter().sum::<f32>() / SEEDS as f32;
        let rms = (errors.iter().map(|error| error * error).sum::<f32>() / SEEDS as f32).sqrt();
        assert!(rms > 0.02 && mean.abs() < 4.0 * rms / (SEEDS as f32).sqrt(), "{mean} of {rms}");
    }

    /// With r² = h²/cos²θ the mean of max(0, 1 - r²/A) is 1 - a + a ln a, a = h²/A.
    #[test]
    fn light_from_emitters_nearer_than_their_patches_comes_back() {
        for a in [0.05f32, 0.3, 0.9] {
            let expected = PI * RADIANCE * (1.0 - a + a * a.ln());
            let [reflected, emitted] = lacking(NONE, HEIGHT * HEIGHT / a);
            assert!((emitted - expected).abs() < 0.01 * PI * RADIANCE, "{a}: {emitted} for {expected}");
            assert_eq!(reflected, 0.0);
        }
        assert_eq!(lacking(NONE, 0.99 * HEIGHT * HEIGHT), [0.0; 2]);
    }
}
