//! Agreement with Mitsuba 3.9.1: BSDF · cosine at a few directions, and the weights of its delta lobes.
//!
//! The numbers were printed by running its `scalar_rgb` variant (`load_dict(...).eval(ctx, si, wo)`, with its
//! `wi` our `wo`): diffuse colour (0.2, 0.5, 0.9), index 1.5 against 1, gold for the conductors with a
//! specular reflectance of (0.9, 0.8, 0.7) on the rough ones. A wider grid of 920 pairs agreed to 5e-6
//! throughout.

use super::*;

/// Material, `wo`, `wi`, BSDF · cosine.
type Row = (&'static str, [f32; 3], [f32; 3], [f32; 3]);

#[rustfmt::skip]
const VALUES: &[Row] = &[
    ("diffuse", [0.9320391, 0.0, 0.36235774], [0.009999833, 0.0, 0.99995], [0.063658796, 0.15914698, 0.28646454]),
    ("plastic_0", [0.0, 0.0, 1.0], [0.009999833, 0.0, 0.99995], [0.06467102, 0.16167754, 0.29101956]),
    ("plastic_0", [0.29552022, 0.0, 0.9553365], [-0.9320391, 0.0000024732494, 0.36235774], [0.020597838, 0.051494595, 0.09269026]),
    ("roughplastic_ggx_0.1_0", [0.9320391, 0.0, 0.36235774], [-0.9320391, 0.0000024732494, 0.36235774], [3.3357236, 3.360325, 3.3931272]),
    ("roughplastic_ggx_0.1_0", [0.997495, 0.0, 0.070737205], [0.009999833, 0.0, 0.99995], [0.03727013, 0.090550475, 0.16159092]),
    ("roughplastic_beckmann_0.1_0", [0.9320391, 0.0, 0.36235774], [-0.9320391, 0.0000024732494, 0.36235774], [3.4456322, 3.4717119, 3.5064847]),
    ("roughplastic_beckmann_0.1_0", [0.997495, 0.0, 0.070737205], [-0.29256278, 0.041703813, 0.9553365], [0.029437292, 0.07359323, 0.13246782]),
    ("plastic_1", [0.0, 0.0, 1.0], [0.009999833, 0.0, 0.99995], [0.029608814, 0.09291207, 0.25349635]),
    ("plastic_1", [0.29552022, 0.0, 0.9553365], [-0.9320391, 0.0000024732494, 0.36235774], [0.009430462, 0.029592665, 0.08073905]),
    ("roughplastic_ggx_0.05_1", [0.9320391, 0.0, 0.36235774], [-0.9320391, 0.0000024732494, 0.36235774], [13.609002, 13.626416, 13.669079]),
    ("roughplastic_ggx_0.05_1", [0.997495, 0.0, 0.070737205], [0.009999833, 0.0, 0.99995], [0.014644074, 0.04434725, 0.11712061]),
    ("roughplastic_ggx_0.3_1", [0.997495, 0.0, 0.070737205], [-0.9320391, 0.0000024732494, 0.36235774], [0.853445, 0.8658306, 0.8899981]),
    ("roughplastic_ggx_0.3_1", [0.29552022, 0.0, 0.9553365], [0.38758916, 0.60363436, 0.6967067], [0.02215863, 0.058008827, 0.12796164]),
    ("roughplastic_beckmann_0.05_1", [0.9320391, 0.0, 0.36235774], [-0.9320391, 0.0000024732494, 0.36235774], [13.721247, 13.738779, 13.782441]),
    ("roughplastic_beckmann_0.05_1", [0.0, 0.0, 1.0], [0.9134604, 0.18516758, 0.36235774], [0.009404741, 0.02935743, 0.07904726]),
    ("roughplastic_beckmann_0.3_1", [0.997495, 0.0, 0.070737205], [-0.9320391, 0.0000024732494, 0.36235774], [1.7786082, 1.7929244, 1.8255516]),
    ("roughplastic_beckmann_0.3_1", [0.29552022, 0.0, 0.9553365], [0.38758916, 0.60363436, 0.6967067], [0.022062283, 0.062697574, 0.1553078]),
    ("roughconductor_ggx_0.01", [0.9320391, 0.0, 0.36235774], [-0.9320391, 0.0000024732494, 0.36235774], [1896.0316, 1435.9899, 651.54407]),
    ("roughconductor_ggx_0.01", [0.0, 0.0, 1.0], [0.38758916, 0.60363436, 0.6967067], [0.0003006804, 0.00022177698, 0.00007856731]),
    ("roughconductor_ggx_0.1", [0.9320391, 0.0, 0.36235774], [-0.9320391, 0.0000024732494, 0.36235774], [18.363985, 13.908257, 6.3105197]),
    ("roughconductor_ggx_0.1", [0.0, 0.0, 1.0], [0.38758916, 0.60363436, 0.6967067], [0.026926216, 0.019860342, 0.0070357784]),
    ("roughconductor_ggx_0.3", [0.997495, 0.0, 0.070737205], [-0.9320391, 0.0000024732494, 0.36235774], [2.3766687, 1.881663, 1.0302088]),
    ("roughconductor_ggx_0.3", [0.9320391, 0.0, 0.36235774], [0.009999833, 0.0, 0.99995], [0.10280757, 0.075815715, 0.027108913]),
    ("roughconductor_ggx_0.7", [0.997495, 0.0, 0.070737205], [-0.71673566, 0.02982814, 0.6967067], [0.257637, 0.1934973, 0.08388192]),
    ("roughconductor_ggx_0.7", [0.29552022, 0.0, 0.9553365], [0.38758916, 0.60363436, 0.6967067], [0.08476883, 0.0625266, 0.022126062]),
    ("roughconductor_beckmann_0.01", [0.9320391, 0.0, 0.36235774], [-0.9320391, 0.0000024732494, 0.36235774], [1896.6597, 1436.4655, 651.7598]),
    ("roughconductor_beckmann_0.01", [0.7173561, 0.0, 0.6967067], [-0.71673566, 0.02982814, 0.6967067], [10.13946, 7.4805083, 2.752592]),
    ("roughconductor_beckmann_0.1", [0.9320391, 0.0, 0.36235774], [-0.9320391, 0.0000024732494, 0.36235774], [18.966597, 14.364655, 6.5175986]),
    ("roughconductor_beckmann_0.1", [0.997495, 0.0, 0.070737205], [-0.71673566, 0.02982814, 0.6967067], [0.0001529721, 0.00011488911, 0.000049804934]),
    ("roughconductor_beckmann_0.3", [0.997495, 0.0, 0.070737205], [-0.9320391, 0.0000024732494, 0.36235774], [4.971646, 3.9361653, 2.1550472]),
    ("roughconductor_beckmann_0.3", [0.0, 0.0, 1.0], [0.38758916, 0.60363436, 0.6967067], [0.1466544, 0.10816991, 0.038320564]),
    ("roughconductor_beckmann_0.7", [0.997495, 0.0, 0.070737205], [-0.71673566, 0.02982814, 0.6967067], [0.58643866, 0.4404425, 0.19093376]),
    ("roughconductor_beckmann_0.7", [0.0, 0.0, 1.0], [0.38758916, 0.60363436, 0.6967067], [0.13606513, 0.10035943, 0.0355536]),
];

fn by_name(name: &str) -> Material {
    let parts: Vec<&str> = name.split('_').collect();
    let distribution = || if parts[1] == "ggx" { Distribution::Ggx } else { Distribution::Beckmann };
    let alpha = || parts[2].parse().unwrap();
    match parts[0] {
        "diffuse" => lambert(PAINT),
        "plastic" => plastic(parts[1] == "1"),
        "roughplastic" => rough_plastic(distribution(), alpha(), parts[3] == "1"),
        "roughconductor" => rough_conductor(distribution(), alpha(), Rgb::new(0.9, 0.8, 0.7)),
        other => panic!("{other}"),
    }
}

#[test]
fn values_agree_with_mitsuba() {
    for &(name, wo, wi, expected) in VALUES {
        let (wo, wi) = (Vec3::from(wo), Vec3::from(wi));
        let value = with_bsdf(&by_name(name), |b| b.eval(wo, wi)) * wi.z;
        let error = ((value - Rgb::from(expected)) / (Rgb::from(expected) + 1e-5)).abs().max_element();
        assert!(error < 2e-5, "{name} {wo} {wi}: {value}, not {expected:?}, off by {error:e}");
    }
}

#[test]
fn delta_lobes_agree_with_mitsuba() {
    // Conductor: inclination of `wo`, weight.
    for (theta, weight) in [
        (0.01, [0.966_662_6, 0.802_190_1, 0.324_050_55]),
        (1.0, [0.962_932_94, 0.802_939_5, 0.361_193_87]),
        (1.4, [0.963_517_07, 0.877_532_84, 0.596_869_95]),
    ] {
        let wo = direction(theta, 0.3);
        let sample = with_bsdf(&mirror(GOLD), |b| b.sample(wo, 0.5, Vec2::splat(0.5))).unwrap();
        assert!((sample.weight - Rgb::from(weight)).abs().max_element() < 2e-6, "{theta} {sample:?}");
        assert!((sample.wi - Vec3::new(-wo.x, -wo.y, wo.z)).length() < 1e-6 && sample.delta);
    }
    // Glass: inclination of `wo`, refracted direction, radiance weight over probability, reflectance, index.
    for (theta, wi, weight, reflectance, eta) in [
        (0.5, [-0.305_341_8, -0.094_453_29, -0.947_546_84], 0.444_444_48, 0.041_241_653, 1.5),
        (1.4, [-0.627_624_1, -0.194_146_87, -0.753_919_8], 0.444_444_48, 0.395_131_4, 1.5),
        (2.6, [-0.738_715_9, -0.228_511_6, 0.634_098_8], 2.25, 0.058_916_077, 0.666_666_7),
    ] {
        let wo = direction(theta, 0.3);
        with_bsdf(&glass(1.5), |b| {
            let refracted = b.sample(wo, 0.999_999, Vec2::splat(0.5)).unwrap();
            assert!((refracted.wi - Vec3::from(wi)).length() < 1e-5, "{theta} {refracted:?}");
            assert!((refracted.weight - weight).abs().max_element() < 1e-5, "{theta} {refracted:?}");
            assert!((refracted.eta - eta).abs() < 1e-6);
            let reflected = b.sample(wo, 1e-6, Vec2::splat(0.5)).unwrap();
            assert!((reflected.pdf - reflectance).abs() < 1e-5, "{theta} {reflected:?}");
            assert!((reflected.weight - 1.0).abs().max_element() < 1e-6);
        });
    }
    // Beyond the critical angle nothing leaves.
    let inside = direction(2.2, 0.3);
    let sample = with_bsdf(&glass(1.5), |b| b.sample(inside, 0.999_999, Vec2::splat(0.5))).unwrap();
    assert!(sample.eta == 1.0 && sample.pdf == 1.0 && sample.wi.z < 0.0);
}
