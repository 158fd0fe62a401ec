//! The bound is never exceeded, and not absurdly loose.

use super::*;

/// Samples a set of unit directions as a cluster of lights gives them, from a single direction to most of the
/// hemisphere. Every third set is around the mirror direction.
fn direction_set(random: &mut Random, wo: Vec3) -> Vec<Vec3> {
    let axis = match (random.next() * 3.0) as u32 {
        0 => Vec3::new(-wo.x, -wo.y, wo.z),
        1 => random.hemisphere(),
        _ => direction(1.5 + 0.2 * random.next(), std::f32::consts::TAU * random.next()),
    };
    let spread = 10f32.powf(-4.0 + 4.2 * random.next());
    let count = 1 + (random.next() * 15.0) as usize;
    (0..count)
        .map(|_| {
            let offset = Vec3::new(random.next() - 0.5, random.next() - 0.5, random.next() - 0.5);
            (axis + spread * offset).normalize()
        })
        .collect()
}

/// Returns the tightest bounds of a set.
fn describe(wo: Vec3, set: &[Vec3]) -> DirectionBound {
    let mirror = Vec3::new(-wo.x, -wo.y, wo.z);
    let max = |f: &dyn Fn(Vec3) -> f32| set.iter().map(|&wi| f(wi)).fold(f32::NEG_INFINITY, f32::max);
    DirectionBound {
        cos_i_max: max(&|wi| wi.z),
        cos_i_min: -max(&|wi| -wi.z),
        cos_mirror_max: max(&|wi| wi.dot(mirror)),
    }
}

fn bounded_materials() -> Vec<Material> {
    let mut all = smooth_materials();
    for distribution in [Distribution::Ggx, Distribution::Beckmann] {
        for alpha in [1e-4, 1e-3, 0.01, 1.0, 1.5] {
            all.push(rough_conductor(distribution, alpha, Rgb::ONE));
        }
        all.push(rough_plastic(distribution, 1.0, true));
    }
    all.extend([mirror(GOLD), glass(1.5)]);
    all
}

#[test]
fn no_direction_of_a_set_exceeds_the_bound() {
    const SETS: usize = 20_000;
    for material in bounded_materials() {
        let mut random = Random(9);
        with_bsdf(&material, |bsdf| {
            let mut looseness = Vec::new();
            for _ in 0..SETS {
                let wo = random.hemisphere();
                let set = direction_set(&mut random, wo);
                let bound = bsdf.bound(wo, &describe(wo, &set));
                let mut largest = Rgb::ZERO;
                for &wi in &set {
                    largest = largest.max(bsdf.eval(wo, wi) * wi.z.max(0.0));
                }
                let within = largest.cmple(bound * (1.0 + 1e-6) + f32::MIN_POSITIVE).all();
                assert!(within, "{} {wo} {set:?}: {largest} over {bound}", material.name);
                if largest.min_element() > 1e-3 {
                    looseness.push((bound / largest).max_element());
                }
            }
            if looseness.is_empty() {
                assert!(!bsdf.has_smooth(), "{} never reflects", material.name);
                return;
            }
            looseness.sort_by(f32::total_cmp);
            let at = |q: f32| looseness[((looseness.len() - 1) as f32 * q) as usize];
            let (median, p90) = (at(0.5), at(0.9));
            eprintln!("{:28} bound / largest: median {median:.3}, 90 % {p90:.3}", material.name);
            // Rounding of the cosines dominates for sharper lobes, and rougher lobes peak at grazing facets.
            let alpha = min_alpha(&material);
            let extreme = alpha.is_finite() && !(0.01..=1.0).contains(&alpha);
            // Bounds do not depend on the azimuth, over which an anisotropic lobe varies as much as its roughness.
            let by_azimuth = match (&material.lobes[..], &material.principled) {
                ([Lobe::Anisotropic { alpha: [Roughness::Constant(u), Roughness::Constant(v)], .. }], _) => {
                    u.max(*v) / u.min(*v)
                }
                (_, Some(principled)) => 1.0 / (1.0 - 0.9 * principled.anisotropic.value(|_| 1.0)),
                _ => 1.0,
            };
            assert!(extreme || median < 1.5 * by_azimuth, "{}: median looseness {median}", material.name);
        });
    }
}

#[test]
fn bounds_are_exact_for_lambert_and_alike_on_two_sides() {
    with_bsdf(&lambert(PAINT), |bsdf| {
        let bound = DirectionBound { cos_i_max: 0.6, cos_i_min: -1.0, cos_mirror_max: 1.0 };
        let exact = PAINT * (0.6 / std::f32::consts::PI);
        assert!((bsdf.bound(direction(0.5, 0.5), &bound) - exact).abs().max_element() < 1e-7);
        let below = DirectionBound { cos_i_max: -0.1, ..bound };
        assert_eq!(bsdf.bound(Vec3::Z, &below), Rgb::ZERO);
        assert_eq!(bsdf.bound(-Vec3::Z, &bound), Rgb::ZERO);
    });
    let two_sided = Material { two_sided: true, ..glossy(PAINT, 0.1, 0.3) };
    with_bsdf(&two_sided, |bsdf| {
        let bound = DirectionBound { cos_i_max: 0.6, cos_i_min: 0.1, cos_mirror_max: 0.9 };
        let wo = direction(0.5, 0.5);
        assert_eq!(bsdf.bound(wo, &bound), bsdf.bound(Vec3::new(wo.x, wo.y, -wo.z), &bound));
    });
}

#[test]
fn not_knowing_bounds_everything() {
    let nothing_known = DirectionBound { cos_i_max: f32::NAN, cos_i_min: f32::NAN, cos_mirror_max: f32::NAN };
    let mut random = Random(10);
    for material in smooth_materials() {
        with_bsdf(&material, |bsdf| {
            for _ in 0..200 {
                let (wo, wi) = (random.hemisphere(), random.hemisphere());
                let bound = bsdf.bound(wo, &nothing_known);
                assert!((bsdf.eval(wo, wi) * wi.z).cmple(bound).all(), "{} {wo} {wi}", material.name);
            }
        });
    }
}
