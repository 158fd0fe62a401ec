//! Instances of the native format: groups at places that are written inline or in a file.

use super::builder::SceneBuilder;
use super::group::Instance;
use super::text::{InstanceText, Number, PlacesText};
use crate::error::{Location, SceneError};
use crate::file::read_text;
use glam::{DMat3, DMat4};
use toml::Spanned;

impl SceneBuilder<'_> {
    /// Adds an instance.
    pub(super) fn instance(&mut self, text: &Spanned<InstanceText>) -> Result<(), SceneError> {
        let place = self.file.place(text.span());
        let text = text.get_ref();
        let to_world = self.transform(&text.transform)?;
        check(&to_world, &place)?;
        let placements = match &text.places {
            None => vec![to_world],
            Some(places) => {
                let at = self.file.place(places.span());
                let own = self.places(places.get_ref(), &at)?;
                own.into_iter().map(|matrix| to_world * matrix).collect()
            }
        };
        let instance = Instance { place, group: text.group.get_ref().clone(), placements };
        self.groups.add(instance, text.member_of.as_deref());
        Ok(())
    }

    /// Shows the meshes of all groups, and warns of groups that are not seen.
    pub(super) fn show_instances(&mut self) -> Result<(), SceneError> {
        let groups = std::mem::take(&mut self.groups);
        for (name, place) in groups.show(&mut self.contents)? {
            let what = format!("no instance shows the group \"{name}\"");
            self.log.warn(&place, what, "its members are left out; add an [[instance]] of it")?;
        }
        Ok(())
    }

    /// Returns the matrices of a list or a file.
    fn places(&mut self, text: &PlacesText, place: &Location) -> Result<Vec<DMat4>, SceneError> {
        let (matrices, place) = match text {
            PlacesText::List(rows) => {
                let matrix = |numbers: &Vec<Number>| {
                    let numbers: Vec<f64> = numbers.iter().map(|number| number.0).collect();
                    matrix(&numbers, place)
                };
                (rows.iter().map(matrix).collect::<Result<Vec<_>, _>>()?, place.clone())
            }
            PlacesText::File(name) => {
                let path = self.folder.join(name);
                let (text, hash) = read_text(&path, place)?;
                let lines =
                    (1..).zip(text.lines().map(|line| line.split('#').next().unwrap_or_default().trim()));
                let written = lines.filter(|(_, line)| !line.is_empty());
                let read = |(number, line): (u32, &str)| {
                    let at = Location::line(&path, number);
                    let numbers: Option<Vec<f64>> =
                        line.split([' ', '\t', ',']).filter(|word| !word.is_empty()).map(finite).collect();
                    matrix(&numbers.unwrap_or_default(), &at)
                };
                let matrices = written.map(read).collect::<Result<Vec<_>, _>>()?;
                self.add_source(&path, hash);
                (matrices, Location::file(&path))
            }
        };
        if matrices.is_empty() {
            return Err(place.wrong("there are no places", "write one matrix for each, or leave places out"));
        }
        Ok(matrices)
    }
}

fn finite(word: &str) -> Option<f64> {
    word.parse().ok().filter(|number: &f64| (*number as f32).is_finite())
}

/// Returns the matrix of 12 or 16 numbers, row by row.
fn matrix(numbers: &[f64], place: &Location) -> Result<DMat4, SceneError> {
    const LAST: [f64; 4] = [0.0, 0.0, 0.0, 1.0];
    let rows: [f64; 16] = match numbers.len() {
        12 => std::array::from_fn(|i| if i < 12 { numbers[i] } else { LAST[i - 12] }),
        16 => std::array::from_fn(|i| numbers[i]),
        _ => {
            let remedy = "write 12 or 16 finite numbers: three or four rows of a matrix";
            return Err(place.wrong("a place is no matrix", remedy));
        }
    };
    if rows[12..] != LAST {
        return Err(place.wrong("the last row of a place is not 0 0 0 1", "write 0 0 0 1, or leave it out"));
    }
    let matrix = DMat4::from_cols_array(&rows).transpose();
    check(&matrix, place)?;
    Ok(matrix)
}

/// Rejects transforms that are not finite.
fn check(to_world: &DMat4, place: &Location) -> Result<(), SceneError> {
    match DMat3::from_mat4(*to_world).determinant().is_finite() {
        true => Ok(()),
        false => Err(place.wrong("the transform of an instance is not finite", "give smaller numbers")),
    }
}
