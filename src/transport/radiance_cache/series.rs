//! Light on glossy surfaces: records that hold radiance as a series beside irradiance, and its reflection by lobes.
//!
//! Paper: Herzog et al. 2009, sections 4 and 5.
//! Deviations: the base of a material reflects irradiance, as it does where there is no lobe; only the lobe needs
//! the series. The paper turns the light with the surface; here, where normals differ, light stays where it is and
//! the lobe keeps pointing where it does: it is that of the record's normal seen from the direction which that
//! normal mirrors to the sample's mirror direction, scaled to reflect as much of uniform light as the sample's
//! own.

use super::lit_cluster::LitCluster;
use super::record::Record;
use super::settings::CacheSettings;
use super::source::Candidate;
use super::splat::Splat;
use super::store::RecordStore;
use super::targets::Targets;
use crate::eye::{DrawnLight, ExtraSamples, PointGeometry, PointSurface, Settled, ShadingPoints};
use crate::gradient::Incidence;
use crate::hsh::{Accumulator, Caching, Kernel, MaterialSeries, Radiance};
use crate::lights::{DirectIndirect, Origin};
use base::math::{Frame, Rgb};
use glam::Vec3;
use scene::MaterialId;
use world::World;
use world::material::Bsdf;

/// Smallest cosine of the direction in which a lobe is seen.
const MIN_COS: f32 = 0.02;

/// Sums the light of records into series, as cuts are read.
#[derive(Default)]
pub struct SeriesGatherer {
    /// Nothing before the first series.
    sums: Option<DirectIndirect<Accumulator>>,
    /// Tangent frame and position of the record, if it is to have series.
    place: Option<(Frame, Vec3)>,
}

impl SeriesGatherer {
    /// Begins a record; nothing is summed if irradiance is enough there.
    pub fn begin(&mut self, candidate: &Candidate) {
        let bands = usize::from(candidate.bands);
        let point = &candidate.point;
        self.place = (bands > 0).then(|| (Frame::from_normal(point.normal), point.position));
        if bands > 0 {
            let sums = self.sums.get_or_insert_with(|| DirectIndirect::from_fn(|_| Accumulator::new(bands)));
            sums.direct.reset(bands);
            sums.indirect.reset(bands);
        }
    }

    /// Adds a visible cluster, of which clamping leaves the share `kept`.
    #[inline]
    pub fn add(&mut self, cluster: &LitCluster, kept: f32) {
        let Some((frame, position)) = &self.place else { return };
        let &LitCluster { transfer, node, vpl } = cluster;
        let profiles = &transfer.trees.profiles;
        let incidence = Incidence::of_vpl(frame, *position, vpl, node.kind(), profiles, cluster.near_sq());
        if let Some(incidence) = incidence {
            let incidence = if kept < 1.0 { incidence.held(kept) } else { incidence };
            self.add_incidence(node.origin(), &incidence, node.intensity);
        }
    }

    /// True if the record is to have series.
    pub fn is_wanted(&self) -> bool {
        self.place.is_some()
    }

    /// Adds light to a layer, in the tangent frame of the record.
    #[inline]
    pub fn add_incidence(&mut self, origin: Origin, incidence: &Incidence<f32>, intensity: Rgb) {
        if let (Some(_), Some(sums)) = (self.place, &mut self.sums) {
            sums[origin].add(incidence, intensity);
        }
    }

    /// Ends the record: the light of each layer as a series, if it is wanted so.
    pub fn finish(&mut self) -> DirectIndirect<Option<Radiance>> {
        match (self.place, &mut self.sums) {
            (Some(_), Some(sums)) => {
                DirectIndirect { direct: Some(sums.direct.finish()), indirect: Some(sums.indirect.finish()) }
            }
            _ => DirectIndirect::default(),
        }
    }
}

/// Lobes of a scene's materials as series.
pub struct Glossy {
    surfaces: MaterialSeries,
}

impl Glossy {
    /// Series of the lobes of a scene; `None` if its materials have no rough lobe.
    pub fn new(world: &World, settings: &CacheSettings) -> Option<Glossy> {
        let materials = 0..world.materials.count() as u32;
        let rough = |id| world.materials.average(MaterialId(id)).split_base(1.0).1.is_some();
        let surfaces = || MaterialSeries::new(&world.materials, &settings.series);
        materials.into_iter().any(rough).then(|| Glossy { surfaces: surfaces() })
    }

