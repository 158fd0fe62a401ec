//! Random scenes, and changes of them that no picture should show.

use glam::{DQuat, DVec3};
use std::fmt::Write;

/// Random numbers that follow from a seed: splitmix64.
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Dice {
        Dice(seed.wrapping_mul(0xA076_1D64_78BD_642F))
    }

    fn below(&mut self, count: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((u128::from(mixed ^ (mixed >> 31)) * u128::from(count)) >> 64) as u64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.below(1 << 53) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self, low: f64, high: f64) -> [f64; 3] {
        [(); 3].map(|()| self.between(low, high))
    }
}

/// Changes of a scene's text that leave its picture as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    Scaled,
    Moved,
    Mirrored,
    MeshesSplit,
    LightsSplit,
    MaterialsRenamed,
    MeshesReordered,
}

impl Change {
    pub const ALL: [Change; 7] = [
        Change::Scaled,
        Change::Moved,
        Change::Mirrored,
        Change::MeshesSplit,
        Change::LightsSplit,
        Change::MaterialsRenamed,
        Change::MeshesReordered,
    ];
}

/// A mesh: a shape, its place, and its light.
#[derive(Clone)]
struct Part {
    shape: &'static str,
    material: usize,
    /// Steps of its transform.
    steps: Vec<String>,
    /// Radiance, and the lamp that it belongs to.
    emission: Option<([f64; 3], usize)>,
}

/// A point light: its place, intensity and lamp.
#[derive(Clone)]
struct Point {
    position: [f64; 3],
    intensity: [f64; 3],
    lamp: usize,
}

/// Projection of a camera.
#[derive(Clone)]
enum Lens {
    /// A pinhole of this field of view in degrees.
    Pinhole(f64),
    /// A parallel projection with its film's up and width.
    Parallel([f64; 3], f64),
}

/// A scene: a room, open or closed, objects, and two lamps.
#[derive(Clone)]
pub struct Spec {
    origin: [f64; 3],
    target: [f64; 3],
    lens: Lens,
    /// Names and kinds.
    materials: Vec<(String, String)>,
    parts: Vec<Part>,
    points: Vec<Point>,
    /// Radiance of the sky.
    sky: f64,
    /// Factors of the lamps; of the sky that of the first.
    powers: [f64; 2],
    /// True if all surfaces shine, to both sides, and paths are of any length.
    is_furnace: bool,
}

fn list([x, y, z]: [f64; 3]) -> String {
    format!("[{x:e}, {y:e}, {z:e}]")
}

fn scale(by: f64) -> String {
    format!("{{ scale = {by:e} }}")
}

fn translate(by: [f64; 3]) -> String {
    format!("{{ translate = {} }}", list(by))
}

impl Spec {
    /// The scene of a number.
    pub fn random(number: u64) -> Spec {
        let mut dice = Dice::new(number);
        let materials = (0..4).map(|i| (format!("m{i}"), kind(&mut dice))).collect();
        let (from, turn) = (dice.between(1.9, 2.3), dice.between(0.0, std::f64::consts::TAU));
        let mut spec = Spec {
            origin: [from * turn.cos(), dice.between(-1.0, 1.5), from * turn.sin()],
            target: dice.vector(-0.5, 0.5),
            lens: Lens::Pinhole(dice.between(40.0, 80.0)),
            materials,
            parts: Vec::new(),
            points: Vec::new(),
            sky: 0.0,
            powers: [1.0; 2],
            is_furnace: false,
        };
        let is_open = dice.below(3) == 0;
        if is_open {
            spec.sky = dice.between(0.1, 1.0);
        }
        let turns = ["0, 1, 0], angle = 0", "0, 1, 0], angle = 90", "0, 1, 0], angle = -90"];
        let others = ["0, 1, 0], angle = 180", "1, 0, 0], angle = -90", "1, 0, 0], angle = 90"];
        let (count, material) = (if is_open { 5 } else { 6 }, dice.below(4) as usize);
        for turn in turns.into_iter().chain(others).take(count) {
            let turn = format!("{{ rotate = {{ axis = [{turn} }} }}");
            let steps = vec![scale(2.5), translate([0.0, 0.0, -2.5]), turn];
            spec.parts.push(Part { shape: "rectangle", material, steps, emission: None });
        }
        for _ in 0..2 + dice.below(3) {
            let shape = ["sphere", "cube", "rectangle", "cylinder"][dice.below(4) as usize];
            let steps = place(&mut dice, 0.2, 0.6, 1.2);
            spec.parts.push(Part { shape, material: dice.below(4) as usize, steps, emission: None });
        }
        for lamp in 0..2 {
            let light = dice.vector(2.0, 10.0);
            if dice.below(4) == 0 {
                let position = dice.vector(-1.5, 1.5);
                spec.points.push(Point { position, intensity: light, lamp });
            } else {
                let shape = ["sphere", "rectangle", "rectangle"][dice.below(3) as usize];
                let steps = place(&mut dice, 0.2, 0.5, 1.5);
                let material = dice.below(4) as usize;
                spec.parts.push(Part { shape, material, steps, emission: Some((light, lamp)) });
            }
        }
        spec
    }

