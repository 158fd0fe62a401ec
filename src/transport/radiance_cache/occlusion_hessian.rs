//! Derivatives of a record's irradiance over the surface, including the motion of occluders' edges.
//!
//! Paper: Schwarzhaupt, Jensen and Jarosz 2012, footprints from second derivatives that include occlusion.
//!
//! Deviations: the smooth part is exact for the virtual lights at constant visibility. The edges' part is an upper
//! estimate (see [`super::edges`]). Hence their absolute values are added.

use super::edges::CellLight;
use super::footprint::Derivatives;
use super::lit_cluster::Arriving16;
use super::probe::{Probes, azimuths16};
use crate::gradient::LocalVpl;
use crate::lights::{DirectIndirect, Origin};
use base::math::{LANES, Rgb, luminance};
use glam::{Mat3, Vec2, Vec3};
use std::f32::consts::TAU;
use world::{SurfacePoint, World};

/// Lower bound of the cosine at which a patch of surface is seen, whose share of the hemisphere does not vanish.
const MIN_PATCH_COS: f32 = 0.2;

/// Surfaces seen from a point, and the light of both layers that they send to it.
#[derive(Clone, Debug)]
pub struct OcclusionHessian {
    probes: Probes,
    layers: DirectIndirect<LayerLight>,
}

/// Light of one layer.
#[derive(Clone, Debug)]
struct LayerLight {
    cells: CellLight,
    /// Second derivatives uu, uv, vv of the luminance at constant visibility.
    smooth: [f32; 3],
}

impl OcclusionHessian {
    /// Traces `rays` probe rays around each of some points, without light yet. The number of a point rotates its rays.
    pub fn at_points(world: &World, points: &[(SurfacePoint, u32)], rays: u32) -> Vec<OcclusionHessian> {
        let of_probes = |probes: Probes| {
            let layers =
                DirectIndirect::from_fn(|_| LayerLight { cells: CellLight::new(&probes), smooth: [0.0; 3] });
            OcclusionHessian { probes, layers }
        };
        Probes::trace(world, points, rays).into_iter().map(of_probes).collect()
    }

    /// Returns the harmonic mean distance of the visible surfaces.
    pub fn distance(&self) -> f32 {
        self.probes.harmonic_mean()
    }

    /// Adds the light of a cluster at several points to the hessian of each.
    pub fn add_arriving(hessians: &mut [OcclusionHessian], origin: Origin, light: &Arriving16) {
        let turns = azimuths16(&light.direction);
        for (lane, hessian) in hessians.iter_mut().enumerate().take(LANES) {
            let passed = light.passed.get(lane);
            if passed != Rgb::ZERO {
                let (direction, inverse) = (light.direction.get(lane), light.inverse[lane]);
                let cells = &mut hessian.layers[origin].cells;
                cells.add(&hessian.probes, direction, turns[lane], inverse, passed);
            }
        }
    }

    /// Adds second derivatives uu, uv, vv of the luminance of a layer at constant visibility.
    pub fn add_smooth(&mut self, origin: Origin, derivatives: [f32; 3]) {
        for (sum, derivative) in self.layers[origin].smooth.iter_mut().zip(derivatives) {
            *sum += derivative;
        }
    }

    /// Adds to a layer the irradiance that a patch of surface gives. `offset` is its position in the frame of the
    /// normal, `patch_normal` its unit normal in that frame.
    #[inline]
    pub fn add_patch(&mut self, origin: Origin, offset: Vec3, patch_normal: Vec3, irradiance: Rgb) {
        let distance_sq = offset.length_squared();
        let direction = offset.normalize_or(Vec3::Z);
        let turns = direction.y.atan2(direction.x) * (1.0 / TAU);
        let inverse = 1.0 / distance_sq.sqrt().max(f32::MIN_POSITIVE);
        self.layers[origin].cells.add(&self.probes, direction, turns, inverse, irradiance);
        let cosines = direction.z * (-direction.dot(patch_normal)).max(MIN_PATCH_COS);
        if !(cosines > 0.0) {
            return;
        }
        let intensity = luminance(irradiance) * distance_sq / cosines;
        let source = LocalVpl::Oriented { offset: offset.to_array(), normal: patch_normal.to_array() };
        self.add_smooth(origin, source.irradiance_hessian(0.0).map(|h| intensity * h));
    }

    /// Returns the derivatives of the light of one layer.
    pub fn derivatives(&self, origin: Origin) -> Derivatives {
        let light = &self.layers[origin];
        let edges = light.cells.edges(&self.probes);
        let (axis, [first, second]) = eigen(light.smooth);
        let absolute = tensor(axis, [first.abs(), second.abs()]);
        let sum = std::array::from_fn(|i| absolute[i] + edges.hessian[i]);
        let (axis, curvature) = eigen(sum);
        let world = |v: Vec2| self.probes.frame.tangent * v.x + self.probes.frame.bitangent * v.y;
        let [x, y, z] = edges.gradient.map(world);
        Derivatives {
            edge_gradient: Mat3::from_cols(x, y, z),
            axes: [world(axis), world(axis.perp())],
            curvature: curvature.map(f32::abs),
        }
    }
}

