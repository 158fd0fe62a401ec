//! Segments as they are asked for, kept to be traced again.

use super::orders::{Order, Orders};
use crate::setting::{Dice, Setting};
use base::math::{LANES, Rgb, Vec3x16, first_lanes, lanes_in};
use embree::{Ray, Rays16};
use glam::Vec3;
use std::cell::RefCell;
use transport::lightcut::{PacketVisibility, RayVisibility, Receiver, ReceiverPacket, Visibility, to_vpl};
use transport::lights::{LightNode, Vpl};

/// Up to sixteen segments.
#[derive(Clone)]
pub struct SegmentPacket {
    /// True if they run from neighbouring points to one light.
    pub neighbours: bool,
    pub rays: Rays16,
    pub valid: u16,
    /// Key of the light that each runs to.
    pub keys: [u32; 16],
}

/// Segments in an order.
pub struct Trace {
    pub name: &'static str,
    /// True if most packets run from neighbouring points to one light.
    pub neighbours: bool,
    /// By stretches of work in which a cache lives.
    pub chunks: Vec<Vec<SegmentPacket>>,
    /// Number of receivers that they were asked for.
    pub points: usize,
}

impl Trace {
    /// All packets in order.
    pub fn packets(&self) -> impl Iterator<Item = &SegmentPacket> {
        self.chunks.iter().flatten()
    }

    /// Coherent packets, of shared cuts, without the rays of points that share with none.
    pub fn bundles(&self) -> impl Iterator<Item = &SegmentPacket> {
        self.packets().filter(|p| p.neighbours == self.neighbours)
    }

    /// Number of segments.
    pub fn rays(&self) -> u64 {
        count(self.packets())
    }
}

/// Number of segments that packets hold.
pub fn count<'a>(packets: impl IntoIterator<Item = &'a SegmentPacket>) -> u64 {
    packets.into_iter().map(|p| u64::from(p.valid.count_ones())).sum()
}

/// One trace of each kind.
pub struct Traces {
    /// Packings of lights drawn at random.
    pub drawn: [Trace; 3],
    /// Order of a point's own refinement, and of a shared one, of each of [`Order::ALL`].
    pub refined: [[Trace; 2]; 3],
}

impl Traces {
    pub fn record(setting: &Setting, orders: &Orders) -> Traces {
        Traces {
            drawn: [unrelated(setting), cluster(setting), neighbours(setting)],
            refined: Order::ALL.map(|order| refined(setting, orders, order)),
        }
    }

    pub fn all(&self) -> impl Iterator<Item = &Trace> {
        self.drawn.iter().chain(self.refined.iter().flatten())
    }

    /// Those of lightcuts per pixel.
    pub fn pixels(&self) -> &[Trace; 2] {
        &self.refined[0]
    }
}

/// Rays to lights one after the other, sixteen a packet.
#[derive(Default)]
struct Packer {
    packets: Vec<SegmentPacket>,
    last: Option<SegmentPacket>,
}

impl Packer {
    fn push(&mut self, ray: &Ray, key: u32) {
        let blank = || SegmentPacket { neighbours: false, rays: Rays16::default(), valid: 0, keys: [0; 16] };
        let packet = self.last.get_or_insert_with(blank);
        let lane = packet.valid.count_ones() as usize;
        packet.rays.set(lane, ray);
        packet.keys[lane] = key;
        packet.valid |= 1 << lane;
        if packet.valid == u16::MAX {
            self.flush();
        }
    }

    fn flush(&mut self) {
        self.packets.extend(self.last.take());
    }
}

/// The ray to a light, if its light would be reflected.
fn lit(setting: &Setting, reflector: &Receiver, leaf: &LightNode) -> Option<Ray> {
    let vpl = &setting.trees.vpls[leaf.representative()];
    let response = setting.transfer().unshadowed(reflector, vpl, leaf.kind());
    let (x, normal) = (reflector.position(), reflector.geometric_normal());
    (response != Rgb::ZERO).then(|| to_vpl(x, normal, vpl, leaf.kind()))
}

/// From each eye sample to lights that have nothing in common.
fn unrelated(setting: &Setting) -> Trace {
    let (leaves, mut dice) = (setting.leaves(), Dice(1));
    drawn(setting, "unrelated lights", |reflector, packer| {
        for _ in 0..32 {
            let Some(leaf) = leaves.get(dice.below(leaves.len())) else { return };
            if let Some(ray) = lit(setting, reflector, leaf) {
                packer.push(&ray, leaf.representative() as u32);
            }
        }
    })
}

