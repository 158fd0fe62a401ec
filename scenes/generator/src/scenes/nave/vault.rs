//! Quadripartite rib vaults. A web is ruled between the arch at the edge of a bay and the diagonal rib, as
//! masons laid it, with a little camber so that every course is an arch of its own.

use crate::shapes::*;
use glam::{Vec2, Vec3};

/// Half an arch in the vertical plane through its foot and its crown.
#[derive(Clone, Copy, Debug)]
pub struct Rib {
    /// Point at which it springs, vertically.
    pub foot: Vec3,
    /// Point at which it meets its other half.
    pub crown: Vec3,
}

impl Rib {
    /// Point at `t` from foot (0) to crown (1).
    pub fn at(&self, t: f32) -> Vec3 {
        let across = Vec3::new(self.crown.x - self.foot.x, 0.0, self.crown.z - self.foot.z);
        let half_span = across.length();
        let arch = PointedArch { half_span, rise: self.crown.y - self.foot.y };
        let p = arch.left(t);
        self.foot + across * ((p.x + half_span) / half_span) + Vec3::Y * p.y
    }

    /// Points from the foot to the crown.
    pub fn points(&self, segments: usize) -> Vec<Vec3> {
        (0..=segments).map(|k| self.at(k as f32 / segments as f32)).collect()
    }
}

/// Half a web between two ribs that spring from one foot, seen from below.
pub fn web(edge: Rib, rib: Rib, camber: f32, across: usize, along: usize) -> Shell {
    let shell = patch(across, along, |s, t| {
        let lift = camber * (std::f32::consts::PI * s).sin() * t;
        edge.at(t).lerp(rib.at(t), s) + Vec3::Y * lift
    });
    shell.facing(Vec3::new(rib.crown.x, edge.foot.y - 100.0, rib.crown.z))
}

/// Fineness of a vault's surfaces and weight of its ribs.
#[derive(Clone, Copy, Debug)]
pub struct Detail {
    /// Quadrilaterals across half a web and along it.
    pub web: [usize; 2],
    /// Width and depth of the diagonal ribs.
    pub diagonal: Vec2,
    /// Width and depth of the transverse arches.
    pub transverse: Vec2,
    /// Width and depth of the ribs along the walls.
    pub wall: Vec2,
    /// True if the northern wall has ribs too; over an arcade its mouldings take their place.
    pub both_walls: bool,
    /// Facets of the roll at the bottom of a rib.
    pub roll: usize,
}

/// One vaulted bay.
#[derive(Clone, Copy, Debug)]
pub struct Bay {
    /// One corner in plan (x, z).
    pub low: Vec2,
    /// Opposite corner.
    pub high: Vec2,
    /// Height of the springing.
    pub spring: f32,
    /// Height of the crown.
    pub crown: f32,
    /// Height of the apex of the arches across the nave and of those along its walls.
    pub apex: [f32; 2],
}

impl Bay {
    fn corner(&self, east: bool, south: bool) -> Vec3 {
        let x = if south { self.high.x } else { self.low.x };
        let z = if east { self.low.y } else { self.high.y };
        Vec3::new(x, self.spring, z)
    }

    fn middle(&self) -> Vec3 {
        let middle = 0.5 * (self.low + self.high);
        Vec3::new(middle.x, self.crown, middle.y)
    }

    /// Half the transverse arch that springs from a corner.
    pub fn transverse(&self, east: bool, south: bool) -> Rib {
        let foot = self.corner(east, south);
        Rib { foot, crown: Vec3::new(self.middle().x, self.apex[0], foot.z) }
    }

    /// Half the wall arch that springs from a corner.
    pub fn wall(&self, east: bool, south: bool) -> Rib {
        let foot = self.corner(east, south);
        Rib { foot, crown: Vec3::new(foot.x, self.apex[1], self.middle().z) }
    }

    fn diagonal(&self, east: bool, south: bool) -> Rib {
        Rib { foot: self.corner(east, south), crown: self.middle() }
    }

    /// Webs, diagonal ribs, wall ribs and the transverse arch at the bay's western edge.
    pub fn vaulted(&self, detail: &Detail) -> Assembly {
        let mut vault = Assembly::new();
        let [across, along] = detail.web;
        let camber = 0.05 * (self.high - self.low).min_element();
        for (east, south) in [(false, false), (false, true), (true, false), (true, true)] {
            for edge in [self.transverse(east, south), self.wall(east, south)] {
                vault.add("vault_webs", &web(edge, self.diagonal(east, south), camber, across, along));
            }
        }
        let mut rib = |halves: [Rib; 2], size: Vec2, roll: usize| {
            vault.add("vault_ribs", &whole_arch(halves, size, along, roll));
        };
        for south in [false, true] {
            rib([self.diagonal(false, south), self.diagonal(true, !south)], detail.diagonal, detail.roll);
            if south || detail.both_walls {
                rib([self.wall(false, south), self.wall(true, south)], detail.wall, 0);
            }
        }
        let transverse = [self.transverse(false, false), self.transverse(false, true)];
        rib(transverse, detail.transverse, detail.roll);
        vault.add("vault_ribs", &boss(self.middle(), 0.8 * detail.diagonal.x));
        vault
    }
}

/// Moulded rib under both halves of an arch; it reaches a little into the web above.
pub fn whole_arch(halves: [Rib; 2], size: Vec2, segments: usize, roll: usize) -> Shell {
    let mut path = halves[0].points(segments);
    path.extend(halves[1].points(segments).iter().rev().skip(1));
    rib_along(&path, size, roll)
}

/// Moulded rib below `path`, which starts vertically and bends away from where it starts.
pub fn rib_along(path: &[Vec3], size: Vec2, roll: usize) -> Shell {
    let profile = rib_profile(size.x, size.y, roll);
    let section = Section { points: &profile, closed: false, crease_degrees: 35.0 };
    let outwards = path[0] - path[path.len() - 1];
    sweep_along(section, path, Vec3::new(outwards.x, 0.0, outwards.z), false, Faces::ALL)
}

/// Open profile: flat sides, a chamfer and a roll of `roll` facets at the bottom (0: chamfers only).
fn rib_profile(width: f32, depth: f32, roll: usize) -> Vec<Vec2> {
    let half = 0.5 * width;
    if roll == 0 {
        let left = [[-half, 0.2], [-half, -0.5], [-0.5 * half, -1.0]];
        let right = [[0.5 * half, -1.0], [half, -0.5], [half, 0.2]];
        return scaled(&[left, right].concat(), Vec2::new(1.0, depth));
    }
    let radius = 0.6 * half;
    let mut left = points(&[[-half, 0.2 * depth], [-half, -0.3 * depth], [-0.72 * half, -0.42 * depth]]);
    let right: Vec<Vec2> = left.iter().rev().map(|p| Vec2::new(-p.x, p.y)).collect();
    let centre = Vec2::new(0.0, radius - depth);
    left.extend(arc(centre, radius, 160.0, 380.0, roll));
    left.extend(right);
    left
}

/// Carved keystone where the diagonals cross.
fn boss(crown: Vec3, radius: f32) -> Shell {
    let profile = [[0.0, -0.62], [0.35, -0.58], [0.45, -0.42], [0.8, -0.4], [1.0, -0.2], [1.0, 0.3]]
        .map(|[r, y]| Vec2::new(r, y - 0.35) * radius * 1.3);
    lathe(&profile, 8).mapped(|p| p + crown)
}
