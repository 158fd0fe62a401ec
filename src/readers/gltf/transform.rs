//! Transforms of nodes, in double precision, and their axes where a scale is 0.

use base::math::unflattened;
use glam::{DMat3, DMat4, DQuat, DVec3};
use gltf_json::Node;
use serde_json::Value;

/// Local transform of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Local {
    Matrix(DMat4),
    /// Transform in three steps: scale, rotation, translation.
    Steps {
        scale: DVec3,
        rotation: DQuat,
        translation: DVec3,
    },
}

impl Local {
    /// Returns the transform of a node at rest. `source` is the node's JSON, whose numbers have double precision.
    pub fn read(node: &Node, source: &Value) -> Local {
        match node.matrix {
            Some(matrix) => Local::Matrix(DMat4::from_cols_array(&precise(source, "matrix", matrix))),
            None => Local::Steps {
                scale: DVec3::from(precise(source, "scale", node.scale.unwrap_or([1.0; 3]))),
                rotation: quaternion(precise(
                    source,
                    "rotation",
                    node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |rotation| rotation.0),
                )),
                translation: DVec3::from(precise(
                    source,
                    "translation",
                    node.translation.unwrap_or_default(),
                )),
            },
        }
    }

    pub fn matrix(&self) -> DMat4 {
        match *self {
            Local::Matrix(matrix) => matrix,
            Local::Steps { scale, rotation, translation } => {
                DMat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }

    /// Returns the transform with a scale of 1 in place of each scale of 0.
    pub fn unflattened(&self) -> DMat4 {
        match *self {
            Local::Matrix(matrix) => unflattened(matrix),
            Local::Steps { scale, rotation, translation } => {
                let scale = DVec3::select(scale.cmpeq(DVec3::ZERO), DVec3::ONE, scale);
                DMat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }
}

/// Returns the numbers of a member in double precision; `rounded`, if the member has others.
fn precise<const N: usize>(source: &Value, key: &str, rounded: [f32; N]) -> [f64; N] {
    let list = source.get(key).and_then(Value::as_array);
    std::array::from_fn(|i| {
        let number = list.and_then(|list| list.get(i)?.as_f64());
        // Numbers beyond single precision are infinite, and refused later.
        number
            .filter(|number| *number as f32 == rounded[i] && rounded[i].is_finite())
            .unwrap_or(rounded[i].into())
    })
}

/// Returns a unit quaternion; the identity for a quaternion without direction.
pub(super) fn quaternion(xyzw: [f64; 4]) -> DQuat {
    let q = DQuat::from_array(xyzw);
    if q.is_finite() && q.length_squared() > 0.0 { q.normalize() } else { DQuat::IDENTITY }
}

/// Place of a node in the file's coordinates.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    /// Transform from local coordinates to the file's.
    pub to_file: DMat4,
    /// Transform with a scale of 1 in place of each scale of 0. Its axes are those of lamps and cameras.
    pub axes: DMat4,
}

impl Place {
    /// Returns the place of a child.
    pub fn child(&self, local: &Local) -> Place {
        Place { to_file: self.to_file * local.matrix(), axes: self.axes * local.unflattened() }
    }

    /// True if a scale of 0 along all axes hides what is here.
    pub fn is_hidden(&self) -> bool {
        DMat3::from_mat4(self.to_file) == DMat3::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn numbers_keep_double_precision() {
        let node: Node = serde_json::from_value(json!({ "translation": [4512344.2, 0, 1e39] })).unwrap();
        let source = json!({ "translation": [4512344.2, 0, 1e39] });
        let expected = DVec3::new(4512344.2, 0.0, f64::INFINITY);
        assert!(
            matches!(Local::read(&node, &source), Local::Steps { translation, .. } if translation == expected)
        );
        let rounded = f64::from(4512344.2f32);
        let local = Local::read(&node, &Value::Null);
        assert!(matches!(local, Local::Steps { translation, .. } if translation.x == rounded));
    }

    #[test]
    fn axes_without_length_follow_the_others() {
        let turn = DQuat::from_rotation_y(0.7) * DQuat::from_rotation_x(0.3);
        let whole = DMat4::from_rotation_translation(turn, DVec3::splat(3.0));
        for zeros in 0..8 {
            let scale = DVec3::from_array(std::array::from_fn(|i| f64::from(zeros >> i & 1)));
            let local = Local::Steps { scale, rotation: turn, translation: DVec3::splat(3.0) };
            assert!(local.unflattened().abs_diff_eq(whole, 1e-12));
        }
    }
}
