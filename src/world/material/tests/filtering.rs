//! Textures averaged over what a ray stands for, where that leaves the mean of the light reflected as it is.

use super::*;
use scene::{Relief, Share};

/// Texture of the scene of the tests.
const TEXTURE: TextureId = TextureId(0);

/// Side of a square of several 2x1 textures.
const ALL: f32 = 8.0;

fn reflectance() -> Reflectance {
    Reflectance::Textured { texture: TEXTURE, scale: Rgb::splat(0.8) }
}

fn share() -> Share {
    Share::Textured { texture: TEXTURE, scale: 0.9 }
}

fn textured(material: Material) -> Material {
    Material { diffuse: reflectance(), ..material }
}

fn principled(change: impl FnOnce(&mut Principled)) -> Material {
    let mut principled = Principled { base_color: reflectance(), ..Principled::default() };
    change(&mut principled);
    Material { principled: Some(principled.into()), ..Material::default() }
}

/// Returns materials whose textures are averaged.
fn averaged() -> Vec<Material> {
    let mut metal = rough_conductor(Distribution::Ggx, 0.3, Rgb::ONE);
    let Lobe::Rough { scale, .. } = &mut metal.lobes[0] else { unreachable!("a rough lobe") };
    *scale = reflectance();
    vec![
        textured(lambert(PAINT)),
        textured(plastic(false)),
        textured(rough_plastic(Distribution::Ggx, 0.2, false)),
        blend(0.3, textured(lambert(PAINT)), metal.clone()),
        metal,
        principled(|_| ()),
        principled(|p| p.metallic = Share::Constant(0.4)),
        principled(|p| (p.sheen, p.clearcoat) = (Share::Constant(0.5), Share::Constant(0.7))),
    ]
}

/// Returns materials whose textures are not averaged, because reflected light is not linear in their texels.
fn at_points() -> Vec<Material> {
    let mut rough = textured(rough_plastic(Distribution::Ggx, 0.2, false));
    let Lobe::Rough { alpha, .. } = &mut rough.lobes[0] else { unreachable!("a rough lobe") };
    *alpha = share();
    let mut mixed = blend(0.3, textured(lambert(PAINT)), lambert(Rgb::ONE));
    if let Some(blend) = &mut mixed.blend {
        blend.weight = share();
    }
    let relief = Relief::Heights { texture: TEXTURE, scale: 0.1 };
    vec![
        rough,
        mixed,
        textured(plastic(true)),
        Material { opacity: Some(share()), ..textured(lambert(PAINT)) },
        Material { relief: Some(relief), ..textured(lambert(PAINT)) },
        principled(|p| p.metallic = share()),
        principled(|p| p.roughness = share()),
        principled(|p| p.spec_tint = Share::Constant(0.5)),
        principled(|p| p.spec_trans = Share::Constant(0.5)),
    ]
}

#[test]
fn averages_reflect_the_mean_of_the_light_or_are_not_taken() {
    let mut random = Random(5);
    let all = averaged().into_iter().map(|m| (m, true)).chain(at_points().into_iter().map(|m| (m, false)));
    for (i, (material, is_averaged)) in all.enumerate() {
        let scene = scene(vec![material]);
        let materials = Materials::new(&scene);
        assert_eq!(materials.filter_textures(), is_averaged, "{i}");
        for _ in 0..50 {
            let (wo, wi) = (random.hemisphere(), random.hemisphere());
            let [red, green] = [0.25, 0.75].map(|u| {
                let uv = Vec2::new(u, 0.5);
                let seen = materials.at_coordinates(MaterialId(0), || uv, || ALL, |_| Rgb::ONE);
                let expected = match is_averaged {
                    true => [0.25, 0.75].map(|u| materials.at(MaterialId(0), Vec2::new(u, 0.5)).eval(wo, wi)),
                    false => [materials.at(MaterialId(0), uv).eval(wo, wi); 2],
                };
                let expected = (expected[0] + expected[1]) * 0.5;
                let error = (seen.eval(wo, wi) - expected).abs().max_element();
                assert!(error <= 1e-4 * expected.max_element(), "{i} {wo} {wi}: {expected}");
                seen.eval(wo, wi)
            });
            assert!(!is_averaged || (red - green).abs().max_element() <= 1e-6 * red.max_element());
        }
    }
}

#[test]
fn scenes_without_textures_have_no_mip_maps() {
    assert!(!Materials::new(&scene(vec![lambert(PAINT), plastic(true)])).filter_textures());
}
