//! A shared cut lent to the points in between.
//!
//! Where the sixteen points of a group are spread over a patch of surface, points among them have nearly the same cut,
//! and what all sixteen see, or none of them, they most likely see too, or do not. So the cut is not refined again.
//! Each of its clusters is treated in one of three ways. Where its light is a smooth function of position at the
//! makers of the cut, it is interpolated (see [`fit`]). Where it is large, or not smooth, it is evaluated at every
//! point, with a shadow ray unless it is small and the makers agree. What is left, mostly small clusters that some
//! makers see and some do not, is interpolated too, and the error corrected at random: a cluster is evaluated with a
//! probability in proportion to its error, and the error found divided by the probability, so that the radiance is
//! right on average.
//!
//! Deviations: this is not part of any paper's lightcuts. It misses what small clusters light through a gap, and
//! what keeps their light away, if none of the makers is aware of it.

mod fit;

use crate::lightcut::packet::receivers::lanes_of;
use crate::lightcut::packet::refine::Entry;
use crate::lightcut::packet::transfer::luminances;
use crate::lightcut::packet::{LANES, Lanes, RgbLanes};
use crate::lightcut::{CutSettings, PacketLightcut, PacketVisibility, ReceiverPacket, Transfer};
use crate::math::{Rgb, luminance};
use crate::vpl::Origin;
use fit::{Fit, Share};

/// Least luminance of a maker where errors are judged, relative to the brightest.
const DARKEST: f32 = 1.0 / 16.0;

/// Largest correction of a point by one cluster drawn, relative to the luminance: an unlikely cluster that is much
/// brighter at the point than at any maker would be a firefly.
const LARGEST_CORRECTION: f32 = 0.5;

/// A cluster this many times as bright at a point as at any maker needs a shadow ray even if all makers see it, and is
/// split if it gives more than ε of the radiance: the makers were too far from it to know what it would look like.
const BRIGHTER: f32 = 2.0;

/// A cluster that gives more than this many times ε of the radiance is never taken for seen unless it is: the shadow of
/// something small is the more visible the more it takes.
const LARGE: f32 = 0.35;
/// A cluster that makers disagree about is drawn with certainty if its error, relative to the luminance, is this
/// many times ε ...
const CHANCE: f32 = 0.4;
/// ... where the error counts as at least this share of what the cluster gives.
const DOUBT: f32 = 0.2;
/// A cluster that all makers see is interpolated if its error, relative to what it gives, is at most this many times ε
/// over the root of what it gives, relative to the luminance: the larger the cluster, the less is tolerated.
const SMOOTH: f32 = 0.3;

/// A cluster that is evaluated at every point.
#[derive(Clone, Copy, Debug)]
struct Certain {
    node: u32,
    /// Luminance above which a point needs a shadow ray: 0 if the makers disagree about whether the cluster is seen.
    sure: f32,
    /// Luminance above which it is split.
    whole: f32,
}

/// A cluster that is evaluated by chance.
#[derive(Clone, Copy, Debug)]
struct Drawn {
    node: u32,
    probability: f32,
    /// What is interpolated of it.
    share: Share,
}

/// A cut and what its makers saw.
#[derive(Default)]
pub struct ReconstructionCut {
    certain: Vec<Certain>,
    drawn: Vec<Drawn>,
    fit: Fit,
    /// Tolerated error and clamp of the cut that was kept.
    epsilon: f32,
    clamp: Option<f32>,
    /// Mean luminance of the makers.
    brightness: f32,
    size: usize,
}

