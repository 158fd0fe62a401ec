//! Functions of colours on a cubic lattice, between whose nodes they are interpolated.
//!
//! Tetrahedral interpolation, as in OpenColorIO: a cell is six tetrahedra around its diagonal from black to white, so
//! that greys depend on greys alone.

use crate::math::Rgb;
use rayon::prelude::*;

/// Values at the nodes of a lattice over [0, 1]^3.
pub struct Lattice {
    /// Number of nodes along each side.
    nodes: usize,
    /// Values of the nodes; red varies fastest.
    values: Vec<Rgb>,
}

impl Lattice {
    /// Evaluates `value` at all nodes.
    pub fn new(nodes: usize, value: impl Fn(Rgb) -> Rgb + Sync) -> Lattice {
        let at = |index: usize| index as f32 / (nodes - 1) as f32;
        let node = |i: usize| Rgb::new(at(i % nodes), at(i / nodes % nodes), at(i / nodes / nodes));
        Lattice { nodes, values: (0..nodes.pow(3)).into_par_iter().map(|i| value(node(i))).collect() }
    }

    /// Returns the interpolated value at a finite position, clipped to the lattice.
    pub fn at(&self, position: Rgb) -> Rgb {
        let last = (self.nodes - 1) as f32;
        let scaled = position.clamp(Rgb::ZERO, Rgb::ONE) * last;
        let cell = scaled.floor().min(Rgb::splat(last - 1.0));
        let beyond = (scaled - cell).to_array();
        let mut axes = [0, 1, 2];
        axes.sort_by(|a, b| beyond[*b].total_cmp(&beyond[*a]));
        let steps = [1, self.nodes, self.nodes * self.nodes];
        let mut node: usize = (0..3).map(|axis| steps[axis] * cell[axis] as usize).sum();
        // The way from the cell's first corner to its last takes the axes in this order.
        let weights = [1.0, beyond[axes[0]], beyond[axes[1]], beyond[axes[2]], 0.0];
        let mut sum = self.values[node] * (weights[0] - weights[1]);
        for (k, axis) in axes.into_iter().enumerate() {
            node += steps[axis];
            sum += self.values[node] * (weights[k + 1] - weights[k + 2]);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_functions_stay_and_greys_depend_on_greys() {
        let linear = Lattice::new(5, |c| Rgb::new(c.z, 2.0 * c.x - c.y, 0.3));
        for position in [Rgb::ZERO, Rgb::ONE, Rgb::new(0.13, 0.57, 0.91), Rgb::new(0.5, 0.2, 0.2)] {
            let expected = Rgb::new(position.z, 2.0 * position.x - position.y, 0.3);
            assert!((linear.at(position) - expected).abs().max_element() < 1e-6, "{position}");
        }
        assert_eq!(linear.at(Rgb::new(-1.0, 2.0, 1.0)), linear.at(Rgb::new(0.0, 1.0, 1.0)));
        let greys = Lattice::new(3, |c| if c.x == c.y && c.y == c.z { c } else { Rgb::splat(1e9) });
        assert!((greys.at(Rgb::splat(0.3)) - 0.3).abs().max_element() < 1e-6);
    }
}
