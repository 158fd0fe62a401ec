//! Representation of each material's reflection in cache records: irradiance, a series, or none.
//!
//! The kernel of a surface is base + lobes. The base, Lambertian and perhaps under a coat, varies with the
//! height of the light only, by the coat's transmittance; it takes one row of functions and has hardly any
//! error. All parts are projected with reflectance 1: colour and texture are factors on each, looked up at
//! the point.
//!
//! Deviations: the paper sets the number of bands by hand; here it is the minimum that keeps the error of the
//! kernel within the tolerance, where each texture has the value of its mean.

use super::CHANNELS;
use super::basis::{MAX_BANDS, MAX_FUNCTIONS, index};
use super::kernel::{Profile, even_index};
use super::lobe_table::LobeTable;
use super::projection::{Projection, Quadrature, ZonalProjection};
use base::setting::{DOWN, settings};
use rayon::prelude::*;
use scene::MaterialId;
use world::material::{Bsdf, DullLobe, Materials};

/// Outgoing inclinations, in degrees, over which the error of a kernel is averaged.
const INCLINATIONS: [f64; 6] = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0];

settings! {
    /// Accuracy of series. Errors are in the L2 norm over the incoming directions, relative to the whole kernel (base
    /// and lobes), averaged over outgoing inclinations up to 75°.
    pub struct SeriesSettings in "Records" {
        /// Roughness α from which lobes are lit by records, 2 for none: sharper ones are lit by cuts.
        min_alpha: f32 = 0.25 => [
            .named("series_alpha").positive().values(&["0.15", "0.2", "0.25", "0.35", "0.5", "2"])
        ];
        /// Error below which a lobe's series gets no further bands, relative to the whole reflection.
        error: f64 = 0.05 => [.named("series_band_error").positive().scaled(&DOWN)];
        /// Largest error of a lobe's series for which it is lit by records, relative to the whole reflection.
        max_error: f64 = 0.12 => [.named("series_error").at_least(0.0).scaled(&DOWN)];
        /// Largest error by interpolation between outgoing directions.
        interpolation_error: f64 = 0.002;
    }
}

/// Content of the cache records of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Caching {
    /// Irradiance is enough: there is no rough lobe (or only such sharp ones as the eye pass follows).
    Irradiance,
    /// A series of so many bands.
    Series(u8),
    /// Too glossy for records, or of textured roughness.
    PerSample,
}

/// Series of the kernels of all materials of a scene.
pub struct MaterialSeries {
    materials: Vec<MaterialEntry>,
    lobes: Vec<LobeTable>,
}

struct MaterialEntry {
    caching: Caching,
    /// Lobes that the series stands for.
    lobes: Vec<LobeUse>,
    /// Transmittance of the coat times cosine: functions of order 0.
    base: [f32; MAX_BANDS],
}

/// A lobe of a material.
#[derive(Clone, Copy)]
struct LobeUse {
    /// Its place in the material.
    slot: usize,
    /// Number among the different lobes of all materials; once the tables are made, of its table.
    kind: usize,
}

impl MaterialSeries {
    /// Projects materials, textured ones by their means. Materials whose lobes differ only by a factor share one table.
    pub fn new(materials: &Materials, settings: &SeriesSettings) -> MaterialSeries {
        let quadrature = Quadrature::standard();
        let averages: Vec<Bsdf> = materials.averages().collect();
        // One lobe of each kind, and for each material the slots and kinds of its own.
        let mut kinds: Vec<DullLobe> = Vec::new();
        let mut used: Vec<Vec<LobeUse>> = Vec::with_capacity(averages.len());
        for bsdf in &averages {
            let mut kind_of = |lobe| {
                kinds.iter().position(|kind| *kind == lobe).unwrap_or_else(|| {
                    kinds.push(lobe);
                    kinds.len() - 1
                })
            };
            let lobes = bsdf.dull_lobes();
            used.push(lobes.map(|(slot, lobe)| LobeUse { slot, kind: kind_of(lobe) }).collect());
        }
        let tests: Vec<Vec<Projection>> = kinds
            .par_iter()
            .map(|lobe| {
                INCLINATIONS.par_iter().map(|d| quadrature.project(*lobe, d.to_radians().cos())).collect()
            })
            .collect();
        let mut surfaces: Vec<MaterialEntry> = averages
            .iter()
            .zip(&used)
            .map(|(bsdf, lobes)| {
                if bsdf.is_of_mean_roughness() {
                    return MaterialEntry::without_series(bsdf, Caching::PerSample, &quadrature);
                }
                if lobes.is_empty() {
                    return MaterialEntry::without_series(bsdf, Caching::Irradiance, &quadrature);
                }
                let alpha = lobes.iter().map(|lobe| kinds[lobe.kind].alpha()).fold(f32::INFINITY, f32::min);
                MaterialEntry::new(bsdf, lobes, alpha, &tests, &quadrature, settings)
            })
            .collect();
        // Tables for the lobes in use, with as many bands as any of their materials needs.
        let mut lobes = Vec::new();
        for (kind, lobe) in kinds.iter().enumerate() {
            let uses_it = |s: &&mut MaterialEntry| s.lobes.iter().any(|lobe| lobe.kind == kind);
            let users: Vec<&mut MaterialEntry> = surfaces.iter_mut().filter(uses_it).collect();
            let Some(bands) = users.iter().filter_map(|s| s.caching.bands()).max() else { continue };
            // There are no more tables than kinds, so none met later in this loop is taken for this one.
            let uses = users.into_iter().flat_map(|s| &mut s.lobes);
            uses.filter(|lobe| lobe.kind == kind).for_each(|lobe| lobe.kind = lobes.len());
            lobes.push(LobeTable::new(*lobe, bands, settings.interpolation_error, &quadrature));
        }
        MaterialSeries { materials: surfaces, lobes }
    }

