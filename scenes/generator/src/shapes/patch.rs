//! Open sheets: a function of two parameters sampled on a grid, and flat ones.

use super::Shell;
use glam::{Vec2, Vec3};

/// Sheet of rows of points: `rows[j][i]`, where the outside is on the side of (along i) x (along j).
/// `wrap_columns` joins the last column to the first, `wrap_rows` the last row to the first. Points of one
/// row that coincide (the pole of a sphere) become one.
pub fn grid(rows: &[Vec<Vec3>], wrap_columns: bool, wrap_rows: bool, crease_degrees: f32) -> Shell {
    let mut shell = Shell::new(crease_degrees);
    let columns = rows.first().map_or(0, Vec::len);
    let indices: Vec<Vec<u32>> = rows.iter().map(|row| row_points(&mut shell, row)).collect();
    let row_lengths = lengths_along(rows, columns);
    let column_spans = columns - usize::from(!wrap_columns);
    let row_spans = rows.len() - usize::from(!wrap_rows);
    let mut v = 0.0;
    for j in 0..row_spans {
        let above = (j + 1) % rows.len();
        let next_v = v + row_lengths[j];
        // One u for both rows keeps the coordinate lines straight along cones.
        let scale = |i: usize| rows[j][i].distance(rows[j][(i + 1) % columns]);
        let scale_above = |i: usize| rows[above][i].distance(rows[above][(i + 1) % columns]);
        let mut u = 0.0;
        for i in 0..column_spans {
            let next_u = u + 0.5 * (scale(i) + scale_above(i));
            let k = (i + 1) % columns;
            shell.quad(
                [indices[j][i], indices[j][k], indices[above][k], indices[above][i]],
                [Vec2::new(u, v), Vec2::new(next_u, v), Vec2::new(next_u, next_v), Vec2::new(u, next_v)],
            );
            u = next_u;
        }
        v = next_v;
    }
    shell
}

fn row_points(shell: &mut Shell, row: &[Vec3]) -> Vec<u32> {
    let pole = row.iter().all(|p| p.distance_squared(row[0]) < 1e-10);
    if pole {
        return vec![shell.point(row[0]); row.len()];
    }
    row.iter().map(|&p| shell.point(p)).collect()
}

/// Mean distance between each row and the next (the last to the first).
fn lengths_along(rows: &[Vec<Vec3>], columns: usize) -> Vec<f32> {
    (0..rows.len())
        .map(|j| {
            let above = &rows[(j + 1) % rows.len()];
            rows[j].iter().zip(above).map(|(a, b)| a.distance(*b)).sum::<f32>() / columns.max(1) as f32
        })
        .collect()
}

/// Sheet f(u, v) for u, v in 0..=1 on `columns` x `rows` quadrilaterals, smooth; the outside is on the
/// side of ∂f/∂u x ∂f/∂v.
pub fn patch(columns: usize, rows: usize, f: impl Fn(f32, f32) -> Vec3) -> Shell {
    let points: Vec<Vec<Vec3>> = (0..=rows)
        .map(|j| (0..=columns).map(|i| f(i as f32 / columns as f32, j as f32 / rows as f32)).collect())
        .collect();
    grid(&points, false, false, 60.0)
}

/// Flat sheet, the parallelogram with one corner at `origin`; the outside is on the side of edge_u x edge_v.
pub fn sheet(origin: impl Into<Vec3>, edge_u: Vec3, edge_v: Vec3) -> Shell {
    let origin = origin.into();
    patch(1, 1, |u, v| origin + edge_u * u + edge_v * v)
}
