//! Energy, reciprocity, sides, and extremes.

use super::*;
use crate::material::lobe::DIFFUSE_ALPHA;
use crate::material::sample::DeltaLobes;

/// Computes the albedo with delta lobes: the mean weight of stratified samples from `wo`.
fn albedo_by_sampling(bsdf: &Bsdf, wo: Vec3, seed: u64) -> Rgb {
    const N: usize = 24;
    let mut random = Random(seed);
    let mut sum = glam::DVec3::ZERO;
    for i in 0..N * N * N {
        let (x, y, z) = (i % N, i / N % N, i / N / N);
        let at = |cell: usize, jitter: f32| (cell as f32 + jitter) / N as f32;
        let u = Vec2::new(at(y, random.next()), at(z, random.next()));
        if let Some(s) = bsdf.sample(wo, at(x, random.next()), u) {
            // Flux, not radiance: the change of the solid angle by refraction cancels.
            sum += (s.weight * s.eta * s.eta).as_dvec3();
        }
    }
    (sum / (N * N * N) as f64).as_vec3()
}

/// Returns materials that absorb as little as their kind can, and the energy that each must keep.
fn white_materials() -> Vec<(Material, f32)> {
    let mut all = vec![(lambert(Rgb::ONE), 1.0), (mirror(Fresnel::One), 1.0), (glass(1.5), 1.0)];
    for distribution in [Distribution::Ggx, Distribution::Beckmann] {
        for alpha in [1e-4, 0.01, 0.1, 0.3, 1.0] {
            let white = |m: Material| Material { diffuse: constant(Rgb::ONE), ..m };
            all.push((white(rough_plastic(distribution, alpha, false)), 1.003));
            let mut metal = rough_conductor(distribution, alpha, Rgb::ONE);
            if let [Lobe::Rough { fresnel, .. }] = &mut metal.lobes[..] {
                *fresnel = Fresnel::One;
            }
            // Walter's fit of Beckmann's masking overshoots by up to 0.35 %.
            all.push((metal, if distribution == Distribution::Ggx { 1.0 } else { 1.0035 }));
        }
    }
    for roughness in [0.0, 0.19, 0.3, 0.55, 0.9] {
        let white = Principled { base_color: constant(Rgb::ONE), ..layered(roughness) };
        let material = Material { principled: Some(Box::new(white)), ..Material::default() };
        all.push((Material { name: format!("layers_{roughness}"), ..material }, 1.004));
    }
    all.push((Material { diffuse: constant(Rgb::ONE), ..plastic(false) }, 1.003));
    all.push((Material { diffuse: constant(Rgb::ONE), ..plastic(true) }, 1.003));
    all
}

#[test]
fn no_surface_reflects_more_than_it_receives() {
    for (material, limit) in white_materials() {
        with_bsdf(&material, |bsdf| {
            for theta in [0.0f32, 0.5, 1.0, 1.3, 1.5, 1.57] {
                let albedo = albedo_by_sampling(&bsdf, direction(theta, 0.4), 5).max_element();
                assert!(albedo < limit + 2e-3, "{} at {theta}: {albedo}", material.name);
                // Smooth surfaces lose nothing to masking, and rough plastic 2 % to its way of averaging
                // the internal reflectance.
                let alpha = min_alpha(&material);
                let lossless = !(alpha.is_finite() && alpha > 0.01);
                if lossless && theta < 1.4 {
                    assert!(albedo > 0.975, "{} at {theta}: {albedo}", material.name);
                }
            }
        });
    }
}

fn layered(roughness: f32) -> Principled {
    Principled { diffuse: Diffuse::Lambertian, roughness: roughness.into(), ..Principled::default() }
}

/// The base of glTF and Blender reflects the share of the light that its dielectric does not.
#[test]
fn a_layered_base_reflects_what_the_dielectric_leaves() {
    for (eta, roughness) in [(1.0, 1.0), (1.5, 1.0), (1.5, 0.5), (1.5, 0.2), (2.0, 0.35)] {
        let of = |grey: f32| {
            let base_color = constant(Rgb::splat(grey));
            let principled = Principled { base_color, eta, ..layered(roughness) };
            Material { principled: Some(Box::new(principled)), ..Material::default() }
        };
        for theta in [0.0, 0.5, 1.0, 1.3] {
            let albedo =
                |grey| with_bsdf(&of(grey), |bsdf| albedo_by_sampling(&bsdf, direction(theta, 0.4), 3).x);
            let (specular, both) = (albedo(0.0), albedo(0.5));
            let expected = specular + 0.5 * (1.0 - specular);
            assert!((both - expected).abs() < 5e-3, "{eta} {roughness} {theta}: {both} {expected}");
        }
    }
}

#[test]
fn perfect_mirrors_and_glass_lose_nothing_at_all() {
    let mut random = Random(6);
    for _ in 0..1000 {
        let wo = random.hemisphere();
        let mirrored = with_bsdf(&mirror(Fresnel::One), |b| b.sample(wo, random.next(), Vec2::ZERO));
        assert_eq!(mirrored.unwrap().weight, Rgb::ONE);
        let through = with_bsdf(&glass(1.5), |b| b.sample(wo, random.next(), Vec2::ZERO)).unwrap();
        assert!((through.weight * through.eta * through.eta - 1.0).abs().max_element() < 1e-5);
    }
}

