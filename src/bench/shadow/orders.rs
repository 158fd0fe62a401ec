//! The refinements of the methods, over stretches of a scene's eye samples, with any visibility.
//!
//! Lightcuts per pixel; the cache's eye samples with direct light by reconstruction cuts; and its records, of
//! indirect light. All in the order of the method, each point by itself or neighbours together.
//!
//! Records are those of the first wave of the finest level, as if there were no coarser ones: its records are
//! as close together as any.

use crate::setting::Setting;
use base::math::{Rgb, luminance};
use transport::lightcut::{
    CutSettings, Lightcut, MIN_SHARED, PacketLightcut, PacketVisibility, RayVisibility, Receiver,
    ReceiverPacket, Visibility,
};
use transport::lights::{DirectIndirect, Origin};
use transport::radiance_cache::CacheSettings;
use transport::radiance_cache::candidate::Candidate;
use transport::radiance_cache::placement::{CandidateStep, candidates};
use transport::radiance_cache::source::LightcutSource;
use transport::radiance_cache::splat::Splat;
use transport::radiance_cache::store::RecordStore;
use transport::radiance_cache::targets::Targets;
use transport::shade::{Gatherers, ShadeSettings, ShadingContext, ShadingTask, patches};

/// Points that are lit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Pixels, by lightcuts.
    Pixels,
    /// Eye samples of the cache, by direct light.
    Samples,
    /// Records of the cache, by indirect light.
    Records,
}

impl Order {
    /// All.
    pub const ALL: [Order; 3] = [Order::Pixels, Order::Samples, Order::Records];

    /// Names with cuts of single points, and with shared ones.
    pub fn names(self) -> [&'static str; 2] {
        match self {
            Order::Pixels => ["pixels, alone", "pixels, shared"],
            Order::Samples => ["samples, alone", "samples, shared"],
            Order::Records => ["records, alone", "records, shared"],
        }
    }
}

/// All orders of a scene.
pub struct Orders<'s> {
    setting: &'s Setting<'s>,
    cache: &'s CacheSettings,
    stretches: Vec<Vec<usize>>,
    tasks: Vec<Vec<ShadingTask>>,
    candidates: Vec<Vec<Candidate>>,
}

impl<'s> Orders<'s> {
    pub fn new(setting: &'s Setting<'s>, cache: &'s CacheSettings) -> Orders<'s> {
        let stretches = setting.pixels();
        let mut single = Lightcut::new();
        let mut tasks = Vec::new();
        for stretch in &stretches {
            let job = |&sample: &usize| {
                // The baseline luminance of a record.
                let cut = CutSettings { origin: Some(Origin::Indirect), ..CutSettings::default() };
                let (transfer, reflector) = (setting.transfer(), setting.reflector(sample));
                let indirect = single.gather(&transfer, setting.world, &reflector, &cut).radiance;
                let baseline_luminance = luminance(indirect);
                let all = ShadingTask::all(sample as u32);
                ShadingTask { origin: Some(Origin::Direct), baseline_luminance, ..all }
            };
            tasks.push(stretch.iter().map(job).collect());
        }
        let samples = &setting.samples;
        let least = cache.least_cell.max(1) as usize;
        let level = (samples.len() / least).checked_ilog2().unwrap_or(0);
        let targets = Targets::new(&samples.points, &samples.index, None);
        let splats = DirectIndirect::from_fn(|_| Splat::new(&targets, &RecordStore::default()));
        let cached = DirectIndirect { direct: false, indirect: true };
        let all = candidates(&targets, &splats, cached, cache.farthest(), CandidateStep { level, parity: 0 });
        let candidates = setting.spread(all.len()).into_iter().map(|s| all[s].to_vec()).collect();
        Orders { setting, cache, stretches, tasks, candidates }
    }

    /// Number of stretches.
    pub fn chunks(&self) -> usize {
        self.stretches.len()
    }

    /// Number of points to be lit.
    pub fn points(&self, order: Order) -> usize {
        match order {
            Order::Pixels | Order::Samples => self.stretches.iter().map(Vec::len).sum(),
            Order::Records => self.candidates.iter().map(Vec::len).sum(),
        }
    }

    /// Shades the points of a stretch. Returns the sum of the reflected radiance.
    pub fn light<V>(&self, order: Order, chunk: usize, shared: bool, rays: &V) -> Rgb
    where
        V: Visibility + PacketVisibility + RayVisibility,
    {
        let setting = self.setting;
        match order {
            Order::Pixels => {
                let groups = setting.groups(&self.stretches[chunk]);
                let surface = |&sample: &usize| setting.reflector(sample);
                self.cut(&groups, surface, shared, &CutSettings::default(), rays)
            }
            Order::Records => {
                let cut = CutSettings { origin: Some(Origin::Indirect), ..self.cache.cut };
                let groups = self.source().groups(&self.candidates[chunk]);
                self.cut(&groups, Candidate::receiver, shared, &cut, rays)
            }
            Order::Samples => {
                let settings = ShadeSettings {
                    cut: CutSettings::default(),
                    share: shared,
                    samples: None,
                    shadows: self.cache.shadows,
                };
                let context = self.context();
                let points = &setting.samples.points;
                let (mut gatherers, mut sum) = (Gatherers::default(), Rgb::ZERO);
                for patch in patches(points, &self.tasks[chunk], self.cache.patches, setting.world.diagonal) {
                    gatherers.shade(&context, rays, points, &patch, &settings, |_, s| sum += s.radiance);
                }
                sum
            }
        }
    }

    fn context(&self) -> ShadingContext<'_> {
        ShadingContext { world: self.setting.world, transfer: self.setting.transfer(), compensation: None }
    }

    fn source(&self) -> LightcutSource<'_> {
        LightcutSource { context: self.context(), settings: self.cache }
    }

    fn cut<'m, T, V: Visibility + PacketVisibility>(
        &self,
        groups: &[Vec<T>],
        reflector: impl Fn(&T) -> Receiver<'m>,
        shared: bool,
        cut: &CutSettings,
        rays: &V,
    ) -> Rgb {
        let transfer = self.setting.transfer();
        let (mut single, mut group, mut points) =
            (Lightcut::new(), PacketLightcut::new(), ReceiverPacket::new());
        let mut sum = Rgb::ZERO;
        for members in groups {
            if !shared || members.len() < MIN_SHARED {
                for point in members {
                    sum += single.gather(&transfer, rays, &reflector(point), cut).radiance;
                }
            } else {
                points.set(members.iter().map(&reflector));
                let radiance = group.gather(&transfer, rays, &points, cut).sum.radiance;
                sum = radiance.into_iter().fold(sum, |sum, r| sum + r);
            }
        }
        sum
    }
}
