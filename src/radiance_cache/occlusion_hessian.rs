//! Derivatives of a record's irradiance over the surface, with the motion of occluders' edges.
//!
//! Paper: Schwarzhaupt, Jensen and Jarosz 2012: footprints from second derivatives that know of occlusion.
//! Deviations: the smooth part is exact for the virtual lights with visibility held; the edges' part is an upper
//! estimate (see [`super::edges`]), so their absolute values are added.

use super::edges::CellLight;
use super::gather::LitCluster;
use super::probe::Probes;
use crate::gradient::LocalVpl;
use crate::math::{Rgb, luminance};
use crate::vpl::{DirectIndirect, Origin, VplKind};
use crate::world::{SurfacePoint, World};
use glam::{Mat3, Vec2, Vec3};

/// Smallest cosine at which a patch is taken to be seen: its share of the hemisphere does not vanish with it.
const MIN_PATCH_COS: f32 = 0.2;

/// Surfaces seen from a point, and the light of both layers that they send.
#[derive(Clone, Debug)]
pub struct OcclusionHessian {
    position: Vec3,
    probes: Probes,
    layers: DirectIndirect<LayerLight>,
}

/// Light of one layer.
#[derive(Clone, Debug)]
struct LayerLight {
    cells: CellLight,
    /// Second derivatives uu, uv, vv of the luminance while visibility is held.
    held: [f32; 3],
}

/// Derivatives of the irradiance over the surface.
#[derive(Clone, Copy, Debug)]
pub struct Derivatives {
    /// Gradient per channel (columns) by moving edges, in world space.
    pub edge_gradient: Mat3,
    /// Unit tangent axes: of the largest second derivative, and across.
    pub axes: [Vec3; 2],
    /// Absolute second derivatives of the luminance along them.
    pub curvature: [f32; 2],
}

impl OcclusionHessian {
    /// Traces `rays` to the surfaces around a point; no light yet. `seed` turns the rays.
    pub fn new(world: &World, point: &SurfacePoint, rays: u32, seed: u32) -> OcclusionHessian {
        let probes = Probes::trace(world, point, rays, seed);
        let layers =
            DirectIndirect::from_fn(|_| LayerLight { cells: CellLight::new(&probes), held: [0.0; 3] });
        OcclusionHessian { position: point.position, probes, layers }
    }

    /// Returns the harmonic mean distance of the visible surfaces.
    pub fn distance(&self) -> f32 {
        self.probes.harmonic_mean()
    }

    /// Adds a visible cluster of the cut, of which the irradiance `passed` is left after clamping and coat. A clamped
    /// one does not change with the receiver.
    #[inline]
    pub fn add(&mut self, cluster: &LitCluster, passed: Rgb) {
        let &LitCluster { node, vpl, irradiance, kept, .. } = cluster;
        let frame = &self.probes.frame;
        let layer = &mut self.layers[node.origin()];
        let kind = node.kind();
        if kind == VplKind::Directional {
            let direction = frame.to_local(vpl.position);
            layer.cells.add(&self.probes, direction, None, passed);
            return;
        }
        let offset = frame.to_local(vpl.position - self.position);
        layer.cells.add(&self.probes, offset.normalize_or(Vec3::Z), Some(offset), passed);
        if kept < 1.0 {
            return;
        }
        let y = luminance(irradiance);
        let scale = luminance(node.intensity) * luminance(passed) / y.max(f32::MIN_POSITIVE);
        let source = LocalVpl::of_vpl(frame, self.position, vpl, kind);
        for (sum, h) in layer.held.iter_mut().zip(source.irradiance_hessian(cluster.near_sq())) {
            *sum += scale * h;
        }
    }

    /// Adds to a layer the irradiance that a patch of surface gives, seen at `offset` in the frame of the normal;
    /// `patch_normal` is of unit length and in that frame too.
    #[inline]
    pub fn add_patch(&mut self, origin: Origin, offset: Vec3, patch_normal: Vec3, irradiance: Rgb) {
        let distance_sq = offset.length_squared();
        let direction = offset.normalize_or(Vec3::Z);
        let layer = &mut self.layers[origin];
        layer.cells.add(&self.probes, direction, Some(offset), irradiance);
        let cosines = direction.z * (-direction.dot(patch_normal)).max(MIN_PATCH_COS);
        if !(cosines > 0.0) {
            return;
        }
        let intensity = luminance(irradiance) * distance_sq / cosines;
        let source = LocalVpl::Oriented { offset: offset.to_array(), normal: patch_normal.to_array() };
        for (sum, h) in layer.held.iter_mut().zip(source.irradiance_hessian(0.0)) {
            *sum += intensity * h;
        }
    }

    /// Derivatives of the light of one layer.
    pub fn derivatives(&self, origin: Origin) -> Derivatives {
        let light = &self.layers[origin];
        let edges = light.cells.edges(&self.probes);
        let (axis, [first, second]) = eigen(light.held);
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

/// Unit axis of the larger eigenvalue of a symmetric matrix uu, uv, vv, and both eigenvalues, the larger one
/// first.
fn eigen([uu, uv, vv]: [f32; 3]) -> (Vec2, [f32; 2]) {
    let (mean, half) = (0.5 * (uu + vv), 0.5 * (uu - vv));
    let radius = half.hypot(uv);
    // The axis of the larger one, twice whose angle has the tangent uv/half.
    let axis = Vec2::from_angle(0.5 * uv.atan2(half));
    (axis, [mean + radius, mean - radius])
}

/// The symmetric matrix with these eigenvalues along `axis` and across it.
fn tensor(axis: Vec2, [along, across]: [f32; 2]) -> [f32; 3] {
    let (x, y) = (axis.x, axis.y);
    [along * x * x + across * y * y, (along - across) * x * y, along * y * y + across * x * x]
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{candidate, light};
    use super::*;
    use crate::lightcut::Transfer;
    use crate::scene::Scene;
    use crate::vpl::Vpl;

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
            let mut hessian = OcclusionHessian::new(&world, &point, 64, 0);
            hessian.add(&LitCluster { transfer: &transfer, node, vpl, irradiance: here, kept: 1.0 }, here);
            let found = hessian.derivatives(Origin::Indirect);
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
                let mut patch = OcclusionHessian::new(&world, &point, 64, 0);
                let local = |v: Vec3| patch.probes.frame.to_local(v);
                let (offset, normal) = (local(position - point.position), local(vpl.normal()));
                patch.add_patch(Origin::Direct, offset, normal, here);
                let curvature = patch.derivatives(Origin::Direct).curvature;
                let scale = found.curvature[0];
                assert!((0..2).all(|i| (curvature[i] - found.curvature[i]).abs() < 1e-3 * scale));
                assert_eq!(patch.derivatives(Origin::Indirect).curvature, [0.0; 2]);
            }
            // A clamped light is taken not to change.
            let mut clamped = OcclusionHessian::new(&world, &point, 64, 0);
            clamped.add(&LitCluster { transfer: &transfer, node, vpl, irradiance: here, kept: 0.5 }, here);
            assert_eq!(clamped.derivatives(Origin::Indirect).curvature, [0.0; 2]);
        }
    }
}
