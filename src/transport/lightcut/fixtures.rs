//! Random points, materials and virtual lights for tests of cuts.

use super::{CutSettings, ReceiverPacket};
use crate::lightcut::{Receiver, Transfer, Visibility, to_vpl};
use crate::lights::{LightTrees, LobeProfile, Origin, Profiles, SpotProfile, Vpl, VplKind, VplSet};
use base::math::{Frame, Rgb, V3, Vec3x16, lanes_in};
use base::progress::Control;
use base::sampling::{hash, uniform_sphere};
use embree::Rays16;
use glam::{DVec3, Vec2, Vec3};
use scene::{Coat, Distribution, Fresnel, Lobe, Material, MaterialId, Reflectance, Roughness, Scene};
use world::material::Materials;

/// Stream of pseudo-random numbers in [0, 1).
pub struct RandomNumbers(pub u32);

impl RandomNumbers {
    pub fn next(&mut self) -> f32 {
        self.0 += 1;
        (hash(self.0, 0x51ed) >> 8) as f32 / (1 << 24) as f32
    }

    pub fn vec3(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }

    pub fn direction(&mut self) -> Vec3 {
        uniform_sphere(Vec2::new(self.next(), self.next()))
    }
}

/// Returns a scene with one material of every kind.
pub fn all_materials() -> Scene {
    let constant = |r: f32, g: f32, b: f32| Reflectance::Constant(Rgb::new(r, g, b));
    let rough = |distribution, alpha, fresnel| {
        let (alpha, scale) = (Roughness::Constant(alpha), constant(0.7, 0.9, 0.5));
        Some(Lobe::Rough { distribution, alpha, fresnel, scale })
    };
    let gold = Fresnel::Conductor { eta: Rgb::new(0.14, 0.37, 1.44), k: Rgb::new(3.98, 2.39, 1.6) };
    let (ggx, beckmann) = (Distribution::Ggx, Distribution::Beckmann);
    let mut materials = Vec::new();
    let mut add = |two_sided, diffuse, coat, lobe: Option<Lobe>| {
        let name = format!("{}", materials.len());
        let lobes = Vec::from_iter(lobe);
        materials.push(Material { name, two_sided, diffuse, coat, lobes, ..Material::default() });
    };
    let coat = Some(Coat { eta: 1.5, nonlinear: true });
    let (grey, black) = (constant(0.5, 0.4, 0.8), constant(0.0, 0.0, 0.0));
    add(true, grey, None, None);
    add(false, grey, None, None);
    for alpha in [0.02, 0.1, 0.3, 0.8] {
        add(true, grey, None, rough(ggx, alpha, Fresnel::One));
        add(false, black, None, rough(ggx, alpha, gold));
        add(true, grey, None, rough(beckmann, alpha, Fresnel::Dielectric(1.5)));
        add(true, grey, coat, rough(ggx, alpha, Fresnel::Dielectric(1.5)));
    }
    let mirror = |fresnel| Some(Lobe::Mirror { fresnel, scale: constant(1.0, 1.0, 1.0) });
    add(true, grey, coat, mirror(Fresnel::Dielectric(1.5)));
    add(true, black, None, mirror(Fresnel::One));
    Scene { materials, ..Scene::default() }
}

/// Makes VPLs in a few groups of very different size, some flat as walls, some with equal normals.
fn grouped(n: usize, kind: VplKind, scale: f32, numbers: &mut RandomNumbers) -> VplSet {
    let mut set = VplSet::new(kind, Origin::Indirect);
    while set.len() < n {
        let (centre, axis) = (numbers.vec3(), numbers.direction());
        let size = 10f32.powf(-4.0 * numbers.next());
        let spread = numbers.next() * numbers.next() * 2.0;
        let flat = if numbers.next() < 0.5 { Vec3::ONE - Vec3::Y } else { Vec3::ONE };
        for _ in 0..12 {
            let position = (centre + numbers.direction() * size * flat) * scale;
            let direction = (axis + numbers.direction() * spread).try_normalize().unwrap_or(axis);
            let vpl = match kind {
                VplKind::Omni if numbers.next() < 0.5 => Vpl::spot(position, 0),
                VplKind::Omni => Vpl::omni(position),
                VplKind::Oriented => Vpl::oriented(position, direction),
                VplKind::Directional => Vpl::directional(direction),
                VplKind::Lobed => Vpl::lobed(position, (numbers.next() * 36.0) as u32),
            };
            set.push(vpl, numbers.vec3() + 0.05);
        }
    }
    set
}

/// Makes profiles of one spot light and of 36 lobes of metals and mirrors of all roughness.
pub fn profiles() -> Profiles {
    let scene = all_materials();
    let materials = Materials::new(&scene);
    let mut numbers = RandomNumbers(7);
    let mut lobes = Vec::new();
    while lobes.len() < 36 {
        let id = MaterialId((numbers.next() * scene.materials.len() as f32) as u32);
        let frame = Frame::from_normal(numbers.direction());
        let towards_light = numbers.direction();
        let wi = frame.to_local(towards_light);
        let bsdf = materials.at(id, Vec2::ZERO);
        let normal = frame.normal * wi.z.signum();
        lobes.extend(bsdf.reflected_lobes(wi).map(|lobe| LobeProfile {
            normal,
            towards_light,
            shape: lobe.shape,
            peak: lobe.peak,
        }));
    }
    let spot = SpotProfile::Cone { direction: Vec3::Y, inner_angle: 0.4, outer_angle: 1.0 };
    Profiles { spots: vec![spot], lobes }
}

