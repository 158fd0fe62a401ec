//! Extremes and their scenes, as text: one quantity grows along each curve by many orders of magnitude.

use std::fmt::Write;

/// A quantity that is taken to its extremes.
pub struct Curve {
    /// Name, by which `--knob` chooses it.
    pub name: &'static str,
    /// Description of the quantity, with its unit.
    pub about: &'static str,
    /// Values, in ascending order.
    pub values: Vec<f64>,
    /// Value that the others are compared with, where all pictures are the same but for [`Curve::brightness`]; `None`
    /// where each value has a picture of its own.
    pub middle: Option<f64>,
    /// Returns the scene of a value.
    pub scene: fn(f64) -> String,
    /// Returns the factor on the light of all pixels.
    pub brightness: fn(f64) -> f64,
}

/// Powers of ten between two exponents.
fn decades(exponents: std::ops::RangeInclusive<i32>, step: usize) -> Vec<f64> {
    // Parses text: products of tenths are not the numbers nearest to these powers.
    exponents.step_by(step).filter_map(|n| format!("1e{n}").parse().ok()).collect()
}

/// All curves.
pub fn all() -> [Curve; 9] {
    let own =
        |name, about, values, scene| Curve { name, about, values, middle: None, scene, brightness: |_| 1.0 };
    let same = |curve: Curve| Curve { middle: Some(1.0), ..curve };
    [
        same(own("scale", "A room with all lengths times this", decades(-8..=8, 1), |scale| {
            room(&Room { scale, ..Room::default() })
        })),
        same(own(
            "offset",
            "The room moved so many times its size along all axes",
            decades(0..=9, 1),
            |far| room(&Room { offset: 5.0 * far, ..Room::default() }),
        )),
        Curve {
            brightness: |power| power,
            ..same(own(
                "power",
                "The room with its lamp's radiance times this",
                decades(-20..=20, 4),
                |power| room(&Room { power, ..Room::default() }),
            ))
        },
        own(
            "ratio",
            "A second lamp behind the camera, whose radiance is so many times the first's",
            decades(0..=20, 4),
            ratio,
        ),
        own("view", "The open room from so many times its size away", decades(0..=6, 1), view),
        own(
            "lamp",
            "A lit ball on a floor, its lamp a point so many ball's radii away",
            decades(1..=8, 1),
            lamp,
        ),
        own("roughness", "A metal ball of this α in the room", decades(-5..=0, 1), roughness),
        own(
            "grazing",
            "The ball on its floor from so many degrees above the floor",
            [decades(-3..=1, 1), vec![30.0, 90.0]].concat(),
            grazing,
        ),
        own(
            "glass",
            "The room through so many thin panes",
            (0..6).map(|n| f64::from(1 << n)).collect(),
            glass,
        ),
    ]
}

/// A room of five units with a lamp and a ball.
struct Room {
    scale: f64,
    offset: f64,
    power: f64,
    /// Material of the ball.
    ball: &'static str,
    /// Distance of the camera from the middle; the wall behind it is left out beyond the room.
    distance: f64,
    fov: f64,
}

impl Default for Room {
    fn default() -> Room {
        Room { scale: 1.0, offset: 0.0, power: 1.0, ball: "wall", distance: 2.3, fov: 70.0 }
    }
}

const WALL: &str = "[[material]]\nname = \"wall\"\nkind = \"diffuse\"\nreflectance = [0.6, 0.5, 0.4]\n";

