//! Animated transforms of nodes, and weights of morph targets.

use super::document::GltfFile;
use super::transform::{Local, quaternion};
use crate::error::SceneError;
use glam::{DQuat, DVec3};
use gltf_json::animation::{Animation, Channel, Interpolation, Property};
use gltf_json::validation::Checked;
use std::collections::BTreeSet;

/// One animated property of a node.
pub(super) struct Track {
    pub node: usize,
    property: Property,
    interpolation: Interpolation,
    /// Times of the keys in seconds, ascending.
    times: Vec<f32>,
    /// Value of each key. A spline has three values per key: tangent in, value, tangent out.
    values: Vec<f32>,
    /// Number of components of a value.
    width: usize,
}

impl Track {
    /// Returns the time of the last key, in seconds.
    fn end(&self) -> f64 {
        self.times.last().map_or(0.0, |time| f64::from(*time))
    }

    /// True if the track moves its node.
    pub fn moves(&self) -> bool {
        self.property != Property::MorphTargetWeights
    }

    /// True if the keys have different values.
    pub fn varies(&self) -> bool {
        let mut values = self.values.chunks_exact(self.width.max(1));
        let first = values.next();
        values.any(|value| Some(value) != first)
    }

    /// Sets the property to its value at `time`.
    pub fn apply(&self, local: &mut Local, time: f64) {
        let Local::Steps { scale, rotation, translation } = local else { return };
        match self.property {
            Property::Translation => *translation = self.vector(time),
            Property::Scale => *scale = self.vector(time),
            Property::Rotation => *rotation = self.rotation(time),
            Property::MorphTargetWeights => {}
        }
    }

    /// Returns the weights of morph targets at `time`; `None` if the track moves something else.
    pub fn weights(&self, time: f64) -> Option<Vec<f32>> {
        if self.moves() {
            return None;
        }
        let mix = |parts: &[(usize, f64)]| {
            let component =
                |c: usize| parts.iter().map(|(i, weight)| f64::from(self.value(*i)[c]) * weight).sum::<f64>();
            (0..self.width).map(|c| component(c) as f32).collect()
        };
        Some(match self.at(time) {
            At::Key(i) => self.value(i).to_vec(),
            At::Between(i, t) => mix(&[(i, 1.0 - t), (i + 1, t)]),
            At::Spline { points, weights } => {
                mix(&std::array::from_fn::<_, 4, _>(|k| (points[k], weights[k])))
            }
        })
    }

    fn value(&self, i: usize) -> &[f32] {
        &self.values[i * self.width..][..self.width]
    }

    fn vector(&self, time: f64) -> DVec3 {
        let key = |i: usize| match *self.value(i) {
            [x, y, z] => DVec3::new(x.into(), y.into(), z.into()),
            _ => DVec3::ZERO,
        };
        match self.at(time) {
            At::Key(i) => key(i),
            At::Between(i, t) => key(i).lerp(key(i + 1), t),
            At::Spline { points, weights } => {
                points.iter().zip(weights).map(|(&i, weight)| key(i) * weight).sum()
            }
        }
    }

    fn rotation(&self, time: f64) -> DQuat {
        let key = |i: usize| match *self.value(i) {
            [x, y, z, w] => [x, y, z, w].map(f64::from),
            _ => [0.0; 4],
        };
        match self.at(time) {
            At::Key(i) => quaternion(key(i)),
            At::Between(i, t) => quaternion(key(i)).slerp(quaternion(key(i + 1)), t),
            At::Spline { points, weights } => {
                let mut sum = [0.0; 4];
                for (i, weight) in points.into_iter().zip(weights) {
                    sum.iter_mut().zip(key(i)).for_each(|(sum, v)| *sum += v * weight);
                }
                quaternion(sum)
            }
        }
    }