/// From each eye sample to sixteen lights that are neighbours in their tree.
fn cluster(setting: &Setting) -> Trace {
    let (leaves, mut dice) = (setting.leaves(), Dice(2));
    drawn(setting, "a cluster's lights", |reflector, packer| {
        let first = dice.below(leaves.len().saturating_sub(LANES));
        for leaf in leaves.iter().skip(first).take(LANES) {
            if let Some(ray) = lit(setting, reflector, leaf) {
                packer.push(&ray, leaf.representative() as u32);
            }
        }
        packer.flush();
    })
}

/// Times that lights are drawn for each eye sample.
const DRAWS: usize = 16;

fn drawn(setting: &Setting, name: &'static str, mut draw: impl FnMut(&Receiver, &mut Packer)) -> Trace {
    let stretches = setting.pixels();
    let points = stretches.iter().map(Vec::len).sum();
    let chunk = |stretch: Vec<usize>| {
        let mut packer = Packer::default();
        for sample in stretch {
            let reflector = setting.reflector(sample);
            (0..DRAWS).for_each(|_| draw(&reflector, &mut packer));
        }
        packer.flush();
        packer.packets
    };
    let chunks = stretches.into_iter().map(chunk).collect();
    Trace { name, neighbours: false, chunks, points }
}

/// From groups of neighbouring eye samples to one light at a time.
fn neighbours(setting: &Setting) -> Trace {
    let (leaves, mut dice) = (setting.leaves(), Dice(3));
    let mut points = 0;
    let mut chunk = |stretch: Vec<usize>| {
        let mut packets = Vec::new();
        for group in setting.groups(&stretch) {
            points += group.len();
            let reflectors: Vec<Receiver> = group.iter().map(|&i| setting.reflector(i)).collect();
            for _ in 0..256 {
                let Some(leaf) = leaves.get(dice.below(leaves.len())) else { continue };
                let key = leaf.representative() as u32;
                let mut packet =
                    SegmentPacket { neighbours: true, rays: Rays16::default(), valid: 0, keys: [key; 16] };
                for (lane, reflector) in reflectors.iter().enumerate() {
                    if let Some(ray) = lit(setting, reflector, leaf) {
                        packet.rays.set(lane, &ray);
                        packet.valid |= 1 << lane;
                    }
                }
                if packet.valid != 0 {
                    packets.push(packet);
                }
            }
        }
        packets
    };
    let chunks = setting.pixels().into_iter().map(&mut chunk).collect();
    Trace { name: "neighbours, one light", neighbours: true, chunks, points }
}

/// Segments that cuts ask for: each point's own cut, and those that groups share.
fn refined(setting: &Setting, orders: &Orders, order: Order) -> [Trace; 2] {
    [false, true].map(|shared| {
        let chunk = |chunk| {
            let recorder = Recorder { setting, packer: RefCell::default() };
            orders.light(order, chunk, shared, &recorder);
            let mut packer = recorder.packer.into_inner();
            packer.flush();
            packer.packets
        };
        let chunks = (0..orders.chunks()).map(chunk).collect();
        let name = order.names()[usize::from(shared)];
        Trace { name, neighbours: shared, chunks, points: orders.points(order) }
    })
}

/// Visibility in the scene that records its queries.
struct Recorder<'a> {
    setting: &'a Setting<'a>,
    packer: RefCell<Packer>,
}

impl Visibility for Recorder<'_> {
    fn visible(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &LightNode) -> bool {
        let ray = to_vpl(x, normal, vpl, node.kind());
        self.packer.borrow_mut().push(&ray, node.representative() as u32);
        !self.setting.world.accel.occluded(&ray)
    }
}

impl PacketVisibility for Recorder<'_> {
    fn visible16(&self, points: &ReceiverPacket, lanes: u16, vpl: &Vpl, node: &LightNode) -> u16 {
        let rays = points.shadow_rays(vpl, node.kind());
        let seen = lanes & !self.setting.world.accel.occluded16(&rays, lanes, true);
        let key = node.representative() as u32;
        let packet = SegmentPacket { neighbours: true, rays, valid: lanes, keys: [key; 16] };
        let mut packer = self.packer.borrow_mut();
        packer.flush();
        packer.packets.push(packet);
        seen
    }
}

impl RayVisibility for Recorder<'_> {
    fn arriving16(&self, rays: &Rays16, count: usize, light: &mut Vec3x16) -> u16 {
        let packet =
            SegmentPacket { neighbours: true, rays: rays.clone(), valid: first_lanes(count), keys: [0; 16] };
        let mut packer = self.packer.borrow_mut();
        packer.flush();
        packer.packets.push(packet);
        self.setting.world.arriving16(rays, count, light)
    }
}

impl SegmentPacket {
    /// Its rays and their lights.
    pub fn singles(&self) -> impl Iterator<Item = (Ray, u32)> + '_ {
        lanes_in(self.valid).map(|lane| (self.rays.get(lane), self.keys[lane]))
    }
}
