//! Crockery, pots, jars, bottles, cutlery and fruit. Everything stands on y = 0 about the origin.

use crate::shapes::*;
use glam::{Affine3A, Quat, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

pub use vessels::{BOTTLE, BOWL, PLATE, TUMBLER};

#[rustfmt::skip]
mod vessels {
    use crate::shapes::Vessel;

    pub const PLATE: Vessel = Vessel::new(&[[0.06, 0.0], [0.065, 0.004], [0.085, 0.006], [0.105, 0.014],
        [0.13, 0.021]], 0.004, 24, 1);
    pub const BOWL: Vessel = Vessel::new(&[[0.035, 0.0], [0.036, 0.008], [0.05, 0.016], [0.072, 0.04], [0.08, 0.07]],
        0.004, 20, 1);
    pub const TUMBLER: Vessel = Vessel::new(&[[0.028, 0.0], [0.03, 0.004], [0.033, 0.05], [0.037, 0.105]],
        0.003, 20, 1);
    pub const BOTTLE: Vessel = Vessel::new(&[[0.034, 0.0], [0.038, 0.006], [0.038, 0.1], [0.037, 0.17], [0.027, 0.21],
        [0.0145, 0.235], [0.014, 0.29], [0.017, 0.292], [0.017, 0.305], [0.013, 0.307]], 0.0, 20, 1);
    pub const JAR: Vessel = Vessel::new(&[[0.046, 0.0], [0.05, 0.006], [0.051, 0.06], [0.05, 0.115], [0.042, 0.128],
        [0.042, 0.135]], 0.0, 20, 1);
    pub const JAR_LID: Vessel = Vessel::new(&[[0.045, 0.0], [0.046, 0.014], [0.04, 0.02], [0.012, 0.022], [0.009, 0.03],
        [0.013, 0.037], [0.008, 0.043]], 0.0, 16, 1);
    pub const POT: Vessel = Vessel::new(&[[0.098, 0.0], [0.108, 0.008], [0.11, 0.03], [0.11, 0.13], [0.114, 0.135]],
        0.004, 24, 2);
    pub const MUG: Vessel = Vessel::new(&[[0.036, 0.0], [0.04, 0.005], [0.041, 0.05], [0.041, 0.095]], 0.0035, 20, 1);
    pub const PAN: Vessel = Vessel::new(&[[0.095, 0.0], [0.105, 0.006], [0.13, 0.045], [0.132, 0.047]], 0.003, 32, 2);
    pub const FRUIT_BOWL: Vessel = Vessel::new(&[[0.07, 0.0], [0.068, 0.01], [0.1, 0.03], [0.15, 0.065],
        [0.17, 0.085]], 0.005, 32, 2);
}

/// Half section of a pot's lid, and outlines of cutlery.
#[rustfmt::skip]
mod outline {
    pub const POT_LID: [[f32; 2]; 8] = [[0.0, 0.134], [0.112, 0.134], [0.113, 0.138], [0.08, 0.155], [0.012, 0.162],
        [0.009, 0.172], [0.017, 0.18], [0.0, 0.185]];
    pub const KNIFE: [[f32; 2]; 7] = [[-0.008, -0.1], [0.006, -0.1], [0.006, 0.0], [0.009, 0.03], [0.007, 0.09],
        [-0.004, 0.105], [-0.006, 0.0]];
    pub const FORK: [[f32; 2]; 16] = [[-0.006, -0.1], [0.006, -0.1], [0.004, 0.03], [0.012, 0.05], [0.012, 0.1],
        [0.008, 0.1], [0.007, 0.06], [0.003, 0.06], [0.002, 0.1], [-0.002, 0.1], [-0.003, 0.06], [-0.007, 0.06],
        [-0.008, 0.1], [-0.012, 0.1], [-0.012, 0.05], [-0.004, 0.03]];
}

/// Storage jar with its lid: parts `jar` and "jar_lids".
pub fn jar(part: &str, scale: Vec2) -> Assembly {
    let mut jar = Assembly::new();
    let place = Affine3A::from_scale(Vec3::new(scale.x, scale.y, scale.x));
    jar.add_at(part, &vessels::JAR.turned(1.0), place);
    jar.add_at("jar_lids", &vessels::JAR_LID.turned(scale.x), at(0.0, 0.134 * scale.y, 0.0));
    jar
}

/// Pot with two handles and a lid.
pub fn pot(scale: f32) -> Assembly {
    let mut pot = Assembly::new();
    pot.add("pots", &vessels::POT.turned(scale));
    pot.add("pots", &lathe(&scaled(&outline::POT_LID, scale), 24));
    for side in [-1.0, 1.0] {
        let ear = [[0.106, -0.035], [0.15, -0.035], [0.15, 0.035], [0.106, 0.035]];
        let path: Vec<Vec3> = ear.iter().map(|p| Vec3::new(side * p[0], 0.105, p[1]) * scale).collect();
        pot.add("hob", &pipe(&fillet(&path, 0.02 * scale, 22.5), 0.006 * scale, 8));
    }
    pot
}

/// Frying pan with a long handle towards +x.
pub fn pan() -> Assembly {
    let mut pan = Assembly::new();
    pan.add("hob", &vessels::PAN.turned(1.0));
    let path = [[0.126, 0.036, 0.0], [0.17, 0.055, 0.0], [0.33, 0.065, 0.0]];
    pan.add("hob", &pipe(&fillet(&path, 0.05, 10.0), 0.009, 10));
    pan
}

/// Mug with its ear towards +x.
pub fn mug(part: &str) -> Assembly {
    let mut mug = Assembly::new();
    mug.add(part, &vessels::MUG.turned(1.0));
    let ear = [[0.038, 0.075, 0.0], [0.068, 0.075, 0.0], [0.066, 0.025, 0.0], [0.039, 0.022, 0.0]];
    mug.add(part, &pipe(&fillet(&ear, 0.02, 18.0), 0.005, 8));
    mug
}

/// Knife, fork and spoon beside a plate about the origin, the diner at +z.
pub fn cutlery() -> Assembly {
    let mut set = Assembly::new();
    let flat = posed(Quat::from_rotation_x(-FRAC_PI_2), Vec3::Y * 0.001);
    set.add_at("cutlery", &extrude(&outline::KNIFE, &[], 0.003), at(0.165, 0.0, 0.0) * flat);
    set.add_at("cutlery", &extrude(&outline::FORK, &[], 0.003), at(-0.165, 0.0, 0.0) * flat);
    set.add_at("cutlery", &superellipsoid([0.018, 0.004, 0.028], 1.0, 0.9, 16, 6), at(0.195, 0.0045, -0.075));
    set.add("cutlery", &rod([0.195, 0.0045, -0.05], [0.195, 0.0035, 0.1], 0.003, 8));
    set
}

/// Wide bowl with seven fruits: parts "fruit_bowl" and "fruit".
pub fn fruit_bowl() -> Assembly {
    let mut bowl = Assembly::new();
    bowl.add("fruit_bowl", &vessels::FRUIT_BOWL.turned(1.0));
    let mut rng = Rng::new(5);
    let spots =
        [[0.0, 0.0], [0.078, 0.0], [0.025, 0.075], [-0.065, 0.045], [-0.065, -0.045], [0.025, -0.075]];
    for (k, [x, z]) in spots.into_iter().enumerate() {
        let radius = 0.036 + rng.range(0.0, 0.003);
        let y = radius + if k == 0 { 0.012 } else { 0.034 };
        bowl.add_at("fruit", &apple(radius), turned(rng.range(0.0, 360.0), [x, y, z]));
    }
    bowl.add_at("fruit", &apple(0.038), turned(40.0, [0.02, 0.11, 0.01]));
    bowl
}

/// Apple about its middle: a sphere drawn in at both poles.
fn apple(radius: f32) -> Shell {
    ellipsoid(Vec3::ONE, 16, 12).mapped(|p| {
        let around = (p.x * p.x + p.z * p.z).sqrt();
        let dent = 0.22 * (1.0 - (around / 0.45).min(1.0)).powi(2);
        let narrow = 1.0 + 0.1 * p.y;
        radius * Vec3::new(p.x * narrow, p.y * (0.92 - dent), p.z * narrow)
    })
}

/// Block with four knives.
pub fn knife_block() -> Assembly {
    let mut set = Assembly::new();
    let lean = Affine3A::from_quat(Quat::from_rotation_x(-0.3));
    let body = [[-0.085, 0.0], [0.06, 0.0], [0.03, 0.2], [-0.055, 0.16]];
    set.add_at("wood", &extrude(&body, &[], 0.1), at(0.05, 0.0, 0.0) * turned(-90.0, Vec3::ZERO));
    for k in 0..4 {
        let x = -0.033 + 0.022 * k as f32;
        let handle = beveled_box([x - 0.008, 0.16, -0.03], [x + 0.008, 0.27, -0.008], 0.003);
        set.add_at("hob", &handle, at(0.0, 0.01, 0.03) * lean);
    }
    set
}
