//! Sixteen surface points at once.

use super::triangle::position;
use super::{Surface, World};
use crate::material::{Bsdf, Bsdfs16, MeanBsdf};
use base::math::{Cone, F32x16, Frame, LANES, Rgb, U32x16, Vec2x16, Vec3x16, lanes_in, mask_of};
use embree::Hits16;
use glam::Vec2;
use scene::AttributeId;

/// Surfaces hit by sixteen rays; see [`Surface`] for the fields.
#[derive(Clone, Debug, Default)]
pub struct Surfaces16 {
    /// Positions.
    pub position: Vec3x16,
    /// Unit geometric normals.
    pub normal: Vec3x16,
    /// Tangents of the shading frames.
    pub tangent: Vec3x16,
    /// Bitangents of the shading frames.
    pub bitangent: Vec3x16,
    /// Normals of the shading frames.
    pub shading_normal: Vec3x16,
    /// Barycentric weights of corners 1 and 2.
    pub barycentric: Vec2x16,
    /// Indices of the meshes.
    pub mesh: U32x16,
    /// Indices of the triangles in the meshes.
    pub triangle: U32x16,
    /// Distances along the rays.
    pub t: F32x16,
    /// Vectors along the rays, as long as the cones around the rays are wide.
    pub footprint: Vec3x16,
}

impl Surfaces16 {
    /// Returns the shading frame of a lane.
    #[inline(always)]
    pub fn frame(&self, lane: usize) -> Frame {
        Frame {
            tangent: self.tangent.get(lane),
            bitangent: self.bitangent.get(lane),
            normal: self.shading_normal.get(lane),
        }
    }

    /// Returns the surface of a lane.
    #[inline]
    pub fn get(&self, lane: usize) -> Surface {
        Surface {
            position: self.position.get(lane),
            normal: self.normal.get(lane),
            frame: self.frame(lane),
            barycentric: self.barycentric.get(lane),
            mesh: self.mesh[lane],
            triangle: self.triangle[lane],
            t: self.t[lane],
            footprint: self.footprint.get(lane),
        }
    }
}

impl World {
    /// Returns the surfaces at sixteen hits, all of which must be valid, with reliefs as they are without a viewer.
    #[inline]
    pub fn surfaces(&self, hits: &Hits16) -> Surfaces16 {
        self.surfaces_along(hits, &Vec3x16::ZERO)
    }

    /// Returns the surfaces that rays along `directions` hit, all of which must be valid.
    #[inline]
    pub fn surfaces_along(&self, hits: &Hits16, directions: &Vec3x16) -> Surfaces16 {
        let mut s =
            Surfaces16 { mesh: hits.geometry, triangle: hits.primitive, t: hits.t, ..Default::default() };
        s.barycentric = Vec2x16 { x: hits.u, y: hits.v };
        let (mut corner, mut edges) = (Vec3x16::default(), [Vec3x16::default(); 2]);
        for i in 0..LANES {
            let triangle = self.triangles.get(s.mesh[i], s.triangle[i]);
            corner.set(i, triangle.corner);
            edges[0].set(i, triangle.edges[0]);
            edges[1].set(i, triangle.edges[1]);
            s.normal.set(i, triangle.normal);
            let mesh = self.mesh(s.mesh[i]);
            let shading = mesh.normal(&triangle.vertices, s.barycentric.get(i)).unwrap_or(triangle.normal);
            s.shading_normal.set(i, shading);
        }
        if self.instances.is_some() {
            self.place_lanes(&mut s, &mut corner, &mut edges);
        }
        for i in 0..LANES {
            let at = position(corner.get(i), [edges[0].get(i), edges[1].get(i)], s.barycentric.get(i));
            s.position.set(i, at);
        }
        for i in 0..LANES {
            let shading = s.shading_normal.get(i).try_normalize().unwrap_or(s.normal.get(i));
            let frame = Frame::from_normal(shading);
            s.tangent.set(i, frame.tangent);
            s.bitangent.set(i, frame.bitangent);
            s.shading_normal.set(i, frame.normal);
        }
        if let Some(reliefs) = &self.reliefs {
            for i in 0..LANES {
                let frame = self.with_triangle(s.mesh[i], s.triangle[i], |seen, triangle| {
                    let mut surface = s.get(i);
                    reliefs.turn(&mut surface, seen, triangle, -directions.get(i));
                    surface.frame
                });
                s.tangent.set(i, frame.tangent);
                s.bitangent.set(i, frame.bitangent);
                s.shading_normal.set(i, frame.normal);
            }
        }
        s
    }

    /// Moves the corners, edges and normals of lanes whose meshes are in groups to the scene's coordinates.
    #[inline(never)]
    fn place_lanes(&self, s: &mut Surfaces16, corner: &mut Vec3x16, edges: &mut [Vec3x16; 2]) {
        for i in 0..LANES {
            let Some(placement) = self.placement(s.mesh[i]) else { continue };
            corner.set(i, placement.point(corner.get(i)));
            edges.iter_mut().for_each(|edge| edge.set(i, placement.vector(edge.get(i))));
            let normal = placement.normal(s.normal.get(i));
            s.normal.set(i, normal);
            let vertices = &self.triangles.get(s.mesh[i], s.triangle[i]).vertices;
            let shading = self.seen(s.mesh[i]).normal(vertices, s.barycentric.get(i));
            s.shading_normal.set(i, shading.unwrap_or(normal));
        }
    }

