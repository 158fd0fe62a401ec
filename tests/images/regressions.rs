//! Defects that were mended, a test for each, named for its symptom.

use crate::kit::*;
use crate::oracle::{assert_rms_below, brightest};
use lightsplat::method::{Output, vpl};

/// A coarse cut gave a point the light of a whole cluster whose representative lay next to it: bright specks, and an
/// RMS error of 1176 %. Today a cluster that gives more than a quarter of the light is split, and the error is 12 %.
#[test]
fn coarse_cuts_leave_no_bright_specks() {
    let world = own("knot", 48);
    let mut fine = vpl::Settings { spp: 1, ..vpl::Settings::lightcuts() };
    fine.light.indirect = 75_000;
    let reference = image(&world, &fine);
    let mut coarse = fine;
    (coarse.cut.epsilon, coarse.cut.max_cut) = (0.32, 1250);
    let mut shared = vpl::Settings { spp: 1, patches: 512, ..vpl::Settings::reconstruction() };
    (shared.light, shared.cut) = (coarse.light, coarse.cut);
    for (name, image) in [("lightcuts", image(&world, &coarse)), ("reconstruction", image(&world, &shared))] {
        assert_rms_below(0.25, &image, &reference, name);
        let ratio = brightest(&image) / brightest(&reference);
        assert!(ratio < 1.5, "{name}: {ratio}");
    }
}

/// The hit of a short ray was lit by a coarse cut, whose representative could lie next to it: fireflies in creases.
/// Today no cluster of such a cut gives more light than its error allows.
#[test]
fn compensation_makes_no_fireflies_in_creases() {
    let world = own("cornell", 48);
    let with = |compensation| {
        let mut settings = vpl::Settings { spp: 1, compensation, ..vpl::Settings::reconstruction() };
        settings.light.indirect = 3000;
        image(&world, &settings)
    };
    let ratio = brightest(&with(true)) / brightest(&with(false));
    assert!(ratio < 1.2, "{ratio}");
}

/// The layers of `--set inspect=on` were PNG files of the cache alone, though the photon cache makes them too.
#[test]
fn every_method_with_records_returns_the_layers_of_inspection() {
    let world = own("cornell", 48);
    let layers = |output: Output| output.extra.iter().map(|layer| layer.name.clone()).collect::<Vec<_>>();
    let mut records = vpl::Settings { spp: 1, inspect: true, ..vpl::Settings::cache() };
    records.light.indirect = 3000;
    let mut photons = vpl::Settings { spp: 1, inspect: true, ..vpl::Settings::photon_cache() };
    photons.gathering.photons = 3000;
    let found = [layers(rendered(&world, &records)), layers(rendered(&world, &photons))];
    for layers in found {
        for name in ["direct", "indirect", "records", "weights"] {
            assert!(layers.iter().any(|layer| layer == name), "{name} is not among {layers:?}");
        }
    }
}
