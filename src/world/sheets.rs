//! Sheets: surfaces that light passes straight through, such as thin panes and surfaces with gaps. Shadow rays pass
//! them, too.
//!
//! Occlusion queries leave sheets out. The transmittance of all sheets that a free segment crosses is a factor on its
//! light; one traversal finds them all. Rays of the camera pass hidden emitters likewise.

use super::World;
use crate::material::LastStraight;
use base::math::{LANES, Rgb, Vec3x16, lanes_in};
use embree::{Hit, Ray, Rays16};
use glam::{Vec2, Vec3};

/// Maximum number of sheets that light passes along a segment.
const MAX_CROSSED: usize = 64;

/// Number of sheets on a segment that are stored without an allocation.
const FEW_CROSSED: usize = 8;

/// Offset behind a sheet at which a ray continues, in units of the last place of the largest coordinate.
const ULPS: f32 = 8.0;

/// Cosine below which the offset does not grow any more.
const MIN_COS: f32 = 0.01;

/// Returns the rest of a ray behind the surface point `position` on it, which has the ray parameter `t` and the
/// geometric normal `normal`.
#[inline]
pub fn beyond(ray: &Ray, position: Vec3, normal: Vec3, t: f32) -> Ray {
    let length = ray.direction.length();
    let largest = position.abs().max(ray.origin.abs()).max_element().max(t * length);
    let cos = normal.dot(ray.direction).abs().max(MIN_COS * length);
    Ray { t_near: t + largest * (ULPS * f32::EPSILON) / cos, ..*ray }
}

/// A sheet on a segment, and the share of the light that passes it.
#[derive(Clone, Copy)]
struct Crossing {
    hit: Hit,
    share: Rgb,
}

/// All sheets on a segment.
struct Crossed {
    few: [Crossing; FEW_CROSSED],
    count: usize,
    /// All sheets, if `few` is too small; else empty.
    many: Vec<Crossing>,
}

impl Crossed {
    /// Makes the empty list.
    fn new() -> Crossed {
        let hit = Hit { t: 0.0, u: 0.0, v: 0.0, geometry: 0, primitive: 0 };
        Crossed { few: [Crossing { hit, share: Rgb::ONE }; FEW_CROSSED], count: 0, many: Vec::new() }
    }

    /// Adds a sheet. Returns false if no light passes it, or there are too many.
    #[inline]
    fn add(&mut self, crossing: Crossing) -> bool {
        if self.count == MAX_CROSSED || crossing.share == Rgb::ZERO {
            return false;
        }
        match self.few.get_mut(self.count) {
            Some(next) => *next = crossing,
            None => {
                if self.many.is_empty() {
                    self.many.extend_from_slice(&self.few);
                }
                self.many.push(crossing);
            }
        }
        self.count += 1;
        true
    }

    /// Returns all sheets.
    fn all(&mut self) -> &mut [Crossing] {
        if self.many.is_empty() { &mut self.few[..self.count] } else { &mut self.many }
    }

    /// Returns the share of the light that passes all sheets, 0 if there are more than `most`. Sheets closer to each
    /// other than rounding count as one, the first.
    fn transmittance(&mut self, world: &World, segment: &Ray, most: u32) -> Rgb {
        let crossings = self.all();
        crossings.sort_unstable_by(|a, b| a.hit.t.total_cmp(&b.hit.t));
        let Some(last) = crossings.last() else { return Rgb::ONE };
        let length = segment.direction.length();
        let largest = segment.origin.abs().max_element() + last.hit.t * length;
        let slack = 1.01 * largest * (ULPS * f32::EPSILON) / (MIN_COS * length);
        let (mut transmittance, mut from, mut left) = (Rgb::ONE, f32::NEG_INFINITY, most);
        for (i, Crossing { hit, share }) in crossings.iter().enumerate() {
            if hit.t > from {
                let Some(fewer) = left.checked_sub(1) else { return Rgb::ZERO };
                left = fewer;
                transmittance *= *share;
                let is_close = crossings.get(i + 1).is_some_and(|next| !(next.hit.t > hit.t + slack));
                from = if is_close { world.behind(segment, hit) } else { hit.t };
            }
        }
        transmittance
    }
}

