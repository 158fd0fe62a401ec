//! VPLs one by one, and those of whole scenes against closed forms.

use super::*;
use crate::lightcut::fixtures::{RandomNumbers, profiles};
use base::math::{LANES, Rgb, Vec3x16};
use base::progress::Control;
use base::sampling::{owen_sobol_2d, uniform_sphere};
use glam::Vec3;
use scene::{Camera, DeltaLight, Emission};
use std::f32::consts::PI;
use world::material::LobeShape;
use world::testkit::*;

#[test]
fn indirect_flux_is_what_the_surfaces_reflect() {
    // In a closed room each watt emitted is reflected ρ + ρ² + ... = ρ/(1-ρ) times.
    let world = room_with_ball(None);
    let settings = LightPassSettings { indirect: 50_000, ..LightPassSettings::default() };
    let lights = light_pass(&world, &settings, &[], u32::MAX, &Control::new());
    let of = |origin| {
        let sets = lights.sets.iter().filter(|s| s.origin == origin);
        sets.flat_map(|s| &s.intensities).copied().sum::<Rgb>() * PI
    };
    let emitted = Rgb::new(10.0, 9.0, 8.0) * (PI * 0.36);
    let direct = of(Origin::Direct);
    assert!((direct / emitted - Rgb::ONE).abs().max_element() < 1e-3, "{direct} {emitted}");
    let albedo = Rgb::new(0.7, 0.5, 0.6);
    let expected = emitted * albedo / (Rgb::ONE - albedo);
    let indirect = of(Origin::Indirect);
    assert!((indirect / expected - Rgb::ONE).abs().max_element() < 0.02, "{indirect} {expected}");
}

/// Flux of many indirect virtual lights, and the number of photons' paths that brought them.
fn indirect_flux(scene: SceneAndView) -> (Rgb, u64) {
    let settings = LightPassSettings { indirect: 20_000, ..LightPassSettings::default() };
    let lights = light_pass(&world(scene), &settings, &[], u32::MAX, &Control::new());
    let indirect = lights.sets.iter().filter(|s| s.origin == Origin::Indirect);
    let intensities: Vec<Rgb> = indirect.flat_map(|s| &s.intensities).copied().collect();
    assert!(intensities.len() > 15_000, "{}", intensities.len());
    (intensities.iter().copied().sum::<Rgb>() * PI, lights.photons.paths)
}

#[test]
fn lights_far_off_send_their_photons_to_the_surfaces() {
    for distance in [10.0, 1e3, 1e5, 1e8f32] {
        let position = Vec3::new(0.0, distance, 0.0);
        let intensity = Rgb::new(1.0, 0.5, 0.25) * distance * distance;
        let spot = |angle: f32| DeltaLight::Spot {
            position,
            direction: Vec3::NEG_Y,
            intensity,
            inner_angle: angle,
            outer_angle: 1.5 * angle,
            image: None,
        };
        // Spots wider and narrower than the floor, as seen from there; the latter's pool of light is even in a radius
        // of .5 and falls to 0 at .75, up to a distance where angles round.
        let narrow = 0.5 / distance.min(1e3);
        let pool = if distance > 1e3 { 4.0 } else { PI * (0.25 + 7.0 / 48.0) };
        for (light, area) in
            [(DeltaLight::Point { position, intensity }, 4.0), (spot(0.5), 4.0), (spot(narrow), pool)]
        {
            let mut scene = scene(Camera::default(), [8, 8]);
            let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
            scene.meshes.push(quad(Vec3::new(-1.0, 0.0, 1.0), Vec3::X * 2.0, Vec3::Z * -2.0, grey));
            scene.lights.push(light);
            let (flux, _) = indirect_flux(scene);
            let expected = Rgb::new(1.0, 0.5, 0.25) * area * 0.5;
            let error = (flux / expected - Rgb::ONE).abs().max_element();
            assert!(error < 0.03, "{flux} {expected}, {light:?}");
        }
    }
}

