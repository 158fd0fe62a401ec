//! Outlines: arcs, circles, rectangles and the pointed arch.

use glam::Vec2;
use std::f32::consts::TAU;
use std::ops::Mul;

/// Points of an outline or a profile written as pairs of numbers.
pub fn points(pairs: &[impl Into<Vec2> + Copy]) -> Vec<Vec2> {
    pairs.iter().map(|&p| p.into()).collect()
}

/// Points of an outline or a profile times `factor`, a number or one for each coordinate.
pub fn scaled<F: Copy>(pairs: &[impl Into<Vec2> + Copy], factor: F) -> Vec<Vec2>
where
    Vec2: Mul<F, Output = Vec2>,
{
    pairs.iter().map(|&p| p.into() * factor).collect()
}

/// Points on the arc about `centre` from one angle to another (degrees), both ends included.
pub fn arc(centre: Vec2, radius: f32, from_degrees: f32, to_degrees: f32, segments: usize) -> Vec<Vec2> {
    (0..=segments)
        .map(|k| {
            let angle = from_degrees + (to_degrees - from_degrees) * k as f32 / segments as f32;
            centre + radius * Vec2::from_angle(angle.to_radians())
        })
        .collect()
}

/// Circle about the origin, counter-clockwise.
pub fn circle(radius: f32, segments: usize) -> Vec<Vec2> {
    (0..segments).map(|k| radius * Vec2::from_angle(TAU * k as f32 / segments as f32)).collect()
}

/// Rectangle between two corners, counter-clockwise.
pub fn rectangle(low: Vec2, high: Vec2) -> Vec<Vec2> {
    vec![low, Vec2::new(high.x, low.y), high, Vec2::new(low.x, high.y)]
}

/// Outline of `lobes` overlapping circles of `lobe_radius` around the origin (trefoil, quatrefoil), their
/// centres at `distance`, the first at `first_degrees`; counter-clockwise.
pub fn foil(lobes: usize, distance: f32, lobe_radius: f32, first_degrees: f32, segments: usize) -> Vec<Vec2> {
    let half_sector = 180.0 / lobes as f32;
    // Neighbouring circles meet on the ray half way between their centres.
    let (sin, cos) = half_sector.to_radians().sin_cos();
    let across = (lobe_radius * lobe_radius - distance * distance * sin * sin).max(0.0).sqrt();
    let cusp = Vec2::new(cos, sin) * (distance * cos + across) - Vec2::new(distance, 0.0);
    let reach = cusp.to_angle().to_degrees();
    let mut outline = Vec::with_capacity(lobes * segments);
    for lobe in 0..lobes {
        let turn = first_degrees + 2.0 * half_sector * lobe as f32;
        let centre = distance * Vec2::from_angle(turn.to_radians());
        let mut points = arc(centre, lobe_radius, turn - reach, turn + reach, segments);
        points.pop();
        outline.append(&mut points);
    }
    outline
}

/// Pointed arch of two circular arcs that spring vertically at (±half_span, 0) and meet at (0, rise);
/// rise = half_span gives the round arch.
#[derive(Clone, Copy, Debug)]
pub struct PointedArch {
    /// Half the width at the springing line.
    pub half_span: f32,
    /// Height of the apex above the springing line; at least half_span.
    pub rise: f32,
}

impl PointedArch {
    /// Point at `t` along the left half, from the springing (0) to the apex (1), by equal angles.
    pub fn left(&self, t: f32) -> Vec2 {
        let radius = self.radius();
        let apex_angle = (self.rise / radius).clamp(-1.0, 1.0).asin();
        let apex_angle =
            if radius >= self.half_span { apex_angle } else { std::f32::consts::PI - apex_angle };
        let (sin, cos) = (apex_angle * t).sin_cos();
        Vec2::new(radius - self.half_span - radius * cos, radius * sin)
    }

    /// Radius of both arcs.
    pub fn radius(&self) -> f32 {
        (self.half_span * self.half_span + self.rise * self.rise) / (2.0 * self.half_span)
    }

    /// Whole curve from the left springing over the apex to the right one, `segments` on each half.
    pub fn curve(&self, segments: usize) -> Vec<Vec2> {
        let left = (0..=segments).map(|k| self.left(k as f32 / segments as f32));
        let right = (0..segments).rev().map(|k| {
            let p = self.left(k as f32 / segments as f32);
            Vec2::new(-p.x, p.y)
        });
        left.chain(right).collect()
    }

    /// Concentric arch `offset` metres further out, for mouldings and orders.
    pub fn offset(&self, offset: f32) -> PointedArch {
        let radius = self.radius() + offset;
        let half_span = self.half_span + offset;
        let centre = self.radius() - self.half_span;
        PointedArch { half_span, rise: (radius * radius - centre * centre).max(0.0).sqrt() }
    }

    /// Outline of an opening: jambs from `sill` (below 0) up to the springing line, then the arch; moved
    /// by `centre`. Counter-clockwise, starting at the lower right.
    pub fn opening(&self, centre: Vec2, sill: f32, segments: usize) -> Vec<Vec2> {
        let mut outline = vec![Vec2::new(-self.half_span, sill), Vec2::new(self.half_span, sill)];
        outline.extend(self.curve(segments).iter().rev());
        outline.iter().map(|p| *p + centre).collect()
    }
}
