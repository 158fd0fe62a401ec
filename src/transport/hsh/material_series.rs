//! Representation of each material's reflection in cache records: irradiance, a series, or none.
//!
//! The kernel of a surface is base + lobes. The base is Lambertian, perhaps under a coat. It varies only with the
//! height of the light, by the coat's transmittance. So it takes one row of functions and has hardly any error. All
//! parts are projected with reflectance 1. Colours and textures are factors on each part, looked up at the point.
//!
//! Deviations: the paper sets the number of bands by hand. Here it is the minimum at which the error of the kernel is
//! within the tolerance, with every texture replaced by its mean.

use super::basis::{CHANNELS, MAX_BANDS, MAX_FUNCTIONS, index};
use super::kernel::{Profile, even_index};
use super::lobe_table::LobeTable;
use super::projection::{KernelProjection, Quadrature, ZonalProjection};
use base::setting::{DOWN, PAPER, settings};
use rayon::prelude::*;
use scene::MaterialId;
use world::material::{Bsdf, DullLobe, Materials};

/// Outgoing inclinations, in degrees, over which the error of a kernel is averaged.
const INCLINATIONS: [f64; 6] = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0];

settings! {
    /// Accuracy of series. Errors are in the L2 norm over the incoming directions, relative to the whole kernel (base
    /// and lobes), averaged over outgoing inclinations up to 75°.
    pub struct SeriesSettings {
        /// Minimum roughness α of lobes that records light. Cuts light sharper lobes. 2 leaves all lobes to cuts.
        min_alpha: f32 = 0.25 => [
            .heading(PAPER).named("series_alpha").positive().values(&["0.15", "0.2", "0.25", "0.35", "0.5", "2"])
        ];
        /// Error of the series of a lobe below which no further bands are added, relative to the whole reflection.
        error: f64 = 0.05 => [.heading(PAPER).named("series_band_error").positive().scaled(&DOWN)];
        /// Maximum error of the series of a lobe that records light, relative to the whole reflection.
        max_error: f64 = 0.12 => [.heading(PAPER).named("series_error").at_least(0.0).scaled(&DOWN)];
        /// Maximum error of the interpolation between outgoing directions.
        interpolation_error: f64 = 0.002;
    }
}

/// Content of the cache records of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Caching {
    /// Irradiance: there is no rough lobe, or only lobes so sharp that the eye pass follows them.
    Irradiance,
    /// Series with this number of bands.
    Series(u8),
    /// Nothing: the material is too glossy for records, or its roughness is textured.
    PerSample,
}

/// Series of the kernels of all materials of a scene.
pub struct MaterialSeries {
    materials: Vec<MaterialEntry>,
    lobes: Vec<LobeTable>,
}

struct MaterialEntry {
    caching: Caching,
    /// Lobes in the series.
    lobes: Vec<LobeUse>,
    /// Transmittance of the coat times cosine: functions of order 0.
    base: [f32; MAX_BANDS],
}

/// A lobe of a material.
#[derive(Clone, Copy)]
struct LobeUse {
    /// Place in the material.
    slot: usize,
    /// Index among the different lobes of all materials; once the tables are made, index of the table.
    kind: usize,
}

impl MaterialSeries {
    /// Projects materials, textured ones by their means. Materials whose lobes differ only by a factor share one table.
    pub fn new(materials: &Materials, settings: &SeriesSettings) -> MaterialSeries {
        let quadrature = Quadrature::standard();
        let averages: Vec<Bsdf> = materials.averages().collect();
        // Different lobes of all materials, and the lobes of each material.
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
        let tests: Vec<Vec<KernelProjection>> = kinds
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
            // There are no more tables than kinds, so an index of a table is not mistaken for a later kind.
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

    /// True if any material has a series.
    pub fn any_series(&self) -> bool {
        self.cachings().any(|caching| caching.bands().is_some())
    }

    /// Number of tables of lobes.
    #[cfg(test)]
    pub(super) fn tables(&self) -> usize {
        self.lobes.len()
    }

    /// Returns the kernel of a material for outgoing directions at `cos_o` > 0 to the normal, at a point
    /// with the BSDF `bsdf`. If [`MaterialSeries::caching`] is not a series, the kernel is that of the base alone.
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
            // The table may have more bands, which another material needs.
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
    /// Creates the entry of a material without lobes to expand.
    fn without_series(bsdf: &Bsdf, caching: Caching, quadrature: &Quadrature) -> MaterialEntry {
        let base = project_base(bsdf, quadrature).coefficients.map(|c| c as f32);
        MaterialEntry { caching, lobes: Vec::new(), base }
    }

    /// Creates the entry of a material with `lobes` to expand, the sharpest of roughness `alpha`. `tests` are the
    /// projections of each kind of lobe at [`INCLINATIONS`].
    fn new(
        bsdf: &Bsdf,
        lobes: &[LobeUse],
        alpha: f32,
        tests: &[Vec<KernelProjection>],
        quadrature: &Quadrature,
        settings: &SeriesSettings,
    ) -> MaterialEntry {
        let zonal = project_base(bsdf, quadrature);
        let sums: Vec<KernelProjection> = (0..INCLINATIONS.len())
            .map(|at| {
                let parts = lobes.iter().map(|lobe| (bsdf.lobe_scale(lobe.slot), &tests[lobe.kind][at]));
                KernelProjection::sum(&Vec::from_iter(parts))
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

/// Computes the error of a kernel in its first `bands`, averaged over [`INCLINATIONS`]. `lobes` are the projections of
/// its lobes together.
fn mean_error(bsdf: &Bsdf, lobes: &[KernelProjection], zonal: &ZonalProjection, bands: usize) -> f64 {
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