#[test]
fn lamps_that_are_surfaces_far_off_send_half_of_their_photons_to_the_others() {
    for (distance, two_sided) in [(4.0, false), (30.0, true), (1e3, false), (1e5, true), (1e6, false)] {
        let mut scene = scene(Camera::default(), [8, 8]);
        let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
        let black = add_material(&mut scene, diffuse(Rgb::ZERO));
        scene.meshes.push(quad(Vec3::new(-1.0, 0.0, 1.0), Vec3::X * 2.0, Vec3::Z * -2.0, grey));
        // A weak one close by, which is not to be left out.
        let half = 0.1 * distance;
        for (height, half, radiance) in
            [(distance, half, Rgb::new(1.0, 0.5, 0.25)), (0.1, 0.05, Rgb::splat(0.1))]
        {
            let corner = Vec3::new(-half, height, -half);
            let mut lamp = quad(corner, Vec3::X * (2.0 * half), Vec3::Z * (2.0 * half), black);
            lamp.emission = Some(Emission { radiance, texture: None, two_sided });
            scene.meshes.push(lamp);
        }
        let (flux, paths) = indirect_flux(scene);
        assert!(paths < 100_000, "{paths} paths at {distance}");
        // The far lamp's angle is .04, over the floor of 4, but for that the corners are farther.
        let far = Rgb::new(1.0, 0.5, 0.25) * 0.16;
        let expected = (far + Rgb::splat(0.1 * PI * 0.01)) * 0.5;
        let error = (flux / expected - Rgb::ONE).abs().max_element();
        let bound = 0.03 + 1.0 / (distance * distance);
        assert!(error < bound, "{flux} {expected} at {distance}");
    }
}

#[test]
fn a_direct_only_depth_makes_no_indirect_vpls() {
    let world = room_with_ball(None);
    let lights = light_pass(&world, &LightPassSettings::default(), &[], 2, &Control::new());
    assert!(lights.sets.iter().all(|s| s.origin == Origin::Direct || s.is_empty()));
    assert_eq!(lights.photons.rays, 0);
}

#[test]
fn many_lamps_have_few_virtual_lights_each() {
    for (lamps, most) in [(1000, 256_000), (5000, 1 << 18)] {
        let mut scene = scene(camera(Vec3::ZERO, Vec3::Z, 0.5), [4, 4]);
        let material = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
        for i in 0..lamps {
            let mut lamp = quad(Vec3::new(i as f32, 3.0, 0.0), 0.1 * Vec3::X, 0.1 * Vec3::Z, material);
            lamp.emission = Some(Emission { radiance: Rgb::ONE, texture: None, two_sided: false });
            scene.meshes.push(lamp);
        }
        let settings = LightPassSettings { direct: 1, indirect: 0, ..LightPassSettings::default() };
        let lights = light_pass(&world(scene), &settings, &[], u32::MAX, &Control::new());
        let count: usize = lights.sets.iter().map(VplSet::len).sum();
        assert!(count <= most && count > most / 2, "{lamps} lamps: {count}");
    }
}

#[test]
fn a_vpl_fills_a_quarter_of_a_cache_line() {
    assert_eq!((size_of::<Vpl>(), align_of::<Vpl>()), (16, 16));
}

#[test]
fn spot_falloff_is_linear_in_angle_between_its_cones() {
    let spot = SpotProfile::Cone { direction: Vec3::Z, inner_angle: 0.2, outer_angle: 0.6 };
    let at = |angle: f32| spot.falloff(Vec3::new(angle.sin(), 0.0, angle.cos()));
    assert_eq!((at(0.1), at(0.7)), (1.0, 0.0));
    assert!((at(0.4) - 0.5).abs() < 1e-5 && (at(0.5) - 0.25).abs() < 1e-5);
}

#[test]
fn a_spot_with_equal_cones_is_a_step() {
    let spot = SpotProfile::Cone { direction: Vec3::Z, inner_angle: 0.5, outer_angle: 0.5 };
    assert_eq!(spot.falloff(Vec3::new(0.6f32.sin(), 0.0, 0.6f32.cos())), 0.0);
    assert_eq!(spot.falloff(Vec3::Z), 1.0);
}

#[test]
fn black_negative_and_non_finite_vpls_are_left_out() {
    let mut set = VplSet::new(VplKind::Omni, Origin::Direct);
    set.push(Vpl::omni(Vec3::ZERO), Rgb::ZERO);
    set.push(Vpl::omni(Vec3::ZERO), Rgb::new(f32::NAN, 1.0, 1.0));
    set.push(Vpl::omni(Vec3::INFINITY), Rgb::ONE);
    set.push(Vpl::omni(Vec3::ZERO), Rgb::new(1.0, -1.0, 1.0));
    assert!(set.is_empty());
    set.push(Vpl::omni(Vec3::ZERO), Rgb::ONE);
    assert_eq!(set.len(), 1);
}