/// Returns the unit axis of the larger eigenvalue of a symmetric matrix uu, uv, vv, and both eigenvalues, the larger
/// first.
fn eigen([uu, uv, vv]: [f32; 3]) -> (Vec2, [f32; 2]) {
    let (mean, half) = (0.5 * (uu + vv), 0.5 * (uu - vv));
    let radius = half.hypot(uv);
    // The doubled angle of the larger eigenvalue's axis has the tangent uv/half.
    let axis = Vec2::from_angle(0.5 * uv.atan2(half));
    (axis, [mean + radius, mean - radius])
}

/// Returns the symmetric matrix with these eigenvalues along `axis` and across it.
fn tensor(axis: Vec2, [along, across]: [f32; 2]) -> [f32; 3] {
    let (x, y) = (axis.x, axis.y);
    [along * x * x + across * y * y, (along - across) * x * y, along * y * y + across * x * x]
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{MATERIALS, candidate, light};
    use super::super::gather::GatheredLayer16;
    use super::super::lit_cluster::{LitCluster, RecordPoints};
    use super::*;
    use crate::lightcut::Transfer;
    use crate::lights::{Vpl, VplKind};
    use base::math::Vec3x16;
    use scene::Scene;

    #[test]
    fn eigenvectors_and_tensors_are_each_others_inverse() {
        for matrix in [[3.0, 0.5, 1.0], [1.0, -2.0, 4.0], [2.0, 0.0, 2.0], [-1.0, 0.3, -5.0], [0.0; 3]] {
            let (axis, values) = eigen(matrix);
            assert!(values[0] >= values[1]);
            let again = tensor(axis, values);
            assert!((0..3).all(|i| (again[i] - matrix[i]).abs() < 1e-5), "{matrix:?} {again:?}");
        }
    }

    #[test]
    fn without_occluders_the_curvature_is_that_of_the_irradiance() {
        let world = World::new(Scene::default(), 1).expect("the world is built");
        let point = candidate(Vec3::new(0.1, 0.2, 0.3), Vec3::Z).point;
        let (position, facing) = (Vec3::new(0.6, -0.1, 1.2), Vec3::new(-0.3, 0.2, -1.0).normalize());
        for (kind, vpl) in
            [(VplKind::Omni, Vpl::omni(position)), (VplKind::Oriented, Vpl::oriented(position, facing))]
        {
            let trees = light(kind, vpl, Rgb::new(3.0, 1.0, 2.0));
            let transfer = Transfer::new(&trees, 1.0);
            let (node, vpl) = (&trees.nodes[trees.roots[0] as usize], &trees.vpls[0]);
            let irradiance = |offset: Vec3| {
                let receiver = candidate(point.position + offset, Vec3::Z).receiver();
                node.intensity * transfer.unshadowed(&receiver, vpl, kind)
            };
            let here = irradiance(Vec3::ZERO);
            let response = here.x / node.intensity.x;
            let of_light = |retained: f32| {
                let mut hessian = OcclusionHessian::at_points(&world, &[(point, 0)], 64);
                let cluster = LitCluster::new(&transfer, trees.roots[0]);
                let group = [candidate(point.position, Vec3::Z)];
                let points = RecordPoints::new(&group, &MATERIALS);
                let mut layer = GatheredLayer16::default();
                let responses = Vec3x16::splat(Rgb::splat(response));
                let light = points.arriving(&cluster, &responses, [retained; LANES]);
                layer.add(&points, &cluster, &light);
                OcclusionHessian::add_arriving(&mut hessian, Origin::Indirect, &light);
                hessian[0].add_smooth(Origin::Indirect, layer.second_derivatives(0));
                hessian[0].derivatives(Origin::Indirect)
            };
            let found = of_light(1.0);
            assert_eq!(found.edge_gradient, Mat3::ZERO);
            assert!(found.curvature[0] >= found.curvature[1]);
            let step = 0.02;
            for (axis, curvature) in found.axes.into_iter().zip(found.curvature) {
                let at = |by: f32| luminance(irradiance(axis * by));
                let truth = (at(step) - 2.0 * at(0.0) + at(-step)) / (step * step);
                assert!((curvature - truth.abs()).abs() < 0.01 * luminance(here), "{curvature} {truth}");
            }
            // A patch of surface in place of an oriented light of the same contribution has the same
            // derivatives.
            if kind == VplKind::Oriented {
                let mut patch = OcclusionHessian::at_points(&world, &[(point, 0)], 64).remove(0);
                let local = |v: Vec3| patch.probes.frame.to_local(v);
                let (offset, normal) = (local(position - point.position), local(vpl.normal()));
                patch.add_patch(Origin::Direct, offset, normal, here);
                let curvature = patch.derivatives(Origin::Direct).curvature;
                let scale = found.curvature[0];
                assert!((0..2).all(|i| (curvature[i] - found.curvature[i]).abs() < 1e-3 * scale));
                assert_eq!(patch.derivatives(Origin::Indirect).curvature, [0.0; 2]);
            }
            // A clamped light is taken not to change.
            assert_eq!(of_light(0.5).curvature, [0.0; 2]);
        }
    }
}
