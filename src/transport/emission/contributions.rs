//! Contributions of the emitters to the visible indirect light, and shares of the paths in proportion to them.
//!
//! In proportion to power, nearly all photons go to a bright hall beside a dim room, or to a plain of which a window
//! shows a little. The emitter in the room then has a few virtual lights, each so bright that it is clamped.
//!
//! Paper: Keller, *Instant Radiosity*, 1997. Deviations: emitters share paths in proportion to their contributions to
//! the image, not to power. Short pilot paths from visible points estimate the contributions.

use super::short_paths::{PilotVertex, follow, is_free};
use base::math::{LANES, Vec2x16, Vec3x16, lanes_in, luminance};
use base::parallel::ShortRuns;
use base::sampling::{Sampler, hash};
use rayon::prelude::*;
use world::light::{DiscreteDistribution, Receivers16};
use world::shadow;
use world::{SurfacePoint, World};

/// Number of visible points per pilot path.
const POINTS_PER_PATH: usize = 4;

/// Minimum number of pilot paths.
const MIN_PATHS: usize = 256;

/// Share of the paths that stay in proportion to power, since pilot paths miss emitters that rarely contribute.
const POWER_SHARE: f32 = 0.25;

/// Minimum ratio of the variance with shares by power to that with shares by contribution.
const MIN_GAIN: f64 = 1.5;

/// Light of an emitter at the beginning of a pilot path.
struct EmitterContribution {
    emitter: u32,
    luminance: f64,
}

/// Returns shares of the paths by emitter for the indirect light of the points `seen`; `None` if `by_power` is nearly
/// as good.
pub(super) fn shares(
    world: &World,
    by_power: &DiscreteDistribution,
    seen: &[SurfacePoint],
    seed: u32,
) -> Option<DiscreteDistribution> {
    let starts: Vec<SurfacePoint> = seen.iter().step_by(POINTS_PER_PATH).copied().collect();
    if by_power.len() < 2 || starts.len() < MIN_PATHS {
        return None;
    }
    let seed = hash(seed, 0x5ea2);
    let from = |(number, start): (usize, &SurfacePoint)| {
        let mut found = Vec::new();
        follow(world, start, &mut Sampler::new(seed, number as u32), |vertex, sampler| {
            add_light(world, vertex, sampler, &mut found);
        });
        found
    };
    let paths: Vec<Vec<EmitterContribution>> =
        starts.par_iter().in_short_runs().enumerate().map(from).collect();
    let all = by_emitter(&paths, by_power.len(), |_| true)?;
    // Paths with even numbers choose shares, and two other sets of paths measure the variance: no path measures itself.
    let chosen = mixed(by_power, &by_emitter(&paths, by_power.len(), |path| path % 2 == 0)?);
    let [a, b] = [1, 3].map(|rest| by_emitter(&paths, by_power.len(), |path| path % 4 == rest));
    let (a, b) = (a?, b?);
    let variance = |shares: &DiscreteDistribution| -> f64 {
        (0..shares.len()).map(|i| a[i] * b[i] / f64::from(shares.probability(i)).max(f64::MIN_POSITIVE)).sum()
    };
    let better = variance(by_power) >= MIN_GAIN * variance(&chosen);
    better.then(|| mixed(by_power, &all))
}

/// Returns each emitter's share of the light found by some of the paths; `None` if they found no light. Light counts
/// relative to that of its path plus the mean, since errors are as visible in darker places.
fn by_emitter(
    paths: &[Vec<EmitterContribution>],
    emitters: usize,
    is_wanted: impl Fn(usize) -> bool,
) -> Option<Vec<f64>> {
    let light = |path: &Vec<EmitterContribution>| path.iter().map(|c| c.luminance).sum::<f64>();
    let mean = paths.iter().map(light).sum::<f64>() / paths.len() as f64;
    let mut shares = vec![0.0; emitters];
    for (_, path) in paths.iter().enumerate().filter(|(number, _)| is_wanted(*number)) {
        let scale = 1.0 / (light(path) + mean);
        path.iter().for_each(|c| shares[c.emitter as usize] += c.luminance * scale);
    }
    let all: f64 = shares.iter().sum();
    shares.iter_mut().for_each(|share| *share /= all);
    (all > 0.0 && all.is_finite()).then_some(shares)
}

/// Returns shares of the paths: [`POWER_SHARE`] in proportion to power, the rest in proportion to contributions.
fn mixed(by_power: &DiscreteDistribution, contributions: &[f64]) -> DiscreteDistribution {
    let share = |(i, contribution): (usize, &f64)| {
        (1.0 - POWER_SHARE) * *contribution as f32 + POWER_SHARE * by_power.probability(i)
    };
    DiscreteDistribution::new(contributions.iter().enumerate().map(share))
}

