//! Cryptomatte: antialiased masks of all objects or materials, as compositors read them.
//!
//! Specification: Friedman and Jones, "Cryptomatte", version 1.2.0. The id of a name is its MurmurHash3 (32 bits,
//! seed 0) as the bits of a float, whose exponent is kept off 0 and 255. Layers `CryptoObject00`, `CryptoObject01` and
//! so on hold two ranks each: an id and the share of the pixel that it covers, the largest share first. The header has
//! the manifest, a JSON object of names and ids.
//!
//! A sample counts for the surface that it hits first, also if this is a mirror or glass. Gaps pass their share on to
//! the surfaces behind. Shares add up to 1 minus the share of the background: a pixel has as many ranks as names.
//!
//! Deviation: the number of layers is the number that the fullest pixel needs, and at least three.

use super::tiles::{by_tiles, pixels_between};
use crate::paths::Estimand;
use base::film::{Image, Layer, Pixels};
use base::math::{LANES, first_lanes};
use base::progress::Control;
use embree::{Hits16, Ray, Rays16};
use scene::Scene;
use serde_json::{Map, Value};
use world::view::View;
use world::{World, beyond};

/// Minimum number of layers, of two ranks each.
const LEAST_LAYERS: usize = 3;

/// Maximum number of packets of samples per pixel. A pixel whose first packet sees one surface has no other.
const PACKETS: u32 = 2;

/// Share of a sample that is no longer followed through gaps.
const LEAST_SHARE: f32 = 1e-4;

/// Maximum number of surfaces with gaps along a ray.
const MAX_GAPS: u32 = 64;

/// Names that masks have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Masks {
    /// Names of objects.
    Objects,
    /// Names of materials.
    Materials,
}

impl Masks {
    /// Returns the name of the layers without their numbers.
    fn name(self) -> &'static str {
        match self {
            Masks::Objects => "CryptoObject",
            Masks::Materials => "CryptoMaterial",
        }
    }

    /// Returns the name of each seen mesh, or of its material. Things without a name have their number.
    fn names(self, scene: &Scene) -> impl Iterator<Item = String> {
        scene.seen().zip(1..).filter_map(move |((stored, _), number)| {
            let mesh = scene.meshes.get(stored)?;
            let (name, number) = match self {
                Masks::Objects => (mesh.name.as_str(), number),
                Masks::Materials => {
                    let material = scene.materials.get(mesh.material.0 as usize);
                    (material.map_or("", |material| material.name.as_str()), mesh.material.0 as usize + 1)
                }
            };
            Some(if name.is_empty() { number.to_string() } else { name.to_owned() })
        })
    }

    /// Returns the masks of the pixels of the view's window; pixels are empty once cancelled.
    pub fn layers(self, world: &World, view: &View, seed: u32, control: &Control) -> Vec<Layer> {
        let ids: Vec<f32> = self.names(&world.scene).map(|name| id_of(&name)).collect();
        let has_gaps = world.scene.materials.iter().any(|material| material.opacity.is_some());
        let sampler = Sampler { world, view, seed, ids: &ids, has_gaps };
        let pixels = by_tiles(view, control, |first, last| {
            pixels_between(first, last).map(|pixel| sampler.ranks(pixel)).collect()
        });
        let most = pixels.pixels.iter().map(Vec::len).max().unwrap_or(0);
        let layer = |number: usize| {
            let rank = |ranks: &Vec<(f32, f32)>, rank: usize| ranks.get(rank).copied().unwrap_or_default();
            let ranks: Image<[f32; 4]> = pixels.map(|ranks| {
                let [(a, share_of_a), (b, share_of_b)] = [0, 1].map(|i| rank(ranks, 2 * number + i));
                [a, share_of_a, b, share_of_b]
            });
            let name = format!("{}{number:02}", self.name());
            Layer { name, pixels: Pixels::Ranks(ranks), preview: None }
        };
        (0..most.div_ceil(2).max(LEAST_LAYERS)).map(layer).collect()
    }

    /// Returns the attributes of the header that belong to the layers.
    pub fn attributes(self, scene: &Scene) -> [(String, String); 4] {
        let key = format!("{:08x}", murmur3(self.name().as_bytes()));
        let hex = |name: String| {
            let hex = format!("{:08x}", id_of(&name).to_bits());
            (name, Value::from(hex))
        };
        let manifest: Map<String, Value> = self.names(scene).map(hex).collect();
        [
            ("name", self.name().to_owned()),
            ("hash", "MurmurHash3_32".to_owned()),
            ("conversion", "uint32_to_float32".to_owned()),
            ("manifest", Value::Object(manifest).to_string()),
        ]
        .map(|(fact, value)| (format!("cryptomatte/{key:.7}/{fact}"), value))
    }
}

