//! Materials: evaluations, samples and bounds per second, of one direction and of sixteen at once.

use super::lit_scene::Dice;
use super::measure::{Case, Clock, measure};
use super::{Benchmark, Context, Kind, Table};
use base::math::{LANES, Rgb, Vec2x16, Vec3x16};
use base::sampling::uniform_sphere;
use glam::{Vec2, Vec3};
use scene::{Coat, Distribution, Fresnel, Lobe, Material, MaterialId, Reflectance, Roughness, Scene};
use std::hint::black_box;
use world::material::{Bsdf, Bsdfs16, DirectionBound, Materials};

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "bsdf",
    about: "Evaluations, samples and bounds of every kind of material per second",
    kind: Kind::Parts { needs_scene: false, run },
};

/// Number of directions.
const DIRECTIONS: usize = 1024;

fn run(context: &Context) -> Vec<Table> {
    let scene = Scene { materials: kinds(), ..Scene::default() };
    let materials = Materials::new(&scene);
    let packets = DirectionPackets::new();
    let table = Table {
        title: "Materials",
        about: "Sixteen directions from one viewpoint, with its preparation. Ratio to one direction at a time.",
        labels: &["call", "material", "directions"],
        unit: "M/s",
        ..Table::default()
    };
    vec![measure(table, Clock::Thread, cases(&scene, &materials, &packets), &context.settings)]
}

/// Returns the cases of one direction and of sixteen directions at once.
fn cases<'a>(scene: &'a Scene, materials: &'a Materials, packets: &'a DirectionPackets) -> Vec<Case<'a>> {
    let mut cases = Vec::new();
    for (i, material) in scene.materials.iter().enumerate() {
        let bsdf = materials.at(MaterialId(i as u32), Vec2::ZERO);
        let mut case = |call: &str, lanes: usize, work: fn(&Bsdf, Vec3, &Vec3x16, &Vec2x16)| {
            let against = cases.len() - usize::from(lanes > 1);
            let labels = [call, &material.name, &lanes.to_string()];
            cases.push(Case::new(&labels, against, DIRECTIONS as f64, move || {
                packets.each().for_each(|(wo, wi, u)| work(&bsdf, wo, wi, u));
            }));
        };
        case("evaluate", 1, |bsdf, wo, wi, _| {
            (0..LANES).for_each(|lane| {
                black_box(bsdf.eval_pdf(wo, wi.get(lane)));
            });
        });
        case("evaluate", LANES, |bsdf, wo, wi, _| {
            black_box(&Bsdfs16::new(Vec3x16::splat(wo), |_| *bsdf).eval_pdf(wi, !0));
        });
        case("sample", 1, |bsdf, wo, wi, u| {
            (0..LANES).for_each(|lane| {
                black_box(bsdf.sample(wo, wi.z[lane], u.get(lane)));
            });
        });
        case("sample", LANES, |bsdf, wo, wi, u| {
            black_box(&Bsdfs16::new(Vec3x16::splat(wo), |_| *bsdf).sample(&wi.z, u, !0));
        });
        case("bound", 1, |bsdf, wo, wi, _| {
            (0..LANES).for_each(|lane| {
                let b = wi.get(lane);
                let bound = DirectionBound { cos_i_max: b.z, cos_i_min: 0.5 * b.z, cos_mirror_max: b.x };
                black_box(bsdf.bound(wo, &bound));
            });
        });
    }
    cases
}

/// Directions in packets, each with a direction of view.
struct DirectionPackets {
    wo: Vec<Vec3>,
    wi: Vec<Vec3x16>,
    /// Numbers from 0 to 1.
    u: Vec<Vec2x16>,
}

impl DirectionPackets {
    /// Makes random directions above the surface.
    fn new() -> DirectionPackets {
        let mut dice = Dice(6);
        let mut direction = |_| {
            let v = uniform_sphere(Vec2::new(dice.unit(), dice.unit()));
            Vec3::new(v.x, v.y, v.z.abs().max(1e-3))
        };
        let directions: Vec<Vec3> = (0..DIRECTIONS).map(&mut direction).collect();
        let mut packets = DirectionPackets { wo: Vec::new(), wi: Vec::new(), u: Vec::new() };
        for (i, packet) in directions.chunks_exact(LANES).enumerate() {
            let (mut wi, mut u) = (Vec3x16::ZERO, Vec2x16::default());
            for (lane, v) in packet.iter().enumerate() {
                wi.set(lane, *v);
                u.set(lane, Vec2::new(0.5 + 0.5 * v.x, 0.5 + 0.5 * v.y));
            }
            packets.wo.push(directions[(i * 7 + 1) % directions.len()]);
            packets.wi.push(wi);
            packets.u.push(u);
        }
        packets
    }

    /// Lists direction of view, incident directions and numbers of each packet.
    fn each(&self) -> impl Iterator<Item = (Vec3, &Vec3x16, &Vec2x16)> {
        (0..self.wo.len()).map(|i| (self.wo[i], &self.wi[i], &self.u[i]))
    }
}

/// Returns a material of each kind.
fn kinds() -> Vec<Material> {
    let constant = |v: f32| Reflectance::Constant(Rgb::splat(v));
    let rough = |alpha, distribution, fresnel, scale| {
        Some(Lobe::Rough { distribution, alpha: Roughness::Constant(alpha), fresnel, scale: constant(scale) })
    };
    let coat = Some(Coat { eta: 1.5, nonlinear: false });
    let dielectric = Fresnel::Dielectric(1.5);
    let gold = Fresnel::Conductor { eta: Rgb::new(0.143, 0.375, 1.442), k: Rgb::new(3.983, 2.386, 1.603) };
    let (ggx, beckmann) = (Distribution::Ggx, Distribution::Beckmann);
    let glass =
        Lobe::Dielectric { eta: 1.5, thin: false, reflectance: constant(1.0), transmittance: constant(1.0) };
    let mirror = |fresnel| Some(Lobe::Mirror { fresnel, scale: constant(1.0) });
    [
        ("diffuse", 0.5, None, None),
        ("glossy", 0.5, None, rough(0.3, ggx, Fresnel::One, 0.3)),
        ("plastic", 0.5, coat, mirror(dielectric)),
        ("rough plastic, GGX", 0.5, coat, rough(0.1, ggx, dielectric, 1.0)),
        ("rough plastic, Beckmann", 0.5, coat, rough(0.1, beckmann, dielectric, 1.0)),
        ("rough conductor, GGX", 0.0, None, rough(0.1, ggx, gold, 1.0)),
        ("rough conductor, Beckmann", 0.0, None, rough(0.1, beckmann, gold, 1.0)),
        ("conductor", 0.0, None, mirror(gold)),
        ("glass", 0.0, None, Some(glass)),
    ]
    .map(|(name, diffuse, coat, lobe)| Material {
        name: name.into(),
        two_sided: true,
        diffuse: constant(diffuse),
        coat,
        lobes: Vec::from_iter(lobe),
        ..Material::default()
    })
    .into()
}
