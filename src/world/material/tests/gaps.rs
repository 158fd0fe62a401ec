//! Materials with gaps.

use super::*;

/// Reflects a direction to the other side.
fn behind(v: Vec3) -> Vec3 {
    Vec3::new(v.x, v.y, -v.z)
}

#[test]
fn a_share_of_the_light_passes_straight_and_the_rest_meets_the_material() {
    let (wo, wi) = (direction(0.4, 0.0), direction(0.6, 2.5));
    for two_sided in [false, true] {
        let whole = Material { two_sided, ..rough_plastic(Distribution::Ggx, 0.3, true) };
        let (value, bound) = with_bsdf(&whole, |b| (b.eval(wo, wi), b.albedo(wo)));
        with_bsdf(&masked(0.7, whole), |b| {
            assert!((b.eval(wo, wi) - 0.7 * value).abs().max_element() < 1e-6);
            assert!((b.albedo(wo) - 0.7 * bound).abs().max_element() < 1e-6);
            assert!(b.passes_straight() && !b.bends_light());
            for wo in [wo, behind(wo)] {
                assert!((b.straight_transmittance(wo.z) - 0.3).abs().max_element() < 1e-6);
                let passage = b.delta_lobes(wo).refraction.expect("a gap");
                assert!(passage.straight && (passage.wi + wo).length() < 1e-6);
            }
            // A black back scatters nothing; light only passes the gaps.
            if !two_sided {
                let mut random = Random(11);
                for _ in 0..1000 {
                    let s = b.sample(behind(wo), random.next(), random.next_2d()).expect("a gap");
                    assert!(s.straight && (s.weight - 0.3).abs().max_element() < 1e-6, "{s:?}");
                }
            }
        });
    }
}

#[test]
fn gaps_are_where_the_texture_says() {
    // Luminances of red and green.
    let opacity = Some(Roughness::Textured { texture: TextureId(0), scale: 0.5 });
    let scene = scene(vec![Material { opacity, ..lambert(PAINT) }]);
    let materials = Materials::new(&scene);
    for (u, texel) in [(0.25, 0.2126), (0.75, 0.7152)] {
        let bsdf = materials.at(MaterialId(0), Vec2::new(u, 0.5));
        assert!((bsdf.straight_transmittance(1.0) - (1.0 - 0.5 * texel)).abs().max_element() < 1e-4);
        let albedo = bsdf.albedo(Vec3::Z) - PAINT * (0.5 * texel);
        assert!(albedo.abs().max_element() < 1e-4, "{albedo}");
    }
    assert!(materials.average(MaterialId(0)).passes_straight());
}