    /// The scene with its lamps' light times `powers`.
    pub fn lit(&self, powers: [f64; 2]) -> Spec {
        Spec { powers, ..self.clone() }
    }

    /// Returns the surfaces in one grey that emits as much as it absorbs, under a sky of radiance 1.
    pub fn furnace(&self, number: u64) -> Spec {
        let grey = Dice::new(!number).between(0.1, 0.8);
        let mut spec = Spec { sky: 1.0, points: Vec::new(), is_furnace: true, ..self.clone() };
        spec.materials
            .iter_mut()
            .for_each(|(_, kind)| *kind = format!("kind = \"diffuse\"\nreflectance = {grey:e}"));
        spec.parts.iter_mut().for_each(|part| part.emission = Some(([1.0 - grey; 3], 0)));
        spec
    }

    /// Takes gloss from the surfaces.
    pub fn make_diffuse(&mut self, number: u64) {
        let mut dice = Dice::new(!number);
        for (_, kind) in &mut self.materials {
            *kind = format!("kind = \"diffuse\"\nreflectance = {}", list(dice.vector(0.1, 0.8)));
        }
    }

    /// The surfaces between two like squares; that of number `from` shines, the other fills the film.
    pub fn exchange(&self, number: u64, from: usize) -> Spec {
        let mut dice = Dice::new(number ^ 0xEEEE);
        let mut spec = Spec { sky: 0.0, points: Vec::new(), ..self.clone() };
        spec.parts.retain(|part| part.emission.is_none());
        let material = spec.materials.len();
        spec.materials.push(("patch".to_owned(), "kind = \"diffuse\"\nreflectance = 0.5".to_owned()));
        let size = dice.between(0.3, 0.6);
        for patch in 0..2 {
            let (axis, angle, at) =
                (dice.vector(-1.0, 1.0), dice.between(0.0, 360.0), dice.vector(-1.5, 1.5));
            let turn = format!("{{ rotate = {{ axis = {}, angle = {angle:e} }} }}", list(axis));
            let steps = vec![scale(size), turn, translate(at)];
            let emission = (patch == from).then_some(([4.0; 3], 0));
            spec.parts.push(Part { shape: "rectangle", material, steps, emission });
            if patch != from {
                let turn = DQuat::from_axis_angle(DVec3::from(axis).normalize(), angle.to_radians());
                // So close that little of what crosses the patch is between.
                let before = DVec3::from(at) + turn * DVec3::Z * (1e-5 * size);
                (spec.origin, spec.target) = (before.into(), at);
                spec.lens = Lens::Parallel((turn * DVec3::Y).into(), 2.0 * size);
            }
        }
        spec
    }

    /// The scene told otherwise.
    pub fn changed(&self, change: Change, number: u64) -> Spec {
        let mut dice = Dice::new(number ^ 0xFFFF);
        let mut spec = self.clone();
        match change {
            Change::Scaled => {
                let by = 10f64.powf(dice.between(-6.0, 6.0));
                spec.parts.iter_mut().for_each(|part| part.steps.push(scale(by)));
                spec.each_point(|p| p.map(|x| x * by));
                spec.points.iter_mut().for_each(|p| p.intensity = p.intensity.map(|i| i * by * by));
            }
            Change::Moved => {
                let by = dice.vector(-1e6, 1e6);
                spec.parts.iter_mut().for_each(|part| part.steps.push(translate(by)));
                spec.each_point(|p| [p[0] + by[0], p[1] + by[1], p[2] + by[2]]);
            }
            Change::Mirrored => {
                let mirror = "{ scale = [-1, 1, 1] }".to_owned();
                spec.parts.iter_mut().for_each(|part| part.steps.push(mirror.clone()));
                spec.each_point(|[x, y, z]| [-x, y, z]);
            }
            Change::MeshesSplit => spec.split(|part| part.emission.is_none()),
            Change::LightsSplit => {
                spec.split(|part| part.emission.is_some());
                spec.points.iter_mut().for_each(|p| p.intensity = p.intensity.map(|i| 0.5 * i));
                spec.points = [spec.points.clone(), spec.points].concat();
            }
            Change::MaterialsRenamed => {
                spec.materials
                    .iter_mut()
                    .enumerate()
                    .for_each(|(i, (name, _))| *name = format!("z{}", 9 - i));
                // They stand in another order, too.
                spec.materials.rotate_left(1);
                spec.parts.iter_mut().for_each(|part| part.material = (part.material + 3) % 4);
            }
            Change::MeshesReordered => spec.parts.reverse(),
        }
        spec
    }

