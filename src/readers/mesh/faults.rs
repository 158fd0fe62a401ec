//! Faults of a mesh file that cost a part of the mesh: each is counted, and reported with its first place.

use crate::error::{Location, Severity, Warning};

/// Fault of a part of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    /// A face of less than three corners.
    FewCorners,
    /// A face with a corner that does not exist.
    NoSuchVertex,
    /// A face with a corner whose position is infinite or no number.
    NoPosition,
    /// A corner whose texture coordinate or normal does not exist.
    NoSuchValue,
    /// A corner whose normal is infinite or no number.
    NoNormal,
    /// A corner whose texture coordinates are infinite or no numbers.
    NoUv,
    /// A vertex or face whose colour is infinite or no number.
    NoColour,
    /// A polygon that crosses itself, so that its surface is approximate.
    Crossing,
}

/// Message about a number of faults, and what is used instead.
const MESSAGES: [(Fault, &str, &str); 8] = [
    (Fault::FewCorners, "faces of less than three corners", "points and lines are left out"),
    (
        Fault::NoSuchVertex,
        "faces with a vertex that does not exist",
        "these faces are left out; repair or re-export the mesh",
    ),
    (
        Fault::NoPosition,
        "faces with a position that is no finite number",
        "these faces are left out; repair or re-export the mesh",
    ),
    (
        Fault::NoSuchValue,
        "corners with a texture coordinate or normal that does not exist",
        "they have none; repair or re-export the mesh",
    ),
    (
        Fault::NoNormal,
        "corners with a normal that is no finite number",
        "the normal of the surface is used instead; repair or re-export the mesh",
    ),
    (
        Fault::NoUv,
        "corners with texture coordinates that are no finite numbers",
        "0 is used instead; repair or re-export the mesh",
    ),
    (
        Fault::NoColour,
        "vertices or faces with a colour that is no finite number",
        "white is used instead; repair or re-export the mesh",
    ),
    (
        Fault::Crossing,
        "polygons that cross themselves",
        "parts of them may be wrong; divide them into triangles in the program that made them",
    ),
];

/// Faults by kind: their number, and the first one's place.
#[derive(Default)]
pub(super) struct Faults([(usize, Option<Location>); MESSAGES.len()]);

impl Faults {
    /// Counts a fault.
    pub fn add(&mut self, fault: Fault, place: impl FnOnce() -> Location) {
        let (count, first) = &mut self.0[fault as usize];
        *count += 1;
        first.get_or_insert_with(place);
    }

    /// Adds a warning for each kind of fault to `remarks`.
    pub fn report(self, remarks: &mut Vec<Warning>) {
        for ((count, place), (_, what, fallback)) in self.0.into_iter().zip(MESSAGES) {
            let Some(place) = place else { continue };
            remarks.push(Warning::new(place, format!("{what}: {count}, here the first"), fallback));
        }
    }
}

/// Greatest code of a colour in eight bits.
pub(crate) const MAX_CODE: f64 = 255.0;

/// Greatest channel up to which whole numbers may be radiance.
const MAX_RADIANCE: f64 = 16.0;

/// True if colours whose greatest channel is `most` go up to 255, if all are whole numbers.
pub(crate) fn are_codes(most: f64, are_whole: bool) -> bool {
    are_whole && most > MAX_RADIANCE && most <= MAX_CODE
}

/// Returns the note that colours of numbers that are not bytes go up to 255.
pub(crate) fn note_of_codes(place: Location) -> Warning {
    let what = "the colours are whole numbers up to 255";
    let fallback = "they count as 0 to 255, coded in sRGB";
    Warning { severity: Severity::Note, ..Warning::new(place, what, fallback) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn each_kind_is_reported_once_with_its_number_and_first_place() {
        let mut faults = Faults::default();
        for (line, fault) in [(3, Fault::NoUv), (4, Fault::FewCorners), (5, Fault::NoUv)] {
            faults.add(fault, || Location::line(Path::new("t.obj"), line));
        }
        let mut remarks = Vec::new();
        faults.report(&mut remarks);
        let said: Vec<String> = remarks.iter().map(Warning::to_string).collect();
        assert_eq!(said.len(), 2);
        assert!(said[0].starts_with("t.obj:4: faces of less than three corners: 1,"), "{said:?}");
        assert!(said[1].starts_with("t.obj:3: corners with texture coordinates"), "{said:?}");
        assert!(MESSAGES.iter().enumerate().all(|(i, message)| message.0 as usize == i));
    }
}