#[test]
fn lobes_send_all_the_light_that_is_reflected_and_nowhere_more_than_their_bounds() {
    const COUNT: u32 = 1 << 15;
    for lobe in profiles().lobes {
        let (axis, width_sq) = (lobe.axis(), lobe.width_sq());
        let mut sent = 0.0;
        for i in 0..COUNT {
            let away = uniform_sphere(owen_sobol_2d(i, 1));
            let share = lobe.share(away);
            let bound = LobeShape::max_share(axis.dot(away), width_sq);
            assert!(
                (0.0..=1.0).contains(&share) && share <= bound * 1.0001 + 1e-6,
                "{share} {bound} {lobe:?}"
            );
            assert!(share == 0.0 || lobe.normal.dot(away) > 0.0);
            sent += f64::from(share * lobe.peak);
        }
        let flux = sent * f64::from(4.0 * PI) / f64::from(COUNT);
        // Tables of albedo are linear between 64 angles.
        let tolerance = if lobe.normal.dot(lobe.towards_light) < 0.05 { 0.1 } else { 0.02 };
        assert!((flux - 1.0).abs() < tolerance, "{flux} {lobe:?}");
    }
}

#[test]
fn lanes_of_lobes_are_those_of_single_directions() {
    let mut numbers = RandomNumbers(3);
    for lobe in profiles().lobes {
        let mut away = Vec3x16::ZERO;
        (0..LANES - 1).for_each(|lane| away.set(lane, numbers.direction()));
        let shares = lobe.shares(away.load()).to_array();
        for (lane, share) in shares.into_iter().enumerate() {
            let single = if lane < LANES - 1 { lobe.share(away.get(lane)) } else { 0.0 };
            assert!((share - single).abs() < 1e-5, "{share} {single}");
        }
    }
}

#[test]
fn slopes_of_lobes_are_perpendicular_and_those_of_their_shares() {
    let mut numbers = RandomNumbers(5);
    for lobe in profiles().lobes {
        let away = (lobe.axis() + 0.3 * numbers.direction()).normalize();
        let (share, slope) = lobe.share_and_slope(away);
        assert!(share == lobe.share(away) && slope.dot(away).abs() < 1e-4 * slope.length().max(1.0));
        let side = away.any_orthonormal_vector();
        let at = |step: f32| lobe.share((away + side * step).normalize());
        let difference = (at(0.01) - at(-0.01)) / 0.02;
        let least = [0.03, -0.03].map(at).into_iter().fold(share, f32::min);
        // A horizon has a kink.
        assert!(least == 0.0 || (slope.dot(side) - difference).abs() < 0.1, "{slope} {difference} {lobe:?}");
    }
}

#[test]
fn metals_radiate_by_lobes_and_plastics_diffusely() {
    let settings = LightPassSettings { indirect: 20_000, ..LightPassSettings::default() };
    let flux_of = |material| {
        let mut scene = scene(Camera::default(), [8, 8]);
        let wall = add_material(&mut scene, material);
        scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
        scene.lights.push(DeltaLight::Point { position: Vec3::ZERO, intensity: Rgb::ONE });
        let lights = light_pass(&world(scene), &settings, &[], 3, &Control::new());
        let flux = |kind: VplKind| -> f32 {
            let sets = lights.sets.iter().filter(|s| s.kind == kind && s.origin == Origin::Indirect);
            let one = |(vpl, intensity): (&Vpl, &Rgb)| match kind {
                VplKind::Lobed => intensity.x * PI * lights.profiles.lobes[vpl.lobe()].diffuse_equivalent(),
                _ => intensity.x * PI,
            };
            sets.flat_map(|s| s.vpls.iter().zip(&s.intensities)).map(one).sum()
        };
        [flux(VplKind::Oriented), flux(VplKind::Lobed)]
    };
    let emitted = 4.0 * PI;
    // Light that facets pass on to each other is lost: 32 % at roughness .5.
    let [diffuse, lobed] = flux_of(rough_metal(0.5, 0.8));
    assert!(diffuse == 0.0 && (lobed / emitted - 0.8 * 0.68).abs() < 0.01, "{diffuse} {lobed}");
    let [diffuse, lobed] = flux_of(rough_metal(0.5, 0.05));
    assert!(lobed == 0.0 && (diffuse / emitted - 0.05 * 0.68).abs() < 0.001, "{diffuse} {lobed}");
    let [diffuse, lobed] = flux_of(rough_metal(0.2, 0.8));
    assert!(lobed == 0.0 && diffuse == 0.0, "{diffuse} {lobed}");
}
