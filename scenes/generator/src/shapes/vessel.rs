//! Plates, bowls, bottles, pots: profiles for the lathe.

use super::{Shell, lathe, spline};
use glam::Vec2;

/// Half section of a vessel that is turned on the lathe; (radius, height) in metres.
#[derive(Clone, Copy, Debug)]
pub struct Vessel {
    /// Outer profile from the foot upwards to the rim.
    pub outside: &'static [[f32; 2]],
    /// Thickness of the wall; the inside follows the outside. 0 for a solid, closed at the top.
    pub wall: f32,
    /// Segments around.
    pub segments: usize,
    /// Curve segments between two points of the profile; 1 keeps its corners.
    pub steps: usize,
}

impl Vessel {
    /// The vessel, scaled by `scale`, standing on y = 0.
    pub fn turned(&self, scale: f32) -> Shell {
        let points: Vec<Vec2> = self.outside.iter().map(|p| Vec2::from_array(*p) * scale).collect();
        let curve = spline(&points, self.steps);
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