    /// Sets the footprints of rays along `direction` that hit `surfaces`, in the lanes of `hit`. `cone` returns the
    /// cone around a lane's ray.
    #[inline]
    pub fn cover(
        &self,
        surfaces: &mut Surfaces16,
        direction: &Vec3x16,
        hit: u16,
        cone: impl Fn(usize) -> Cone,
    ) {
        if self.filters_textures() {
            for lane in lanes_in(hit) {
                let width = cone(lane).width_at(surfaces.t[lane]);
                surfaces.footprint.set(lane, direction.get(lane) * width);
            }
        }
    }

    /// Returns the BSDFs of the surfaces at their texture coordinates, seen from `wo` in their shading frames.
    #[inline]
    pub fn bsdfs(&self, s: &Surfaces16, wo: Vec3x16) -> Bsdfs16<'_> {
        let at = self.textured(s, u16::MAX);
        Bsdfs16::new(wo, |i| {
            let mesh = self.mesh(s.mesh[i]);
            let uv = || at[i].unwrap_or_else(|| self.coordinates(s, i));
            let covered = || self.covered(s.mesh[i], s.triangle[i], s.footprint.get(i));
            let bsdf =
                self.materials.at_coordinates(mesh.material, uv, covered, |id| self.attribute(s, i, id));
            bsdf.on_relief(|| self.level_normal(&s.get(i)))
        })
    }

    /// Returns the lanes whose materials scatter light by densities alone: by no mirrors, no glass and no gaps.
    #[inline]
    pub fn with_densities_alone(&self, mesh: &U32x16) -> u16 {
        let alone = |mesh: u32| self.materials.has_only_densities(self.material(mesh));
        if *mesh == [mesh[0]; LANES] {
            return if alone(mesh[0]) { u16::MAX } else { 0 };
        }
        mask_of(&mesh.map(|mesh| u32::from(alone(mesh))))
    }

    /// Returns the mean of the materials of some lanes, all of one material, and the lanes that it stands for. Lanes
    /// whose lobes differ from those of the first lane are left out.
    pub fn mean_bsdf(&self, s: &Surfaces16, lanes: u16) -> (Bsdf<'_>, u16) {
        let first = lanes.trailing_zeros() as usize;
        let id = self.material(s.mesh[first]);
        if let Some(bsdf) = self.materials.constant(id) {
            return (bsdf, lanes);
        }
        let at = self.textured(s, lanes);
        let uv = |i: usize| at[i].unwrap_or_else(|| self.coordinates(s, i));
        let covered = |i: usize| self.covered(s.mesh[i], s.triangle[i], s.footprint.get(i));
        if self.materials.averages_texels(id) {
            let (mut places, mut at, mut count) = ([(Vec2::ZERO, 0.0); LANES], [0; LANES], 0);
            for lane in lanes_in(lanes) {
                places[count] = (uv(lane), covered(lane));
                at[count] = lane;
                count += 1;
            }
            let attribute = |place: usize, id| self.attribute(s, at[place], id);
            return (self.materials.mean(id, &places[..count], attribute), lanes);
        }
        let attribute = |i, id| self.attribute(s, i, id);
        let bsdf =
            |i| self.materials.at_coordinates(id, || uv(i), || covered(i), |found| attribute(i, found));
        let (first_bsdf, mut taken) = (bsdf(first), 1 << first);
        let mut mean = MeanBsdf::new(first_bsdf);
        for lane in lanes_in(lanes & !taken) {
            let bsdf = bsdf(lane);
            if bsdf.same_lobes(&first_bsdf) && bsdf.coat() == first_bsdf.coat() {
                mean.add(&bsdf);
                taken |= 1 << lane;
            }
        }
        (mean.mean(), taken)
    }

    /// Returns the value of an attribute in a lane.
    fn attribute(&self, s: &Surfaces16, lane: usize, id: AttributeId) -> Rgb {
        let mesh = self.mesh(s.mesh[lane]);
        mesh.attribute(id, s.triangle[lane] as usize, s.barycentric.get(lane))
    }

    /// Returns the texture coordinates in a lane.
    #[inline]
    fn coordinates(&self, s: &Surfaces16, lane: usize) -> Vec2 {
        let vertices = &self.triangles.get(s.mesh[lane], s.triangle[lane]).vertices;
        self.mesh(s.mesh[lane]).uv(vertices, s.barycentric.get(lane))
    }

    /// Returns the texture coordinates of the surfaces in `lanes` that are textured. It also reads some of their
    /// texels, so that the lanes wait for memory together.
    #[inline]
    fn textured(&self, s: &Surfaces16, lanes: u16) -> [Option<Vec2>; LANES] {
        let (mut at, mut squares) = ([None; LANES], [None; LANES]);
        for i in lanes_in(lanes) {
            if let Some(texture) = self.materials.texture(self.material(s.mesh[i])) {
                let uv = self.coordinates(s, i);
                at[i] = Some(uv);
                squares[i] = Some((&texture.texels, texture.square(uv)));
            }
        }
        // This loop is short enough for the processor to look ahead over all lanes.
        let read = squares.iter().flatten().fold(0, |read, (texels, square)| read ^ texels.peek(*square));
        std::hint::black_box(read);
        at
    }
}
