//! Properties of every kind of material, and shared test helpers.

mod agreement;
mod alike;
mod blends;
mod bounds;
mod brushed;
mod energy;
mod filtering;
mod gaps;
mod lanes;
mod packed;
mod rough_glass;
mod sampling;
mod sheets;

use super::*;
use crate::testkit::textured_materials as scene;
use ::base::math::Rgb;
use glam::{Vec2, Vec3};
use scene::{
    Blend, Coat, Diffuse, Distribution, Fresnel, Lobe, Material, MaterialId, Principled, Reflectance,
    Roughness, TextureId,
};

/// Runs `f` on the BSDF of an untextured material.
fn with_bsdf<R>(material: &Material, f: impl FnOnce(Bsdf) -> R) -> R {
    let scene = scene(vec![material.clone()]);
    let materials = Materials::new(&scene);
    f(materials.at(MaterialId(0), Vec2::ZERO))
}

const GOLD: Fresnel =
    Fresnel::Conductor { eta: Rgb::new(0.143119, 0.374957, 1.44248), k: Rgb::new(3.98316, 2.38572, 1.60322) };
const PAINT: Rgb = Rgb::new(0.2, 0.5, 0.9);

fn constant(value: Rgb) -> Reflectance {
    Reflectance::Constant(value)
}

fn material(name: &str, diffuse: Rgb, coat: Option<Coat>, lobe: Lobe) -> Material {
    let (name, diffuse) = (name.into(), constant(diffuse));
    Material { name, diffuse, coat, lobes: vec![lobe], ..Material::default() }
}

fn lambert(albedo: Rgb) -> Material {
    Material { name: "diffuse".into(), diffuse: constant(albedo), ..Material::default() }
}

fn plastic(nonlinear: bool) -> Material {
    let lobe = Lobe::Mirror { fresnel: Fresnel::Dielectric(1.5), scale: constant(Rgb::ONE) };
    let name = format!("plastic_{}", u8::from(nonlinear));
    material(&name, PAINT, Some(Coat { eta: 1.5, nonlinear }), lobe)
}

fn rough_plastic(distribution: Distribution, alpha: f32, nonlinear: bool) -> Material {
    let fresnel = Fresnel::Dielectric(1.5);
    let lobe = Lobe::Rough { distribution, alpha: alpha.into(), fresnel, scale: constant(Rgb::ONE) };
    let name = format!("roughplastic_{}_{alpha}_{}", label(distribution), u8::from(nonlinear));
    material(&name, PAINT, Some(Coat { eta: 1.5, nonlinear }), lobe)
}

fn rough_conductor(distribution: Distribution, alpha: f32, scale: Rgb) -> Material {
    let lobe = Lobe::Rough { distribution, alpha: alpha.into(), fresnel: GOLD, scale: constant(scale) };
    let name = format!("roughconductor_{}_{alpha}", label(distribution));
    material(&name, Rgb::ZERO, None, lobe)
}

/// Returns a metal whose roughness differs along x and y.
fn brushed(distribution: Distribution, alpha: [f32; 2]) -> Material {
    let scale = constant(Rgb::new(0.9, 0.8, 0.7));
    let lobe =
        Lobe::Anisotropic { distribution, alpha: alpha.map(Roughness::Constant), fresnel: GOLD, scale };
    let name = format!("roughconductor_{}_{}_{}", label(distribution), alpha[0], alpha[1]);
    material(&name, Rgb::ZERO, None, lobe)
}

fn glossy(diffuse: Rgb, specular: f32, alpha: f32) -> Material {
    let scale = constant(Rgb::splat(specular));
    let name = format!("glossy_{alpha}");
    let (distribution, alpha) = (Distribution::Ggx, Roughness::Constant(alpha));
    let lobe = Lobe::Rough { distribution, alpha, fresnel: Fresnel::One, scale };
    material(&name, diffuse, None, lobe)
}

