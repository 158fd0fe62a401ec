//! Things made of several parts, a chair of wood and cloth say.
//!
//! A thing is built once about its own origin and placed as often as needed, or built where it stands in a frame and
//! merged; every shell goes to the part of its name.

use super::{Part, Shell};
use glam::Affine3A;

/// Parts by name, in the order in which they were first named.
#[derive(Clone, Debug, Default)]
pub struct Assembly {
    parts: Vec<Part>,
    /// Transform of whatever is added or placed, if any.
    frame: Option<Affine3A>,
}

impl Assembly {
    /// Assembly without parts.
    pub fn new() -> Self {
        Assembly::default()
    }

    /// Assembly without parts; `frame` moves whatever is added or placed.
    pub fn framed(frame: Affine3A) -> Self {
        Assembly { frame: Some(frame), ..Assembly::default() }
    }

    /// Part called `name`, which becomes the last one where it is new.
    fn part(&mut self, name: &str) -> &mut Part {
        let index = self.parts.iter().position(|p| p.name == name).unwrap_or_else(|| {
            self.parts.push(Part::new(name));
            self.parts.len() - 1
        });
        &mut self.parts[index]
    }

    fn framed_by(&self, transform: Affine3A) -> Affine3A {
        self.frame.map_or(transform, |frame| frame * transform)
    }

    /// Appends `shell` to the part called `name`.
    pub fn add(&mut self, name: &str, shell: &Shell) {
        self.add_at(name, shell, Affine3A::IDENTITY);
    }

    /// Appends `shell` placed by `transform` to the part called `name`.
    pub fn add_at(&mut self, name: &str, shell: &Shell, transform: Affine3A) {
        let transform = self.framed_by(transform);
        self.part(name).add(shell, transform);
    }

    /// Appends a copy of `shell` for each of `transforms` to the part called `name`.
    pub fn add_each(&mut self, name: &str, shell: &Shell, transforms: impl IntoIterator<Item = Affine3A>) {
        for transform in transforms {
            self.add_at(name, shell, transform);
        }
    }

    /// Appends a copy of all parts of `piece` placed by `transform`.
    pub fn place(&mut self, piece: &Assembly, transform: Affine3A) {
        let transform = self.framed_by(transform);
        for part in &piece.parts {
            self.part(&part.name).append(part, transform);
        }
    }

    /// Appends all parts of `piece` where they stand.
    pub fn merge(&mut self, piece: Assembly) {
        for part in piece.parts {
            self.part(&part.name).merge(part);
        }
    }

    /// All parts.
    pub fn into_parts(self) -> Vec<Part> {
        self.parts
    }
}

#[cfg(test)]
mod tests {
    use super::super::{at, block, turned};
    use super::*;
    use glam::Vec3;

    #[test]
    fn placing_an_assembly_keeps_its_parts_apart_and_moves_them_together() {
        let mut chair = Assembly::new();
        chair.add("wood", &block(Vec3::ZERO, Vec3::ONE));
        chair.add_at("cloth", &block(Vec3::ZERO, Vec3::ONE), at(0.0, 1.0, 0.0));
        let mut room = Assembly::new();
        room.place(&chair, at(10.0, 0.0, 0.0));
        room.place(&chair, at(20.0, 0.0, 0.0));
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

    #[test]
    fn an_assembly_built_in_a_frame_is_the_one_placed_by_it() {
        let frame = turned(30.0, [1.0, 2.0, 3.0]);
        let build = |mut piece: Assembly| {
            piece.add_at("wood", &block(Vec3::ZERO, Vec3::ONE), at(0.5, 0.0, 0.0));
            piece
        };
        let mut placed = Assembly::new();
        placed.place(&build(Assembly::new()), frame);
        let mut merged = Assembly::new();
        merged.add("wood", &block(Vec3::ZERO, Vec3::ONE));
        merged.merge(build(Assembly::framed(frame)));
        let [placed, merged] = [placed, merged].map(|a| a.into_parts().remove(0));
        assert_eq!(merged.triangles.len(), 24);
        for (p, q) in placed.positions.iter().zip(&merged.positions[24..]) {
            assert!(p.distance(*q) < 1e-5, "{p} {q}");
        }
    }
}
