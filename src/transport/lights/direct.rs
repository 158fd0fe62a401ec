//! VPLs of emitted light: stratified points on area lights; one VPL for each point, spot and directional light,
//! up to three for a projected image; luminance-stratified directions for the environment, in a set of their own.

use super::{LightPassSettings, Origin, SpotProfile, Vpl, VplKind, VplSet, size_of_area};
use base::math::Rgb;
use base::progress::Control;
use base::sampling::{hash, owen_sobol_2d};
use scene::DeltaLight;
use world::World;
use world::light::{AreaLight, EnvironmentLight};

/// Minimum number of points on an area light. With fewer points, penumbrae would show bands.
const MIN_PER_LIGHT: u32 = 256;

/// Maximum of the sum of the minimum numbers over all area lights, for cities with thousands of lights.
const MIN_OF_ALL: u32 = 1 << 18;

/// VPLs of emitted light.
pub struct DirectVpls {
    /// Sets of VPLs; some may be empty.
    pub sets: Vec<VplSet>,
    /// Profiles of the spot lights.
    pub spots: Vec<SpotProfile>,
    /// Size code of the patches of the VPLs on each mesh; 0 for meshes that do not emit.
    pub sizes: Vec<u32>,
}

/// Makes the VPLs of emitted light; only some of them if `control` is cancelled.
pub fn direct_vpls(world: &World, settings: &LightPassSettings, control: &Control) -> DirectVpls {
    let emitters = &world.emitters;
    let mut oriented = VplSet::new(VplKind::Oriented, Origin::Direct);
    let total_power: f64 = emitters.areas.iter().map(|a| f64::from(a.power)).sum();
    let min_count = (MIN_OF_ALL / emitters.areas.len().max(1) as u32).clamp(1, MIN_PER_LIGHT);
    let mut sizes = vec![0; world.scene.seen().count()];
    for (i, light) in emitters.areas.iter().enumerate() {
        let share = f64::from(light.power) / total_power;
        let count = ((share * f64::from(settings.direct)).ceil() as u32).max(min_count);
        let size = size_of_area(light.area / count as f32, world.diagonal);
        sizes[light.mesh as usize] = size;
        let patches = Patches { count, size, seed: hash(settings.seed, 0x0a1e_a000 ^ i as u32) };
        add_area_light(light, patches, &mut oriented, control);
    }
    let mut omni = VplSet::new(VplKind::Omni, Origin::Direct);
    let mut directional = VplSet::new(VplKind::Directional, Origin::Direct);
    let mut spots = Vec::new();
    for delta in &emitters.deltas {
        match (delta.light, &delta.image) {
            (DeltaLight::Spot { position, .. } | DeltaLight::Projector { position, .. }, Some(image)) => {
                // Shares of virtual lights have no hue, so an image in colour has a virtual light for each channel.
                let mut add = |colour: Rgb, channel| {
                    omni.push(Vpl::spot(position, spots.len() as u32), image.peak * colour);
                    spots.push(SpotProfile::Image { image: image.clone(), channel });
                };
                match image.is_grey {
                    true => add(Rgb::ONE, image.peak.max_position()),
                    false => Rgb::AXES.into_iter().enumerate().for_each(|(channel, axis)| add(axis, channel)),
                }
            }
            (DeltaLight::Point { position, intensity }, _) => omni.push(Vpl::omni(position), intensity),
            (DeltaLight::Spot { position, direction, intensity, inner_angle, outer_angle, .. }, None) => {
                omni.push(Vpl::spot(position, spots.len() as u32), intensity);
                spots.push(SpotProfile::Cone { direction, inner_angle, outer_angle });
            }
            (DeltaLight::Projector { .. }, None) => {}
            (DeltaLight::Directional { direction, irradiance }, _) => {
                directional.push(Vpl::directional(-direction), irradiance);
            }
        }
    }
    let mut environment = VplSet::new(VplKind::Directional, Origin::Direct);
    if let Some(light) = &emitters.environment {
        let seed = hash(settings.seed, 0x0e57);
        add_environment(light, settings.direct.max(1), seed, &mut environment, control);
    }
    DirectVpls { sets: vec![oriented, omni, directional, environment], spots, sizes }
}

/// Division of an area light into patches.
struct Patches {
    count: u32,
    /// Size code (see [`size_of_area`]).
    size: u32,
    seed: u32,
}

fn add_area_light(light: &AreaLight, patches: Patches, set: &mut VplSet, control: &Control) {
    let area = light.area / patches.count as f32;
    set.reserve(patches.count as usize * if light.emission.two_sided { 2 } else { 1 });
    for i in (0..patches.count).take_while(|_| !control.is_cancelled()) {
        let point = light.sample(owen_sobol_2d(i, patches.seed));
        let radiance = light.radiance(&point, point.normal);
        set.push(Vpl::patch(point.position, point.normal, patches.size), radiance * area);
        if light.emission.two_sided {
            set.push(Vpl::patch(point.position, -point.normal, patches.size), radiance * area);
        }
    }
}

fn add_environment(light: &EnvironmentLight, count: u32, seed: u32, set: &mut VplSet, control: &Control) {
    set.reserve(count as usize);
    for i in (0..count).take_while(|_| !control.is_cancelled()) {
        if let Some(s) = light.sample(owen_sobol_2d(i, seed)) {
            set.push(Vpl::directional(s.direction), s.radiance / (s.pdf * count as f32));
        }
    }
}