    /// The same where there are to be records and any of the points has a lobe broad enough.
    pub fn for_points(&self, points: &ShadingPoints, settings: &CacheSettings) -> Option<&Glossy> {
        let needed = settings.cached().any()
            && self.surfaces.any_series()
            && points.surfaces.iter().any(|surface| surface.bsdf.split_base(1.0).1.is_some());
        needed.then_some(self)
    }

    /// Materials whose lobes neither irradiance nor series can light.
    fn too_sharp(&self) -> Vec<bool> {
        self.surfaces.cachings().map(|caching| caching == Caching::PerSample).collect()
    }

    /// Bands of the series that a surface needs; 0 where it has no lobe, or one too sharp.
    pub fn bands(&self, surface: &PointSurface) -> u8 {
        match self.surfaces.caching(surface.bsdf.material()) {
            Caching::Series(bands) if surface.bsdf.split_base(1.0).1.is_some() => bands,
            _ => 0,
        }
    }
}

/// Direct light to be drawn, if it is: chains follow the lobes that records cannot light. All else in the picture of
/// the whole film takes `other_rays`, about, if that is known.
pub fn drawn_light(
    glossy: Option<&Glossy>,
    settings: &CacheSettings,
    settled: Settled,
    other_rays: Option<f64>,
) -> Option<DrawnLight> {
    let followed = || glossy.map_or(Vec::new(), Glossy::too_sharp);
    settings.draws_direct_light().then(|| DrawnLight {
        followed: followed(),
        extra_samples: ExtraSamples { most: settings.extra_samples, other_rays },
        settled,
        guides: false,
    })
}

impl Targets<'_> {
    /// Sample as it reflects the light of records; `None` if its lobe is not to be lit by them.
    pub fn glossy_point(&self, sample: usize) -> Option<GlossyPoint<'_>> {
        let surfaces = &self.glossy.filter(|_| self.bands[sample] > 0)?.surfaces;
        let (point, surface) = (&self.points.geometry[sample], &self.points.surfaces[sample]);
        let cos = surface.out.dot(point.normal);
        let (base, lobe) = surface.bsdf.split_base(cos);
        let lobe = lobe?;
        let mirror = 2.0 * cos * point.normal - surface.out;
        let strength = surfaces.profile(&lobe, cos.max(MIN_COS)).strength();
        let bands = self.bands[sample];
        Some(GlossyPoint { surfaces, point, bands, base, lobe, mirror, strength, towards: None })
    }
}

/// A sample in the light of one record after another.
pub struct GlossyPoint<'a> {
    surfaces: &'a MaterialSeries,
    point: &'a PointGeometry,
    /// Bands of the series that it needs.
    bands: u8,
    /// BRDF of the base.
    base: Rgb,
    lobe: Bsdf<'a>,
    /// Unit vector in which the lobe points.
    mirror: Vec3,
    /// Strength of the lobe's kernel seen from the sample's own direction.
    strength: Rgb,
    /// Frame of the last record, and the kernel in it; neighbouring records often have the same.
    towards: Option<(Frame, Kernel, Rgb)>,
}

impl GlossyPoint<'_> {
    /// Radiance by base and lobe of a record's light, given the irradiance extrapolated from it.
    #[inline]
    pub fn radiance(&mut self, record: &Record, series: Option<&Radiance>, irradiance: Rgb) -> Rgb {
        self.base * irradiance + series.map_or(Rgb::ZERO, |series| self.reflected(record, series))
    }

    /// Radiance by the lobe.
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
        let profile = self.surfaces.profile(&self.lobe, cos.max(MIN_COS));
        let kernel = profile.towards(out.dot(frame.tangent), out.dot(frame.bitangent));
        (frame, kernel, ratio(self.strength, profile.strength()))
    }

    /// Mean over the records of a layer that reach the sample, which is in `leaf`, of the radiance by the lobe.
    pub fn mean(&mut self, store: &RecordStore, splat: &Splat, leaf: usize) -> Rgb {
        let (mut sum, mut weights) = (Rgb::ZERO, 0.0);
        for &id in &splat.lists[leaf] {
            let record = &store.records[id as usize];
            if let (Some((weight, _)), Some(series)) = (record.at(self.point, self.bands), store.series(id)) {
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
