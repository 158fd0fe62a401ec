//! Nanoseconds per BSDF call: `cargo run --release --example bsdf_speed`.

use glam::{Vec2, Vec3};
use lightsplat::material::{DirectionBound, Materials};
use lightsplat::math::Rgb;
use lightsplat::scene::{Coat, Distribution, Fresnel, Lobe, Material, MaterialId, Reflectance, Scene};
use std::hint::black_box;
use std::time::Instant;

const CALLS: usize = 2_000_000;

fn main() {
    let constant = |v: f32| Reflectance::Constant(Rgb::splat(v));
    let rough =
        |distribution, fresnel| Lobe::Rough { distribution, alpha: 0.1, fresnel, scale: constant(1.0) };
    let coat = Some(Coat { eta: 1.5, nonlinear: false });
    let glossy = Lobe::Rough {
        distribution: Distribution::Ggx,
        alpha: 0.3,
        fresnel: Fresnel::One,
        scale: constant(0.3),
    };
    let dielectric = Fresnel::Dielectric(1.5);
    let gold = Fresnel::Conductor { eta: Rgb::new(0.143, 0.375, 1.442), k: Rgb::new(3.983, 2.386, 1.603) };
    let kinds = [
        ("diffuse", 0.5, None, Lobe::None),
        ("glossy", 0.5, None, glossy),
        ("plastic", 0.5, coat, Lobe::Mirror { fresnel: dielectric, scale: constant(1.0) }),
        ("rough plastic, GGX", 0.5, coat, rough(Distribution::Ggx, dielectric)),
        ("rough plastic, Beckmann", 0.5, coat, rough(Distribution::Beckmann, dielectric)),
        ("rough conductor, GGX", 0.0, None, rough(Distribution::Ggx, gold)),
        ("rough conductor, Beckmann", 0.0, None, rough(Distribution::Beckmann, gold)),
        ("conductor", 0.0, None, Lobe::Mirror { fresnel: gold, scale: constant(1.0) }),
        (
            "glass",
            0.0,
            None,
            Lobe::Dielectric { eta: 1.5, reflectance: constant(1.0), transmittance: constant(1.0) },
        ),
    ];
    let materials = kinds.iter().map(|&(name, diffuse, coat, lobe)| Material {
        name: name.into(),
        two_sided: true,
        diffuse: constant(diffuse),
        coat,
        lobe,
    });
    let scene = scene(materials.collect());
    let start = Instant::now();
    let materials = Materials::new(&scene);
    println!("tables: {:.1} ms for {} materials", start.elapsed().as_secs_f64() * 1e3, kinds.len());

    let directions: Vec<Vec3> = (0..1024u32).map(|i| direction(i.wrapping_mul(2_654_435_769))).collect();
    println!("{:26} {:>6} {:>9} {:>7} {:>6}  ns per call", "", "at", "eval_pdf", "sample", "bound");
    for (i, (name, ..)) in kinds.iter().enumerate() {
        let bsdf = materials.at(&scene, MaterialId(i as u32), Vec2::ZERO);
        let pair = |i: usize| (directions[i & 1023], directions[(i * 7 + 1) & 1023]);
        let at = time(|i| {
            let uv = Vec2::splat(i as f32);
            black_box(materials.at(&scene, black_box(MaterialId(0)), uv));
        });
        let eval_pdf = time(|i| {
            let (wo, wi) = pair(i);
            black_box(bsdf.eval_pdf(wo, wi));
        });
        let sample = time(|i| {
            let (wo, u) = pair(i);
            black_box(bsdf.sample(wo, u.z, Vec2::new(0.5 + 0.5 * u.x, 0.5 + 0.5 * u.y)));
        });
        let bound = time(|i| {
            let (wo, b) = pair(i);
            let bound = DirectionBound { cos_i_max: b.z, cos_i_min: 0.5 * b.z, cos_mirror_max: b.x };
            black_box(bsdf.bound(wo, &bound));
        });
        println!("{name:26} {at:6.1} {eval_pdf:9.1} {sample:7.1} {bound:6.1}");
    }
}

/// Best of five runs.
fn time(mut call: impl FnMut(usize)) -> f64 {
    let mut run = || {
        let start = Instant::now();
        (0..CALLS).for_each(&mut call);
        start.elapsed().as_secs_f64() * 1e9 / CALLS as f64
    };
    (0..5).map(|_| run()).fold(f64::INFINITY, f64::min)
}

/// A direction of the upper hemisphere.
fn direction(bits: u32) -> Vec3 {
    let z = ((bits >> 8) as f32 + 0.5) / (1u32 << 24) as f32;
    let phi = (bits.wrapping_mul(747_796_405) >> 8) as f32 * 1e-3;
    let r = (1.0 - z * z).sqrt();
    Vec3::new(r * phi.cos(), r * phi.sin(), z)
}

fn scene(materials: Vec<Material>) -> Scene {
    Scene { materials, ..Scene::default() }
}
