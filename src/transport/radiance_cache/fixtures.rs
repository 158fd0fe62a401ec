//! Records, eye samples and lights for tests.

use super::cells::Candidate;
use super::footprint::Footprint;
use super::record::{Diagnostics, Record};
use super::targets::Targets;
use crate::eye::{PointGeometry, PointSurface, PointSurfaces, ShadingPoints, edge_class};
use crate::lights::{DirectIndirect, LightTrees, Origin, Profiles, Vpl, VplKind, VplSet};
use base::kd_tree::KdTree;
use base::math::{Rgb, luminance};
use base::progress::Control;
use glam::{Mat3, Vec2, Vec3};
use rayon::prelude::*;
use scene::{MaterialId, Scene};
use std::sync::LazyLock;
use world::SurfacePoint;
use world::material::Materials;
use world::testkit::diffuse;

/// Reflectance of the only material.
pub const ALBEDO: Rgb = Rgb::new(0.5, 0.4, 0.8);

/// Scene with one diffuse material and no geometry.
pub static SCENE: LazyLock<Scene> =
    LazyLock::new(|| Scene { materials: vec![diffuse(ALBEDO)], ..Scene::default() });

pub static MATERIALS: LazyLock<Materials> = LazyLock::new(|| Materials::new(&SCENE));

/// Returns a shading point on a floor with the normal z.
pub fn point(position: Vec3) -> PointGeometry {
    PointGeometry { position, spacing: 0.1, normal: Vec3::Z, coat: 0, is_chained: false, edges: u16::MAX }
}

/// Shading points on a floor, in the order of their index.
pub struct Floor {
    pub points: ShadingPoints<'static>,
    pub index: KdTree,
}

impl Floor {
    pub fn new(positions: &[Vec3]) -> Floor {
        let (index, order) = KdTree::build(positions.par_iter().copied());
        let surface = PointSurface {
            bsdf: MATERIALS.at(MaterialId(0), Vec2::ZERO),
            geometric_normal: Vec3::Z,
            out: Vec3::Z,
        };
        let geometry = order.iter().map(|&i| point(positions[i as usize])).collect();
        let mut surfaces = PointSurfaces::default();
        positions.iter().for_each(|_| surfaces.push(&surface));
        Floor { points: ShadingPoints { geometry, surfaces }, index }
    }

    /// Returns `n` by `n` points over the unit square.
    pub fn grid(n: u32) -> Floor {
        let at = |i: u32| Vec3::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5, 0.0) / n as f32;
        Floor::new(&(0..n * n).map(at).collect::<Vec<_>>())
    }

    pub fn targets(&self) -> Targets<'_> {
        Targets::new(&self.points, &self.index, None)
    }
}

/// Returns a record of light from straight above, with these footprint radii along x and y.
pub fn record(position: Vec3, radii: [f32; 2], irradiance: Rgb) -> Record {
    Record {
        position,
        normal: Vec3::Z,
        coat: 0,
        edge_class: edge_class(u16::MAX),
        bands: 0,
        footprint: Footprint { axes: [Vec3::X, Vec3::Y], radii, unraised: radii },
        vector: Mat3::from_cols(Vec3::Z * irradiance.x, Vec3::Z * irradiance.y, Vec3::Z * irradiance.z),
        gradient: Mat3::ZERO,
        luminance: luminance(irradiance),
        diagnostics: Diagnostics::default(),
    }
}

/// Returns a candidate at a point, with both layers missing.
pub fn candidate(position: Vec3, normal: Vec3) -> Candidate {
    Candidate {
        sample: 0,
        point: SurfacePoint { position, normal, geometric_normal: normal },
        cell: 256,
        spacing: 0.1,
        clearance: f32::INFINITY,
        coat: 0,
        edges: u16::MAX,
        bands: 0,
        missing: DirectIndirect { direct: true, indirect: true },
        baseline_luminance: 0.0,
    }
}

/// Returns the trees of a single virtual light of indirect light.
pub fn light(kind: VplKind, vpl: Vpl, intensity: Rgb) -> LightTrees {
    let mut set = VplSet::new(kind, Origin::Indirect);
    set.push(vpl, intensity);
    lit_by(&[set], Profiles::default())
}

pub fn lit_by(sets: &[VplSet], profiles: Profiles) -> LightTrees {
    LightTrees::build(sets, profiles, 1.0, &Control::new())
}
