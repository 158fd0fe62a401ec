//! Light on glossy surfaces: records that hold radiance as a series beside irradiance, and what lobes reflect of
//! it.
//!
//! Paper: Herzog et al. 2009, sections 4 and 5.
//! Deviations: the base of a material reflects irradiance, as it does where there is no lobe; only the lobe needs
//! the series. The paper turns the light with the surface; here, where normals differ, light stays where it is and
//! the lobe keeps pointing where it does: it is that of the record's normal seen from the direction which that
//! normal mirrors to the sample's mirror direction, scaled to reflect as much of uniform light as the sample's
//! own.

use super::record::Record;
use super::splat::Layer;
use crate::eye::{EyePass, PointGeometry, PointSurface};
use crate::gradient::Incidence;
use crate::hsh::{Accumulator, Caching, Kernel, MaterialSeries, Radiance, SeriesSettings};
use crate::light_tree::Node;
use crate::lightcut::Transfer;
use crate::material::Bsdf;
use crate::math::{Frame, Rgb};
use crate::vpl::Vpl;
use crate::world::World;
use glam::Vec3;
use rayon::prelude::*;

/// Least cosine of the direction in which a lobe is seen.
const LEAST_COS: f32 = 0.02;

/// Sums the light of records into series, as cuts are read.
#[derive(Default)]
pub struct SeriesGatherer {
    /// Direct and indirect; none before the first series.
    sums: Vec<Accumulator>,
    /// Where the record is, if it is to have series.
    place: Option<(Frame, Vec3)>,
}

impl SeriesGatherer {
    /// Begins a record at a sample; nothing is summed if irradiance is enough there.
    pub fn begin(&mut self, point: &PointGeometry) {
        let bands = point.sharing.bands();
        self.place = (bands > 0).then(|| (Frame::from_normal(point.normal), point.position));
        if bands > 0 {
            self.sums.resize_with(2, || Accumulator::new(bands));
            self.sums.iter_mut().for_each(|sum| sum.reset(bands));
        }
    }

    /// Adds a visible cluster to a layer; `kept` of it is left after clamping (1: not clamped).
    #[inline]
    pub fn add(&mut self, layer: usize, transfer: &Transfer, node: &Node, vpl: &Vpl, kept: f32) {
        let Some((frame, position)) = &self.place else { return };
        let kind = node.kind();
        let found = Incidence::of_vpl(
            frame,
            *position,
            vpl,
            kind,
            &transfer.trees.spots,
            transfer.near_sq(vpl, kind),
        );
        if let Some(incidence) = found {
            let incidence = if kept < 1.0 { incidence.held(kept) } else { incidence };
            self.sums[layer].add(&incidence, node.intensity);
        }
    }

    /// Where the record is, if it is to have series.
    pub fn place(&self) -> Option<&(Frame, Vec3)> {
        self.place.as_ref()
    }

    /// Adds light to a layer, in the frame of the place.
    #[inline]
    pub fn add_incidence(&mut self, layer: usize, incidence: &Incidence<f32>, intensity: Rgb) {
        if self.place.is_some() {
            self.sums[layer].add(incidence, intensity);
        }
    }

    /// Ends the record: the light of each layer as a series, if it is wanted so.
    pub fn finish(&mut self) -> [Option<Radiance>; 2] {
        let mut sums = self.sums.iter_mut();
        [(); 2].map(|()| self.place.and_then(|_| sums.next()).map(Accumulator::finish))
    }
}

/// The glossy surfaces of a scene.
pub struct Glossy {
    surfaces: MaterialSeries,
}

impl Glossy {
    /// Which samples are lit by series, if any; their bands are noted with them.
    pub fn find(world: &World, samples: &mut EyePass, settings: &SeriesSettings) -> Option<Glossy> {
        if samples.points.surfaces.iter().all(|surface| surface.bsdf.split_base(1.0).1.is_none()) {
            return None;
        }
        let surfaces = MaterialSeries::new(&world.scene, &world.materials, settings);
        for (point, surface) in samples.points.geometry.iter_mut().zip(&samples.points.surfaces) {
            if surface.bsdf.split_base(1.0).1.is_none() {
                continue;
            }
            if let Caching::Series(bands) = surfaces.caching(surface.material) {
                point.sharing = point.sharing.with_bands(usize::from(bands));
            }
        }
        surfaces.any_series().then_some(Glossy { surfaces })
    }

