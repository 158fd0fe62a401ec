//! Ends of paths by photons against paths that go on.

use super::{DirectSampling, EyePass, EyeSettings, LightSources};
use crate::irradiance::{EndsWanted, PathEnds};
use base::math::luminance;
use base::progress::Control;
use glam::Vec3;
use world::testkit::*;

#[test]
fn paths_that_end_by_photons_find_as_much_light_with_less_noise_and_fewer_rays() {
    let (mut scene, _) = lit_room(room_camera(), 32);
    let metal = add_material(&mut scene, rough_metal(0.15, 0.9));
    scene.meshes.push(quad(Vec3::new(-0.99, -1.0, -1.0), Vec3::Y * 2.0, Vec3::Z * 2.0, metal));
    scene.meshes.push(quad(Vec3::new(0.99, -1.0, -1.0), Vec3::Z * 2.0, Vec3::Y * 2.0, metal));
    let world = world(scene);
    let (settings, control) = (EyeSettings { spp: 64, seed: 3, max_depth: 32 }, Control::new());
    let wanted = |max_depth| EndsWanted::new(1 << 18, max_depth, 5);
    assert!(wanted(8).is_some() && wanted(7).is_none());
    let ends = PathEnds::new(&world, wanted(settings.max_depth).unwrap(), &control);
    let direct = DirectSampling::default();
    let [with, without] = [Some(&ends), None].map(|path_ends| {
        let sources = LightSources { direct: &direct, caustics: None, learned: None, path_ends };
        let passes = [3, 4].map(|seed| {
            EyePass::with_direct_light(
                &world,
                &world.view,
                EyeSettings { seed, ..settings },
                sources,
                &control,
            )
        });
        let pixels = passes[0].known.pixels.iter().zip(&passes[1].known.pixels);
        let square: f32 = pixels.map(|(a, b)| luminance(*a - *b).powi(2)).sum();
        let mean = 0.5 * (passes[0].known.luminance() + passes[1].known.luminance());
        (mean, square, passes[0].chains.rays)
    });
    assert!((with.0 / without.0 - 1.0).abs() < 0.01, "{with:?} {without:?}");
    assert!(with.1 < 0.9 * without.1 && with.2 < without.2, "{with:?} {without:?}");
}
