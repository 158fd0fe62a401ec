//! Absorption coefficients of the bodies of glass in a scene.

use base::math::Rgb;
use scene::Scene;

/// Absorption coefficients of a scene.
#[derive(Clone, Debug, Default)]
pub(super) struct Absorption {
    /// Coefficient by seen mesh, 0 for those that do not absorb; empty if no mesh does.
    by_mesh: Vec<Rgb>,
}

impl Absorption {
    /// Collects the coefficients of a scene.
    pub fn new(scene: &Scene) -> Absorption {
        let of = |id: usize| scene.materials.get(id).and_then(|material| material.interior_absorption());
        let by_mesh: Vec<Rgb> =
            scene.meshes.iter().map(|mesh| of(mesh.material.0 as usize).unwrap_or(Rgb::ZERO)).collect();
        match by_mesh.iter().all(|absorption| *absorption == Rgb::ZERO) {
            true => Absorption::default(),
            false => Absorption { by_mesh: scene.seen().map(|(mesh, _)| by_mesh[mesh]).collect() },
        }
    }

    /// Returns true if no mesh absorbs.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.by_mesh.is_empty()
    }

    /// Returns the coefficient inside a mesh; `None` if it does not absorb.
    #[inline]
    pub fn of(&self, mesh: u32) -> Option<Rgb> {
        self.by_mesh.get(mesh as usize).copied().filter(|absorption| *absorption != Rgb::ZERO)
    }
}