    /// What a sample does to the light of records; `None` if its lobe is not to be lit by them.
    pub fn seen<'a>(&'a self, point: &'a PointGeometry, surface: &'a PointSurface<'a>) -> Option<Seen<'a>> {
        if point.sharing.bands() == 0 {
            return None;
        }
        let cos = surface.out.dot(point.normal);
        let (base, lobe) = surface.bsdf.split_base(cos);
        let lobe = lobe?;
        let mirror = 2.0 * cos * point.normal - surface.out;
        let strength = self.surfaces.profile(surface.material, &lobe, cos.max(LEAST_COS)).strength();
        Some(Seen { glossy: self, point, surface, base, lobe, mirror, strength, towards: None })
    }

    /// For each sample, the mean over the records around it of what its lobe reflects, both layers together.
    pub fn lobes(&self, samples: &EyePass, layers: &[Layer; 2]) -> Vec<Rgb> {
        let by_leaf: Vec<Vec<Rgb>> = (0..samples.index.leaves())
            .into_par_iter()
            .map(|leaf| {
                let at = |i: usize| match self.seen(&samples.points.geometry[i], &samples.points.surfaces[i])
                {
                    Some(mut seen) => seen.mean(&layers[0], leaf) + seen.mean(&layers[1], leaf),
                    None => Rgb::ZERO,
                };
                samples.index.leaf(leaf).map(at).collect()
            })
            .collect();
        by_leaf.concat()
    }
}

/// A sample in the light of one record after another.
pub struct Seen<'a> {
    glossy: &'a Glossy,
    point: &'a PointGeometry,
    surface: &'a PointSurface<'a>,
    /// BRDF of the base.
    base: Rgb,
    lobe: Bsdf<'a>,
    /// Unit vector, where the lobe points.
    mirror: Vec3,
    /// Of the lobe's kernel seen from the sample's own direction.
    strength: Rgb,
    /// Frame of the last record, and the kernel in it; neighbouring records often have the same.
    towards: Option<(Frame, Kernel, Rgb)>,
}

impl Seen<'_> {
    /// What base and lobe reflect of a record's light, given the irradiance extrapolated from it.
    #[inline]
    pub fn radiance(&mut self, record: &Record, series: Option<&Radiance>, irradiance: Rgb) -> Rgb {
        self.base * irradiance + series.map_or(Rgb::ZERO, |series| self.reflected(record, series))
    }

    /// What the lobe reflects.
    fn reflected(&mut self, record: &Record, series: &Radiance) -> Rgb {
        let towards = match self.towards.take() {
            Some(towards) if towards.0.normal == record.normal => towards,
            _ => self.kernel(record.normal),
        };
        let (frame, kernel, scale) = self.towards.insert(towards);
        let offset = self.point.position - record.position;
        let light = series.reflected(kernel);
        let change =
            light.gradient[0] * offset.dot(frame.tangent) + light.gradient[1] * offset.dot(frame.bitangent);
        // Cut off as the series is, it may be negative; and it is believed to change by as much as itself at most.
        let value = light.value.max(Rgb::ZERO);
        *scale * (value + change.clamp(-value, value))
    }

    fn kernel(&self, normal: Vec3) -> (Frame, Kernel, Rgb) {
        let frame = Frame::from_normal(normal);
        let cos = normal.dot(self.mirror);
        let out = 2.0 * cos * normal - self.mirror;
        let surfaces = &self.glossy.surfaces;
        let profile = surfaces.profile(self.surface.material, &self.lobe, cos.max(LEAST_COS));
        let kernel = profile.towards(out.dot(frame.tangent), out.dot(frame.bitangent));
        (frame, kernel, ratio(self.strength, profile.strength()))
    }

    /// Mean over the records of a layer that reach the sample, which is in `leaf`.
    fn mean(&mut self, layer: &Layer, leaf: usize) -> Rgb {
        let (mut sum, mut weights) = (Rgb::ZERO, 0.0);
        for &id in &layer.lists[leaf] {
            let record = &layer.records[id as usize];
            if let (Some((weight, _)), Some(series)) = (record.at(self.point), layer.series(id)) {
                sum += weight * self.reflected(record, series);
                weights += weight;
            }
        }
        if weights > 0.0 { sum / weights } else { Rgb::ZERO }
    }
}

/// Quotient by channel; 1 where there is nothing to divide by.
fn ratio(a: Rgb, b: Rgb) -> Rgb {
    Rgb::from_array(std::array::from_fn(|c| if b[c] > 0.0 { a[c].max(0.0) / b[c] } else { 1.0 }))
}