fn room(room: &Room) -> String {
    let Room { scale, offset, power, ball, distance, fov } = room;
    let at = |[x, y, z]: [f64; 3]| {
        let [x, y, z] = [x, y, z].map(|part| part * scale + offset);
        format!("[{x:e}, {y:e}, {z:e}]")
    };
    let mut text = format!(
        "{WALL}[camera]\norigin = {}\ntarget = {}\nfov = {fov:e}\n",
        at([0.3, 0.4, *distance]),
        at([0.0; 3])
    );
    let mut mesh = |shape: &str, material: &str, more: &str, steps: &str| {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "[[mesh]]\nshape = \"{shape}\"\nmaterial = \"{material}\"\n{more}\
             transform = [{steps}{{ scale = {scale:e} }}, {{ translate = {} }}]",
            at([0.0; 3])
        );
    };
    mesh(
        "rectangle",
        "wall",
        &format!("emission = [{:e}, {:e}, {:e}]\n", 8.0 * power, 7.0 * power, 6.0 * power),
        "{ scale = 0.7 }, { rotate = { axis = [1, 0, 0], angle = 90 } }, { translate = [0, 2.4, 0] }, ",
    );
    mesh("sphere", ball, "", "{ translate = [0.5, -1.5, -0.5] }, ");
    let walls = ["[0, 1, 0], angle = 0", "[0, 1, 0], angle = 90", "[0, 1, 0], angle = -90"];
    let others = ["[1, 0, 0], angle = 90", "[1, 0, 0], angle = -90", "[0, 1, 0], angle = 180"];
    let count = if *distance > 2.5 { 5 } else { 6 };
    for turn in walls.into_iter().chain(others).take(count) {
        mesh(
            "rectangle",
            "wall",
            "",
            &format!(
                "{{ scale = 2.5 }}, {{ translate = [0, 0, -2.5] }}, {{ rotate = {{ axis = {turn} }} }}, "
            ),
        );
    }
    text
}

fn ratio(power: f64) -> String {
    room(&Room::default())
        + &format!(
            "[[mesh]]\nshape = \"sphere\"\nmaterial = \"wall\"\nemission = [{power:e}, {power:e}, {power:e}]\n\
             transform = [{{ scale = 0.3 }}, {{ translate = [-1.5, 0.5, 1.8] }}]\n"
        )
}

fn view(sizes: f64) -> String {
    let distance = 2.5 + 5.0 * sizes;
    // The open side fills the film.
    let fov = 2.0 * (2.5 / (distance - 2.5)).atan().to_degrees();
    // A room of this distance has no lamp: a lamp seen edge on is a bright line thinner than a pixel.
    room(&Room { distance, fov, power: 0.0, ..Room::default() })
        + "[[light]]\nkind = \"point\"\nposition = [0, 1.5, 0]\nintensity = [5, 5, 5]\n"
}

/// A ball on a floor seen from `degrees` above it, with a light.
fn ball_on_floor(degrees: f64, light: &str) -> String {
    let (sin, cos) = degrees.to_radians().sin_cos();
    format!(
        "{WALL}[camera]\norigin = [{:e}, {:e}, {:e}]\ntarget = [0, 0, 0]\nup = [0, {cos:e}, {:e}]\nfov = 40\n{light}\
         [[mesh]]\nshape = \"sphere\"\nmaterial = \"wall\"\ntransform = [{{ translate = [0, 1, 0] }}]\n\
         [[mesh]]\nshape = \"rectangle\"\nmaterial = \"wall\"\n\
         transform = [{{ scale = 20 }}, {{ rotate = {{ axis = [1, 0, 0], angle = -90 }} }}]\n",
        0.0,
        8.0 * sin,
        8.0 * cos,
        -sin
    )
}

fn lamp(radii: f64) -> String {
    let intensity = 3.0 * radii * radii;
    ball_on_floor(
        25.0,
        &format!(
            "[[light]]\nkind = \"point\"\nposition = [{:e}, {:e}, {:e}]\n\
             intensity = [{intensity:e}, {intensity:e}, {intensity:e}]\n",
            0.3 * radii,
            0.9 * radii,
            0.3 * radii
        ),
    )
}

fn roughness(alpha: f64) -> String {
    let metal =
        format!("[[material]]\nname = \"metal\"\nkind = \"conductor\"\npreset = \"Al\"\nalpha = {alpha:e}\n");
    metal + &room(&Room { ball: "metal", ..Room::default() })
}

fn grazing(degrees: f64) -> String {
    ball_on_floor(
        degrees,
        "[environment]\nradiance = [0.3, 0.3, 0.3]\n[[light]]\nkind = \"directional\"\n\
         direction = [-1, -1, -1]\nirradiance = [2, 2, 2]\n",
    )
}

fn glass(panes: f64) -> String {
    let mut text = room(&Room::default());
    text += "[[material]]\nname = \"pane\"\nkind = \"glass\"\nthin = true\n";
    for pane in 0..panes as u32 {
        let z = 2.2 - 0.01 * f64::from(pane);
        text += &format!(
            "[[mesh]]\nshape = \"rectangle\"\nmaterial = \"pane\"\n\
             transform = [{{ scale = 2.4 }}, {{ translate = [0, 0, {z:e}] }}]\n"
        );
    }
    text
}
