//! Seen meshes: stored meshes at their places.
//!
//! Hits, surfaces and ids number the seen meshes: first the meshes in the scene's coordinates, then the meshes of each
//! group, placement by placement.

use super::{Mesh, Scene};
use base::math::Placement;
use glam::Vec3;

impl Mesh {
    /// Returns the lowest and the highest corner of the box around all triangles; `None` without triangles.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        let corners = self.triangles.iter().flatten().filter_map(|i| self.positions.get(*i as usize));
        let empty = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        let [low, high] = corners.fold(empty, |[low, high], p| [low.min(*p), high.max(*p)]);
        low.cmple(high).all().then_some([low, high])
    }
}

impl Scene {
    /// Returns the number of meshes that are stored in the scene's coordinates.
    pub fn own_mesh_count(&self) -> usize {
        self.groups.first().map_or(self.meshes.len(), |group| group.meshes.start)
    }

    /// Returns all seen meshes in the order of their numbers: the index of each in [`Scene::meshes`], and its placement
    /// if it is in a group.
    pub fn seen(&self) -> impl Iterator<Item = (usize, Option<&Placement>)> {
        let own = (0..self.own_mesh_count()).map(|mesh| (mesh, None));
        let placed = self.groups.iter().flat_map(|group| {
            let at = |placement| group.meshes.clone().map(move |mesh| (mesh, Some(placement)));
            group.placements.iter().flat_map(at)
        });
        own.chain(placed)
    }

    /// Returns the number of times that each stored mesh is seen.
    pub fn uses(&self) -> Vec<usize> {
        let mut uses = vec![1; self.meshes.len()];
        for group in &self.groups {
            uses[group.meshes.clone()].fill(group.placements.len());
        }
        uses
    }

    /// Returns the area of each stored mesh at all its places, in units of its own. Placements that stretch count by
    /// their mean over directions.
    pub fn area_factors(&self) -> Vec<f64> {
        let mut factors = vec![1.0; self.meshes.len()];
        for group in &self.groups {
            factors[group.meshes.clone()].fill(group.placements.iter().map(Placement::area_scale).sum());
        }
        factors
    }

    /// Returns the number of triangles that are seen. Triangles of groups count at each placement.
    pub fn seen_triangle_count(&self) -> usize {
        self.meshes.iter().zip(self.uses()).map(|(mesh, uses)| mesh.triangles.len() * uses).sum()
    }

    /// Returns boxes around the seen meshes for which `is_wanted` is true. Boxes at placements may be larger than
    /// needed.
    pub fn seen_bounds(&self, is_wanted: impl Fn(&Mesh) -> bool) -> Vec<[Vec3; 2]> {
        let wanted = |mesh: &Mesh| mesh.bounds().filter(|_| is_wanted(mesh));
        let bounds: Vec<Option<[Vec3; 2]>> = self.meshes.iter().map(wanted).collect();
        let placed = |(mesh, placement): (usize, Option<&Placement>)| {
            let own = bounds[mesh]?;
            Some(placement.map_or(own, |placement| placement.bounds(own)))
        };
        self.seen().filter_map(placed).collect()
    }
}
