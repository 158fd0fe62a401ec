//! Plates, bowls, bottles, pots: profiles for the lathe.

use super::{Shell, lathe, scaled, spline};
use glam::Vec2;

/// Half section of a vessel that is turned on the lathe; (radius, height) in metres.
#[derive(Clone, Copy, Debug)]
pub struct Vessel {
    outside: &'static [[f32; 2]],
    wall: f32,
    segments: usize,
    steps: usize,
}

impl Vessel {
    /// Vessel whose outer profile from the foot upwards to the rim is `outside`, in `segments` around and `steps`
    /// between two points of the profile (1 keeps its corners). The inside follows the outside at the distance
    /// `wall`, 0 for a solid that is closed at the top.
    pub const fn new(outside: &'static [[f32; 2]], wall: f32, segments: usize, steps: usize) -> Self {
        Vessel { outside, wall, segments, steps }
    }

    /// Vessel scaled by `scale`, standing on y = 0.
    pub fn turned(&self, scale: f32) -> Shell {
        let curve = spline(&scaled(self.outside, scale), self.steps);
        let mut profile = vec![Vec2::new(0.0, curve[0].y)];
        profile.extend(curve.iter().map(|p| p.max(Vec2::new(1e-4, f32::MIN))));
        if self.wall > 0.0 {
            let wall = self.wall * scale;
            let floor = curve[0].y + wall;
            // Back down inside; the inner surface ends on a flat floor one wall above the foot.
            let inside = curve.iter().rev().map(|p| Vec2::new(p.x - wall, p.y));
            profile.extend(inside.filter(|p| p.x > wall && p.y > floor + 0.2 * wall));
            profile.push(Vec2::new(0.0, floor));
        } else {
            let top = profile[profile.len() - 1].y;
            profile.push(Vec2::new(0.0, top));
        }
        lathe(&profile, self.segments).creased(50.0)
    }
}
