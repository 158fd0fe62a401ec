//! Packed materials.

use super::*;
use crate::material::PackedBsdf;

#[test]
fn unpacked_materials_have_all_factors_of_any_number_of_lobes() {
    let scene = scene(smooth_materials());
    let materials = Materials::new(&scene);
    let at = |id| materials.at(MaterialId(id), Vec2::new(0.3, 0.6));
    let all: Vec<Bsdf> = (0..materials.count() as u32).map(at).collect();
    let (mut factors, mut behind) = (Vec::new(), vec![Rgb::ONE]);
    let packed: Vec<PackedBsdf> = all.iter().map(|bsdf| PackedBsdf::new(bsdf, &mut factors)).collect();
    behind.extend(&factors);
    let bits = |bsdf: &Bsdf| format!("{bsdf:?}");
    for (packed, bsdf) in packed.iter().zip(&all) {
        assert_eq!(bits(&packed.unpack(&factors)), bits(bsdf));
        assert_eq!(bits(&packed.behind(1).unpack(&behind)), bits(bsdf));
    }
    assert!(size_of::<PackedBsdf>() <= 24 && factors.len() > all.len());
}