    fn at(&self, time: f64) -> At {
        let is_spline = self.interpolation == Interpolation::CubicSpline;
        let value = |key: usize| if is_spline { 3 * key + 1 } else { key };
        let after = self.times.partition_point(|&key| f64::from(key) <= time);
        if after == 0 || after == self.times.len() || self.interpolation == Interpolation::Step {
            return At::Key(value(after.saturating_sub(1)));
        }
        let [from, to] = [after - 1, after].map(|i| f64::from(self.times[i]));
        let t = (time - from) / (to - from);
        if !is_spline {
            return At::Between(after - 1, t);
        }
        // glTF 2.0 specification, appendix C: cubic Hermite spline.
        let (t2, t3) = (t * t, t * t * t);
        let weights = [
            2.0 * t3 - 3.0 * t2 + 1.0,
            (to - from) * (t3 - 2.0 * t2 + t),
            3.0 * t2 - 2.0 * t3,
            (to - from) * (t3 - t2),
        ];
        let (before, behind) = (3 * (after - 1), 3 * after);
        At::Spline { points: [before + 1, before + 2, behind + 1, behind], weights }
    }
}

/// Indices of the values at or around a time.
enum At {
    Key(usize),
    Between(usize, f64),
    Spline { points: [usize; 4], weights: [f64; 4] },
}

/// Animations that play together, from the time 0 on. The default is none.
#[derive(Default)]
pub(super) struct Clip {
    tracks: Vec<Track>,
    /// Names of the animations that do not play, because others move what they move.
    pub left_out: Vec<String>,
}

impl Clip {
    /// Reads the animations of a file.
    pub fn read(document: &GltfFile) -> Result<Clip, SceneError> {
        let (mut clip, mut targets) = (Clip::default(), BTreeSet::new());
        for animation in &document.root.animations {
            let of_channel = |channel: &Channel| {
                let property = match channel.target.path {
                    Checked::Valid(property) => Some(property as u8),
                    Checked::Invalid => None,
                };
                (channel.target.node.value(), property)
            };
            let own: BTreeSet<_> = animation.channels.iter().map(of_channel).collect();
            if !own.is_disjoint(&targets) {
                clip.left_out.push(animation.name.clone().unwrap_or_default());
                continue;
            }
            for channel in &animation.channels {
                clip.tracks.push(track(document, animation, channel)?);
            }
            targets.extend(own);
        }
        Ok(clip)
    }

    /// Returns the tracks of a node.
    pub fn of_node(&self, node: usize) -> impl Iterator<Item = &Track> {
        self.tracks.iter().filter(move |track| track.node == node)
    }

    /// Returns the number of frames from the time 0 to the last key of all; 0 if nothing plays.
    pub fn frames(&self, fps: f64) -> usize {
        let end = self.tracks.iter().map(Track::end).fold(0.0, f64::max);
        if self.tracks.is_empty() { 0 } else { (end * fps).round() as usize + 1 }
    }
}

fn track(document: &GltfFile, animation: &Animation, channel: &Channel) -> Result<Track, SceneError> {
    let what = format!("the animation of node {}", channel.target.node.value());
    let wrong = |problem: &str| document.wrong(format!("{what} {problem}"));
    let Checked::Valid(property) = channel.target.path else {
        return Err(wrong("is of an unknown property"));
    };
    let sampler = animation.samplers.get(channel.sampler.value()).ok_or_else(|| wrong("has no sampler"))?;
    let Checked::Valid(interpolation) = sampler.interpolation else {
        return Err(wrong("has an unknown interpolation"));
    };
    let times: Vec<f32> = document.vectors::<1>(sampler.input, &what)?.into_flattened();
    let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let (values, width) = match property {
        Property::Rotation => (document.vectors::<4>(sampler.output, &what)?.into_flattened(), 4),
        Property::Translation | Property::Scale => {
            (document.vectors::<3>(sampler.output, &what)?.into_flattened(), 3)
        }
        Property::MorphTargetWeights => {
            let values = document.vectors::<1>(sampler.output, &what)?.into_flattened();
            let width = values.len() / times.len().max(1) / each;
            (values, width)
        }
    };
    if times.is_empty() || values.len() != each * times.len() * width {
        return Err(wrong(&format!("has {} keys and {} values", times.len(), values.len() / width.max(1))));
    }
    if !values.iter().all(|value| value.is_finite()) {
        return Err(wrong("has values that are no numbers"));
    }
    if !times.iter().all(|time| time.is_finite()) || times.windows(2).any(|pair| !(pair[0] < pair[1])) {
        return Err(wrong("has keys that are out of order"));
    }
    Ok(Track { node: channel.target.node.value(), property, interpolation, times, values, width })
}
