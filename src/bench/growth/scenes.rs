//! Scenes of many lamps and of many triangles.

use base::sampling::owen_sobol_2d;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Half the length of the hall's sides.
const HALF: f32 = 12.0;
/// Height of the hall.
const HEIGHT: f32 = 4.0;
/// Half the distance between the hall's pillars.
const PILLARS: f32 = 3.0;

/// Power of all lamps together, W.
const POWER: f32 = 9000.0;

/// Area of all lamps together, as a share of the ceiling's.
const LAMP_AREA: f32 = 0.01;

/// Length of the sides of the dunes.
const LENGTH: f32 = 10.0;

/// Returns a hall with pillars under `count` square lamps, whose total power and area do not depend on their number.
pub fn hall(count: u32) -> String {
    let mut text = "[[material]]\nname = \"wall\"\nkind = \"diffuse\"\nreflectance = [0.7, 0.65, 0.6]\n\
        [camera]\norigin = [-10, 1.7, 11]\ntarget = [3, 1.2, -4]\nfov = 70\n"
        .to_owned();
    let mut mesh = |shape: &str, more: &str, steps: &str| {
        // Writing to a string cannot fail.
        let _ =
            writeln!(text, "[[mesh]]\nshape = \"{shape}\"\nmaterial = \"wall\"\n{more}transform = [{steps}]");
    };
    let middle = 0.5 * HEIGHT;
    mesh(
        "cube",
        "",
        &format!("{{ scale = [{HALF}, {middle}, {HALF}] }}, {{ translate = [0, {middle}, 0] }}"),
    );
    let places = (0..).map(|i| (2 * i - 3) as f32 * PILLARS).take(4);
    for (x, z) in places.clone().flat_map(|x| places.clone().map(move |z| (x, z))) {
        mesh(
            "cube",
            "",
            &format!("{{ scale = [0.3, {middle}, 0.3] }}, {{ translate = [{x}, {middle}, {z}] }}"),
        );
    }
    let area = 4.0 * HALF * HALF * LAMP_AREA;
    let radiance = POWER / (std::f32::consts::PI * area);
    let half = 0.5 * (area / count as f32).sqrt();
    for i in 0..count {
        let at = (owen_sobol_2d(i, 1) - 0.5) * (2.0 * HALF - 1.0);
        mesh(
            "rectangle",
            &format!("emission = [{radiance}, {}, {}]\n", 0.9 * radiance, 0.8 * radiance),
            &format!(
                "{{ scale = {half} }}, {{ rotate = {{ axis = [1, 0, 0], angle = 90 }} }}, \
                 {{ translate = [{}, {}, {}] }}",
                at.x,
                HEIGHT - 0.2,
                at.y
            ),
        );
    }
    text
}

/// Returns the name of the file of dunes of `count` triangles.
pub fn mesh_name(count: u32) -> String {
    format!("dunes {count}.ply")
}

/// Returns dunes of `count` triangles under a sun and a sky.
pub fn dunes(count: u32) -> String {
    format!(
        "[[material]]\nname = \"sand\"\nkind = \"diffuse\"\nreflectance = [0.7, 0.6, 0.4]\n\
         [camera]\norigin = [5, 3.5, 12]\ntarget = [5, 0, 4]\nfov = 45\n[environment]\nradiance = [0.5, 0.6, 0.8]\n\
         [[light]]\nkind = \"directional\"\ndirection = [-1, -0.7, -0.4]\nirradiance = [3, 2.8, 2.5]\n\
         [[mesh]]\nfile = \"{}\"\nmaterial = \"sand\"\n",
        mesh_name(count)
    )
}

/// Writes the mesh of the dunes, a grid of about `count` triangles, as binary PLY.
pub fn write_dunes(count: u32, path: &Path) -> io::Result<()> {
    let mut to = BufWriter::new(File::create(path)?);
    let cells = (0.5 * f64::from(count)).sqrt().round() as u32;
    let vertices = cells + 1;
    write!(
        to,
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n\
         property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        vertices * vertices,
        2 * cells * cells
    )?;
    let place = |i: u32| LENGTH * i as f32 / cells as f32;
    for (z, x) in (0..vertices).flat_map(|z| (0..vertices).map(move |x| (place(z), place(x)))) {
        let wave = |n: i32| {
            let frequency = 1.7f32.powi(n);
            (frequency * (x + 0.4 * z) + n as f32).sin() * (frequency * (z - 0.3 * x)).cos() / frequency
        };
        let y = 0.4 * (0..8).map(wave).sum::<f32>();
        for value in [x, y, z] {
            to.write_all(&value.to_le_bytes())?;
        }
    }
    for (z, x) in (0..cells).flat_map(|z| (0..cells).map(move |x| (z, x))) {
        let at = |z: u32, x: u32| z * vertices + x;
        let corners = [at(z, x), at(z + 1, x), at(z + 1, x + 1), at(z, x + 1)];
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            to.write_all(&[3])?;
            for corner in [a, b, c] {
                to.write_all(&corners[corner].to_le_bytes())?;
            }
        }
    }
    to.flush()
}
