//! Surfaces with specular lobes: delta lobes of mirrors and glass, and lobes too sharp to count as diffuse. Their light
//! does not travel along straight segments between surfaces and virtual lights.

use super::towards::{Boxes16, Faces, MIN_DIRECTION};
use crate::material::{Bsdf, Materials};
use base::math::{LANES, U32x16, Vec3x16, mask_of};
use embree::Ray;
use glam::Vec3;
use scene::{Mesh, Scene};

/// Maximum number of boxes that rays are tested against.
const MAX_BOXES: usize = LANES;

/// The specular surfaces of a scene.
#[derive(Clone, Debug, Default)]
pub struct Specular {
    /// True for seen meshes with specular lobes, lobes that light passes straight included; empty if there are none.
    pub(super) meshes: Vec<bool>,
    /// Boxes around meshes with lobes that change the direction of light, as lowest and highest corners.
    pub(super) boxes: Vec<(Vec3, Vec3)>,
    /// Boxes around meshes with delta lobes or of rough glass.
    pub(super) delta_boxes: Boxes16,
    /// True if there are delta lobes or rough glass.
    pub(super) has_delta_lobes: bool,
    /// True if a surface scatters light to its other side in more than isolated directions.
    pub(super) scatter_across: bool,
    /// See [`Specular::store_light`].
    pub(super) store_light: bool,
    /// True if some surface scatters light into more than isolated directions.
    pub(super) spread_light: bool,
}

impl Specular {
    /// Collects the specular surfaces of a scene.
    pub fn new(scene: &Scene, materials: &Materials) -> Specular {
        // Each material is evaluated once for all its meshes.
        let averages: Vec<Bsdf> = materials.averages().collect();
        let average = |mesh: &Mesh| &averages[mesh.material.0 as usize];
        let by_delta = |mesh: &Mesh| average(mesh).bends_light();
        let bends =
            |mesh: &Mesh| by_delta(mesh) || average(mesh).is_glossy() || average(mesh).is_of_mean_roughness();
        let is_specular = |mesh: &Mesh| bends(mesh) || average(mesh).passes_straight();
        let mut meshes: Vec<bool> = scene.meshes.iter().map(is_specular).collect();
        if !meshes.contains(&true) {
            meshes.clear();
        } else if !scene.groups.is_empty() {
            meshes = scene.seen().map(|(mesh, _)| meshes[mesh]).collect();
        }
        let boxes = |is_such: &dyn Fn(&Mesh) -> bool| {
            let mut boxes = Vec::new();
            group(scene.seen_bounds(is_such).into_iter().map(enlarged).collect(), MAX_BOXES, &mut boxes);
            boxes
        };
        let delta_boxes = boxes(&by_delta);
        let some = |is_such: &dyn Fn(&Bsdf) -> bool| {
            scene.meshes.iter().any(|mesh| {
                let bsdf = average(mesh);
                !mesh.triangles.is_empty() && (is_such(bsdf) || bsdf.is_of_mean_roughness())
            })
        };
        Specular {
            meshes,
            boxes: boxes(&bends),
            has_delta_lobes: !delta_boxes.is_empty(),
            delta_boxes: Boxes16::new(&delta_boxes),
            scatter_across: averages.iter().any(Bsdf::scatters_across),
            store_light: some(&|bsdf: &Bsdf| bsdf.stores_light()),
            spread_light: some(&|bsdf: &Bsdf| bsdf.has_smooth()),
        }
    }

    /// Returns true if a surface scatters light to its other side in more than isolated directions.
    #[inline]
    pub fn scatter_across(&self) -> bool {
        self.scatter_across
    }

    /// Returns true if a surface reflects light diffusely, so that photons and virtual lights are stored on it.
    pub fn store_light(&self) -> bool {
        self.store_light
    }

    /// Returns true if a surface scatters light into more than isolated directions.
    pub fn spread_light(&self) -> bool {
        self.spread_light
    }

    /// Returns true if a surface bends light by delta lobes or is of rough glass.
    pub fn has_delta_lobes(&self) -> bool {
        self.has_delta_lobes
    }

    /// Returns true if a surface changes the direction of light by specular lobes.
    #[inline]
    pub fn bends_light(&self) -> bool {
        !self.boxes.is_empty()
    }

