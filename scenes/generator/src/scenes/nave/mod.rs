//! `nave`: a church of five rib-vaulted bays with aisles, triforium, clerestory and a five-sided apse. All
//! surfaces are diffuse. Most of the light comes from floodlights on the ledge under the clerestory that look
//! up at the vault, so that nearly everything below is lit indirectly; the windows add a little sky.
//!
//! Units: metres; 25 m long to the chancel arch, 9 m wide between the arcades, 18 m high.

mod aisles;
mod apse;
mod arcade;
mod candles;
mod floodlights;
mod floor;
mod furniture;
mod piers;
mod plan;
mod vault;
mod west;
mod windows;

use crate::shapes::Part;
use glam::Vec2;
use plan::{BAY, BAYS, CROWN, NAVE, VAULT_SPRING, pier_z};

/// The parts of the church.
pub fn parts() -> Vec<Part> {
    let [mut walls, mut piers, mut mouldings] = ["walls", "piers", "mouldings"].map(Part::new);
    let [mut webs, mut ribs] = ["vault_webs", "vault_ribs"].map(Part::new);
    let [mut slabs_light, mut slabs_dark, mut floor_bed] =
        ["slabs_light", "slabs_dark", "floor_bed"].map(Part::new);
    let [mut wood, mut furniture_stone, mut cloth] = ["wood", "furniture_stone", "cloth"].map(Part::new);
    let mut windows = windows::Parts {
        tracery: Part::new("tracery"),
        sills: Part::new("sills"),
        sky: Part::new("sky_panels"),
    };
    let mut candles =
        candles::Parts { iron: Part::new("iron"), wax: Part::new("wax"), flames: Part::new("flames") };

    high_vault(&mut webs, &mut ribs);
    piers::build(&mut piers);
    arcade::build(&mut walls, &mut mouldings, &mut windows);
    aisles::build(&mut aisles::Parts {
        walls: &mut walls,
        piers: &mut piers,
        ribs: &mut ribs,
        webs: &mut webs,
        windows: &mut windows,
    });
    apse::build(&mut walls, &mut piers, &mut ribs, &mut webs, &mut windows);
    west::build(&mut walls, &mut mouldings, &mut wood, &mut windows);
    floor::build(&mut slabs_light, &mut slabs_dark, &mut floor_bed);
    furniture::build(&mut wood, &mut furniture_stone, &mut cloth);
    candles::build(&mut candles);
    let mut lamps = Part::new("floodlights");
    floodlights::build(&mut candles.iron, &mut lamps);

    let windows::Parts { tracery, sills, sky } = windows;
    let candles::Parts { iron, wax, flames } = candles;
    vec![
        walls,
        piers,
        mouldings,
        webs,
        ribs,
        slabs_light,
        slabs_dark,
        floor_bed,
        wood,
        furniture_stone,
        cloth,
        tracery,
        sills,
        sky,
        iron,
        wax,
        flames,
        lamps,
    ]
}

fn high_vault(webs: &mut Part, ribs: &mut Part) {
    let detail = vault::Detail {
        web: [3, 8],
        diagonal: Vec2::new(0.34, 0.36),
        transverse: Vec2::new(0.5, 0.45),
        wall: Vec2::new(0.24, 0.2),
        both_walls: true,
        roll: 2,
    };
    for k in 0..BAYS {
        let bay = vault::Bay {
            low: Vec2::new(-NAVE, pier_z(k) - BAY),
            high: Vec2::new(NAVE, pier_z(k)),
            spring: VAULT_SPRING,
            crown: CROWN,
            apex: [CROWN, CROWN - 0.7],
        };
        bay.build(&detail, webs, ribs);
        if k + 1 == BAYS {
            let halves = [bay.transverse(true, false), bay.transverse(true, true)];
            ribs.add(&vault::whole_arch(halves, Vec2::new(0.8, 0.6), 14, 6));
        }
    }
}
