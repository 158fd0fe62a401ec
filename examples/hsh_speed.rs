//! Nanoseconds per virtual light added to a record, and per lookup of what a record reflects; what records of a scene's
//! materials hold: `cargo run --release --example hsh_speed [SCENE]`.

use glam::{Vec2, Vec3};
use lightsplat::gradient::{Incidence, Source};
use lightsplat::hsh::{Accumulator, Kernel, Reflected, SeriesSettings, Surfaces};
use lightsplat::material::Materials;
use lightsplat::math::Rgb;
use lightsplat::scene::MaterialId;
use lightsplat::scene::formats::{LoadOptions, load};
use std::hint::black_box;
use std::time::Instant;

const LIGHTS: usize = 1000;
const RECORDS: usize = 400;

fn main() {
    let sources: Vec<Source<f32>> =
        (0..LIGHTS as u32).map(|i| source(i.wrapping_mul(2_654_435_769))).collect();
    let incidences: Vec<Incidence<f32>> = sources.iter().filter_map(|s| s.incidence(1e-9)).collect();
    let geometry = time(RECORDS * LIGHTS, || {
        for source in (0..RECORDS).flat_map(|_| &sources) {
            black_box(source.incidence(1e-9));
        }
    });
    println!("geometry and its gradient: {geometry:.1} ns per light, {} lights seen", incidences.len());
    println!("bands  add (ns per light)  finish  reflected (ns)  bytes");
    for bands in [1, 2, 3, 4, 5, 6, 7, 8] {
        let mut accumulator = Accumulator::new(bands);
        let add = time(RECORDS * incidences.len(), || {
            for incidence in (0..RECORDS).flat_map(|_| &incidences) {
                accumulator.add(incidence, Rgb::ONE);
            }
        });
        let finish = time(RECORDS, || {
            for _ in 0..RECORDS {
                black_box(accumulator.finish());
            }
        });
        incidences.iter().for_each(|i| accumulator.add(i, Rgb::ONE));
        let (radiance, kernel) = (accumulator.finish(), Kernel::cosine(bands));
        let reflected = time(100_000, || {
            for _ in 0..100_000 {
                black_box::<Reflected>(black_box(&radiance).reflected(black_box(&kernel)));
            }
        });
        let bytes = radiance.heap_bytes();
        println!("{bands:5}  {add:18.1}  {finish:6.0}  {reflected:14.1}  {bytes:5}");
    }
    match std::env::args().nth(1) {
        Some(path) => of_scene(&path),
        None => of_scene("scenes/knot.toml"),
    }
}

fn of_scene(path: &str) {
    let scene = match load(path.as_ref(), &LoadOptions::default()) {
        Ok(loaded) => loaded.scene,
        Err(error) => return eprintln!("{error}"),
    };
    let materials = Materials::new(&scene);
    let start = Instant::now();
    let surfaces = Surfaces::new(&scene, &materials, &SeriesSettings::default());
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "{path}: {} materials in {:.1} ms, {} bytes, tables of {:?} outgoing directions",
        materials.count(),
        seconds * 1e3,
        surfaces.heap_bytes(),
        surfaces.directions()
    );
    for (i, material) in scene.materials.iter().enumerate() {
        let id = MaterialId(i as u32);
        let bsdf = materials.average(&scene, id);
        let cos = |i: usize| 0.05 + 0.9 * (i & 1023) as f32 / 1023.0;
        let profile = time(100_000, || {
            for i in 0..100_000 {
                black_box(surfaces.profile(id, &bsdf, cos(i)));
            }
        });
        let profile_there = surfaces.profile(id, &bsdf, 0.5);
        let towards = time(100_000, || {
            for i in 0..100_000 {
                black_box(black_box(&profile_there).towards(cos(i), 0.3));
            }
        });
        let (caching, error) = (surfaces.caching(id), 100.0 * surfaces.error(id));
        let name = format!("{} (alpha {:?})", material.name, materials.at(&scene, id, Vec2::ZERO).alpha());
        println!(
            "{name:40} {caching:?}, error {error:.1} %, profile {profile:.0} ns, towards {towards:.0} ns"
        );
    }
}

/// Best of seven runs.
fn time(calls: usize, mut run: impl FnMut()) -> f64 {
    let mut once = || {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64() * 1e9 / calls as f64
    };
    (0..7).map(|_| once()).fold(f64::INFINITY, f64::min)
}

/// A patch somewhere above, facing the receiver more or less.
fn source(bits: u32) -> Source<f32> {
    let part =
        |shift: u32| (bits.rotate_left(shift).wrapping_mul(747_796_405) >> 8) as f32 / (1 << 24) as f32;
    let offset = Vec3::new(part(0) - 0.5, part(7) - 0.5, part(13));
    let normal = (Vec3::new(part(19) - 0.5, part(23) - 0.5, part(29) - 0.5) - offset).normalize();
    Source::Oriented { offset: offset.to_array(), normal: normal.to_array() }
}
