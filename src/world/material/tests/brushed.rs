//! Roughness along u and v, and anisotropy, from textures.

use super::*;
use crate::testkit::{add_texture, texture};
use ::base::math::Vec3x16;
use scene::{Camera, Share, Stretch};

/// Values of two textures of two texels each. They are levels of the roughness, so no value is rounded.
const VALUES: [[f32; 2]; 2] = [[0.25, 0.5], [0.125, 0.5]];

fn parameters() -> [Roughness; 2] {
    [0, 1].map(|id| Roughness::Textured { texture: TextureId(id), scale: 0.8 })
}

/// Asserts that the textured material is the constant one at each texel, and for sixteen directions at once.
fn assert_same(textured: Material, constant: impl Fn([f32; 2]) -> Material) {
    let mut scene = crate::testkit::scene(Camera::default(), [1, 1]);
    for values in VALUES {
        add_texture(&mut scene, texture(2, &values.map(Rgb::splat)));
    }
    for at in 0..2 {
        scene.materials.push(constant(VALUES.map(|values| 0.8 * values[at])));
    }
    scene.materials.push(textured);
    let materials = Materials::new(&scene);
    assert!(!materials.filter_textures());
    let mut random = Random(9);
    for (at, u) in [0.25, 0.75].into_iter().enumerate() {
        let expected = materials.at(MaterialId(at as u32), Vec2::ZERO);
        let found = materials.at(MaterialId(2), Vec2::new(u, 0.5));
        for _ in 0..200 {
            let (wo, wi) = (random.hemisphere(), random.hemisphere());
            let (value, wanted) = (found.eval(wo, wi), expected.eval(wo, wi));
            assert!((value - wanted).abs().max_element() <= 1e-5 * wanted.max_element(), "{value} {wanted}");
            let lanes = Bsdfs16::new(Vec3x16::splat(wo), |_| found).eval_pdf(&Vec3x16::splat(wi), !0);
            let (whole, pdf) = found.eval_pdf(wo, wi);
            assert!((lanes.0.get(5) - whole).abs().max_element() <= 1e-4 * whole.max_element().max(1e-3));
            assert!((lanes.1[5] - pdf).abs() <= 1e-4 * pdf.max(1e-3), "{} {pdf}", lanes.1[5]);
        }
    }
}

#[test]
fn roughness_along_u_and_v_comes_from_two_textures_or_one() {
    for distribution in [Distribution::Ggx, Distribution::Beckmann] {
        let metal = |alpha| {
            let lobe = Lobe::Anisotropic { distribution, alpha, fresnel: GOLD, scale: constant(Rgb::ONE) };
            material("brushed", Rgb::ZERO, None, lobe)
        };
        let [u, v] = parameters();
        assert_same(metal([u, v]), |[u, v]| metal([u.into(), v.into()]));
        assert_same(metal([u, 0.3.into()]), |[u, _]| metal([u.into(), 0.3.into()]));
        assert_same(metal([0.3.into(), v]), |[_, v]| metal([0.3.into(), v.into()]));
        assert_same(metal([u, u]), |[u, _]| metal([u.into(), u.into()]));
    }
}

#[test]
fn anisotropy_of_principled_materials_comes_from_a_texture_beside_that_of_roughness() {
    for stretch in [Stretch::AboutMean, Stretch::AlongU] {
        let of = |roughness: Share, anisotropic: Share| {
            let metallic = Share::Constant(0.5);
            let principled =
                Principled { roughness, anisotropic, stretch, metallic, ..Principled::default() };
            Material { principled: Some(principled.into()), ..Material::default() }
        };
        let [first, second] = parameters();
        assert_same(of(first, second), |[roughness, a]| of(roughness.into(), a.into()));
        assert_same(of(0.4.into(), second), |[_, a]| of(0.4.into(), a.into()));
        assert_same(of(first, 0.7.into()), |[roughness, _]| of(roughness.into(), 0.7.into()));
    }
}