    fn each_point(&mut self, change: impl Fn([f64; 3]) -> [f64; 3]) {
        self.origin = change(self.origin);
        self.target = change(self.target);
        self.points.iter_mut().for_each(|p| p.position = change(p.position));
    }

    /// Cuts rectangles in two.
    fn split(&mut self, which: impl Fn(&Part) -> bool) {
        let halves = |part: &Part| -> Vec<Part> {
            if part.shape != "rectangle" || !which(part) {
                return vec![part.clone()];
            }
            let half = |x: f64| {
                let first = vec!["{ scale = [0.5, 1, 1] }".to_owned(), translate([x, 0.0, 0.0])];
                Part { steps: [first, part.steps.clone()].concat(), ..part.clone() }
            };
            vec![half(-0.5), half(0.5)]
        };
        self.parts = self.parts.iter().flat_map(halves).collect();
    }

    /// The scene as TOML.
    pub fn text(&self) -> String {
        let mut text = format!(
            "resolution = [12, 12]\n{}[camera]\norigin = {}\ntarget = {}\n",
            if self.is_furnace { "" } else { "max_depth = 8\n" },
            list(self.origin),
            list(self.target),
        );
        text += &match self.lens {
            Lens::Pinhole(fov) => format!("fov = {fov:e}\n"),
            Lens::Parallel(up, width) => format!("up = {}\nfilm_width = {width:e}\n", list(up)),
        };
        // Writing to a string cannot fail.
        if self.sky > 0.0 {
            let _ = writeln!(text, "[environment]\nradiance = {:e}", self.sky * self.powers[0]);
        }
        for (name, kind) in &self.materials {
            let _ = writeln!(text, "[[material]]\nname = \"{name}\"\n{kind}");
        }
        for part in &self.parts {
            let (shape, material) = (part.shape, &self.materials[part.material].0);
            let steps = part.steps.join(", ");
            let _ = writeln!(
                text,
                "[[mesh]]\nshape = \"{shape}\"\nmaterial = \"{material}\"\ntransform = [{steps}]"
            );
            if let Some((radiance, lamp)) = part.emission
                && self.powers[lamp] > 0.0
            {
                let radiance = list(radiance.map(|r| r * self.powers[lamp]));
                let is_two_sided = self.is_furnace;
                let _ = writeln!(text, "emission = {radiance}\nemission_two_sided = {is_two_sided}");
            }
        }
        for Point { position, intensity, lamp } in &self.points {
            if self.powers[*lamp] > 0.0 {
                let [position, intensity] = [*position, intensity.map(|i| i * self.powers[*lamp])].map(list);
                let _ = writeln!(
                    text,
                    "[[light]]\nkind = \"point\"\nposition = {position}\nintensity = {intensity}"
                );
            }
        }
        text
    }
}

/// Steps that place a shape of a size between two anywhere within `reach`.
fn place(dice: &mut Dice, low: f64, high: f64, reach: f64) -> Vec<String> {
    let (axis, angle) = (dice.vector(0.1, 1.0), dice.between(0.0, 360.0));
    let turn = format!("{{ rotate = {{ axis = {}, angle = {angle:e} }} }}", list(axis));
    vec![scale(dice.between(low, high)), turn, translate(dice.vector(-reach, reach))]
}

/// A material without sharp reflections, whose light few paths find.
fn kind(dice: &mut Dice) -> String {
    let (colour, alpha) = (list(dice.vector(0.1, 0.8)), dice.between(0.2, 0.6));
    match dice.below(6) {
        0 => format!("kind = \"roughplastic\"\ndiffuse = {colour}\nalpha = {alpha:e}"),
        1 => format!("kind = \"conductor\"\npreset = \"Al\"\nalpha = {alpha:e}"),
        2 => format!("kind = \"principled\"\nbase_color = {colour}\nroughness = {:e}", alpha.sqrt()),
        _ => format!("kind = \"diffuse\"\nreflectance = {colour}"),
    }
}