    /// Returns the front faces of the boxes around delta lobes and rough glass, seen from `x`, where the normal is `n`.
    pub fn faces(&self, x: Vec3, n: Vec3) -> Faces<'_> {
        self.delta_boxes.faces(x, n)
    }

    /// Returns true if a ray may hit a surface that has delta lobes or is of rough glass.
    #[inline]
    pub fn may_meet_delta_lobes(&self, ray: &Ray) -> bool {
        self.delta_boxes.may_be_met(ray)
    }

    /// Returns the lanes whose meshes are specular.
    #[inline]
    pub fn lanes(&self, mesh: &U32x16) -> u16 {
        match self.meshes[..] {
            [] => 0,
            _ => mask_of(&mesh.map(|mesh| u32::from(self.meshes[mesh as usize]))),
        }
    }

    /// Returns the lanes whose rays may hit a surface that changes the direction of light by specular lobes.
    #[inline]
    pub fn may_be_met(&self, origin: &Vec3x16, direction: &Vec3x16) -> u16 {
        let mut met = [0; LANES];
        for (low, high) in &self.boxes {
            for i in 0..LANES {
                let (mut near, mut far) = (0.0, f32::INFINITY);
                for axis in 0..3 {
                    let (o, d) = (origin.rows()[axis][i], direction.rows()[axis][i]);
                    let d = if d.abs() < MIN_DIRECTION { MIN_DIRECTION } else { d };
                    let (a, b) = ((low[axis] - o) / d, (high[axis] - o) / d);
                    let (least, most) = if a < b { (a, b) } else { (b, a) };
                    near = if least > near { least } else { near };
                    far = if most < far { most } else { far };
                }
                met[i] |= u32::from(near <= far);
            }
        }
        mask_of(&met)
    }
}

/// Returns a box that covers rounding, too.
fn enlarged([low, high]: [Vec3; 2]) -> (Vec3, Vec3) {
    let slack = 1e-5 * low.abs().max(high.abs()).max_element();
    (low - slack, high + slack)
}

/// Joins boxes to at most `count` boxes of neighbours: the list is halved along its longest axis, again and again.
fn group(mut boxes: Vec<(Vec3, Vec3)>, count: usize, joined: &mut Vec<(Vec3, Vec3)>) {
    if boxes.len() <= count {
        joined.append(&mut boxes);
        return;
    }
    let join = |a: (Vec3, Vec3), b: &(Vec3, Vec3)| (a.0.min(b.0), a.1.max(b.1));
    let all = boxes[1..].iter().fold(boxes[0], join);
    if count == 1 {
        joined.push(all);
        return;
    }
    let axis = (all.1 - all.0).max_position();
    boxes.sort_by(|a, b| (a.0 + a.1)[axis].total_cmp(&(b.0 + b.1)[axis]));
    let rest = boxes.split_off(boxes.len() / 2);
    group(boxes, count / 2, joined);
    group(rest, count - count / 2, joined);
}

#[cfg(test)]
mod tests {
    use crate::shadow::ray_from;
    use crate::testkit::*;
    use base::math::{Rgb, lanes_in};
    use base::sampling::owen_sobol_2d;
    use embree::{Hits16, Rays16};
    use glam::Vec3;
    use scene::Camera;

    #[test]
    fn no_ray_that_meets_a_specular_surface_is_missed_and_most_others_are() {
        let mut scene = scene(Camera::default(), [1, 1]);
        let (mirror, grey) =
            (add_material(&mut scene, mirror()), add_material(&mut scene, diffuse(Rgb::ONE)));
        let clear = add_material(&mut scene, glass(1.0));
        let place = |i: u32| {
            let (a, b) = (owen_sobol_2d(i, 1), owen_sobol_2d(i, 2));
            Vec3::new(a.x, a.y, b.x) * 2.0 - 1.0
        };
        scene.meshes.extend(room(Vec3::splat(-2.0), Vec3::splat(2.0), grey));
        for i in 0..40 {
            let corner = Vec3::X + 0.5 * place(i);
            scene.meshes.push(quad(corner, Vec3::Y * 0.1, Vec3::Z * 0.1, mirror));
            scene.meshes.push(quad(place(100 + i) - 0.9 * Vec3::X, Vec3::Y * 0.1, Vec3::Z * 0.1, clear));
        }
        let world = world(scene);
        assert!(world.specular.bends_light() && world.specular.boxes.len() == super::MAX_BOXES);
        let (mut met, mut rays_sent) = (0, 0);
        for first in (0..16_000).step_by(16) {
            let mut rays = Rays16::default();
            for lane in 0..16 {
                let (x, towards) = (place(1000 + first + lane), place(50_000 + 3 * (first + lane)));
                // Every other ray runs along an axis.
                let towards = if lane % 2 == 0 { towards.normalize_or(Vec3::X) } else { Vec3::X };
                rays.set(lane as usize, &ray_from(x, Vec3::ZERO, towards));
            }
            let mut hits = Hits16::default();
            let found = world.accel.closest_hit16(&rays, u16::MAX, false, &mut hits);
            let may_be = world.specular.may_be_met(&rays.origins(), &rays.directions());
            for lane in lanes_in(found) {
                let material = world.scene.meshes[hits.geometry[lane] as usize].material;
                let specular = world.specular.lanes(&hits.geometry) >> lane & 1 != 0;
                assert_eq!(specular, material != grey);
                assert!(material != mirror || may_be >> lane & 1 != 0);
            }
            met += may_be.count_ones();
            rays_sent += 16;
        }
        assert!(met > 0 && met < rays_sent / 2, "{met}");
    }
}
