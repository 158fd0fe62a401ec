//! Records kept from frame to frame of a walk-through.
//!
//! Paper: Herzog et al. 2009, section 6.4: records of the frames before are splatted first, and new ones are computed
//! only where none reaches.
//!
//! The minimum radius of a footprint, in spacings of eye samples, is that of the frame it was made for. As the camera
//! comes closer, the spacing falls, and radii that were raised to the minimum follow it down, to those that accuracy
//! asks for. As the camera goes away, radii stay, since there are records enough; those whose footprints fall between
//! eye samples rest until the camera comes back. The maximum radius bounds extrapolation, which does not depend on the
//! view, and is not applied anew.
//!
//! Deviations: the paper says neither when records go nor how their radii follow the camera. Here they go after a
//! number of frames in which none of their light was near a point seen, and the longest unused first where memory is
//! short.

use super::fill::CacheFrame;
use super::record::Record;
use super::settings::CacheSettings;
use super::source::NewRecord;
use super::store::Records;
use crate::hsh::Radiance;
use crate::lights::{DirectIndirect, Origin};
use crate::perception::Q_SCALE;
use base::stats::Stats;
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::mem;

/// Minimum cosine between normal and direction to the eye that foreshortens; as that of eye samples.
const MIN_COS: f32 = 0.05;

/// Longer radius, in minimum radii, below which a record rests.
const RESTS_BELOW: f32 = 0.5;

/// Bounds of what a walk keeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeepLimits {
    /// Maximum number of frames for which a record is kept unused.
    pub idle_frames: u32,
    /// Maximum number of bytes of all records between frames.
    pub bytes: u64,
    /// True if drawn light is carried over from the picture before (see [`crate::reprojection`]).
    pub reprojects: bool,
    /// Quantisation scale of the differences that are seen (see [`crate::perception`]); `None` for Weber's everywhere.
    pub q_scale: Option<f32>,
}

/// By default a gibibyte, a second or two of film, and differences that are seen.
impl Default for KeepLimits {
    fn default() -> KeepLimits {
        KeepLimits { idle_frames: 48, bytes: 1 << 30, reprojects: true, q_scale: Some(Q_SCALE) }
    }
}

/// Records of a walk-through.
#[derive(Default)]
pub struct KeptRecords {
    limits: KeepLimits,
    /// Frames begun.
    frame: u32,
    /// All records between frames, those that rest during one.
    kept: DirectIndirect<Vec<Kept>>,
    /// Uses of the records that light the frame, as far as they are older than it.
    older: DirectIndirect<Vec<Use>>,
    /// Records that light the frame.
    records: Records,
}

/// A record between frames.
#[derive(Serialize, Deserialize)]
struct Kept {
    record: Record,
    series: Option<Radiance>,
    usage: Use,
}

/// History of a record.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Use {
    /// Frame that it was last near a point seen.
    last: u32,
    /// Spacing of eye samples at the record over its apparent distance.
    spacing_by_distance: f32,
}

impl KeptRecords {
    /// None yet.
    pub fn new(limits: KeepLimits) -> KeptRecords {
        KeptRecords { limits, ..KeptRecords::default() }
    }

    /// Records as they were when [`KeptRecords::save`] returned these bytes; `None` if it did not.
    pub fn restored(limits: KeepLimits, saved: &[u8]) -> Option<KeptRecords> {
        let ((frame, kept), rest): ((u32, DirectIndirect<Vec<Kept>>), _) =
            postcard::take_from_bytes(saved).ok()?;
        let mut all = kept.direct.iter().chain(&kept.indirect);
        let is_sound = rest.is_empty() && frame < u32::MAX && all.all(|kept| kept.is_sound(frame));
        is_sound.then(|| KeptRecords { limits, frame, kept, ..KeptRecords::default() })
    }

    /// The records between frames as bytes, for this version of the program.
    pub fn save(&self) -> Vec<u8> {
        // Records are plain numbers, which cannot fail to be written; without bytes there would be none to restore.
        postcard::to_stdvec(&(self.frame, &self.kept)).unwrap_or_default()
    }

