//! Records retained from frame to frame of a walk-through.
//!
//! Paper: Herzog et al. 2009, section 6.4. Records of earlier frames are splatted first; new ones are computed only
//! where none reaches.
//!
//! The minimum radius of a footprint, in spacings of eye samples, is that of the frame it was made for. As the camera
//! approaches, the spacing falls. Radii that were raised to the minimum follow it down to the radii that accuracy
//! allows. As the camera recedes, radii stay, since there are enough records. Records whose footprints fall between
//! eye samples rest until the camera returns. The maximum radius bounds extrapolation, which does not depend on the
//! view, and is not applied again.
//!
//! Deviations: the paper does not say when records are dropped or how their radii follow the camera. Here a record is
//! dropped after a number of frames in which its footprint covered no visible point. If memory is short, the records
//! unused for longest are dropped first.

use super::fill::CacheFrame;
use super::record::{NewRecord, Record};
use super::settings::CacheSettings;
use super::store::Records;
use super::vantage::Vantage;
use crate::hsh::Radiance;
use crate::lights::{DirectIndirect, Origin};
use crate::perception::Q_SCALE;
use base::stats::Stats;
use serde::{Deserialize, Serialize};
use std::mem;

/// Longer radius, in minimum radii, below which a record rests.
const RESTING_RADIUS: f32 = 0.5;

/// Limits of the records that a walk retains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RetentionLimits {
    /// Maximum number of frames for which an unused record is retained.
    pub idle_frames: u32,
    /// Maximum size of all records between frames, in bytes.
    pub bytes: u64,
    /// True if sampled light is carried over from the previous image (see [`crate::reprojection`]).
    pub reprojects: bool,
    /// Quantisation scale of just visible differences (see [`crate::perception`]); `None` for Weber's law everywhere.
    pub q_scale: Option<f32>,
}

/// Defaults: one gibibyte, one to two seconds of film, and just visible differences.
impl Default for RetentionLimits {
    fn default() -> RetentionLimits {
        RetentionLimits { idle_frames: 48, bytes: 1 << 30, reprojects: true, q_scale: Some(Q_SCALE) }
    }
}

/// Records of a walk-through.
#[derive(Default)]
pub struct RetainedRecords {
    limits: RetentionLimits,
    /// Number of frames begun.
    frame: u32,
    /// All records between frames; during a frame, the resting ones.
    retained: DirectIndirect<Vec<RetainedRecord>>,
    /// Usage of the records that light the frame and are older than it.
    older: DirectIndirect<Vec<Use>>,
    /// Records that light the frame.
    records: Records,
}

/// Record between frames.
#[derive(Serialize, Deserialize)]
struct RetainedRecord {
    record: Record,
    series: Option<Radiance>,
    usage: Use,
}

/// Usage of a record.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Use {
    /// Last frame in which its footprint may have covered a visible point.
    last: u32,
    /// Spacing of eye samples at the record over [`Vantage::spacing`].
    relative_spacing: f32,
}

impl RetainedRecords {
    /// Returns an empty store.
    pub fn new(limits: RetentionLimits) -> RetainedRecords {
        RetainedRecords { limits, ..RetainedRecords::default() }
    }

    /// Restores the records from the bytes of [`RetainedRecords::save`]; returns `None` if the bytes are damaged.
    pub fn restored(limits: RetentionLimits, saved: &[u8]) -> Option<RetainedRecords> {
        let ((frame, retained), rest): ((u32, DirectIndirect<Vec<RetainedRecord>>), _) =
            postcard::take_from_bytes(saved).ok()?;
        let mut all = retained.direct.iter().chain(&retained.indirect);
        let is_sound = rest.is_empty() && frame < u32::MAX && all.all(|retained| retained.is_sound(frame));
        is_sound.then(|| RetainedRecords { limits, frame, retained, ..RetainedRecords::default() })
    }

    /// Returns the records between frames as bytes, which only this version of the program can restore.
    pub fn save(&self) -> Vec<u8> {
        // Records are plain numbers, whose serialisation cannot fail.
        postcard::to_stdvec(&(self.frame, &self.retained)).unwrap_or_default()
    }

    /// Begins a frame seen from `vantage`. Returns the records that may light it.
    pub fn begin(&mut self, vantage: &Vantage, settings: &CacheSettings) -> &mut Records {
        self.frame += 1;
        for origin in Origin::ALL {
            let least_in_spacings = settings.reach[origin as usize][0];
            for mut retained in mem::take(&mut self.retained[origin]) {
                let spacing = retained.usage.relative_spacing * vantage.spacing(&retained.record);
                let footprint = &mut retained.record.footprint;
                footprint.lower(least_in_spacings * spacing);
                if footprint.max_radius() < RESTING_RADIUS * least_in_spacings * spacing {
                    self.retained[origin].push(retained);
                    continue;
                }
                let RetainedRecord { record, series, usage } = retained;
                self.older[origin].push(usage);
                self.records[origin].push(NewRecord { origin, sample: 0, record, series });
            }
        }
        &mut self.records
    }

