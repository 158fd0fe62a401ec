//! Scenes of any size, written as TOML files with meshes beside them: a forest of instances, and dunes.
//!
//! A tree has about 100,000 triangles. They are stored once and seen at any number of places.
//!
//! Units: metres.

use base::sampling::{hash, owen_sobol_2d, unit};
use glam::{Quat, Vec3};
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Number of different trees.
const KINDS: u32 = 3;

/// Area per tree, in square metres.
const AREA: f32 = 30.0;

/// Number of levels of branches, and of branches that grow from one.
const LEVELS: u32 = 5;
const BRANCHES: u32 = 4;

/// Number of sides of a branch.
const SIDES: u32 = 6;

/// Number of leaves at each end.
const LEAVES: u32 = 41;

/// Length of the sides of the dunes.
const LENGTH: f32 = 10.0;

/// Triangles without normals.
#[derive(Default)]
struct Soup {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

/// A tree under construction.
struct Tree {
    bark: Soup,
    leaves: Soup,
    seed: u32,
    /// Number of random numbers so far.
    count: u32,
}

impl Tree {
    /// Grows a tree.
    fn new(seed: u32) -> Tree {
        let mut tree = Tree { bark: Soup::default(), leaves: Soup::default(), seed, count: 0 };
        tree.branch(Vec3::ZERO, Vec3::Y * 3.0, 0.22, 0);
        tree
    }

    fn unit(&mut self) -> f32 {
        self.count += 1;
        unit(hash(self.count, self.seed))
    }

    fn direction(&mut self) -> Vec3 {
        let components = [(); 3].map(|()| self.unit() * 2.0 - 1.0);
        Vec3::from(components).normalize_or(Vec3::X)
    }

    /// Grows a branch and all that it carries.
    fn branch(&mut self, from: Vec3, along: Vec3, radius: f32, level: u32) {
        let to = from + along;
        self.tube([from, to], [radius, 0.65 * radius]);
        if level == LEVELS {
            (0..LEAVES).for_each(|_| self.leaf(to, 0.45));
            return;
        }
        let turn = self.unit() * std::f32::consts::TAU;
        for i in 0..BRANCHES {
            let around = Quat::from_axis_angle(
                along.normalize(),
                turn + i as f32 * std::f32::consts::TAU / BRANCHES as f32,
            );
            let aside = around * along.any_orthonormal_vector().normalize();
            let spread = if i == 0 && level < 2 { 0.15 } else { 0.8 };
            let towards = (along.normalize() + aside * spread + 0.25 * self.direction()).normalize();
            let length = along.length() * (0.55 + 0.15 * self.unit());
            self.branch(to, towards * length, 0.6 * radius, level + 1);
        }
    }

    fn tube(&mut self, ends: [Vec3; 2], radii: [f32; 2]) {
        let axis = (ends[1] - ends[0]).normalize_or(Vec3::Y);
        let (x, first) = (axis.any_orthonormal_vector(), self.bark.positions.len() as u32);
        for (end, radius) in ends.into_iter().zip(radii) {
            let at =
                |i: u32| Quat::from_axis_angle(axis, i as f32 * std::f32::consts::TAU / SIDES as f32) * x;
            self.bark.positions.extend((0..SIDES).map(|i| end + at(i) * radius));
        }
        for i in 0..SIDES {
            let [a, b] = [first + i, first + (i + 1) % SIDES];
            self.bark.triangles.extend([[a, b, b + SIDES], [a, b + SIDES, a + SIDES]]);
        }
    }