    /// Begins a frame seen from `eye`; returns the records that may light it.
    pub fn begin(&mut self, eye: Vec3, settings: &CacheSettings) -> &mut Records {
        self.frame += 1;
        for origin in Origin::ALL {
            let least_in_spacings = settings.reach[origin as usize][0];
            for mut kept in mem::take(&mut self.kept[origin]) {
                let spacing = kept.usage.spacing_by_distance * apparent_distance(&kept.record, eye);
                let footprint = &mut kept.record.footprint;
                footprint.lower(least_in_spacings * spacing);
                if footprint.max_radius() < RESTS_BELOW * least_in_spacings * spacing {
                    self.kept[origin].push(kept);
                    continue;
                }
                let Kept { record, series, usage } = kept;
                self.older[origin].push(usage);
                self.records[origin].push(NewRecord { origin, sample: 0, record, series });
            }
        }
        &mut self.records
    }

    /// Ends the frame, which `frame` has lit: records grow older, and those beyond the limits go.
    pub fn end(&mut self, frame: &CacheFrame, eye: Vec3, stats: &mut Stats) {
        let mut added = 0;
        for origin in Origin::ALL {
            let mut usages = mem::take(&mut self.older[origin]);
            for &id in frame.splats[origin].lists.iter().flatten() {
                if let Some(usage) = usages.get_mut(id as usize) {
                    usage.last = self.frame;
                }
            }
            let records = self.records[origin].drain();
            let mut placed = frame.placed[origin].iter();
            for (id, (record, series)) in records.enumerate() {
                let usage = match usages.get(id) {
                    Some(usage) => *usage,
                    None => {
                        let sample = placed.next().map_or(0, |sample| *sample as usize);
                        let spacing = frame.targets.points.geometry.get(sample).map_or(0.0, |p| p.spacing);
                        let spacing_by_distance = spacing / apparent_distance(&record, eye);
                        Use { last: self.frame, spacing_by_distance }
                    }
                };
                self.kept[origin].push(Kept { record, series, usage });
            }
            added += frame.placed[origin].len();
        }
        let [idle, over] = self.evict();
        stats.count("Walk/new records", added as u64);
        stats.count("Walk/records kept", self.count() as u64);
        stats.count("Walk/bytes kept", self.bytes());
        stats.count("Walk/records evicted, idle", idle as u64);
        stats.count("Walk/records evicted for memory", over as u64);
    }

    /// Drops records that were unused for too long, and the longest unused ones beyond the bytes allowed; returns the
    /// numbers of both.
    fn evict(&mut self) -> [usize; 2] {
        let before = self.count();
        let KeepLimits { idle_frames, bytes, .. } = self.limits;
        let is_idle = |kept: &Kept| self.frame - kept.usage.last > idle_frames;
        for origin in Origin::ALL {
            self.kept[origin].retain(|kept| !is_idle(kept));
        }
        let left = self.count();
        let mut excess = self.bytes().saturating_sub(bytes);
        if excess > 0 {
            // The oldest use goes first, direct light before indirect, in the order of making.
            let mut order: Vec<(u32, Origin, usize)> = Vec::with_capacity(left);
            for origin in Origin::ALL {
                order.extend(self.kept[origin].iter().enumerate().map(|(i, k)| (k.usage.last, origin, i)));
            }
            order.sort_by_key(|&(last, origin, i)| (last, origin as usize, i));
            let mut goes = self.kept.as_ref().map(|kept| vec![false; kept.len()]);
            for (_, origin, i) in order {
                if excess == 0 {
                    break;
                }
                goes[origin][i] = true;
                excess = excess.saturating_sub(self.kept[origin][i].bytes());
            }
            for origin in Origin::ALL {
                let mut goes = goes[origin].iter();
                self.kept[origin].retain(|_| !goes.next().is_some_and(|goes| *goes));
            }
        }
        [before - left, left - self.count()]
    }

    fn count(&self) -> usize {
        self.kept.direct.len() + self.kept.indirect.len()
    }

