//! Attributes of meshes as files give them: values with a name.
//!
//! Names are those of Mitsuba 3: `vertex_NAME` for values of vertices, and `face_NAME` for values of faces. Colours are
//! called `color`, and opacities `alpha`.

use scene::AttributeValues;

/// Name of vertex colours.
pub(crate) const VERTEX_COLOUR: &str = "vertex_color";
/// Name of face colours.
pub(crate) const FACE_COLOUR: &str = "face_color";
/// Name of opacities of vertices.
pub(crate) const VERTEX_ALPHA: &str = "vertex_alpha";
/// Colours of vertices, or else of faces.
pub(crate) const COLOUR: &str = "color";

/// An attribute with its name.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NamedAttribute {
    pub name: String,
    pub values: AttributeValues,
}

impl NamedAttribute {
    /// Returns an attribute of vertices.
    pub fn of_vertices(name: &str, values: Vec<base::math::Rgb>) -> NamedAttribute {
        NamedAttribute { name: name.into(), values: AttributeValues::Vertices(values) }
    }
}

/// Returns the attribute that a material calls `wanted`: that of this name, or else that of vertices or of faces.
///
/// Mitsuba 3 appends `_color` to the names of attributes whose channels are called `_r`, `_g` and `_b`.
pub(crate) fn find<'a>(attributes: &'a [NamedAttribute], wanted: &str) -> Option<&'a NamedAttribute> {
    let called = |name: &str| attributes.iter().find(|attribute| attribute.name == name);
    let named = |name: &str| {
        called(name).or_else(|| called(&format!("vertex_{name}"))).or_else(|| called(&format!("face_{name}")))
    };
    named(wanted).or_else(|| named(wanted.strip_suffix("_color")?))
}

/// Gives the vertices of a mesh new numbers: value `i` becomes that of vertex `from(i)`.
pub(crate) fn reorder(attributes: &mut [NamedAttribute], from: &[u32]) {
    for attribute in attributes {
        if let AttributeValues::Vertices(values) = &mut attribute.values {
            *values = from.iter().filter_map(|&i| values.get(i as usize).copied()).collect();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::Rgb;

    #[test]
    fn names_without_a_kind_are_those_of_vertices_first() {
        let named = |name: &str, grey: f32| NamedAttribute::of_vertices(name, vec![Rgb::splat(grey)]);
        let attributes = [named("face_color", 1.0), named("vertex_color", 2.0), named("face_dirt", 3.0)];
        let value = |wanted: &str| find(&attributes, wanted).map(|found| found.values.all()[0].x);
        assert_eq!(value("color"), Some(2.0));
        assert_eq!(value("face_color"), Some(1.0));
        assert_eq!(
            (value("dirt"), value("face_dirt"), value("face_dirt_color")),
            (Some(3.0), Some(3.0), Some(3.0))
        );
        assert_eq!((value("vertex_dirt"), value("colour")), (None, None));
    }
}
