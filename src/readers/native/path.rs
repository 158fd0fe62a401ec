//! The curve of a camera path through its keys.
//!
//! Papers: Yuksel, Schaefer and Keyser, *Parameterization and Applications of Catmull-Rom Curves*, CAD 2011. Eye,
//! target and up vector follow a centripetal Catmull-Rom curve, which neither overshoots nor loops between keys.
//! Steffen, *A Simple Method for Monotonic Interpolation in One Dimension*, A&A 1990. It gives the curve's parameter by
//! frame if keys have frames, and the field of view by parameter.
//!
//! The parameter of keys without frames advances at constant speed.

use glam::DVec3;

/// A key: the camera at one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key {
    pub origin: DVec3,
    pub target: DVec3,
    pub up: DVec3,
    /// Field of view in degrees.
    pub fov: f64,
}

/// A smooth path through keys.
pub(super) struct KeyedPath {
    /// Keys, with one extrapolated linearly at each end.
    points: Vec<Key>,
    /// Parameter of each point.
    knots: Vec<f64>,
    /// Frame of each key; empty if keys have no frames.
    at: Vec<f64>,
    /// Number of frames.
    frames: usize,
}

impl Key {
    fn blend(self, other: Key, t: f64) -> Key {
        Key {
            origin: self.origin.lerp(other.origin, t),
            target: self.target.lerp(other.target, t),
            up: self.up.lerp(other.up, t),
            fov: self.fov,
        }
    }

    fn distance(self, other: Key) -> f64 {
        let squared = self.origin.distance_squared(other.origin) + self.target.distance_squared(other.target);
        squared.sqrt()
    }
}

impl KeyedPath {
    /// Returns the path of `frames` frames through at least one key. `at` are the frames of the keys in ascending
    /// order, or empty.
    pub fn new(keys: Vec<Key>, at: Vec<usize>, frames: usize) -> KeyedPath {
        let at = at.into_iter().map(|frame| frame as f64).collect();
        let [first, .., last] = keys[..] else {
            return KeyedPath { points: keys, knots: Vec::new(), at, frames };
        };
        let before = first.blend(keys[1], -1.0);
        let after = last.blend(keys[keys.len() - 2], -1.0);
        let points: Vec<Key> = [before].into_iter().chain(keys).chain([after]).collect();
        // Centripetal knots. A small distance separates coincident keys.
        let mut knots = vec![0.0];
        for pair in points.windows(2) {
            knots.push(knots[knots.len() - 1] + pair[0].distance(pair[1]).sqrt().max(1e-9));
        }
        KeyedPath { points, knots, at, frames }
    }

    /// Returns the camera at a frame, counted from 1. Before the first key and after the last one the camera stands
    /// still.
    pub fn at(&self, frame: usize) -> Key {
        let [_, own @ .., _] = &self.knots[..] else { return self.points[0] };
        let u = match &self.at[..] {
            [] => {
                let t = (frame as f64 - 1.0) / (self.frames.max(2) - 1) as f64;
                let (start, end) = (own[0], own[own.len() - 1]);
                start + (end - start) * t.clamp(0.0, 1.0)
            }
            at => monotone(at, |i| own[i], frame as f64),
        };
        let segment = (1..self.points.len() - 2).rev().find(|&i| self.knots[i] <= u).unwrap_or(1);
        let around = segment - 1..segment + 3;
        let key = barry_goldman(&self.points[around.clone()], &self.knots[around], u);
        Key { fov: monotone(own, |i| self.points[i + 1].fov, u), ..key }
    }
}

/// Evaluates the segment between the middle two of four points by repeated interpolation.
fn barry_goldman(p: &[Key], k: &[f64], u: f64) -> Key {
    let mix = |a: Key, b: Key, from: f64, to: f64| a.blend(b, (u - from) / (to - from));
    let a = [0, 1, 2].map(|i| mix(p[i], p[i + 1], k[i], k[i + 1]));
    let b = [0, 1].map(|i| mix(a[i], a[i + 1], k[i], k[i + 2]));
    mix(b[0], b[1], k[1], k[2])
}