    fn bytes(&self) -> u64 {
        self.kept.direct.iter().chain(&self.kept.indirect).map(Kept::bytes).sum()
    }
}

impl Kept {
    /// True if it can be a record after that frame, as it is unless it was read from damaged bytes.
    fn is_sound(&self, frame: u32) -> bool {
        self.usage.last <= frame && self.series.as_ref().is_none_or(Radiance::is_sound)
    }

    fn bytes(&self) -> u64 {
        (size_of::<Kept>() + self.series.as_ref().map_or(0, Radiance::bytes)) as u64
    }
}

/// Distance to which the spacing of eye samples at a record is proportional: that to the eye, foreshortened. Chains
/// through mirrors are longer, so that spacings are never taken for larger than they are as the camera moves.
fn apparent_distance(record: &Record, eye: Vec3) -> f32 {
    let to_eye = eye - record.position;
    let distance = to_eye.length();
    let cos = record.normal.dot(to_eye).abs() / distance.max(f32::MIN_POSITIVE);
    (distance / cos.max(MIN_COS).sqrt()).max(f32::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{Floor, record};
    use super::super::source::{Candidate, RecordSource};
    use super::*;
    use crate::lightcut::CutCounts;
    use base::math::Rgb;
    use base::progress::Control;
    use glam::Vec3;

    /// Records of constant indirect light whose radii are raised to the minimum.
    struct Constant(CacheSettings);

    impl RecordSource for Constant {
        fn settings(&self) -> &CacheSettings {
            &self.0
        }

        fn records(&self, candidates: &[Candidate]) -> (Vec<NewRecord>, CutCounts) {
            let made = candidates.iter().map(|candidate| {
                let radius = self.0.reach[1][0] * candidate.spacing;
                let mut record = record(candidate.point.position, [radius; 2], Rgb::ONE);
                record.footprint.unraised = [1e-3; 2];
                NewRecord { origin: Origin::Indirect, sample: candidate.sample, record, series: None }
            });
            (made.collect(), CutCounts::default())
        }
    }

    fn source() -> Constant {
        Constant(CacheSettings { least_cell: 1, ..CacheSettings::default() })
    }

    /// Lights a floor seen from `eye`; returns the number of new records.
    fn light(kept: &mut KeptRecords, floor: &Floor, eye: Vec3) -> usize {
        let source = source();
        let records = kept.begin(eye, &source.0);
        let before = records.indirect.records.len();
        let mut stats = Stats::new();
        let frame = CacheFrame::fill(floor.targets(), records, &source, &Control::new(), &mut stats);
        assert!(frame.splats.indirect.sums.iter().all(|sum| sum.weight > 0.0));
        let after = records.indirect.records.len();
        kept.end(&frame, eye, &mut stats);
        assert_eq!(stats.get("Walk/new records"), Some(base::stats::Counter::Count((after - before) as u64)));
        after - before
    }

    /// A floor like another, its eye samples `scale` times as far apart.
    fn seen_from(floor: &Floor, scale: f32) -> Floor {
        let mut floor = Floor::new(&floor.points.geometry.iter().map(|p| p.position).collect::<Vec<_>>());
        floor.points.geometry.iter_mut().for_each(|point| point.spacing *= scale);
        floor
    }

    /// Two floors that are 50 apart.
    fn floors() -> [Floor; 2] {
        let grid = Floor::grid(16);
        [0.0, 50.0].map(|x| {
            let moved = grid.points.geometry.iter().map(|p| p.position + Vec3::X * x);
            Floor::new(&moved.collect::<Vec<_>>())
        })
    }

    const ABOVE: Vec3 = Vec3::new(0.5, 0.5, 4.0);

    #[test]
    fn a_frame_like_the_last_needs_no_new_records() {
        let floor = Floor::grid(32);
        let mut kept = KeptRecords::new(KeepLimits::default());
        assert!(light(&mut kept, &floor, ABOVE) > 10);
        assert_eq!(light(&mut kept, &floor, ABOVE), 0);
    }

    #[test]
    fn records_restored_are_those_saved_and_damaged_bytes_are_refused() {
        let floor = Floor::grid(32);
        let mut kept = KeptRecords::new(KeepLimits::default());
        light(&mut kept, &floor, ABOVE);
        kept.kept.indirect[3].series = Some(Radiance::black(3));
        let saved = kept.save();
        let mut restored = KeptRecords::restored(KeepLimits::default(), &saved).unwrap();
        assert_eq!(restored.save(), saved);
        assert_eq!(light(&mut restored, &floor, ABOVE), 0);
        for length in [0, 1, saved.len() / 2, saved.len() - 1] {
            assert!(KeptRecords::restored(KeepLimits::default(), &saved[..length]).is_none());
        }
        assert!(KeptRecords::restored(KeepLimits::default(), &[&saved[..], &[0]].concat()).is_none());
        // Damage that the file's hash does not show: uses after the last frame.
        kept.kept.indirect[0].usage.last = kept.frame + 1;
        assert!(KeptRecords::restored(KeepLimits::default(), &kept.save()).is_none());
        kept.frame = u32::MAX;
        assert!(KeptRecords::restored(KeepLimits::default(), &kept.save()).is_none());
    }

    #[test]
    fn footprints_follow_the_camera_nearer_and_rest_as_it_goes_far() {
        let floor = Floor::grid(32);
        let mut kept = KeptRecords::new(KeepLimits::default());
        light(&mut kept, &floor, ABOVE);
        let all = kept.count();
        let radius = |kept: &KeptRecords| kept.kept.indirect[0].record.footprint.max_radius();
        let first = radius(&kept);
        // Twice as near: spacings and the radii raised to a minimum are halved, and new records fill the holes.
        let nearer = light(&mut kept, &seen_from(&floor, 0.5), Vec3::new(0.5, 0.5, 2.0));
        let ratio = radius(&kept) / first;
        assert!(nearer > all && (0.45..0.56).contains(&ratio), "{nearer} {ratio}");
        // Back again: radii stay as they are, which is enough.
        assert_eq!(light(&mut kept, &floor, ABOVE), 0);
        assert_eq!(radius(&kept) / first, ratio);
        // Eight times as far away, all rest and none is lost.
        let before = kept.count();
        let far = light(&mut kept, &seen_from(&floor, 8.0), Vec3::new(0.5, 0.5, 32.0));
        assert!(far > 0 && kept.count() == before + far);
        assert_eq!(kept.begin(Vec3::new(0.5, 0.5, 32.0), &source().0).indirect.records.len(), far);
    }

    #[test]
    fn records_unused_for_too_many_frames_go() {
        let [floor, elsewhere] = floors();
        let mut kept = KeptRecords::new(KeepLimits { idle_frames: 2, ..KeepLimits::default() });
        let many = light(&mut kept, &floor, ABOVE);
        let mut counts = Vec::new();
        for _ in 0..4 {
            light(&mut kept, &elsewhere, ABOVE + Vec3::X * 50.0);
            counts.push(kept.count());
        }
        assert_eq!(counts, [2 * many, 2 * many, many, many]);
    }

    #[test]
    fn memory_stays_below_the_limit_and_the_longest_unused_go_first() {
        let floors = floors();
        let mut kept = KeptRecords::new(KeepLimits::default());
        let many = light(&mut kept, &floors[0], ABOVE);
        kept.limits.bytes = kept.bytes() + kept.bytes() / 4;
        light(&mut kept, &floors[1], ABOVE + Vec3::X * 50.0);
        assert!(kept.bytes() <= kept.limits.bytes && kept.count() > many);
        let left = |kept: &KeptRecords, x: f32| {
            kept.kept.indirect.iter().filter(|k| (k.record.position.x - x).abs() < 25.0).count()
        };
        assert!(left(&kept, 50.0) == many && left(&kept, 0.0) > 0);
        kept.limits.bytes = 0;
        light(&mut kept, &floors[1], ABOVE + Vec3::X * 50.0);
        assert_eq!(kept.count(), 0);
    }
}
