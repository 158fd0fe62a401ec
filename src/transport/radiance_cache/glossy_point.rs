//! Reflection of records' series by the lobe of a glossy sample.
//!
//! Paper: Herzog et al. 2009, sections 4 and 5.
//!
//! Deviations: the base of a material reflects irradiance; only the lobe uses the series. The paper rotates the light
//! with the surface. If normals differ, the light here stays fixed in space and the lobe keeps its direction. The lobe
//! is evaluated for the record's normal, seen from the direction that this normal mirrors into the sample's mirror
//! direction. It is scaled to reflect as much uniform light as the sample's own lobe.

use super::record::Record;
use super::splat::Splat;
use super::store::RecordStore;
use super::targets::Targets;
use crate::eye::PointGeometry;
use crate::hsh::{Kernel, MaterialSeries, Radiance};
use base::math::{Frame, Rgb};
use glam::Vec3;
use world::material::Bsdf;

/// Minimum cosine of the direction in which a lobe is seen.
const MIN_COS: f32 = 0.02;

/// Glossy sample, lit by one record after another.
pub struct GlossyPoint<'a> {
    surfaces: &'a MaterialSeries,
    point: &'a PointGeometry,
    /// Bands of the series that the sample needs.
    bands: u8,
    /// BRDF of the base.
    base: Rgb,
    lobe: Bsdf<'a>,
    /// Unit vector along which the lobe points.
    mirror: Vec3,
    /// Strength of the lobe's kernel seen from the sample's own direction.
    strength: Rgb,
    /// Frame of the last record and the kernel in it, which neighbouring records often share.
    towards: Option<(Frame, Kernel, Rgb)>,
}

impl<'a> GlossyPoint<'a> {
    /// Returns a sample as it reflects the light of records; `None` if records do not light its lobe.
    pub fn new(targets: &'a Targets, sample: usize) -> Option<GlossyPoint<'a>> {
        let (base, lobe) = targets.split_for_series(sample)?;
        let surfaces = &targets.glossy?.surfaces;
        let (point, surface) = (&targets.points.geometry[sample], targets.points.surfaces.get(sample));
        let cos = surface.out.dot(point.normal);
        let mirror = 2.0 * cos * point.normal - surface.out;
        let strength = surfaces.profile(&lobe, cos.max(MIN_COS)).strength();
        let bands = targets.bands[sample];
        Some(GlossyPoint { surfaces, point, bands, base, lobe, mirror, strength, towards: None })
    }

    /// Returns the radiance that base and lobe reflect of a record's light, given the irradiance extrapolated from it.
    #[inline]
    pub fn radiance(&mut self, record: &Record, series: Option<&Radiance>, irradiance: Rgb) -> Rgb {
        self.base * irradiance + series.map_or(Rgb::ZERO, |series| self.reflected(record, series))
    }

    /// Returns the radiance that the lobe reflects.
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
        // The truncated series may be negative. Its change is limited to its own value.
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

    /// Returns the radiance that the lobe reflects, averaged over the records of a layer that reach the sample in
    /// `leaf`.
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

/// Returns the quotient per channel; 1 in channels with a zero divisor.
fn ratio(a: Rgb, b: Rgb) -> Rgb {
    Rgb::from_array(std::array::from_fn(|c| if b[c] > 0.0 { a[c].max(0.0) / b[c] } else { 1.0 }))
}
