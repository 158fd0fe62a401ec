//! Statements of MTL files.

use crate::statements::{Fate, Statement};

const fn statement(name: &'static str, fate: Fate, note: &'static str) -> Statement {
    Statement { name, fate, note }
}

/// Replacement of an ambient map.
pub(crate) const AMBIENT_NOTE: &str = "ambient light is computed; the image of `map_Kd` may stand here, too";

/// Statements of MTL files. Small and capital letters count the same.
pub(crate) const MTL: &[Statement] = &[
    statement(
        "newmtl",
        Fate::Read,
        "name of a material; the first library that has the name counts, and other definitions are named",
    ),
    statement("illum", Fate::Read, "kind of the surface, below; 0 and 10 and unknown numbers are named"),
    statement("Kd", Fate::Read, "colour of the base, of a metal, or of a principled material"),
    statement(
        "Ks",
        Fate::Read,
        "reflectance straight on, at most 0.08 over a base; colour of a metal without `Kd`",
    ),
    statement("Ns", Fate::Read, "Phong exponent: microfacets of α = √(2 / (Ns + 2))"),
    statement("Ke", Fate::Read, "radiance of the front"),
    statement(
        "Ka",
        Fate::Read,
        "share of metal beside `illum` 3 and 6, as Blender writes it; no ambient light",
    ),
    statement("Ni", Fate::Read, "index of refraction of glass"),
    statement("Tf", Fate::Read, "factor on light through glass, at each surface; else named unless 0 or 1"),
    statement("d", Fate::Read, "opacity"),
    statement("Tr", Fate::Read, "1 - opacity, if there is no `d`"),
    statement("Pr", Fate::Read, "roughness of a principled material"),
    statement("Pm", Fate::Read, "share of metal"),
    statement("Ps", Fate::Read, "sheen"),
    statement("Pc", Fate::Read, "clear coat"),
    statement("Pcr", Fate::Read, "roughness of the clear coat: α is its square, at most 0.1"),
    statement("aniso", Fate::Read, "anisotropy"),
    statement("anisor", Fate::Read, "angle of the anisotropy, in turns"),
    statement("map_Kd", Fate::Read, "colour, times `Kd` unless that is black"),
    statement(
        "map_Ks",
        Fate::Read,
        "factor on reflection; named where there is none, and of principled materials",
    ),
    statement("map_Ke", Fate::Read, "emission, times `Ke` unless that is black"),
    statement("map_d", Fate::Read, "opacity, by the image's alpha or else its luminance, times `d`"),
    statement("map_Pr", Fate::Read, "roughness"),
    statement("map_Pm", Fate::Read, "share of metal"),
    statement("map_Ps", Fate::Read, "sheen"),
    statement("map_Pc", Fate::Read, "clear coat"),
    statement("norm", Fate::Read, "normals; `-bm` is a factor on their x and y"),
    statement(
        "bump",
        Fate::Read,
        "heights in the file's unit, times `-bm`; bluish images are normals, as of Blender",
    ),
    statement("map_bump", Fate::Read, "the same as `bump`"),
    statement("map_Ka", Fate::Named, AMBIENT_NOTE),
    statement("map_aat", Fate::NoEffect, "anti-aliasing"),
    statement("map_Ns", Fate::Named, "the exponent is the same everywhere"),
    statement("map_Pcr", Fate::Named, "the coat's roughness is the same everywhere"),
    statement("map_aniso", Fate::Named, "the anisotropy is the same everywhere"),
    statement("map_anisor", Fate::Named, "the anisotropy's angle is the same everywhere"),
    statement("map_Tr", Fate::Named, "the opacity is the same everywhere; write `map_d`"),
    statement("map_refl", Fate::Named, "the share of metal is the same everywhere; write `map_Pm`"),
    statement("refl", Fate::Named, "surfaces reflect the scene"),
    statement("disp", Fate::Named, "the surface stays as it is"),
    statement("decal", Fate::Named, "the image is left out"),
    statement("sharpness", Fate::Named, "reflections are as sharp as the surface"),
];

/// Options of maps, before or behind the file's name.
pub(crate) const MAP_OPTIONS: &[Statement] = &[
    statement("-s", Fate::Read, "factors on u and v; the third has no effect"),
    statement("-o", Fate::Read, "offsets of u and v, added behind the factors; the third has no effect"),
    statement("-clamp", Fate::Read, "`on`: the edge of the image goes on; else the image repeats"),
    statement("-blendu", Fate::Read, "`off`, with `-blendv off`: the nearest texel; alone it is named"),
    statement("-blendv", Fate::Read, "as `-blendu`"),
    statement("-mm", Fate::Read, "base and gain: texels times the gain, plus the base"),
    statement("-bm", Fate::Read, "factor on `bump` and `norm`; else named unless 1"),
    statement(
        "-imfchan",
        Fate::Read,
        "channel of a number: `r`, `g`, `b`, `m` (alpha) or `l`; `z`, and of colours, is named",
    ),
    statement("-t", Fate::Named, "turbulence is left out"),
    statement("-cc", Fate::Named, "colours are as in the image"),
    statement("-boost", Fate::Named, "the image is filtered without it"),
    statement("-texres", Fate::Named, "the image has its own resolution"),
    statement("-type", Fate::Named, "the image lies in texture coordinates"),
];

/// Returns the statement of a keyword, whatever its case.
pub(crate) fn listed(word: &str) -> Option<&'static Statement> {
    let exact = MTL.iter().find(|statement| statement.name == word);
    exact.or_else(|| MTL.iter().find(|statement| statement.name.eq_ignore_ascii_case(word)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statements::assert_page_lists;

    #[test]
    fn the_page_lists_the_statements() {
        assert_page_lists("MTL", MTL);
        assert_page_lists("Options of MTL maps", MAP_OPTIONS);
    }
}
