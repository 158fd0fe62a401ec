//! Merging of a pixel's first hits into shading points. One point stands for all samples of the pixel that see nearly
//! the same part of one surface along the same class of path.
//!
//! A point has the position and normals of its first sample and the weights of all. It reflects by the mean of their
//! factors, so that textures are antialiased.
//!
//! Deviations: chains through mirrors, glass and sharp lobes may lead to many points per pixel. These are thinned in
//! proportion to the light they may carry, with weights that preserve the mean.

use super::points::{PointGeometry, shading_point};
use super::surfaces::{PointSurface, PointSurfaces};
use crate::paths::{ChainEnd, MAX_DISTANCE, MAX_HEIGHT, MIN_OUT_COS};
use base::math::{Rgb, luminance};

/// Minimum cosine between normals of samples that are merged: 11 degrees.
const MIN_COS: f32 = 0.98;

/// Mean number of points per pixel beyond mirrors, glass and sharp lobes, if all light of the pixel comes through
/// them.
const CHAINED_POINTS: f32 = 6.0;

/// Shading point under construction.
#[derive(Clone, Copy, Debug)]
pub struct MergedPoint<'w> {
    /// Geometry of its first sample.
    pub geometry: PointGeometry,
    /// Surface with the mean BSDF of its samples.
    pub surface: PointSurface<'w>,
    /// Sum of the samples' throughputs.
    pub weight: Rgb,
    path_class: u32,
    depth: u32,
}

impl<'w> MergedPoint<'w> {
    /// Returns the point of one first hit, or `None` if it cannot be lit. `spacing` is the distance to the point of
    /// the next pixel. Light may take at most `edges` edges to the point.
    #[inline]
    pub fn new(end: &ChainEnd<'w>, spacing: f32, edges: u32) -> Option<MergedPoint<'w>> {
        let (geometry, surface) = shading_point(&end.surface, end.bsdf, end.out, spacing, edges)?;
        let point = MergedPoint {
            geometry: PointGeometry { is_chained: end.depth > 1, ..geometry },
            surface,
            weight: end.throughput,
            path_class: end.path_class,
            depth: end.depth,
        };
        end.throughput.is_finite().then_some(point)
    }

    /// Returns true if `other` may be merged into this point.
    fn takes(&self, other: &MergedPoint) -> bool {
        let (a, b) = (&self.geometry, &other.geometry);
        let (mine, others) = (&self.surface.bsdf, &other.surface.bsdf);
        let between = b.position - a.position;
        self.path_class == other.path_class
            && mine.material() == others.material()
            && mine.same_lobes(others)
            && a.normal.dot(b.normal) > MIN_COS
            && self.surface.out.dot(other.surface.out) > MIN_OUT_COS
            && between.length_squared() < (MAX_DISTANCE * a.spacing).powi(2)
            && a.normal.dot(between).abs() < MAX_HEIGHT * a.spacing
    }

    fn merge(&mut self, other: &MergedPoint<'w>) {
        self.surface.bsdf = self.surface.bsdf.mean(self.weight, &other.surface.bsdf, other.weight);
        self.weight += other.weight;
    }

    /// Returns the luminance of the share of light that the point reflects into the pixel.
    fn carried(&self) -> f32 {
        let cos = self.surface.out.dot(self.geometry.normal);
        luminance(self.weight * self.surface.bsdf.albedo_at(cos))
    }
}

/// Points that wait for others, in half the memory.
#[derive(Default)]
pub struct MergedPoints<'w> {
    geometry: Vec<PointGeometry>,
    surfaces: PointSurfaces<'w>,
    /// Weight, class of path and depth.
    paths: Vec<(Rgb, u32, u32)>,
}

impl<'w> MergedPoints<'w> {
    /// Adds a point.
    pub fn push(&mut self, point: &MergedPoint<'w>) {
        let MergedPoint { geometry, surface, weight, path_class, depth } = point;
        self.geometry.push(*geometry);
        self.surfaces.push(surface);
        self.paths.push((*weight, *path_class, *depth));
    }

    /// Returns a point.
    pub fn get(&self, index: usize) -> MergedPoint<'w> {
        let (weight, path_class, depth) = self.paths[index];
        let (geometry, surface) = (self.geometry[index], self.surfaces.get(index));
        MergedPoint { geometry, surface, weight, path_class, depth }
    }

    /// Returns the number of points.
    pub fn len(&self) -> usize {
        self.geometry.len()
    }

    /// Gives memory back that is not needed.
    pub fn shrink_to_fit(&mut self) {
        self.geometry.shrink_to_fit();
        self.surfaces.shrink_to_fit();
        self.paths.shrink_to_fit();
    }
}