#[test]
fn a_virtual_light_radiates_what_the_surface_reflects() {
    for material in smooth_materials() {
        with_bsdf(&material, |bsdf| {
            for theta in [0.0, 0.7, 1.3] {
                let wi = direction(theta, 0.4);
                // All but the lobes that paths follow: those too sharp to pass for diffuse, and delta lobes.
                let followed = match bsdf.glossy_part() {
                    Some(part) => albedo_by_sampling(&part, wi, 8),
                    None => {
                        let DeltaLobes { reflection, refraction } = bsdf.delta_lobes(wi);
                        [reflection, refraction].into_iter().flatten().map(|s| s.weight).sum()
                    }
                };
                let sampled = albedo_by_sampling(&bsdf, wi, 7) - followed;
                let error = (bsdf.diffuse_albedo(wi) - sampled).abs().max_element();
                assert!(error < 4e-3, "{} {theta}: {} {sampled}", material.name, bsdf.diffuse_albedo(wi));
            }
        });
    }
    // A sharp lobe is not passed off as diffuse.
    with_bsdf(&glossy(Rgb::splat(0.4), 0.3, 0.99 * DIFFUSE_ALPHA), |b| {
        assert!((b.diffuse_albedo(Vec3::Z) - 0.4).abs().max_element() < 1e-6);
    });
}

#[test]
fn light_may_go_either_way() {
    let mut random = Random(8);
    for material in smooth_materials() {
        with_bsdf(&material, |bsdf| {
            for _ in 0..2000 {
                let (a, b) = (random.hemisphere(), random.hemisphere());
                let (there, back) = (bsdf.eval(a, b), bsdf.eval(b, a));
                let error = ((there - back) / (there + 1e-6)).abs().max_element();
                assert!(error < 1e-4, "{} {a} {b}: {there} {back}", material.name);
            }
        });
    }
}

#[test]
fn sides_are_kept_apart() {
    let back = |v: Vec3| Vec3::new(v.x, v.y, -v.z);
    let (wo, wi) = (direction(0.4, 0.0), direction(0.6, 2.5));
    for material in smooth_materials() {
        let one_sided = Material { two_sided: false, ..material.clone() };
        with_bsdf(&one_sided, |b| {
            assert!(b.eval(wo, wi).max_element() > 0.0);
            for (wo, wi) in [(back(wo), back(wi)), (wo, back(wi)), (back(wo), wi)] {
                assert_eq!(b.eval_pdf(wo, wi), (Rgb::ZERO, 0.0), "{}", material.name);
            }
            assert!(b.sample(back(wo), 0.3, Vec2::splat(0.3)).is_none_or(|s| s.straight));
            assert_eq!(b.diffuse_albedo(back(wo)), Rgb::ZERO);
        });
        with_bsdf(&Material { two_sided: true, ..material.clone() }, |b| {
            assert_eq!(b.eval_pdf(wo, wi), b.eval_pdf(back(wo), back(wi)), "{}", material.name);
            assert_eq!(b.eval_pdf(wo, back(wi)), (Rgb::ZERO, 0.0));
            let front = b.sample(wo, 0.3, Vec2::splat(0.3));
            let behind = b.sample(back(wo), 0.3, Vec2::splat(0.3));
            assert_eq!(front.map(|s| back(s.wi)), behind.map(|s| s.wi));
            assert_eq!(front.map(|s| s.weight), behind.map(|s| s.weight));
            assert_eq!(b.diffuse_albedo(wo), b.diffuse_albedo(back(wo)));
        });
    }
}

#[test]
fn nothing_is_ever_infinite_or_nan() {
    let mut materials = smooth_materials();
    for distribution in [Distribution::Ggx, Distribution::Beckmann] {
        for alpha in [0.0, 1e-4, 1e-3, 0.01, 1.0, 2.0] {
            materials.push(rough_conductor(distribution, alpha, Rgb::ONE));
            materials.push(rough_plastic(distribution, alpha, true));
            let black = rough_plastic(distribution, alpha, true);
            materials.push(Material { diffuse: constant(Rgb::ZERO), ..black });
        }
    }
    materials.push(lambert(Rgb::ZERO));
    materials.push(glossy(Rgb::ZERO, 0.0, 0.2));
    materials.extend([glass(1.5), glass(1.0), glass(1.0 / 1.5), mirror(GOLD), mirror(Fresnel::One)]);
    let directions: Vec<Vec3> = [0.0f32, 1e-30, 1e-7, 1e-4, 0.1, 0.9, 1.0]
        .into_iter()
        .flat_map(|z| [(z, 0.0), (z, 1.0), (z, std::f32::consts::PI), (-z, 0.0)])
        .map(|(z, phi)| {
            let r = (1.0 - z * z).sqrt();
            Vec3::new(r * phi.cos(), r * phi.sin(), z)
        })
        .collect();
    let edges = [0.0, 1e-7, 0.25, 0.5, 0.999_999_9, 1.0];
    for material in materials {
        let name = &material.name;
        with_bsdf(&material, |bsdf| {
            for &wo in &directions {
                for &wi in &directions {
                    let (value, pdf) = bsdf.eval_pdf(wo, wi);
                    assert!(value.is_finite() && pdf.is_finite(), "{name} {wo} {wi}: {value} {pdf}");
                    assert!(value.min_element() >= 0.0 && pdf >= 0.0);
                }
                for u_lobe in edges {
                    for (x, y) in edges.iter().flat_map(|x| edges.map(|y| (*x, y))) {
                        let Some(s) = bsdf.sample(wo, u_lobe, Vec2::new(x, y)) else { continue };
                        assert!(
                            s.wi.is_finite() && s.weight.is_finite() && s.pdf.is_finite(),
                            "{name} {s:?}"
                        );
                        assert!(s.pdf > 0.0 && s.weight.min_element() >= 0.0, "{name} {wo} {s:?}");
                        assert!(s.weight.max_element() < 50.0, "{name} {wo} {s:?}");
                    }
                }
                assert!(bsdf.diffuse_albedo(wo).is_finite());
            }
        });
    }
}