struct Sampler<'a> {
    world: &'a World,
    view: &'a View,
    seed: u32,
    /// Id of each seen mesh.
    ids: &'a [f32],
    /// True if surfaces may have gaps.
    has_gaps: bool,
}

impl Sampler<'_> {
    /// Returns the ids that a pixel sees with the shares that they cover, the largest first.
    fn ranks(&self, pixel: [u32; 2]) -> Vec<(f32, f32)> {
        let (mut shares, mut samples) = (Vec::new(), 0.0);
        for packet in 0..PACKETS {
            self.add(pixel, packet, &mut shares);
            samples += LANES as f32;
            if let [(_, share)] = shares[..]
                && share == samples
            {
                break;
            }
        }
        shares.iter_mut().for_each(|(_, share)| *share /= samples);
        shares.sort_by(|(a, share_of_a), (b, share_of_b)| {
            share_of_b.total_cmp(share_of_a).then(a.total_cmp(b))
        });
        shares
    }

    /// Adds a packet of samples.
    fn add(&self, pixel: [u32; 2], packet: u32, shares: &mut Vec<(f32, f32)>) {
        let (mut rays, mut hits) = (Rays16::default(), Hits16::default());
        for lane in 0..LANES {
            let sample = packet * LANES as u32 + lane as u32;
            let (_, jitter) = Estimand::Pixels.eye_sampler(pixel, self.seed, sample);
            let ray = self.view.sample_ray(pixel, jitter, self.seed, sample);
            rays.set(lane, &self.world.behind_hidden(ray));
        }
        let hit_lanes = self.world.accel.closest_hit16(&rays, first_lanes(LANES), true, &mut hits);
        for lane in (0..LANES).filter(|lane| hit_lanes >> lane & 1 != 0) {
            match self.has_gaps {
                true => self.follow(rays.get(lane), shares),
                false => self.count(hits.geometry[lane], 1.0, shares),
            }
        }
    }

    /// Adds a sample whose ray may meet gaps.
    fn follow(&self, mut ray: Ray, shares: &mut Vec<(f32, f32)>) {
        let mut share = 1.0;
        for _ in 0..MAX_GAPS {
            let Some(surface) = self.world.intersect(&ray) else { return };
            let gaps = self.world.bsdf(&surface).gaps();
            self.count(surface.mesh, share * (1.0 - gaps), shares);
            share *= gaps;
            if share < LEAST_SHARE {
                return;
            }
            ray = beyond(&ray, surface.position, surface.normal, surface.t);
        }
    }

    /// Adds the share of a sample to the id of a mesh.
    fn count(&self, mesh: u32, share: f32, shares: &mut Vec<(f32, f32)>) {
        let Some(id) = self.ids.get(mesh as usize).copied().filter(|_| share > 0.0) else { return };
        match shares.iter_mut().find(|(other, _)| other.to_bits() == id.to_bits()) {
            Some((_, sum)) => *sum += share,
            None => shares.push((id, share)),
        }
    }
}