/// Merges the points of one pixel, in order, and thins those beyond mirrors, glass and sharp lobes. `draw` in [0, 1)
/// chooses among them.
pub fn merge<'a, 'w: 'a>(
    samples: impl Iterator<Item = &'a MergedPoint<'w>>,
    draw: f32,
    merged: &mut Vec<MergedPoint<'w>>,
) {
    merged.clear();
    for sample in samples {
        match merged.iter_mut().find(|point| point.takes(sample)) {
            Some(point) => point.merge(sample),
            None => merged.push(*sample),
        }
    }
    if merged.iter().all(|point| point.depth <= 1) {
        return;
    }
    let total: f32 = merged.iter().map(MergedPoint::carried).sum();
    let mut reached = draw;
    merged.retain_mut(|point| {
        if point.depth <= 1 {
            return true;
        }
        let kept = (CHAINED_POINTS * point.carried() / total).min(1.0);
        let before = reached;
        reached += kept;
        point.weight /= kept;
        before.floor() != reached.floor()
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::Frame;
    use embree::Ray;
    use glam::{Vec2, Vec3};
    use std::f32::consts::PI;
    use world::testkit::*;

    /// Distance between the samples of the tests: that of points seen from far away.
    const SPACING: f32 = 0.01;

    const TEXELS: [Rgb; 4] =
        [Rgb::new(0.9, 0.1, 0.2), Rgb::ZERO, Rgb::new(0.3, 0.8, 0.0), Rgb::new(0.2, 0.4, 0.6)];

    /// A square of four texels in the plane z = 0, and one of another material at its right; fronts towards +z.
    fn squares() -> WorldAndView {
        let mut scene = scene(camera(Vec3::Z, Vec3::ZERO, 1.0), [1, 1]);
        let checker = checkered(&mut scene, 2, TEXELS.into());
        let checker = add_material(&mut scene, checker);
        let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
        let square = textured(quad(Vec3::ZERO, Vec3::X, Vec3::Y, checker), Vec2::ONE);
        scene.meshes.extend([square, quad(Vec3::X * 2.0, Vec3::X, Vec3::Y, grey)]);
        world(scene)
    }

    /// The end of a path seen from above at (`x`, `y`), straight from the eye.
    fn end(world: &WorldAndView, [x, y]: [f32; 2]) -> ChainEnd<'_> {
        let surface = world.intersect(&Ray::new(Vec3::new(x, y, 1.0), -Vec3::Z)).expect("a square");
        let bsdf = world.bsdf(&surface);
        let (out, throughput) = (Vec3::Z, Rgb::ONE);
        ChainEnd { path: 0, surface, bsdf, out, throughput, distance: 1.0, path_class: 0, depth: 1 }
    }

    fn point<'w>(end: &ChainEnd<'w>) -> MergedPoint<'w> {
        MergedPoint::new(end, SPACING, 1).expect("a finite end")
    }

    fn merged<'w>(ends: &[ChainEnd<'w>], draw: f32) -> Vec<MergedPoint<'w>> {
        let mut merged = Vec::new();
        let points: Vec<MergedPoint> = ends.iter().map(point).collect();
        merge(points.iter(), draw, &mut merged);
        merged
    }

    fn weight(points: &[MergedPoint]) -> Rgb {
        points.iter().map(|point| point.weight).sum()
    }

    fn assert_near(found: Rgb, expected: Rgb) {
        assert!((found - expected).abs().max_element() < 1e-5, "{found} {expected}");
    }

    #[test]
    fn samples_of_a_checker_become_one_point_of_their_mean_albedo() {
        let world = squares();
        // Around the middle, where the texels meet; the weights tell channels and samples apart.
        let (mut ends, mut reflected, mut sum) = (Vec::new(), Rgb::ZERO, Rgb::ZERO);
        for i in 0..16 {
            let at = |k: i32| 0.5 + SPACING * (k as f32 - 1.5);
            let throughput = Rgb::new(1.0, 0.1 * i as f32, if i < 3 { 0.7 } else { 0.0 });
            ends.push(ChainEnd { throughput, ..end(&world, [at(i % 4), at(i / 4)]) });
            reflected += throughput * ends[i as usize].bsdf.base_brdf() * PI;
            sum += throughput;
        }
        let found = merged(&ends, 0.5);
        assert_eq!(found.len(), 1);
        assert_near(found[0].weight, sum);
        assert_near(found[0].weight * found[0].surface.bsdf.base_brdf() * PI, reflected);
        assert_eq!(found[0].geometry.position, ends[0].surface.position);
        // With equal weights it is the mean of the texels themselves.
        ends.iter_mut().for_each(|end| end.throughput = Rgb::ONE);
        let found = merged(&ends, 0.5);
        assert_near(found[0].surface.bsdf.base_brdf() * PI, TEXELS.iter().sum::<Rgb>() / 4.0);
    }

    #[test]
    fn samples_that_see_other_things_become_points_of_their_own() {
        let world = squares();
        let here = end(&world, [0.2, 0.2]);
        let moved = |by: Vec3| {
            let mut end = here;
            end.surface.position += by * SPACING;
            end
        };
        let turned = |degrees: f32| {
            let mut end = here;
            let radians = degrees.to_radians();
            end.surface.frame = Frame::from_normal(Vec3::new(radians.sin(), 0.0, radians.cos()));
            end
        };
        let mut grey = end(&world, [2.5, 0.5]);
        grey.surface.position = here.surface.position;
        let mut behind = here;
        (behind.out, behind.surface.normal) = (-Vec3::Z, here.surface.normal);
        for (what, points, other) in [
            ("itself", 1, here),
            ("a neighbour", 1, moved(Vec3::X * 8.0)),
            ("a little higher", 1, moved(Vec3::Z * 0.3)),
            ("on a curved surface", 1, turned(8.0)),
            ("another material", 2, grey),
            ("another normal", 2, turned(20.0)),
            ("another depth", 2, moved(-Vec3::Z)),
            ("far away", 2, moved(Vec3::Y * 40.0)),
            ("the other side", 2, behind),
            ("seen by another way", 2, ChainEnd { path_class: 7, ..here }),
        ] {
            let other = ChainEnd { throughput: Rgb::new(0.5, 0.25, 0.0), ..other };
            let found = merged(&[here, other, here], 0.5);
            assert_eq!(found.len(), points, "{what}");
            assert_near(weight(&found), Rgb::new(2.5, 2.25, 2.0));
        }
    }

    #[test]
    fn ends_that_are_not_finite_make_no_points() {
        let world = squares();
        let here = end(&world, [0.2, 0.2]);
        let mut nowhere = here;
        nowhere.surface.position.x = f32::INFINITY;
        for bad in [
            nowhere,
            ChainEnd { throughput: Rgb::new(0.0, f32::NAN, 0.0), ..here },
            ChainEnd { distance: f32::NAN, ..here },
        ] {
            assert!(MergedPoint::new(&bad, SPACING * bad.distance, 1).is_none());
        }
    }

    #[test]
    fn thinning_keeps_the_mean_and_the_expected_number_of_points() {
        let world = squares();
        let here = end(&world, [2.5, 0.5]);
        // Ends straight from the eye, and ends of chains that carry from nothing to more than all others.
        let mut ends = vec![ChainEnd { throughput: Rgb::splat(0.5), ..here }];
        let shares = [4.0, 1.0, 0.5, 0.25, 0.1, 0.03, 0.0, 1e-6];
        for (path_class, share) in (1..).zip(shares) {
            ends.push(ChainEnd { throughput: Rgb::new(1.0, 0.8, 1.2) * share, path_class, depth: 3, ..here });
        }
        let total =
            merged(&ends[..1], 0.0)[0].carried() + ends[1..].iter().map(|e| point(e).carried()).sum::<f32>();
        let kept: Vec<f32> =
            ends.iter().map(|e| (CHAINED_POINTS * point(e).carried() / total).min(1.0)).collect();
        let expected = 1.0 + kept[1..].iter().sum::<f32>();
        assert!(expected < 1.0 + CHAINED_POINTS && kept[1] == 1.0, "{kept:?}");

        let draws = 10_000;
        let (mut weights, mut number) = (vec![Rgb::ZERO; ends.len()], 0);
        for draw in 0..draws {
            let found = merged(&ends, (draw as f32 + 0.5) / draws as f32);
            assert!((expected.floor()..=expected.ceil()).contains(&(found.len() as f32)), "{}", found.len());
            number += found.len();
            for point in found {
                weights[point.path_class as usize] += point.weight / draws as f32;
            }
        }
        assert!((number as f32 / draws as f32 - expected).abs() < 1e-3, "{number} {expected}");
        for (end, weight) in ends.iter().zip(weights) {
            // A share below that of one draw is found by none or by one of them.
            let rounding = CHAINED_POINTS.recip() * total / draws as f32 * 4.0;
            let error = (weight - end.throughput).abs().max_element();
            assert!(error < rounding + 1e-4, "{} {weight} {}", end.path_class, end.throughput);
        }
    }

    #[test]
    fn points_that_carry_nothing_have_no_weights_that_are_not_numbers() {
        let world = squares();
        let here = end(&world, [2.5, 0.5]);
        let dark = |path_class| ChainEnd { throughput: Rgb::ZERO, path_class, depth: 2, ..here };
        for ends in [vec![dark(1), dark(2)], vec![dark(1), ChainEnd { path_class: 3, depth: 2, ..here }]] {
            assert!(merged(&ends, 0.3).iter().all(|point| point.weight.is_finite()));
        }
    }
}
