//! Things made of several parts, a chair of wood and cloth say: built once about their own origin, then
//! placed as a whole, every shell going to the part of its name.

use super::{Part, Shell};
use glam::Affine3A;

/// Parts by name, in the order in which they were first named.
#[derive(Clone, Debug, Default)]
pub struct Assembly {
    parts: Vec<Part>,
}

impl Assembly {
    /// An assembly without parts.
    pub fn new() -> Self {
        Assembly::default()
    }

    /// The part called `name`, which becomes the last one where it is new.
    pub fn part(&mut self, name: &str) -> &mut Part {
        let index = match self.parts.iter().position(|p| p.name == name) {
            Some(index) => index,
            None => {
                self.parts.push(Part::new(name));
                self.parts.len() - 1
            }
        };
        &mut self.parts[index]
    }

    /// Appends `shell` as it stands to the part called `name`.
    pub fn add(&mut self, name: &str, shell: &Shell) {
        self.part(name).add(shell);
    }

    /// Appends `shell` placed by `transform` to the part called `name`.
    pub fn add_at(&mut self, name: &str, shell: &Shell, transform: &Affine3A) {
        self.part(name).add_at(shell, transform);
    }

    /// Appends a copy of all parts of `piece` placed by `transform`.
    pub fn place(&mut self, piece: &Assembly, transform: &Affine3A) {
        for part in &piece.parts {
            self.part(&part.name).append(part, transform);
        }
    }

    /// The parts.
    pub fn into_parts(self) -> Vec<Part> {
        self.parts
    }
}

#[cfg(test)]
mod tests {
    use super::super::{at, block};
    use super::*;
    use glam::Vec3;

    #[test]
    fn placing_an_assembly_keeps_its_parts_apart_and_moves_them_together() {
        let mut chair = Assembly::new();
        chair.add("wood", &block(Vec3::ZERO, Vec3::ONE));
        chair.add_at("cloth", &block(Vec3::ZERO, Vec3::ONE), &at(0.0, 1.0, 0.0));
        let mut room = Assembly::new();
        room.place(&chair, &at(10.0, 0.0, 0.0));
        room.place(&chair, &at(20.0, 0.0, 0.0));
        let parts = room.into_parts();
        let names: Vec<_> = parts.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names, ["wood", "cloth"]);
        let bounds = |part: &Part| {
            let low = part.positions.iter().copied().reduce(Vec3::min);
            (low, part.positions.iter().copied().reduce(Vec3::max), part.triangles.len())
        };
        let corners = |low, high| (Some(low), Some(high), 24);
        assert_eq!(bounds(&parts[0]), corners(Vec3::new(10.0, 0.0, 0.0), Vec3::new(21.0, 1.0, 1.0)));
        assert_eq!(bounds(&parts[1]), corners(Vec3::new(10.0, 1.0, 0.0), Vec3::new(21.0, 2.0, 1.0)));
    }
}