/// Adds the contributions of sixteen light samples at a vertex.
fn add_light(
    world: &World,
    vertex: &PilotVertex,
    sampler: &mut Sampler,
    found: &mut Vec<EmitterContribution>,
) {
    let (mut choices, mut places) = ([0.0; LANES], Vec2x16::default());
    for (lane, choice) in choices.iter_mut().enumerate() {
        *choice = sampler.next_1d();
        places.set(lane, sampler.next_2d());
    }
    let (x, normal) = (vertex.surface.position, vertex.surface.normal);
    let side = vertex.surface.frame.normal * vertex.wo.z.signum();
    let at = Receivers16 { position: &Vec3x16::splat(x), normal: &Vec3x16::splat(side), learned: None };
    let (chosen, samples) = world.emitters.sample_of(at, &choices, &places, |_| true);
    for lane in lanes_in(samples.useful()) {
        let (direction, distance) = (samples.direction.get(lane), samples.distance[lane]);
        let y = luminance(vertex.reflected(direction, samples.radiance.get(lane))) / samples.pdf[lane];
        let ray = match distance < f32::INFINITY {
            true => shadow::segment(x, normal, x + direction * distance, samples.normal.get(lane)),
            false => shadow::ray_from(x, normal, direction),
        };
        if y > 0.0 && y.is_finite() && is_free(world, ray) {
            found.push(EmitterContribution { emitter: chosen[lane], luminance: f64::from(y) });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emission::{PhotonEmitter, PhotonSettings, trace_photons};
    use base::math::Rgb;
    use base::progress::Control;
    use glam::Vec3;
    use scene::{Camera, Environment};
    use world::testkit::{SceneAndView, add_material, diffuse, emitting, quad, room, scene, world};

    /// A closed room of edge 1 with a lamp of some power.
    fn add_room(scene: &mut SceneAndView, low: Vec3, radiance: f32) {
        let grey = add_material(scene, diffuse(Rgb::splat(0.6)));
        scene.meshes.extend(room(low, low + Vec3::ONE, grey));
        let corner = low + Vec3::new(0.4, 0.4, 0.95);
        let lamp = quad(corner, 0.2 * Vec3::Y, 0.2 * Vec3::X, grey);
        scene.meshes.push(emitting(lamp, Rgb::splat(radiance)));
    }

    /// Points of the floor of the room at the origin.
    fn floor() -> Vec<SurfacePoint> {
        let point = |i: u32| SurfacePoint {
            position: Vec3::new((i % 64) as f32 + 0.5, (i / 64) as f32 + 0.5, 0.0) / 64.0,
            normal: Vec3::Z,
            geometric_normal: Vec3::Z,
        };
        (0..64 * 64).map(point).collect()
    }

    /// Number of photons in the room at the origin of so many, and their flux over that of all paths.
    fn inside(world: &World, seen: &[SurfacePoint], seed: u32) -> (usize, f32) {
        let settings = PhotonSettings { photons: 20_000, seen, max_edges: 4, seed };
        let (photons, counts) = trace_photons(world, &settings, &Control::new(), |hit| hit.photon);
        let is_in = |p: Vec3| p.cmpge(Vec3::splat(-1e-3)).all() && p.cmple(Vec3::splat(1.001)).all();
        let inside = || photons.iter().filter(|photon| is_in(photon.position));
        (inside().count(), inside().map(|p| luminance(p.flux)).sum::<f32>() / counts.paths as f32)
    }

    #[test]
    fn a_dim_room_has_the_photons_and_a_bright_one_beside_it_its_flux() {
        let mut scene = scene(Camera::default(), [8, 8]);
        add_room(&mut scene, Vec3::ZERO, 1.0);
        add_room(&mut scene, Vec3::X * 2.0, 300.0);
        let world = world(scene).world;
        let (mut by_power, mut by_contribution, mut count) = ([0.0; 2], [0.0; 2], [0; 2]);
        for seed in 0..40 {
            let ([few, many], [a, b]) = {
                let [a, b] = [inside(&world, &[], seed), inside(&world, &floor(), seed)];
                ([a.0, b.0], [a.1, b.1])
            };
            for (sums, value) in [(&mut by_power, a), (&mut by_contribution, b)] {
                sums[0] += value / 40.0;
                sums[1] += value * value / 40.0;
            }
            count = [count[0] + few, count[1] + many];
        }
        assert!(count[1] > 100 * count[0] && count[0] > 0, "{count:?}");
        let deviation = ((by_power[1] - by_power[0] * by_power[0]) / 40.0).sqrt();
        assert!(
            (by_contribution[0] - by_power[0]).abs() < 4.0 * deviation,
            "{by_contribution:?} {by_power:?} {deviation}"
        );
        let spread = |[mean, squares]: [f32; 2]| (squares - mean * mean).max(0.0).sqrt() / mean;
        assert!(spread(by_contribution) < 0.2 * spread(by_power), "{by_contribution:?} {by_power:?}");
    }

    #[test]
    fn a_lamp_has_photons_beside_a_sky_that_does_not_come_in() {
        let mut scene = scene(Camera::default(), [8, 8]);
        add_room(&mut scene, Vec3::ZERO, 1.0);
        let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
        let plain = quad(Vec3::new(-500.0, -500.0, -0.5), Vec3::X * 1e3, Vec3::Y * 1e3, grey);
        scene.meshes.push(plain);
        scene.environment = Some(Environment::Constant(Rgb::splat(0.5)));
        let world = world(scene).world;
        let [few, many] = [&[][..], &floor()].map(|seen| inside(&world, seen, 1).0);
        assert!(many > 5000 && few < 50, "{few} {many}");
    }

    #[test]
    fn lamps_that_give_what_their_power_says_share_by_power() {
        let mut scene = scene(Camera::default(), [8, 8]);
        let grey = add_material(&mut scene, diffuse(Rgb::splat(0.6)));
        scene.meshes.extend(room(Vec3::ZERO, Vec3::ONE, grey));
        for (x, radiance) in [(0.2, 3.0), (0.4, 1.0), (0.6, 2.0), (0.7, 0.1)] {
            let lamp = quad(Vec3::new(x, 0.5, 0.95), 0.1 * Vec3::Y, 0.1 * Vec3::X, grey);
            scene.meshes.push(emitting(lamp, Rgb::splat(radiance)));
        }
        let world = world(scene).world;
        let emitter = PhotonEmitter::new(&world).expect("there are lamps");
        assert!(shares(&world, &emitter.by_power, &floor(), 1).is_none());
        let by_power: Vec<f32> = emitter.shares().collect();
        assert!((by_power[0] / by_power[1] - 3.0).abs() < 1e-3, "{by_power:?}");
    }
}