impl World {
    /// Returns true if there are sheets.
    #[inline]
    pub fn has_sheets(&self) -> bool {
        self.sheets.is_some()
    }

    /// Returns [`World::transmittance_of`] for any number of sheets.
    #[cfg(test)]
    pub(crate) fn transmittance(&self, segment: &Ray) -> Rgb {
        self.transmittance_of(segment, u32::MAX)
    }

    /// Returns the share of the light that passes the sheets on a segment that is not occluded, 0 if there are more
    /// than `most`.
    pub fn transmittance_of(&self, segment: &Ray, most: u32) -> Rgb {
        let Some(sheets) = &self.sheets else { return Rgb::ONE };
        let out = -segment.direction.normalize();
        let (mut crossed, mut last) = (Crossed::new(), None);
        let is_free = sheets.each_crossed(segment, |hit| {
            let share = self.share_passing(&hit, out, &mut last);
            crossed.add(Crossing { hit, share })
        });
        if !is_free {
            return Rgb::ZERO;
        }
        let passed = crossed.transmittance(self, segment, most);
        match self.absorbs() {
            true => passed * self.share_between(segment, crossed.all().iter().map(|crossing| crossing.hit)),
            false => passed,
        }
    }

    /// Returns the share of the light towards the unit vector `out` that passes the sheet at a hit.
    #[inline]
    fn share_passing(&self, hit: &Hit, out: Vec3, last: &mut Option<LastStraight>) -> Rgb {
        let mesh = self.mesh(hit.geometry);
        let barycentric = Vec2::new(hit.u, hit.v);
        let normal = || match self.reliefs.is_some() {
            true => self.surface(hit).frame.normal,
            false => self.with_triangle(hit.geometry, hit.primitive, |seen, triangle| {
                seen.shading_normal(triangle, barycentric)
            }),
        };
        let uv = || mesh.uv(&self.triangles.get(hit.geometry, hit.primitive).vertices, barycentric);
        let attribute = |id| mesh.attribute(id, hit.primitive as usize, barycentric);
        let cos = || normal().dot(out);
        self.materials.straight_transmittance(mesh.material, cos, uv, attribute, last)
    }

    /// Returns the parameter at which a segment continues behind the sheet at a hit.
    fn behind(&self, segment: &Ray, hit: &Hit) -> f32 {
        self.with_triangle(hit.geometry, hit.primitive, |_, triangle| {
            let position = triangle.position(Vec2::new(hit.u, hit.v));
            beyond(segment, position, triangle.normal, hit.t).t_near
        })
    }

    /// Multiplies the `light` along the segments in `lanes` by [`World::transmittance_of`], 0 if `most` is `None`.
    #[inline]
    pub fn attenuate(
        &self,
        segments: &Rays16,
        lanes: u16,
        most: impl Fn(usize) -> Option<u32>,
        light: &mut Vec3x16,
    ) {
        if !self.has_sheets() {
            return;
        }
        for lane in lanes_in(lanes) {
            let passed =
                most(lane).map_or(Rgb::ZERO, |most| self.transmittance_of(&segments.get(lane), most));
            light.set(lane, light.get(lane) * passed);
        }
    }
}

/// Maximum number of emitting surfaces along a ray that are hidden.
const MAX_HIDDEN: u32 = 64;

impl World {
    /// Returns the rest of a camera ray behind the emitters that are hidden from it.
    #[inline]
    pub fn behind_hidden(&self, ray: Ray) -> Ray {
        if !self.scene.hides_emitters { ray } else { self.behind_emitters(ray) }
    }

    /// Replaces camera rays by their rests behind the emitters that are hidden from them.
    #[inline]
    pub fn put_behind_hidden(&self, rays: &mut Rays16) {
        if self.scene.hides_emitters {
            (0..LANES).for_each(|i| rays.set(i, &self.behind_emitters(rays.get(i))));
        }
    }