    fn leaf(&mut self, around: Vec3, reach: f32) {
        let at = around + self.direction() * (reach * self.unit());
        let (along, across) = (self.direction() * 0.09, self.direction() * 0.045);
        let first = self.leaves.positions.len() as u32;
        self.leaves.positions.extend([at, at + 0.5 * along + across, at + along, at + 0.5 * along - across]);
        self.leaves.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
}

/// Writes the meshes of a forest of `trees` under a sun and a sky into a folder, and returns its description.
pub fn forest(trees: u32, folder: &Path) -> io::Result<String> {
    for kind in 0..KINDS {
        let tree = Tree::new(kind + 1);
        write_ply(&tree.bark, &folder.join(format!("bark {kind}.ply")))?;
        write_ply(&tree.leaves, &folder.join(format!("leaves {kind}.ply")))?;
        fs::write(folder.join(places_name(trees, kind)), places(trees, kind))?;
    }
    Ok(forest_text(trees))
}

/// Writes the mesh of dunes of about `count` triangles under a sun and a sky into a folder, and returns their
/// description.
pub fn dunes(count: u32, folder: &Path) -> io::Result<String> {
    let mesh = format!("dunes {count}.ply");
    write_ply(&sand(count), &folder.join(&mesh))?;
    Ok(format!(
        "[[material]]\nname = \"sand\"\nkind = \"diffuse\"\nreflectance = [0.7, 0.6, 0.4]\n\
         [camera]\norigin = [5, 3.5, 12]\ntarget = [5, 0, 4]\nfov = 45\n[environment]\nradiance = [0.5, 0.6, 0.8]\n\
         [[light]]\nkind = \"directional\"\ndirection = [-1, -0.7, -0.4]\nirradiance = [3, 2.8, 2.5]\n\
         [[mesh]]\nfile = \"{mesh}\"\nmaterial = \"sand\"\n"
    ))
}

/// Returns a grid of about `count` triangles.
fn sand(count: u32) -> Soup {
    let cells = (0.5 * f64::from(count)).sqrt().round() as u32;
    let place = |i: u32| LENGTH * i as f32 / cells as f32;
    let point = |x: f32, z: f32| {
        let wave = |n: i32| {
            let frequency = 1.7f32.powi(n);
            (frequency * (x + 0.4 * z) + n as f32).sin() * (frequency * (z - 0.3 * x)).cos() / frequency
        };
        Vec3::new(x, 0.4 * (0..8).map(wave).sum::<f32>(), z)
    };
    let mut soup = Soup::default();
    for z in 0..=cells {
        soup.positions.extend((0..=cells).map(|x| point(place(x), place(z))));
    }
    for (z, x) in (0..cells).flat_map(|z| (0..cells).map(move |x| (z, x))) {
        let at = |z: u32, x: u32| z * (cells + 1) + x;
        let [a, b, c, d] = [at(z, x), at(z + 1, x), at(z + 1, x + 1), at(z, x + 1)];
        soup.triangles.extend([[a, b, c], [a, c, d]]);
    }
    soup
}

fn places_name(trees: u32, kind: u32) -> String {
    format!("places {trees} {kind}.txt")
}

/// Returns half the length of the sides of a forest.
fn half(trees: u32) -> f32 {
    0.5 * (trees as f32 * AREA).sqrt()
}

/// Returns the matrices of the trees of a kind: turned, of different sizes, and every fourth mirrored and stretched.
fn places(trees: u32, kind: u32) -> String {
    let mut text = String::new();
    for i in (kind..trees).step_by(KINDS as usize) {
        let at = (owen_sobol_2d(i, 1) * 2.0 - 1.0) * half(trees);
        let [turn, size] = owen_sobol_2d(i, 2).to_array();
        let (sin, cos) = (turn * std::f32::consts::TAU).sin_cos();
        let size = 0.7 + 0.6 * size;
        let [x, y] = if i.is_multiple_of(4) { [-size, 1.2 * size] } else { [size, size] };
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{} 0 {} {} 0 {y} 0 0 {} 0 {} {}",
            x * cos,
            size * sin,
            at.x,
            -x * sin,
            size * cos,
            at.y
        );
    }
    text
}

/// Returns the description of a forest.
fn forest_text(trees: u32) -> String {
    let half = half(trees);
    let mut text = format!(
        "[[material]]\nname = \"ground\"\nkind = \"diffuse\"\nreflectance = [0.22, 0.17, 0.1]\n\
         [[material]]\nname = \"bark\"\nkind = \"diffuse\"\nreflectance = [0.25, 0.17, 0.11]\n\
         [[material]]\nname = \"leaves\"\nkind = \"diffuse\"\nreflectance = [0.13, 0.3, 0.06]\n\
         [camera]\norigin = [{}, {}, {}]\ntarget = [0, 2, 0]\nfov = 45\n\
         [environment]\nradiance = [0.5, 0.6, 0.8]\n\
         [[light]]\nkind = \"directional\"\ndirection = [-1, -0.9, -0.3]\nirradiance = [3, 2.8, 2.5]\n\
         [[mesh]]\nshape = \"rectangle\"\nmaterial = \"ground\"\n\
         transform = [{{ scale = {} }}, {{ rotate = {{ axis = [1, 0, 0], angle = -90 }} }}]\n",
        0.3 * half,
        6.0 + 0.1 * half,
        1.15 * half + 12.0,
        1.5 * half + 20.0
    );
    for kind in 0..KINDS.min(trees) {
        let _ = write!(
            text,
            "[[mesh]]\nfile = \"bark {kind}.ply\"\nmaterial = \"bark\"\nmember_of = \"tree {kind}\"\n\
             [[mesh]]\nfile = \"leaves {kind}.ply\"\nmaterial = \"leaves\"\nmember_of = \"tree {kind}\"\n\
             [[instance]]\ngroup = \"tree {kind}\"\nplaces = \"{}\"\n",
            places_name(trees, kind)
        );
    }
    text
}

/// Writes a mesh as binary PLY.
fn write_ply(soup: &Soup, path: &Path) -> io::Result<()> {
    let mut to = BufWriter::new(File::create(path)?);
    write!(
        to,
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n\
         property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        soup.positions.len(),
        soup.triangles.len()
    )?;
    for value in soup.positions.iter().flat_map(|p| p.to_array()) {
        to.write_all(&value.to_le_bytes())?;
    }
    for triangle in &soup.triangles {
        to.write_all(&[3])?;
        for corner in triangle {
            to.write_all(&corner.to_le_bytes())?;
        }
    }
    to.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trees_have_as_many_triangles_as_promised_and_dunes_as_asked_for() {
        let tree = Tree::new(1);
        let count = tree.bark.triangles.len() + tree.leaves.triangles.len();
        assert!((count as f64 / 1e5 - 1.0).abs() < 0.02, "{count}");
        assert_eq!(sand(200).triangles.len(), 200);
    }
}
