//! What a record's point sees: the surfaces around it, the light that comes from each, and how both move.
//!
//! Paper: Schwarzhaupt, Jensen and Jarosz 2012: footprints from second derivatives that know of occlusion.
//! Deviations: the smooth part is exact for the virtual lights with visibility held; the edges' part is an upper
//! estimate (see [`super::edges`]), so their absolute values are added.

use super::edges::CellLight;
use super::probe::Probes;
use crate::gradient::LocalVpl;
use crate::light_tree::Node;
use crate::lightcut::Transfer;
use crate::math::{Frame, Rgb, luminance};
use crate::vpl::{Vpl, VplKind};
use crate::world::World;
use glam::{Mat3, Vec2, Vec3};

/// Least cosine at which a patch is taken to be seen: its share of the hemisphere does not vanish with it.
const LEAST_PATCH_COS: f32 = 0.2;

/// Surfaces seen from a point, and the light of both layers that they send.
#[derive(Clone, Debug)]
pub struct Sight {
    position: Vec3,
    probes: Probes,
    layers: [SeenLight; 2],
}

/// Light of one layer.
#[derive(Clone, Debug)]
struct SeenLight {
    cells: CellLight,
    /// Second derivatives uu, uv, vv of the luminance while visibility is held.
    held: [f32; 3],
}

/// What the edges of occluders add to a layer, and how far extrapolation may go.
#[derive(Clone, Copy, Debug)]
pub struct Change {
    /// Gradient per channel (columns) by moving edges, in world space.
    pub gradient: Mat3,
    /// Unit tangent axes: of the largest second derivative, and across.
    pub axes: [Vec3; 2],
    /// Absolute second derivatives of the luminance along them.
    pub curvature: [f32; 2],
}

impl Sight {
    /// Looks around by `rays` from a point at a position on a surface of the given geometric normal. `seed` turns them.
    pub fn new(
        world: &World,
        (position, geometric_normal): (Vec3, Vec3),
        normal: Vec3,
        rays: u32,
        seed: u32,
    ) -> Sight {
        let frame = Frame::from_normal(normal);
        let probes = Probes::trace(world, (position, geometric_normal), &frame, rays, seed);
        let dark = || SeenLight { cells: CellLight::new(&probes), held: [0.0; 3] };
        let layers = [dark(), dark()];
        Sight { position, probes, layers }
    }

    /// Harmonic mean distance of what is seen.
    pub fn distance(&self) -> f32 {
        self.probes.harmonic_mean()
    }

    /// Adds a visible cluster of the cut to a layer: `contribution` by its representative, `passed` of which is
    /// kept. A clamped one (`held`) does not change with the receiver.
    #[inline]
    pub fn add(
        &mut self,
        layer: usize,
        transfer: &Transfer,
        (node, vpl): (&Node, &Vpl),
        contribution: Rgb,
        passed: Rgb,
        held: bool,
    ) {
        let frame = &self.probes.frame;
        let layer = &mut self.layers[layer];
        let kind = node.kind();
        if kind == VplKind::Directional {
            let direction = frame.to_local(vpl.position);
            layer.cells.add(&self.probes, direction, None, passed);
            return;
        }
        let offset = frame.to_local(vpl.position - self.position);
        layer.cells.add(&self.probes, offset.normalize_or(Vec3::Z), Some(offset), passed);
        if held {
            return;
        }
        let y = luminance(contribution);
        let scale = luminance(node.intensity) * luminance(passed) / y.max(f32::MIN_POSITIVE);
        let source = LocalVpl::of_vpl(frame, self.position, vpl, kind);
        for (sum, h) in layer.held.iter_mut().zip(source.irradiance_hessian(transfer.near_sq(vpl, kind))) {
            *sum += scale * h;
        }
    }

    /// Adds to a layer the irradiance that a patch of surface gives, seen at `offset` in the frame of the normal;
    /// `patch_normal` is of unit length and in that frame too.
    #[inline]
    pub fn add_patch(&mut self, layer: usize, offset: Vec3, patch_normal: Vec3, irradiance: Rgb) {
        let distance_sq = offset.length_squared();
        let direction = offset.normalize_or(Vec3::Z);
        let layer = &mut self.layers[layer];
        layer.cells.add(&self.probes, direction, Some(offset), irradiance);
        let cosines = direction.z * (-direction.dot(patch_normal)).max(LEAST_PATCH_COS);
        if !(cosines > 0.0) {
            return;
        }
        let intensity = luminance(irradiance) * distance_sq / cosines;
        let source = LocalVpl::Oriented { offset: offset.to_array(), normal: patch_normal.to_array() };
        for (sum, h) in layer.held.iter_mut().zip(source.irradiance_hessian(0.0)) {
            *sum += intensity * h;
        }
    }

    /// First derivatives by edges, and absolute second derivatives.
    pub fn change(&self, layer: usize) -> Change {
        let light = &self.layers[layer];
        let edges = light.cells.edges(&self.probes);
        let (axis, [first, second]) = eigen(light.held);
        let absolute = tensor(axis, [first.abs(), second.abs()]);
        let sum = std::array::from_fn(|i| absolute[i] + edges.hessian[i]);
        let (axis, curvature) = eigen(sum);
        let world = |v: Vec2| self.probes.frame.tangent * v.x + self.probes.frame.bitangent * v.y;
        let [x, y, z] = edges.gradient.map(world);
        Change {
            gradient: Mat3::from_cols(x, y, z),
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
    use super::*;

    #[test]
    fn eigenvectors_and_tensors_are_each_others_inverse() {
        for matrix in [[3.0, 0.5, 1.0], [1.0, -2.0, 4.0], [2.0, 0.0, 2.0], [-1.0, 0.3, -5.0], [0.0; 3]] {
            let (axis, values) = eigen(matrix);
            assert!(values[0] >= values[1]);
            let again = tensor(axis, values);
            assert!((0..3).all(|i| (again[i] - matrix[i]).abs() < 1e-5), "{matrix:?} {again:?}");
        }
    }
}