    /// Returns the rest of a ray behind the emitters in front.
    fn behind_emitters(&self, mut ray: Ray) -> Ray {
        for _ in 0..MAX_HIDDEN {
            match self.intersect(&ray) {
                Some(surface) if self.mesh(surface.mesh).emission.is_some() => {
                    ray = beyond(&ray, surface.position, surface.normal, surface.t);
                }
                _ => break,
            }
        }
        ray
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testkit::*;
    use scene::{Camera, Material, Parameter};

    /// Builds sheets of all kinds, flat and curved, textured and not, some of which intersect.
    fn curtains() -> WorldAndView {
        let mut scene = scene(Camera::default(), [1, 1]);
        let checker =
            checkered(&mut scene, 2, vec![Rgb::splat(0.2), Rgb::ONE, Rgb::splat(0.5), Rgb::splat(0.7)]);
        let Parameter::Textured { texture, .. } = checker.diffuse else { unreachable!("it is textured") };
        let opacity = Some(Parameter::Textured { texture, scale: 0.9 });
        let kinds = [
            pane(1.5, Rgb::new(0.9, 0.6, 0.3)),
            Material { opacity: Some(0.3.into()), ..diffuse(Rgb::ONE) },
            Material { opacity, ..diffuse(Rgb::ONE) },
        ];
        let kinds = kinds.map(|kind| add_material(&mut scene, kind));
        for (i, x) in [0.1, 0.2, 0.2, 0.4, 0.7].into_iter().enumerate() {
            let corner = Vec3::new(x, -1.0, -1.0);
            let (up, along) = (Vec3::new(0.1 * i as f32, 2.0, 0.0), Vec3::Z * 2.0);
            scene.meshes.push(textured(quad(corner, up, along, kinds[i % 3]), Vec2::splat(3.0)));
        }
        scene.meshes.push(sphere(Vec3::X * 0.5, 0.3, 16, kinds[0]));
        world(scene)
    }

    /// Returns the transmittance of a segment, by one query per sheet.
    fn one_by_one(world: &World, segment: &Ray) -> Rgb {
        let (mut transmittance, mut rest) = (Rgb::ONE, *segment);
        while let Some(surface) = world.intersect(&rest) {
            let out = surface.frame.to_local(-segment.direction.normalize());
            transmittance *= world.bsdf(&surface).straight_transmittance(out.z);
            rest = beyond(&rest, surface.position, surface.normal, surface.t);
        }
        transmittance
    }

    #[test]
    fn light_passes_each_sheet_once() {
        let world = curtains();
        let (mut clear, mut dark) = (0, 0);
        for i in 0..2000 {
            let at = |k: f32| (i as f32 * k).fract() * 1.6 - 0.8;
            let (from, to) =
                (Vec3::new(-0.5, at(0.618), at(0.414)), Vec3::new(0.85 + at(0.73), at(0.27), at(0.91)));
            let segment = Ray::between(from, to);
            let (found, expected) = (world.transmittance(&segment), one_by_one(&world, &segment));
            assert_eq!(found, expected, "{segment:?}");
            clear += usize::from(expected == Rgb::ONE);
            dark += usize::from(expected.max_element() < 0.05);
        }
        assert!(clear > 10 && dark > 10, "{clear} {dark}");
    }

    #[test]
    fn nothing_passes_more_sheets_than_are_followed() {
        let mut scene = scene(Camera::default(), [1, 1]);
        let veil = add_material(&mut scene, Material { opacity: Some(0.001.into()), ..diffuse(Rgb::ONE) });
        for i in 0..80 {
            scene.meshes.push(quad(
                Vec3::new(0.01 * i as f32, -1.0, -1.0),
                Vec3::Y * 2.0,
                Vec3::Z * 2.0,
                veil,
            ));
        }
        let world = world(scene);
        let through = |count: f32| {
            let start = Vec3::new(-0.005, 0.2, 0.1);
            world.transmittance(&Ray::between(start, start + Vec3::X * (0.01 * count))).x
        };
        assert!((through(50.0) - 0.999f32.powi(50)).abs() < 1e-4, "{}", through(50.0));
        assert_eq!(through(80.0), 0.0);
    }
}