/// Returns the id of a name.
fn id_of(name: &str) -> f32 {
    let hash = murmur3(name.as_bytes());
    // Floats with these exponents are not normal.
    f32::from_bits(if matches!(hash >> 23 & 255, 0 | 255) { hash ^ 1 << 23 } else { hash })
}

/// Returns the MurmurHash3 of 32 bits with seed 0.
fn murmur3(bytes: &[u8]) -> u32 {
    let scrambled = |block: u32| block.wrapping_mul(0xcc9e_2d51).rotate_left(15).wrapping_mul(0x1b87_3593);
    let block = |bytes: &[u8]| bytes.iter().rev().fold(0, |block, byte| block << 8 | u32::from(*byte));
    let (blocks, rest) = bytes.split_at(bytes.len() / 4 * 4);
    let mix = |hash: u32, four: &[u8]| {
        (hash ^ scrambled(block(four))).rotate_left(13).wrapping_mul(5).wrapping_add(0xe654_6b64)
    };
    let mut hash = blocks.chunks_exact(4).fold(0, mix) ^ scrambled(block(rest)) ^ bytes.len() as u32;
    for (shift, factor) in [(16, 0x85eb_ca6b), (13, 0xc2b2_ae35)] {
        hash = (hash ^ hash >> shift).wrapping_mul(factor);
    }
    hash ^ hash >> 16
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::Rgb;
    use glam::Vec3;
    use scene::{Camera, Parameter};
    use world::testkit::*;

    #[test]
    fn hashes_are_those_of_the_specification() {
        assert_eq!(
            (murmur3(b""), murmur3(b"hello"), murmur3(b"hello, world")),
            (0, 0x248b_fa47, 0x149b_bb7f)
        );
        // Names and ids of the sample images of the specification.
        assert_eq!(murmur3(b"bunny"), 0x13851a76);
        assert!(["", "a", "bunny"].iter().all(|name| id_of(name).is_normal()));
    }

    #[test]
    fn shares_add_up_to_one_at_edges_and_behind_gaps() {
        let mut scene = scene(Camera { tan_half_x: 0.5, ..Camera::default() }, [20, 20]);
        let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
        let mut cut = diffuse(Rgb::splat(0.9));
        cut.opacity = Some(Parameter::Constant(0.25));
        let cut = add_material(&mut scene, cut);
        let mut wall = quad(Vec3::new(-9.0, -9.0, -2.0), Vec3::X * 18.0, Vec3::Y * 18.0, grey);
        let mut veil = quad(Vec3::new(-0.31, -0.27, -1.0), Vec3::X * 0.53, Vec3::new(0.1, 0.47, 0.0), cut);
        (wall.name, veil.name) = ("wall".to_owned(), "veil".to_owned());
        scene.meshes.extend([wall, veil]);
        let WorldAndView { world, view } = world(scene);
        let layers = Masks::Objects.layers(&world, &view, 3, &Control::new());
        let names: Vec<&str> = layers.iter().map(|layer| layer.name.as_str()).collect();
        assert_eq!(names, ["CryptoObject00", "CryptoObject01", "CryptoObject02"]);
        let Pixels::Ranks(first) = &layers[0].pixels else { panic!() };
        let [wall, veil] = ["wall", "veil"].map(id_of);
        let mut partial = 0;
        for [a, share_of_a, b, share_of_b] in &first.pixels {
            assert!((share_of_a + share_of_b - 1.0).abs() < 1e-5 && *a == wall);
            assert!(*share_of_b == 0.0 || *b == veil && *share_of_b <= 0.251, "{share_of_b}");
            partial += u32::from(*share_of_b > 0.01 && *share_of_b < 0.24);
        }
        let middle = first.pixels[10 * 20 + 10];
        assert!((middle[1] - 0.75).abs() < 1e-5 && partial > 5, "{middle:?} {partial}");
        let manifest = &Masks::Objects.attributes(&world.scene)[3];
        assert!(manifest.1.contains(&format!("\"wall\":\"{:08x}\"", wall.to_bits())), "{manifest:?}");
    }
}