pub fn all_kinds(n: usize, scale: f32, numbers: &mut RandomNumbers) -> Vec<VplSet> {
    let kinds = [VplKind::Omni, VplKind::Oriented, VplKind::Directional, VplKind::Lobed];
    kinds.map(|k| grouped(n, k, scale, numbers)).into()
}

pub fn random_receiver<'m>(
    materials: &'m Materials,
    scene: &Scene,
    scale: f32,
    n: &mut RandomNumbers,
) -> Receiver<'m> {
    let id = MaterialId((n.next() * scene.materials.len() as f32) as u32);
    let normal = n.direction();
    let geometric = (normal + n.direction() * 0.2).normalize();
    let bsdf = materials.at(id, Vec2::ZERO);
    Receiver::new(n.vec3() * scale, geometric, &Frame::from_normal(normal), bsdf, n.direction())
}

pub fn members(trees: &LightTrees, id: u32, found: &mut Vec<usize>) {
    let node = &trees.nodes[id as usize];
    match node.children() {
        None => found.push(node.representative()),
        Some(left) => (left..left + 2).for_each(|child| members(trees, child, found)),
    }
}

/// A ball that casts shadows.
pub struct Ball {
    pub centre: Vec3,
    pub radius: f32,
}

impl Visibility for Ball {
    fn visible16(&self, rays: &Rays16, lanes: u16, _: Option<u32>) -> u16 {
        let is_free = |&lane: &usize| {
            let ray = rays.get(lane);
            let along = (self.centre - ray.origin).dot(ray.direction) / ray.direction.length_squared();
            (ray.origin + ray.direction * along.clamp(0.0, ray.t_far) - self.centre).length() > self.radius
        };
        lanes_in(lanes).filter(is_free).fold(0, |mask, lane| mask | 1 << lane)
    }
}

/// The inside of a box: VPLs on its six walls, facing inwards.
pub fn room(n: usize, numbers: &mut RandomNumbers) -> VplSet {
    let mut set = VplSet::new(VplKind::Oriented, Origin::Indirect);
    for i in 0..n {
        let axis = i % 3;
        let side = if i / 3 % 2 == 0 { 0.0 } else { 1.0 };
        let mut position = numbers.vec3();
        position[axis] = side;
        let mut normal = Vec3::ZERO;
        normal[axis] = 1.0 - 2.0 * side;
        set.push(Vpl::oriented(position, normal), numbers.vec3() * numbers.next());
    }
    set
}

pub fn rms(errors: &[f32]) -> f32 {
    (errors.iter().map(|e| e * e).sum::<f32>() / errors.len() as f32).sqrt()
}

pub const EXACT: CutSettings = CutSettings { epsilon: 0.02, max_cut: usize::MAX, clamp: None, origin: None };

/// Points a millimetre to a decimetre above the floor of a room of VPLs, some of which are that near.
pub fn points_near_vpls(numbers: &mut RandomNumbers, count: usize) -> Vec<Receiver<'static>> {
    let frame = Frame::from_normal(Vec3::Y);
    let at = |numbers: &mut RandomNumbers| {
        let p = numbers.vec3() * 0.9 + 0.05;
        Receiver::irradiance(p.with_y(0.1f32.powf(1.0 + 2.0 * p.y)), Vec3::Y, &frame)
    };
    (0..count).map(|_| at(numbers)).collect()
}

/// A room whose floor is covered by lamps, a hand's breadth above it and shining down.
pub fn low_lamps(numbers: &mut RandomNumbers) -> LightTrees {
    let mut set = room(3000, numbers);
    for _ in 0..300 {
        let position = numbers.vec3().with_y(0.05 + 0.05 * numbers.next());
        set.push(Vpl::oriented(position, -Vec3::Y), numbers.vec3());
    }
    LightTrees::build(&[set], Vec::new(), 1.7, &Control::new())
}

/// A scene without surfaces, in which everything is visible.
#[derive(Clone, Copy, Debug)]
pub struct Unoccluded;

impl Visibility for Unoccluded {
    #[inline]
    fn visible16(&self, _: &Rays16, lanes: u16, _: Option<u32>) -> u16 {
        lanes
    }
}

/// Returns a packet of one point.
pub fn alone<'m>(receiver: Receiver<'m>) -> ReceiverPacket<'m> {
    let mut packet = ReceiverPacket::new();
    packet.set([receiver]);
    packet
}

/// Gathers the light of all VPLs at `receiver`, without clamping.
pub fn gather_all<V: Visibility>(transfer: &Transfer, visibility: &V, receiver: &Receiver) -> Rgb {
    let [x, normal] = [receiver.position(), receiver.geometric_normal()].map(V3::<f32>::splat);
    let (mut rays, mut sum) = (Rays16::default(), DVec3::ZERO);
    for leaf in transfer.trees.leaves() {
        let (vpl, before) = transfer.trees.representative(leaf);
        let contribution = leaf.intensity * transfer.unshadowed(receiver, vpl, leaf.kind());
        rays.set(0, &to_vpl(x, normal, vpl, leaf.kind()).into());
        if contribution != Rgb::ZERO && visibility.visible16(&rays, 1, None) != 0 {
            let mut light = Vec3x16::splat(contribution);
            visibility.attenuate(&rays, 1, |_| receiver.sheets(before), &mut light);
            sum += light.get(0).as_dvec3();
        }
    }
    sum.as_vec3()
}
