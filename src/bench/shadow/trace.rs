//! Shadow rays as the renderer's cuts ask for them, recorded to be traced again.

use crate::lit_scene::LitScene;
use base::math::{LANES, lanes_in};
use embree::{Ray, Rays16};
use std::cell::RefCell;
use transport::lightcut::{CutSettings, Lightcut, Receiver, ReceiverPacket, Visibility};
use transport::lights::Origin;
use transport::radiance_cache::{CLAMP, CacheSettings, MAX_CUT};

/// Points that cuts light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Pixels of lightcuts.
    Pixels,
    /// Irradiance at the spacing of the finest cache records, from indirect virtual lights.
    Records,
}

/// Up to sixteen shadow rays.
#[derive(Clone)]
pub struct SegmentPacket {
    /// True if the rays run from neighbouring points to one light.
    pub neighbours: bool,
    pub rays: Rays16,
    pub valid: u16,
    /// Key of each ray's light.
    pub keys: [u32; LANES],
}

/// Shadow rays in the order of their queries.
pub struct Trace {
    pub name: &'static str,
    /// True if neighbouring points share cuts, so that most packets run from these to one light.
    pub shared: bool,
    /// Packets by stretch of work, at whose end an occluder cache is cleared.
    pub chunks: Vec<Vec<SegmentPacket>>,
}

impl Trace {
    /// Records the rays of both orders, with a cut per point and with shared cuts.
    pub fn all(lit: &LitScene) -> Vec<Trace> {
        let record = |(name, order, shared)| Trace {
            name,
            shared,
            chunks: stretches(lit, order).iter().map(|points| chunk(lit, order, points, shared)).collect(),
        };
        let names = [
            ("pixels, alone", Order::Pixels, false),
            ("pixels, shared", Order::Pixels, true),
            ("records, alone", Order::Records, false),
            ("records, shared", Order::Records, true),
        ];
        names.into_iter().map(record).filter(|trace| trace.rays() > 0).collect()
    }

    /// Returns the packets in order; of shared cuts, without the single rays of points that share with no other.
    pub fn packets(&self) -> impl Iterator<Item = &SegmentPacket> {
        self.chunks.iter().flatten().filter(|p| p.neighbours == self.shared)
    }

    /// Returns the number of rays in [`Trace::packets`].
    pub fn rays(&self) -> u64 {
        self.packets().map(|p| u64::from(p.valid.count_ones())).sum()
    }
}

impl SegmentPacket {
    /// Returns the rays with the keys of their lights.
    pub fn singles(&self) -> impl Iterator<Item = (Ray, u32)> + '_ {
        lanes_in(self.valid).map(|lane| (self.rays.get(lane), self.keys[lane]))
    }
}

/// Returns stretches of eye samples that are neighbours in space.
fn stretches(lit: &LitScene, order: Order) -> Vec<Vec<usize>> {
    let step = match order {
        Order::Pixels => 1,
        Order::Records => CacheSettings::default().least_cell.max(1) as usize,
    };
    let samples: Vec<usize> = (0..lit.samples.len()).step_by(step).collect();
    lit.spread(samples.len()).into_iter().map(|stretch| samples[stretch].to_vec()).collect()
}

/// Records the rays of the cuts at some points.
fn chunk<'w>(lit: &LitScene<'w>, order: Order, points: &[usize], shared: bool) -> Vec<SegmentPacket> {
    let recorder = Recorder { lit, packer: RefCell::default() };
    let (transfer, mut lightcut) = (lit.transfer(), Lightcut::new());
    let (surface, irradiance) = (|point| lit.surface(point), |point| lit.irradiance(point));
    let (groups, cut, receiver): (_, _, &dyn Fn(usize) -> Receiver<'w>) = match order {
        Order::Pixels => (lit.groups(points), CutSettings::default(), &surface),
        Order::Records => {
            let CacheSettings { epsilon, .. } = CacheSettings::default();
            let cut = CutSettings { epsilon, max_cut: MAX_CUT, clamp: CLAMP, origin: Some(Origin::Indirect) };
            (lit.groups_of_records(points), cut, &irradiance)
        }
    };
    let mut packet = ReceiverPacket::new();
    for members in groups {
        for points in members.chunks(if shared { LANES } else { 1 }) {
            packet.set(points.iter().map(|&point| receiver(point)));
            lightcut.gather(&transfer, &recorder, &packet, &cut);
        }
    }
    let mut packer = recorder.packer.into_inner();
    packer.flush();
    packer.packets
}

/// Packets, the last of which takes single rays until it is full.
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

/// Visibility in the scene that records its queries.
struct Recorder<'a> {
    lit: &'a LitScene<'a>,
    packer: RefCell<Packer>,
}

impl Visibility for Recorder<'_> {
    fn visible16(&self, rays: &Rays16, lanes: u16, light: Option<u32>) -> u16 {
        let (accel, key) = (&self.lit.world.accel, light.unwrap_or(0));
        let mut packer = self.packer.borrow_mut();
        if lanes.is_power_of_two() {
            let ray = rays.get(lanes.trailing_zeros() as usize);
            packer.push(&ray, key);
            return if accel.occluded(&ray) { 0 } else { lanes };
        }
        packer.flush();
        let packet = SegmentPacket { neighbours: true, rays: rays.clone(), valid: lanes, keys: [key; LANES] };
        packer.packets.push(packet);
        lanes & !accel.occluded16(rays, lanes, true)
    }
}