    /// Returns the content of the records of a material.
    #[inline]
    pub fn caching(&self, id: MaterialId) -> Caching {
        self.materials[id.0 as usize].caching
    }

    /// Returns the content of the records of all materials, in their order.
    pub fn cachings(&self) -> impl Iterator<Item = Caching> + '_ {
        self.materials.iter().map(|surface| surface.caching)
    }

    /// True if any material is to have a series.
    pub fn any_series(&self) -> bool {
        self.cachings().any(|caching| caching.bands().is_some())
    }

    /// Number of tables of lobes.
    #[cfg(test)]
    pub(super) fn tables(&self) -> usize {
        self.lobes.len()
    }

    /// Returns the kernel of a material for outgoing directions at `cos_o` > 0 to the normal, at a point
    /// whose BSDF is `bsdf`. Where [`MaterialSeries::caching`] is not a series it is that of the base alone.
    #[inline]
    pub fn profile(&self, bsdf: &Bsdf, cos_o: f32) -> Profile {
        let surface = &self.materials[bsdf.material().0 as usize];
        let bands = surface.caching.bands().unwrap_or(MAX_BANDS);
        let mut coefficients = [[0.0; MAX_FUNCTIONS]; CHANNELS];
        for lobe in &surface.lobes {
            let (of_lobe, scale) = (self.lobes[lobe.kind].lookup(cos_o), bsdf.lobe_scale(lobe.slot));
            for c in 0..CHANNELS {
                for k in 0..MAX_FUNCTIONS {
                    coefficients[c][k] += of_lobe[c][k] * scale[c];
                }
            }
        }
        let base = bsdf.base_brdf() * bsdf.coat_transmittance(cos_o);
        for (c, row) in coefficients.iter_mut().enumerate() {
            for l in 0..MAX_BANDS {
                row[index(l, 0)] += base[c] * surface.base[l];
            }
            // The table may have more bands, for another material.
            row[bands * bands..].fill(0.0);
        }
        Profile { coefficients }
    }
}

impl Caching {
    /// Number of bands of the series, if it is one.
    pub fn bands(self) -> Option<usize> {
        match self {
            Caching::Series(bands) => Some(usize::from(bands)),
            Caching::Irradiance | Caching::PerSample => None,
        }
    }
}

impl MaterialEntry {
    /// For a material with no lobe to expand.
    fn without_series(bsdf: &Bsdf, caching: Caching, quadrature: &Quadrature) -> MaterialEntry {
        let base = project_base(bsdf, quadrature).coefficients.map(|c| c as f32);
        MaterialEntry { caching, lobes: Vec::new(), base }
    }

    /// For a material with lobes to expand, of roughness `alpha` or more, given the projections of each kind of lobe at
    /// [`INCLINATIONS`].
    fn new(
        bsdf: &Bsdf,
        lobes: &[LobeUse],
        alpha: f32,
        tests: &[Vec<Projection>],
        quadrature: &Quadrature,
        settings: &SeriesSettings,
    ) -> MaterialEntry {
        let zonal = project_base(bsdf, quadrature);
        let sums: Vec<Projection> = (0..INCLINATIONS.len())
            .map(|at| {
                let parts = lobes.iter().map(|lobe| (bsdf.lobe_scale(lobe.slot), &tests[lobe.kind][at]));
                Projection::sum(&Vec::from_iter(parts))
            })
            .collect();
        let error = |bands: usize| mean_error(bsdf, &sums, &zonal, bands);
        // Two bands hold the irradiance.
        let bands = (2..=MAX_BANDS).find(|bands| error(*bands) <= settings.error).unwrap_or(MAX_BANDS);
        let fits = error(bands) <= settings.max_error && alpha >= settings.min_alpha;
        let base = zonal.coefficients.map(|c| c as f32);
        match fits {
            true => MaterialEntry { caching: Caching::Series(bands as u8), lobes: lobes.to_vec(), base },
            false => MaterialEntry { caching: Caching::PerSample, lobes: Vec::new(), base },
        }
    }
}

/// Projects the transmittance of the coat times cosine.
fn project_base(bsdf: &Bsdf, quadrature: &Quadrature) -> ZonalProjection {
    quadrature.project_zonal(|z| z * f64::from(bsdf.coat_transmittance(z as f32)))
}

/// Computes the error of a kernel in its first `bands`, given the projections of its lobes together at
/// [`INCLINATIONS`].
fn mean_error(bsdf: &Bsdf, lobes: &[Projection], zonal: &ZonalProjection, bands: usize) -> f64 {
    let errors = INCLINATIONS.iter().zip(lobes).map(|(degrees, lobes)| {
        let through = bsdf.coat_transmittance(degrees.to_radians().cos() as f32);
        let (mut left_out, mut whole) = (0.0, 0.0);
        for c in 0..CHANNELS {
            let base = f64::from(bsdf.base_brdf()[c] * through);
            let row = &lobes.coefficients[c];
            let common: f64 = (0..MAX_BANDS).map(|l| zonal.coefficients[l] * row[even_index(l, 0)]).sum();
            let norm_sq = base * base * zonal.norm_sq + 2.0 * base * common + lobes.norm_sq[c];
            let mut kept = 0.0;
            for l in 0..bands {
                for m in 0..=l {
                    let zonal = if m == 0 { base * zonal.coefficients[l] } else { 0.0 };
                    kept += (zonal + row[even_index(l, m)]).powi(2);
                }
            }
            left_out += (norm_sq - kept).max(0.0);
            whole += norm_sq;
        }
        if whole > 0.0 { (left_out / whole).sqrt() } else { 0.0 }
    });
    errors.sum::<f64>() / INCLINATIONS.len() as f64
}
