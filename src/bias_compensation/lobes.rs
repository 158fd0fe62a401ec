//! Light that rough metals reflect back along short rays: by their lobes, as their virtual lights radiate it.
//!
//! The virtual light of a lobe gives ρ = π p s / cosθ times what a diffuse one of its flux would, p the peak of the
//! lobe's intensity over its flux and s the share of it that leaves towards the point. So it lacks max(0, ρ - b/G) of
//! what the diffuse one would give without a limit, where the diffuse one lacks max(0, 1 - b/G).

use super::Compensation;
use super::short_rays::{Limit, NearSurface};
use crate::lightcut::{PacketCluster, PacketCut};
use crate::material::Bsdf;
use crate::math::Rgb;
use crate::vpl::VplKind;
use glam::Vec3;
use std::f32::consts::PI;

/// Light that a lobe may give, over a diffuse surface of its flux, as far as short rays look.
const MOST: f32 = 4.0;

/// Luminance that a virtual light may give over the limit where geometry terms are limited: one much brighter than
/// those around would leave a spot.
pub const BRIGHTER: f32 = 2.0;

impl Compensation<'_> {
    /// Light that a virtual light of the scene may give, over a diffuse one of its flux, as far as short rays look.
    pub(super) fn most_of_lobes(&self) -> f32 {
        if self.transfer.trees.profiles.lobes.is_empty() { 1.0 } else { MOST }
    }
}

/// How much a surface met by a short ray gives of what virtual lights lack.
#[derive(Clone, Copy, Debug)]
pub struct Lack {
    /// Unit vector back along the ray.
    pub out: Vec3,
    /// Geometry term that virtual lights have kept, over the ray's.
    pub kept: f32,
    /// Limit of the virtual lights.
    pub limit: Limit,
    /// True if the surface radiates by lobes.
    pub by_lobes: bool,
}

impl Lack {
    /// Share that virtual lights lack at most of what a diffuse surface of the same flux gives, over what they do of a
    /// lobe's greatest.
    pub fn weight(&self) -> f32 {
        let most = if self.by_lobes { MOST } else { 1.0 };
        (1.0 - self.kept / most).max(0.0)
    }
}

/// Returns how much a surface met gives of what virtual lights lack for light from the unit vector `wi`, over what its
/// weight says.
fn over_weight(near: &NearSurface, bsdf: &Bsdf, wi: Vec3) -> Rgb {
    let (lack, frame) = (&near.lack, &near.surface.frame);
    let (cos, local) = (near.normal.dot(lack.out), frame.to_local(wi));
    let mut diffuse = bsdf.diffuse_albedo(local);
    let mut lacking = Rgb::ZERO;
    for lobe in bsdf.reflected_lobes(local) {
        let peak = PI * lobe.peak;
        let given = peak * lobe.shape.share(near.normal, wi, lack.out) / cos;
        let limited = if let Limit::Geometry(_) = lack.limit { peak.min(BRIGHTER) } else { 1.0 };
        lacking += lobe.albedo * (given - limited * lack.kept).max(0.0);
        diffuse -= lobe.albedo;
    }
    lacking += diffuse * (1.0 - lack.kept).max(0.0);
    let usual = bsdf.diffuse_albedo(frame.to_local(lack.out)) * lack.weight();
    Rgb::select(usual.cmpgt(Rgb::ZERO), lacking / usual, Rgb::ZERO)
}

/// Irradiance at a surface met, such that its weight gives what virtual lights lack. Cluster by cluster of a `cut` it
/// has the irradiance `light`.
pub fn irradiance(
    c: &Compensation,
    near: &NearSurface,
    cut: &PacketCut,
    light: impl Fn(&PacketCluster) -> Rgb,
) -> Rgb {
    if !near.lack.by_lobes {
        return cut.clusters.iter().map(light).sum();
    }
    let (trees, bsdf) = (c.transfer.trees, c.world.bsdf(&near.surface));
    let given = cut.clusters.iter().map(|cluster| {
        let light = light(cluster);
        if light == Rgb::ZERO {
            return light;
        }
        let node = &trees.nodes[cluster.node as usize];
        let place = trees.vpls[node.representative()].position;
        let towards = if node.kind() == VplKind::Directional { place } else { place - near.surface.position };
        light * over_weight(near, &bsdf, towards.normalize_or_zero())
    });
    given.sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::embree::Ray;
    use crate::scene::Camera;
    use crate::test_scenes::*;
    use crate::world::{Surface, World};
    use std::f32::consts::FRAC_1_PI;

    fn plate() -> (World, Surface) {
        let mut scene = scene(Camera::default(), [1, 1]);
        let metal = add_material(&mut scene, rough_metal(0.5, 0.8));
        scene.meshes.push(quad(Vec3::ZERO, Vec3::X, Vec3::Y, metal));
        let world = world(scene).world;
        let origin = Vec3::new(0.3, 0.3, 1.0);
        let ray = Ray { origin, t_near: 0.0, direction: -Vec3::Z, t_far: f32::INFINITY };
        let surface = world.intersect(&ray).expect("the plate");
        (world, surface)
    }

    fn seen(surface: Surface, out: Vec3, limit: Limit, kept: f32) -> NearSurface {
        let lack = Lack { out, kept, limit, by_lobes: true };
        let normal = Vec3::Z;
        NearSurface { surface, distance: 1.0, cos: 1.0, normal, weight: Rgb::ONE, emitted: Rgb::ZERO, lack }
    }

    #[test]
    fn a_lobe_gives_what_its_surface_reflects_but_for_what_virtual_lights_have_kept() {
        let (world, surface) = plate();
        let bsdf = world.bsdf(&surface);
        let limit = Limit::Irradiance(1.0);
        for (out, wi) in [
            (Vec3::Z, Vec3::Z),
            (Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.6, 0.0, 0.8)),
            (Vec3::new(0.8, 0.0, 0.6), Vec3::new(0.0, 0.6, 0.8)),
        ] {
            let [local_out, local_in] = [out, wi].map(|v| surface.frame.to_local(v));
            let usual = bsdf.diffuse_albedo(local_out).x * FRAC_1_PI;
            let reflected = bsdf.eval(local_out, local_in).x / usual;
            let given = |limit, kept| {
                let near = seen(surface, out, limit, kept);
                over_weight(&near, &bsdf, wi).x * near.lack.weight()
            };
            let whole = given(limit, 0.0);
            // Facets' Fresnel reflectance is not that of the whole lobe.
            assert!((whole / reflected - 1.0).abs() < 0.03, "{out} {wi}: {whole} for {reflected}");
            for kept in [0.3, 1.5, 3.0] {
                let scale = bsdf.diffuse_albedo(local_in).x / bsdf.diffuse_albedo(local_out).x;
                let lacking = (whole - kept * scale).max(0.0);
                assert!((given(limit, kept) - lacking).abs() < 1e-4, "{out} {wi} {kept}");
                // Geometry terms are limited where lobes may give more.
                assert!(given(Limit::Geometry(1.0), kept) <= given(limit, kept));
            }
            assert_eq!(given(limit, MOST), 0.0);
        }
    }

    #[test]
    fn diffuse_surfaces_lack_their_share() {
        let (_, surface) = plate();
        let lack = |kept| Lack { by_lobes: false, ..seen(surface, Vec3::Z, Limit::Geometry(1.0), kept).lack };
        assert_eq!([0.0, 0.25, 1.0, 2.0].map(|kept| lack(kept).weight()), [1.0, 0.75, 0.0, 0.0]);
    }
}
