//! Animated transforms of nodes.

use super::document::GltfFile;
use super::nodes::{Local, quaternion};
use crate::error::SceneError;
use glam::{DQuat, DVec3};
use gltf_json::animation::{Animation, Channel, Interpolation, Property};
use gltf_json::validation::Checked;

/// One animated property of a node.
pub(super) struct Track {
    pub node: usize,
    property: Property,
    interpolation: Interpolation,
    /// Times of the keys in seconds, ascending.
    times: Vec<f32>,
    /// Value of each key. A spline has three values per key: tangent in, value, tangent out.
    values: Vec<[f32; 4]>,
}

impl Track {
    /// Returns the first and last time of the keys, in seconds.
    pub fn span(&self) -> [f32; 2] {
        [self.times[0], self.times[self.times.len() - 1]]
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

    fn vector(&self, time: f64) -> DVec3 {
        let key = |i: usize| DVec3::from_slice(&self.values[i].map(f64::from));
        match self.at(time) {
            At::Key(i) => key(i),
            At::Between(i, t) => key(i).lerp(key(i + 1), t),
            At::Spline { points, weights } => {
                points.iter().zip(weights).map(|(&i, weight)| key(i) * weight).sum()
            }
        }
    }

    fn rotation(&self, time: f64) -> DQuat {
        match self.at(time) {
            At::Key(i) => quaternion(self.values[i]),
            At::Between(i, t) => quaternion(self.values[i]).slerp(quaternion(self.values[i + 1]), t),
            At::Spline { points, weights } => {
                let mut sum = [0.0; 4];
                for (i, weight) in points.into_iter().zip(weights) {
                    sum.iter_mut().zip(self.values[i]).for_each(|(sum, v)| *sum += v * weight as f32);
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

/// Reads the tracks of an animation that move the wanted nodes.
pub(super) fn tracks(
    document: &GltfFile,
    animation: &Animation,
    is_wanted: impl Fn(usize) -> bool,
) -> Result<Vec<Track>, SceneError> {
    let channels = animation.channels.iter().filter(|channel| is_wanted(channel.target.node.value()));
    let tracks: Result<Vec<Option<Track>>, SceneError> =
        channels.map(|channel| track(document, animation, channel)).collect();
    Ok(tracks?.into_iter().flatten().collect())
}

fn track(document: &GltfFile, animation: &Animation, channel: &Channel) -> Result<Option<Track>, SceneError> {
    let what = format!("the animation of node {}", channel.target.node.value());
    let wrong = |problem: &str| document.wrong(format!("{what} {problem}"));
    let property = match channel.target.path {
        Checked::Valid(Property::MorphTargetWeights) => return Ok(None),
        Checked::Valid(property) => property,
        Checked::Invalid => return Err(wrong("is of an unknown property")),
    };
    let sampler = animation.samplers.get(channel.sampler.value()).ok_or_else(|| wrong("has no sampler"))?;
    let Checked::Valid(interpolation) = sampler.interpolation else {
        return Err(wrong("has an unknown interpolation"));
    };
    let times: Vec<f32> = document.vectors::<1>(sampler.input, &what)?.into_iter().map(|[t]| t).collect();
    let values: Vec<[f32; 4]> = match property {
        Property::Rotation => document.vectors::<4>(sampler.output, &what)?,
        _ => {
            let vectors = document.vectors::<3>(sampler.output, &what)?;
            vectors.into_iter().map(|[x, y, z]| [x, y, z, 0.0]).collect()
        }
    };
    let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    if times.is_empty() || values.len() != each * times.len() {
        return Err(wrong(&format!("has {} keys and {} values", times.len(), values.len())));
    }
    if !times.iter().all(|time| time.is_finite()) || times.windows(2).any(|pair| !(pair[0] < pair[1])) {
        return Err(wrong("has keys that are out of order"));
    }
    Ok(Some(Track { node: channel.target.node.value(), property, interpolation, times, values }))
}