/// Evaluates a smooth function through values `y` at ascending `x` that is monotone where the values are; it is
/// constant outside.
fn monotone(x: &[f64], y: impl Fn(usize) -> f64, at: f64) -> f64 {
    let last = x.len() - 1;
    if last == 0 || at <= x[0] {
        return y(0);
    }
    if at >= x[last] {
        return y(last);
    }
    let secant = |i: usize| (y(i + 1) - y(i)) / (x[i + 1] - x[i]);
    let slope = |i: usize| {
        if i == 0 || i == last {
            return secant(i.min(last - 1));
        }
        let (left, right) = (secant(i - 1), secant(i));
        if left * right <= 0.0 {
            return 0.0;
        }
        let [before, behind] = [x[i] - x[i - 1], x[i + 1] - x[i]];
        let parabola = (left * behind + right * before) / (before + behind);
        2.0 * left.signum() * left.abs().min(right.abs()).min(0.5 * parabola.abs())
    };
    let i = x.partition_point(|&x| x <= at) - 1;
    let width = x[i + 1] - x[i];
    let (t, secant, from, to) = ((at - x[i]) / width, secant(i), slope(i), slope(i + 1));
    let change = t * (from + t * (3.0 * secant - 2.0 * from - to + t * (from + to - 2.0 * secant)));
    y(i) + width * change
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> Key {
        let (origin, target) = (DVec3::new(x, y, 0.0), DVec3::new(x, y, -1.0));
        Key { origin, target, up: DVec3::Y, fov: 60.0 }
    }

    fn keys() -> Vec<Key> {
        vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, 2.0), at(5.0, 2.0)]
    }

    #[test]
    fn the_path_goes_through_its_keys_from_end_to_end() {
        let path = KeyedPath::new(keys(), Vec::new(), 4001);
        assert!(path.at(1).distance(keys()[0]) < 1e-9 && path.at(4001).distance(keys()[3]) < 1e-9);
        for key in keys() {
            let nearest = (1..=4001).map(|i| path.at(i).distance(key)).fold(f64::MAX, f64::min);
            assert!(nearest < 5e-3, "{nearest}");
        }
    }

    #[test]
    fn keys_with_frames_are_passed_at_those_frames() {
        let frames = [3, 400, 500, 2000];
        let mut keyed = keys();
        (keyed[1].fov, keyed[2].fov, keyed[2].up) = (30.0, 90.0, DVec3::new(0.6, 0.8, 0.0));
        let path = KeyedPath::new(keyed.clone(), frames.to_vec(), 2100);
        for (frame, key) in frames.into_iter().zip(&keyed) {
            let found = path.at(frame);
            assert!(found.distance(*key) < 1e-9 && (found.fov - key.fov).abs() < 1e-9, "{frame}");
            assert!(found.up.distance(key.up) < 1e-9);
        }
        // The camera stands still outside.
        assert_eq!((path.at(1).origin, path.at(2100).origin), (keyed[0].origin, keyed[3].origin));
        // The field of view lies between those of the keys around.
        for frame in 400..=500 {
            assert!((30.0..=90.0).contains(&path.at(frame).fov));
        }
    }

    #[test]
    fn the_path_is_smooth() {
        for frames in [vec![], vec![1, 1500, 7000, 10_000]] {
            let path = KeyedPath::new(keys(), frames, 10_000);
            let velocity = |i: usize| (path.at(i + 1).origin - path.at(i).origin) * 1e4;
            for i in 1..9998 {
                let turn = (velocity(i + 1) - velocity(i)).length();
                assert!(turn < 0.05, "{i} {turn}");
            }
        }
    }

    #[test]
    fn one_key_and_keys_that_coincide_are_no_trouble() {
        let one = |keys: Vec<Key>, frames: Vec<usize>, frame| KeyedPath::new(keys, frames, 11).at(frame);
        let here = at(1.0, 1.0);
        assert_eq!(one(vec![here], vec![], 6), here);
        assert_eq!(one(vec![here], vec![3], 6), here);
        assert!(one(vec![here; 3], vec![], 4).distance(here) < 1e-6);
        assert!(one(vec![here; 3], vec![1, 5, 11], 4).distance(here) < 1e-6);
        let turn = one(vec![here, Key { target: DVec3::X, ..here }], vec![], 6);
        assert!(turn.origin.distance(DVec3::new(1.0, 1.0, 0.0)) < 1e-12);
        assert_eq!(one(vec![here], vec![], 1).fov, 60.0);
    }

    #[test]
    fn monotone_functions_pass_their_values_and_never_overshoot() {
        let (x, y) = ([0.0, 1.0, 1.5, 4.0, 5.0], [0.0, 0.1, 5.0, 5.0, 2.0]);
        let value = |at| monotone(&x, |i| y[i], at);
        for (x, y) in x.into_iter().zip(y) {
            assert!((value(x) - y).abs() < 1e-12);
        }
        assert_eq!((value(-1.0), value(9.0)), (0.0, 2.0));
        for i in 0..4000 {
            let (a, b) = (value(f64::from(i) / 1e3), value(f64::from(i + 1) / 1e3));
            assert!(b >= a - 1e-12 && b <= 5.0 + 1e-12);
        }
    }
}
