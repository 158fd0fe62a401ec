//! Mixtures of materials.

use super::*;

/// Returns pairs of materials whose bases have the same coat, or of which one has no base.
fn pairs() -> Vec<[Material; 2]> {
    let metal = || rough_conductor(Distribution::Ggx, 0.3, Rgb::ONE);
    let [plain, metal_too] = [0, 1].map(|i| principled_materials().swap_remove(i));
    vec![
        [lambert(PAINT), metal()],
        [metal(), rough_plastic(Distribution::Ggx, 0.2, true)],
        [lambert(PAINT), lambert(Rgb::new(0.9, 0.1, 0.3))],
        [plain, metal_too],
    ]
}

#[test]
fn mixtures_are_the_weighted_sums() {
    let mut random = Random(12);
    for [first, second] in pairs() {
        let directions: [_; 200] = std::array::from_fn(|_| [random.hemisphere(), random.hemisphere()]);
        let values =
            |material: &Material| with_bsdf(material, |bsdf| directions.map(|[wo, wi]| bsdf.eval(wo, wi)));
        let (a, b) = (values(&first), values(&second));
        let mixed = values(&blend(0.3, first.clone(), second));
        for (i, mixed) in mixed.into_iter().enumerate() {
            let expected = a[i] * 0.7 + b[i] * 0.3;
            let error = ((mixed - expected) / (expected + 1e-5)).abs().max_element();
            assert!(error < 1e-4, "{} {:?}: {mixed} {expected}", first.name, directions[i]);
        }
    }
}

#[test]
fn weights_are_those_of_the_texture() {
    // Luminances of red and green.
    let weight = Roughness::Textured { texture: TextureId(0), scale: 1.0 };
    let [mut first, other] = pairs().swap_remove(2);
    first.blend = Some(Box::new(Blend { weight, other }));
    let scene = scene(vec![first]);
    let materials = Materials::new(&scene);
    for (u, share) in [(0.25, 0.2126), (0.75, 0.7152)] {
        let albedo = materials.at(MaterialId(0), Vec2::new(u, 0.5)).albedo(Vec3::Z);
        let expected = PAINT.lerp(Rgb::new(0.9, 0.1, 0.3), share);
        assert!((albedo - expected).abs().max_element() < 1e-4, "{u}: {albedo} {expected}");
    }
}