impl ReconstructionCut {
    /// Keeps the last cut of `group`, made for `points`, which reflect `radiance`, by `settings`.
    pub fn keep(
        &mut self,
        group: &PacketLightcut,
        transfer: &Transfer,
        points: &ReceiverPacket,
        radiance: &[Rgb; LANES],
        settings: &CutSettings,
    ) {
        let epsilon = settings.epsilon;
        let (certain_from, smooth_to) = (CHANCE * epsilon, SMOOTH * epsilon);
        let inverse_totals = inverse_totals(points, radiance);
        self.fit.begin(points);
        self.certain.clear();
        self.drawn.clear();
        self.size = group.size();
        (self.epsilon, self.clamp) = (epsilon, settings.clamp);
        self.brightness =
            lanes_of(points.valid).map(|l| points.known[l] + luminance(radiance[l])).sum::<f32>()
                / points.len().max(1) as f32;
        let least_split = epsilon * self.brightness;
        let mut unshadowed = [[0.0; LANES]; 3];
        for (node, responses) in group.entries() {
            let n = &transfer.trees.nodes[node as usize];
            let vpl = &transfer.trees.vpls[n.representative()];
            let lit = transfer.unshadowed16(points, vpl, n.kind(), &mut unshadowed);
            let reached = |&l: &usize| responses[0][l] + responses[1][l] + responses[2][l] > 0.0;
            if lit == 0 {
                // Below every maker's horizon, which says nothing about how much of it rises above another point's.
                self.certain.push(Certain { node, sure: 0.0, whole: least_split });
                continue;
            }
            let seen = lanes_of(lit).filter(reached).fold(0u16, |mask, lane| mask | 1 << lane);
            // If only a few of the makers are lit at all, little is known.
            let known = lit.count_ones() * 2 >= points.valid.count_ones();
            if known && seen == 0 {
                continue;
            }
            let y = luminances(n.intensity, &unshadowed);
            let share_of_luminance: f32 =
                lanes_of(lit).map(|l| y[l] * inverse_totals[l]).sum::<f32>() / points.len() as f32;
            let large = share_of_luminance > LARGE * epsilon;
            let doubtful = seen != lit || !known || large;
            let weak = n.is_leaf() && n.origin() == Origin::Indirect;
            let singular = large || weak && lanes_of(lit).any(|l| y[l] > 0.5 * group.limit(l));
            let share =
                if singular { None } else { self.fit.share(transfer, points, n, vpl, seen, responses) };
            // What is much brighter than at any maker is none of their business.
            let brighter = BRIGHTER * lanes_of(lit).map(|l| y[l]).fold(0.0, f32::max);
            let sure = if doubtful { 0.0 } else { brighter };
            let certain = Certain { node, sure, whole: brighter.max(least_split) };
            let Some((share, sums)) = share else {
                self.certain.push(certain);
                continue;
            };
            let error = self.fit.error(points, n, &sums, &inverse_totals);
            if !doubtful {
                if error * error <= smooth_to * smooth_to * share_of_luminance {
                    self.fit.add(n, &share);
                } else {
                    self.certain.push(certain);
                }
                continue;
            }
            let probability = error.max(DOUBT * share_of_luminance) / certain_from;
            if probability >= 1.0 {
                self.certain.push(certain);
            } else {
                self.fit.add(n, &share);
                self.drawn.push(Drawn { node, probability, share });
            }
        }
        // Neighbours in the tree are drawn in turn, so that what is drawn is spread over the lights.
        self.drawn.sort_unstable_by_key(|d| d.node);
    }

    /// Luminance of one correction at most: half of what is known of a point or its makers.
    fn limits(&self, known: &RgbLanes) -> Lanes {
        luminances(Rgb::ONE, known).map(|y| LARGEST_CORRECTION * y.max(self.brightness))
    }

    /// How many clusters.
    pub fn size(&self) -> usize {
        self.size
    }
}

/// Inverse of the luminance of each maker, as far as errors are judged by it.
fn inverse_totals(points: &ReceiverPacket, radiance: &[Rgb; LANES]) -> Lanes {
    let totals: Lanes = std::array::from_fn(|l| points.known[l] + luminance(radiance[l]));
    let brightest = lanes_of(points.valid).map(|l| totals[l]).fold(f32::MIN_POSITIVE, f32::max);
    totals.map(|total| 1.0 / total.max(DARKEST * brightest))
}

