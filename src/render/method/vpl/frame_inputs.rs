//! Inputs in which a still, a view of a list and a frame of a film differ.

use super::Settings;
use crate::calibration::PRICES;
use crate::method::prepared::LitSurfaces;
use crate::method::renderer::FormerFrames;
use transport::eye::Settled;
use transport::perception::Thresholds;
use transport::radiance_cache::retained::RetainedRecords;
use transport::radiance_cache::{CacheSettings, CellLimits};
use world::view::View;

/// Inputs of an image, besides the settings.
pub struct FrameInputs<'a> {
    /// Settings of records.
    pub cache: CacheSettings,
    /// Cells that get a record.
    pub cells: CellLimits,
    /// Records of former frames; `None` for a still.
    pub kept: Option<&'a mut RetainedRecords>,
    /// Surfaces that virtual lights are made for.
    pub lit: LitSurfaces<'a>,
    /// True for a frame of a film, whose noise must not flicker and whose guides are computed before.
    pub is_film: bool,
    /// Pixels whose direct light is reprojected.
    pub settled: Settled,
    /// Visibility thresholds of the previous frame.
    pub thresholds: Option<&'a Thresholds>,
    /// Expected work besides the eye samples, in rays; unknown in a film, which has records already.
    pub other_rays: Option<f64>,
}

impl<'a> FrameInputs<'a> {
    /// Returns the inputs of a still.
    pub fn still(settings: &Settings, view: &View) -> FrameInputs<'a> {
        let pixels = view.window.film_pixel_count() as f64;
        let (lights, lit) = match settings.gathers() {
            true => (settings.gathering.photons, LitSurfaces::All),
            false => (settings.light.indirect, LitSurfaces::InView),
        };
        FrameInputs {
            cache: settings.cache,
            cells: CellLimits::new(&settings.cache),
            kept: None,
            lit,
            is_film: false,
            settled: Settled::default(),
            thresholds: None,
            other_rays: Some(PRICES.rays_beside_samples(pixels, settings.spp.into(), lights.into())),
        }
    }

    /// Returns the inputs of the next frame of a film, or of the next view of a list.
    pub fn next(settings: &Settings, former: FormerFrames<'a>, view: &View) -> FrameInputs<'a> {
        let FormerFrames { records, settled, thresholds, outlook } = former;
        let still = FrameInputs { kept: Some(records), ..FrameInputs::still(settings, view) };
        if let Some(outlook) = outlook {
            let cells = CellLimits::of_views(&settings.cache, outlook.overlap, settings.cut.epsilon);
            return FrameInputs { cells, lit: LitSurfaces::Seen(&outlook.points), ..still };
        }
        let cache = settings.cache.for_walk();
        let (cells, lit) = (CellLimits::new(&cache), LitSurfaces::All);
        FrameInputs { cache, cells, lit, is_film: true, settled, thresholds, other_rays: None, ..still }
    }
}