fn mirror(fresnel: Fresnel) -> Material {
    material("mirror", Rgb::ZERO, None, Lobe::Mirror { fresnel, scale: constant(Rgb::ONE) })
}

fn glass(eta: f32) -> Material {
    let one = constant(Rgb::ONE);
    material(
        "glass",
        Rgb::ZERO,
        None,
        Lobe::Dielectric { eta, thin: false, reflectance: one, transmittance: one },
    )
}

fn rough_glass(distribution: Distribution, alpha: f32, eta: f32) -> Material {
    let (reflectance, transmittance) = (constant(Rgb::ONE), constant(Rgb::ONE));
    let lobe = Lobe::RoughDielectric { distribution, alpha: alpha.into(), eta, reflectance, transmittance };
    material(&format!("roughdielectric_{}_{alpha}", label(distribution)), Rgb::ZERO, None, lobe)
}

fn principled(name: &str, parameters: Principled) -> Material {
    let parameters = Principled { base_color: constant(PAINT), ..parameters };
    Material { name: name.into(), principled: Some(Box::new(parameters)), ..Material::default() }
}

/// Returns principled materials of every kind that does not transmit light.
fn principled_materials() -> Vec<Material> {
    let of = |metallic: f32, roughness: f32| Principled {
        metallic: metallic.into(),
        roughness: roughness.into(),
        ..Principled::default()
    };
    let mixed = Principled {
        spec_tint: 0.4.into(),
        sheen: 0.8.into(),
        sheen_tint: 0.5.into(),
        clearcoat: 0.9.into(),
        clearcoat_gloss: 0.3,
        ..of(0.3, 0.6)
    };
    vec![
        principled("principled_plain", of(0.0, 0.5)),
        principled("principled_metal", of(1.0, 0.4)),
        principled("principled_layers", Principled { diffuse: Diffuse::Lambertian, ..of(0.2, 0.6) }),
        principled("principled_mixed", mixed),
        principled("principled_brushed", Principled { anisotropic: 0.6.into(), ..of(0.5, 0.5) }),
    ]
}

fn principled_glass() -> Material {
    principled("principled_glass", Principled { spec_trans: 0.7.into(), eta: 1.4, ..Principled::default() })
}

/// Returns thin sheets that transmit light: diffuse light, both, and around the direction of the light alone.
fn sheets() -> Vec<Material> {
    let of = |diffuse: f32, specular: f32, roughness: f32| Principled {
        thin: Some(diffuse.into()),
        spec_trans: specular.into(),
        roughness: roughness.into(),
        ..Principled::default()
    };
    let matte = Principled { sheen: 0.6.into(), sheen_tint: 0.5.into(), ..of(0.4, 0.0, 0.4) };
    let glossy = Principled { spec_tint: 0.3.into(), sheen: 0.3.into(), eta: 1.4, ..of(0.6, 0.7, 0.5) };
    let clear = Principled { anisotropic: 0.5.into(), eta: 1.6, ..of(0.0, 1.0, 0.45) };
    let two_sided = |name: &str, p: Principled| Material { two_sided: true, ..principled(name, p) };
    vec![two_sided("thin_matte", matte), two_sided("thin_glossy", glossy), two_sided("thin_clear", clear)]
}

fn label(distribution: Distribution) -> &'static str {
    match distribution {
        Distribution::Ggx => "ggx",
        Distribution::Beckmann => "beckmann",
    }
}

