//! Visibility in a real scene: one shadow ray a query.

use super::transfer::Visibility;
use crate::light_tree::Node;
use crate::vpl::{Vpl, VplKind};
use crate::world::World;
use glam::Vec3;

impl Visibility for World {
    #[inline]
    fn visible(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &Node) -> bool {
        match node.kind() {
            VplKind::Oriented => World::visible(self, x, normal, vpl.position, vpl.normal()),
            VplKind::Omni => World::visible(self, x, normal, vpl.position, Vec3::ZERO),
            VplKind::Directional => self.escapes(x, normal, vpl.position),
        }
    }
}