impl PacketLightcut {
    /// Reflected radiance of points among those that `cut` was made for; `start` (in [0, 1)) decides on what is left
    /// to chance.
    pub fn gather_lent<V: PacketVisibility>(
        &mut self,
        cut: &ReconstructionCut,
        transfer: &Transfer,
        visibility: &V,
        points: &ReceiverPacket,
        start: f32,
        radiance: &mut [Rgb; LANES],
    ) {
        const ZERO: Lanes = [0.0; LANES];
        let trees = transfer.trees;
        self.entries.clear();
        let at = cut.fit.at(points);
        // What is never clamped needs no second look.
        let mut strong = cut.fit.reflected(points, &at);
        let least_split = cut.epsilon * cut.brightness;
        let mut parts: Vec<Certain> = Vec::new();
        for &whole in &cut.certain {
            parts.push(whole);
            while let Some(Certain { node, sure, whole }) = parts.pop() {
                let n = &trees.nodes[node as usize];
                let Some(responses) = self.responses(transfer, visibility, points, node, sure) else {
                    continue;
                };
                match n.children() {
                    None if n.origin() == Origin::Indirect => {
                        self.entries.push(Entry { node, weak: true, responses, errors: ZERO, counted: ZERO });
                    }
                    Some(left) if luminances(n.intensity, &responses).iter().any(|&y| y > whole) => {
                        let part = |node| Certain { node, sure: 0.0, whole: least_split };
                        parts.extend([part(left), part(left + 1)]);
                    }
                    _ => add(&mut strong, n.intensity, &responses),
                }
            }
        }
        let limits = cut.limits(&strong);
        let mut ticket = start;
        for Drawn { node, probability, share } in &cut.drawn {
            ticket += probability;
            if ticket < 1.0 {
                continue;
            }
            ticket -= 1.0;
            let mut error = share.reflected(points, &at);
            error.iter_mut().flatten().for_each(|e| *e = -*e);
            if let Some(responses) = self.responses(transfer, visibility, points, *node, 0.0) {
                add(&mut error, Rgb::ONE, &responses);
            }
            let scale = trees.nodes[*node as usize].intensity / *probability;
            let y = luminances(scale, &error);
            for row in &mut error {
                for l in 0..LANES {
                    row[l] *= if y[l].abs() > limits[l] { limits[l] / y[l].abs() } else { 1.0 };
                }
            }
            add(&mut strong, scale, &error);
        }
        let count = points.len() as u64;
        self.counts.cuts += count;
        self.counts.clusters += count * cut.size() as u64;
        self.sum(trees, points, cut.clamp, &strong, radiance);
        for radiance in radiance.iter_mut() {
            *radiance = radiance.max(Rgb::ZERO);
        }
    }

    /// What a cluster of unit intensity gives to each point, with a shadow ray where it is brighter than `sure`.
    fn responses<V: PacketVisibility>(
        &mut self,
        transfer: &Transfer,
        visibility: &V,
        points: &ReceiverPacket,
        node: u32,
        sure: f32,
    ) -> Option<RgbLanes> {
        let n = &transfer.trees.nodes[node as usize];
        let vpl = &transfer.trees.vpls[n.representative()];
        let mut responses = [[0.0; LANES]; 3];
        let lit = transfer.unshadowed16(points, vpl, n.kind(), &mut responses);
        if lit == 0 {
            return None;
        }
        let y = luminances(n.intensity, &responses);
        let doubtful = (0..LANES).fold(0, |mask, l| mask | u16::from(y[l] > sure) << l) & lit;
        if doubtful != 0 {
            self.counts.rays += u64::from(doubtful.count_ones());
            self.packets += 1;
            let seen = visibility.visible16(points, doubtful, vpl, n) | !doubtful;
            for row in &mut responses {
                for (l, r) in row.iter_mut().enumerate() {
                    *r = if seen >> l & 1 != 0 { *r } else { 0.0 };
                }
            }
        }
        Some(responses)
    }
}

fn add(sums: &mut RgbLanes, intensity: Rgb, responses: &RgbLanes) {
    for (c, sum) in sums.iter_mut().enumerate() {
        for (s, r) in sum.iter_mut().zip(&responses[c]) {
            *s += intensity[c] * r;
        }
    }
}