/// Returns every kind of material that has a smooth part, over the range of roughnesses.
fn smooth_materials() -> Vec<Material> {
    let mut all = vec![lambert(PAINT), plastic(false), plastic(true)];
    for distribution in [Distribution::Ggx, Distribution::Beckmann] {
        for alpha in [0.05, 0.1, 0.3, 0.8] {
            all.push(rough_plastic(distribution, alpha, alpha == 0.1));
            all.push(rough_conductor(distribution, alpha, Rgb::new(0.9, 0.8, 0.7)));
        }
        all.extend([[0.3, 0.1], [0.2, 0.9]].map(|alpha| brushed(distribution, alpha)));
    }
    for alpha in [0.05, 0.2, 0.5, 1.0] {
        all.push(glossy(Rgb::splat(0.4), 0.3, alpha));
    }
    let mut inverted = rough_plastic(Distribution::Ggx, 0.2, true);
    inverted.coat = Some(Coat { eta: 0.75, nonlinear: true });
    if let [Lobe::Rough { fresnel, .. }] = &mut inverted.lobes[..] {
        *fresnel = Fresnel::Dielectric(0.75);
    }
    all.push(Material { name: "coat of lower index".into(), ..inverted });
    all.push(Material { name: "two-sided".into(), two_sided: true, ..glossy(PAINT * 0.5, 0.4, 0.3) });
    all.push(Material { name: "black glossy".into(), ..glossy(Rgb::ZERO, 0.4, 0.3) });
    all.push(layered());
    all.extend(principled_materials());
    let metal = rough_conductor(Distribution::Ggx, 0.3, Rgb::ONE);
    all.push(blend(0.4, rough_plastic(Distribution::Beckmann, 0.2, true), metal));
    all.push(Material { name: "gaps".into(), ..masked(0.7, layered()) });
    all.push(Material { name: "layered, black base".into(), diffuse: constant(Rgb::ZERO), ..layered() });
    all
}

/// Returns the mixture of two materials; `weight` is the share of the second.
fn blend(weight: f32, first: Material, other: Material) -> Material {
    let name = format!("{} and {}", first.name, other.name);
    let (weight, lobes) = (weight.into(), first.lobes.clone());
    Material { name, lobes, blend: Some(Box::new(Blend { weight, other })), ..first }
}

/// Returns the material on a share of the surface, with gaps between.
fn masked(opacity: f32, material: Material) -> Material {
    Material { opacity: Some(opacity.into()), ..material }
}

/// Returns a material of a base and three lobes: a sharp lobe, a wide lobe and a mirror.
fn layered() -> Material {
    let rough = |alpha, fresnel, scale| {
        let scale = constant(scale);
        Lobe::Rough { distribution: Distribution::Ggx, alpha: Roughness::Constant(alpha), fresnel, scale }
    };
    let mirror = Lobe::Mirror { fresnel: Fresnel::Dielectric(1.5), scale: constant(Rgb::splat(0.4)) };
    let lobes =
        vec![rough(0.4, GOLD, Rgb::splat(0.3)), mirror, rough(0.06, Fresnel::One, Rgb::new(0.1, 0.2, 0.05))];
    Material { name: "layered".into(), diffuse: constant(PAINT * 0.3), lobes, ..Material::default() }
}

/// Returns the minimum roughness of the rough lobes; infinity if there are none.
fn min_alpha(material: &Material) -> f32 {
    if let Some(principled) = &material.principled {
        return if principled.clearcoat == 0.0.into() { 0.16 } else { 0.07 };
    }
    let alphas = material.parts().flat_map(|part| &part.lobes).filter_map(|lobe| match lobe {
        Lobe::Rough { alpha: Roughness::Constant(alpha), .. } => Some(*alpha),
        Lobe::Anisotropic { alpha: [Roughness::Constant(u), Roughness::Constant(v)], .. } => Some(u.min(*v)),
        _ => None,
    });
    alphas.fold(f32::INFINITY, f32::min)
}

/// A small deterministic generator (PCG), enough for tests.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let x = (((self.0 >> 18) ^ self.0) >> 27) as u32;
        let bits = x.rotate_right((self.0 >> 59) as u32);
        (bits >> 8) as f32 / (1u32 << 24) as f32
    }

    fn next_2d(&mut self) -> Vec2 {
        Vec2::new(self.next(), self.next())
    }

    /// Samples the upper hemisphere uniformly.
    fn hemisphere(&mut self) -> Vec3 {
        direction(self.next().acos(), self.next() * std::f32::consts::TAU)
    }
}

