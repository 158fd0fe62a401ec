//! Light that rough metals reflect back along short rays: by their lobes, as their virtual lights radiate.
//!
//! The virtual light of a lobe gives ρ = π p s / cosθ times the light of a diffuse one of the same flux. p is the peak
//! of the lobe's intensity over its flux, s the share of the peak that leaves towards the point. So it lacks max(0, ρ -
//! b/G) of the unlimited light of the diffuse one, which itself lacks max(0, 1 - b/G).

use super::Compensation;
use super::near_surface::NearSurface;
use crate::lightcut::{BRIGHTER, PacketCluster, PacketCut};
use crate::lights::VplKind;
use base::math::{Rgb, V3};
use glam::Vec3;
use std::f32::consts::PI;
use world::material::Bsdf;

/// Returns factors of the irradiance from each cluster of a `cut` at a surface met. With them, the weight of the
/// surface gives the light that virtual lights lack. Returns `None` if all factors are 1.
pub fn factors(c: &Compensation, near: &NearSurface, cut: &PacketCut) -> Option<Vec<Rgb>> {
    if !near.lack.by_lobes {
        return None;
    }
    let (trees, bsdf) = (c.transfer.trees, c.world.bsdf(&near.surface));
    let diffuse = near.diffuse(&bsdf);
    let factor = |cluster: &PacketCluster| {
        let node = &trees.nodes[cluster.node as usize];
        let place = trees.vpls[node.representative()].position;
        let towards = if node.kind() == VplKind::Directional { place } else { place - near.surface.position };
        let lacking = near.lacking(&bsdf, towards.normalize_or_zero());
        Rgb::select(diffuse.cmpgt(Rgb::ZERO), lacking / diffuse, Rgb::ZERO)
    };
    Some(cut.clusters.iter().map(factor).collect())
}

impl NearSurface {
    /// Reflectance in the weight of the surface.
    fn diffuse(&self, bsdf: &Bsdf) -> Rgb {
        bsdf.diffuse_albedo(self.surface.frame.to_local(self.lack.out)) * self.lack.weight()
    }

    /// Returns the light that virtual lights lack, for light from the unit vector `wi`, as the reflectance of a diffuse
    /// surface that would give as much.
    fn lacking(&self, bsdf: &Bsdf, wi: Vec3) -> Rgb {
        let lack = &self.lack;
        let (cos, local) = (self.normal.dot(lack.out), self.surface.frame.to_local(wi));
        let mut diffuse = bsdf.diffuse_albedo(local);
        let mut lacking = Rgb::ZERO;
        for lobe in bsdf.reflected_lobes(local) {
            let peak = PI * lobe.peak;
            let given = peak * lobe.shape.share(self.normal, wi, V3::<f32>::splat(lack.out)) / cos;
            lacking += lobe.albedo * f32::max(given - peak.min(BRIGHTER) * lack.kept, 0.0);
            diffuse -= lobe.albedo;
        }
        lacking + diffuse * (1.0 - lack.kept).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bias_compensation::near_surface::{Lack, MAX_LOBE};
    use embree::Ray;
    use scene::Camera;
    use world::testkit::*;
    use world::{Surface, World};

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

    fn seen(surface: Surface, out: Vec3, kept: f32) -> NearSurface {
        let lack = Lack { out, kept, by_lobes: true };
        let normal = Vec3::Z;
        NearSurface { surface, distance: 1.0, cos: 1.0, normal, weight: Rgb::ONE, emitted: Rgb::ZERO, lack }
    }

    #[test]
    fn a_lobe_gives_what_its_surface_reflects_but_for_what_virtual_lights_have_kept() {
        let (world, surface) = plate();
        let bsdf = world.bsdf(&surface);
        for (out, wi) in [
            (Vec3::Z, Vec3::Z),
            (Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.6, 0.0, 0.8)),
            (Vec3::new(0.8, 0.0, 0.6), Vec3::new(0.0, 0.6, 0.8)),
        ] {
            let [local_out, local_in] = [out, wi].map(|v| surface.frame.to_local(v));
            let reflected = bsdf.eval(local_out, local_in).x * PI;
            let given = |kept| seen(surface, out, kept).lacking(&bsdf, wi).x;
            let whole = given(0.0);
            // Facets' Fresnel reflectance is not that of the whole lobe.
            assert!((whole / reflected - 1.0).abs() < 0.03, "{out} {wi}: {whole} for {reflected}");
            for kept in [0.3, 1.5, 3.0] {
                // The peak of a lobe is limited, where it may give more than a diffuse surface.
                let most = whole - kept * bsdf.diffuse_albedo(local_in).x;
                let least = whole - BRIGHTER * kept * bsdf.diffuse_albedo(local_in).x;
                let given = given(kept);
                assert!(given >= least.max(0.0) - 1e-4 && given <= most.max(0.0) + 1e-4, "{out} {wi} {kept}");
            }
            assert_eq!(seen(surface, out, MAX_LOBE).diffuse(&bsdf), Rgb::ZERO);
        }
    }

    #[test]
    fn diffuse_surfaces_lack_their_share() {
        let (_, surface) = plate();
        let lack = |kept| Lack { by_lobes: false, ..seen(surface, Vec3::Z, kept).lack };
        assert_eq!([0.0, 0.25, 1.0, 2.0].map(|kept| lack(kept).weight()), [1.0, 0.75, 0.0, 0.0]);
    }
}