    /// Ends the frame that `frame` has lit: records age, and those beyond the limits are dropped.
    pub fn end(&mut self, frame: &CacheFrame, vantage: &Vantage, stats: &mut Stats) {
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
                        let relative_spacing = spacing / vantage.spacing(&record);
                        Use { last: self.frame, relative_spacing }
                    }
                };
                self.retained[origin].push(RetainedRecord { record, series, usage });
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

    /// Drops records that were idle for too long, and then those unused for longest until the size limit holds.
    /// Returns the numbers of both.
    fn evict(&mut self) -> [usize; 2] {
        let before = self.count();
        let RetentionLimits { idle_frames, bytes, .. } = self.limits;
        let is_idle = |retained: &RetainedRecord| self.frame - retained.usage.last > idle_frames;
        for origin in Origin::ALL {
            self.retained[origin].retain(|retained| !is_idle(retained));
        }
        let left = self.count();
        let mut excess = self.bytes().saturating_sub(bytes);
        if excess > 0 {
            // Order: by last use, direct light before indirect, then by creation.
            let mut order: Vec<(u32, Origin, usize)> = Vec::with_capacity(left);
            for origin in Origin::ALL {
                order
                    .extend(self.retained[origin].iter().enumerate().map(|(i, k)| (k.usage.last, origin, i)));
            }
            order.sort_by_key(|&(last, origin, i)| (last, origin as usize, i));
            let mut goes = self.retained.as_ref().map(|retained| vec![false; retained.len()]);
            for (_, origin, i) in order {
                if excess == 0 {
                    break;
                }
                goes[origin][i] = true;
                excess = excess.saturating_sub(self.retained[origin][i].bytes());
            }
            for origin in Origin::ALL {
                let mut goes = goes[origin].iter();
                self.retained[origin].retain(|_| !goes.next().is_some_and(|goes| *goes));
            }
        }
        [before - left, left - self.count()]
    }

    fn count(&self) -> usize {
        self.retained.direct.len() + self.retained.indirect.len()
    }

    fn bytes(&self) -> u64 {
        self.retained.direct.iter().chain(&self.retained.indirect).map(RetainedRecord::bytes).sum()
    }
}

impl RetainedRecord {
    /// Returns true if the record is possible after that frame. Only damaged bytes give others.
    fn is_sound(&self, frame: u32) -> bool {
        self.usage.last <= frame && self.series.as_ref().is_none_or(Radiance::is_sound)
    }

    fn bytes(&self) -> u64 {
        (size_of::<RetainedRecord>() + self.series.as_ref().map_or(0, Radiance::bytes)) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::super::cells::Candidate;
    use super::super::compute::RecordSource;
    use super::super::fixtures::{Floor, record};
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
    fn light(kept: &mut RetainedRecords, floor: &Floor, eye: Vec3) -> usize {
        let source = source();
        let records = kept.begin(&Vantage::at(eye), &source.0);
        let before = records.indirect.records.len();
        let mut stats = Stats::new();
        let frame = CacheFrame::fill(floor.targets(), records, &source, &Control::new(), &mut stats);
        assert!(frame.splats.indirect.sums.iter().all(|sum| sum.weight > 0.0));
        let after = records.indirect.records.len();
        kept.end(&frame, &Vantage::at(eye), &mut stats);
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
        let mut kept = RetainedRecords::new(RetentionLimits::default());
        assert!(light(&mut kept, &floor, ABOVE) > 10);
        assert_eq!(light(&mut kept, &floor, ABOVE), 0);
    }

    #[test]
    fn records_restored_are_those_saved_and_damaged_bytes_are_refused() {
        let floor = Floor::grid(32);
        let mut kept = RetainedRecords::new(RetentionLimits::default());
        light(&mut kept, &floor, ABOVE);
        kept.retained.indirect[3].series = Some(Radiance::black(3));
        let saved = kept.save();
        let mut restored = RetainedRecords::restored(RetentionLimits::default(), &saved).unwrap();
        assert_eq!(restored.save(), saved);
        assert_eq!(light(&mut restored, &floor, ABOVE), 0);
        for length in [0, 1, saved.len() / 2, saved.len() - 1] {
            assert!(RetainedRecords::restored(RetentionLimits::default(), &saved[..length]).is_none());
        }
        assert!(
            RetainedRecords::restored(RetentionLimits::default(), &[&saved[..], &[0]].concat()).is_none()
        );
        // Damage that the file's hash does not show: uses after the last frame.
        kept.retained.indirect[0].usage.last = kept.frame + 1;
        assert!(RetainedRecords::restored(RetentionLimits::default(), &kept.save()).is_none());
        kept.frame = u32::MAX;
        assert!(RetainedRecords::restored(RetentionLimits::default(), &kept.save()).is_none());
    }

    #[test]
    fn footprints_follow_the_camera_nearer_and_rest_as_it_goes_far() {
        let floor = Floor::grid(32);
        let mut kept = RetainedRecords::new(RetentionLimits::default());
        light(&mut kept, &floor, ABOVE);
        let all = kept.count();
        let radius = |kept: &RetainedRecords| kept.retained.indirect[0].record.footprint.max_radius();
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
        assert_eq!(
            kept.begin(&Vantage::at(Vec3::new(0.5, 0.5, 32.0)), &source().0).indirect.records.len(),
            far
        );
    }

    #[test]
    fn records_unused_for_too_many_frames_go() {
        let [floor, elsewhere] = floors();
        let mut kept = RetainedRecords::new(RetentionLimits { idle_frames: 2, ..RetentionLimits::default() });
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
        let mut kept = RetainedRecords::new(RetentionLimits::default());
        let many = light(&mut kept, &floors[0], ABOVE);
        kept.limits.bytes = kept.bytes() + kept.bytes() / 4;
        light(&mut kept, &floors[1], ABOVE + Vec3::X * 50.0);
        assert!(kept.bytes() <= kept.limits.bytes && kept.count() > many);
        let left = |kept: &RetainedRecords, x: f32| {
            kept.retained.indirect.iter().filter(|k| (k.record.position.x - x).abs() < 25.0).count()
        };
        assert!(left(&kept, 50.0) == many && left(&kept, 0.0) > 0);
        kept.limits.bytes = 0;
        light(&mut kept, &floors[1], ABOVE + Vec3::X * 50.0);
        assert_eq!(kept.count(), 0);
    }
}