/// Returns the unit vector at inclination `theta` and azimuth `phi`.
fn direction(theta: f32, phi: f32) -> Vec3 {
    Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

#[test]
fn textures_are_looked_up_where_they_are_and_only_there() {
    let textured = Reflectance::Textured { texture: TextureId(0), scale: Rgb::splat(0.5) };
    let mut coated = plastic(true);
    coated.diffuse = textured;
    let mut metal = rough_conductor(Distribution::Ggx, 0.3, Rgb::ONE);
    if let [Lobe::Rough { scale, .. }] = &mut metal.lobes[..] {
        *scale = textured;
    }
    let scene = scene(vec![Material { diffuse: textured, ..lambert(Rgb::ONE) }, coated, metal]);
    let materials = Materials::new(&scene);
    let (wo, wi) = (direction(0.3, 0.0), direction(0.3, 3.0));
    for (id, whole) in [(0, Rgb::splat(0.5)), (1, Rgb::splat(0.5)), (2, Rgb::splat(0.5))] {
        let at = |u| materials.at(MaterialId(id), Vec2::new(u, 0.5)).eval(wo, wi);
        let (red, green) = (at(0.25), at(0.75));
        let constant = match id {
            0 => lambert(whole),
            1 => Material { diffuse: constant(whole), ..plastic(true) },
            _ => rough_conductor(Distribution::Ggx, 0.3, whole),
        };
        let expected = with_bsdf(&constant, |b| b.eval(wo, wi));
        assert!(expected.min_element() > 0.0);
        assert!((red - expected * Rgb::X).length() < 1e-6, "{id}: {red} {expected}");
        assert!((green - expected * Rgb::Y).length() < 1e-6, "{id}: {green} {expected}");
    }
}

#[test]
fn textured_roughness_is_that_of_the_place() {
    // Red is smoother than green: luminances of .2126 and .7152.
    let textured = Roughness::Textured { texture: TextureId(0), scale: 0.9 };
    for (index, constant) in
        [rough_conductor(Distribution::Beckmann, 0.5, Rgb::ONE), rough_plastic(Distribution::Ggx, 0.5, true)]
            .into_iter()
            .enumerate()
    {
        let with = |roughness| {
            let mut material = constant.clone();
            if let [Lobe::Rough { alpha, .. }] = &mut material.lobes[..] {
                *alpha = roughness;
            }
            material
        };
        let scene = scene(vec![lambert(PAINT), with(textured)]);
        let materials = Materials::new(&scene);
        assert_eq!(materials.count(), 2);
        assert!(materials.average(MaterialId(1)).is_of_mean_roughness());
        for (u, texel) in [(0.25, 0.2126), (0.75, 0.7152)] {
            let bsdf = materials.at(MaterialId(1), Vec2::new(u, 0.5));
            assert_eq!(bsdf.material(), MaterialId(1));
            let (_, lobe) = bsdf.dull_lobes().next().unwrap();
            assert!((lobe.alpha() / (0.9 * texel) - 1.0).abs() < 0.0115, "{index} {u}: {}", lobe.alpha());
            let (wo, wi) = (direction(0.9, 0.0), direction(0.7, 2.8));
            let exact = with_bsdf(&with(Roughness::Constant(0.9 * texel)), |b| b.eval(wo, wi));
            let error = (bsdf.eval(wo, wi) / exact - 1.0).abs().max_element();
            assert!(error < 0.03, "{index} {u}: {error}");
        }
    }
}

#[test]
fn a_scene_may_name_a_texture_that_is_not_there() {
    let missing = Reflectance::Textured { texture: TextureId(7), scale: Rgb::splat(0.5) };
    with_bsdf(&Material { diffuse: missing, ..lambert(Rgb::ONE) }, |b| {
        assert!((b.eval(Vec3::Z, Vec3::Z) * std::f32::consts::PI - 0.5).length() < 1e-6);
    });
}
