//! Parser of Wavefront MTL, the classic materials of an OBJ file. The module `native::mtl` converts them.
//!
//! Reason against `tobj` 4.0.5: a colour of one or two numbers makes its MTL reader panic, and its errors name no line.

use super::obj;
use crate::error::{Location, SceneError};
use base::math::Rgb;
use glam::DVec3;
use std::path::Path;

/// A material (`newmtl`) with its statements.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ClassicMaterial {
    pub name: String,
    pub place: Location,
    /// Kd.
    pub diffuse: Rgb,
    /// Ks.
    pub specular: Rgb,
    /// Ke.
    pub emissive: Rgb,
    /// Ns.
    pub exponent: f32,
    /// d, or 1 - Tr.
    pub dissolve: f32,
    /// Ni.
    pub ior: Option<f32>,
    /// illum.
    pub model: u32,
    /// map_Kd, without its options.
    pub diffuse_map: Option<String>,
    /// map_Ke, without its options.
    pub emissive_map: Option<String>,
    /// map_d, without its options.
    pub opacity_map: Option<String>,
    /// Keywords of other maps.
    pub other_maps: Vec<String>,
}

/// Reads the MTL text `bytes`; `path` is for messages.
pub fn read(bytes: &[u8], path: &Path) -> Result<Vec<ClassicMaterial>, SceneError> {
    let mut materials: Vec<ClassicMaterial> = Vec::new();
    for (number, line) in obj::lines(bytes).enumerate() {
        let place = Location::line(path, number as u32 + 1);
        let line = line.trim_ascii();
        let word_end = line.iter().position(|b| b.is_ascii_whitespace()).unwrap_or(line.len());
        let (word, rest) = line.split_at(word_end);
        let text = String::from_utf8_lossy(rest).trim().to_owned();
        if word == b"newmtl" {
            materials.push(ClassicMaterial {
                name: text,
                place,
                diffuse: Rgb::ZERO,
                specular: Rgb::ZERO,
                emissive: Rgb::ZERO,
                exponent: 0.0,
                dissolve: 1.0,
                ior: None,
                model: 2,
                diffuse_map: None,
                emissive_map: None,
                opacity_map: None,
                other_maps: Vec::new(),
            });
        } else if let Some(material) = materials.last_mut() {
            statement(material, word, rest, text).map_err(|what| SceneError::mesh(place, what))?;
        }
    }
    Ok(materials)
}

fn statement(material: &mut ClassicMaterial, word: &[u8], rest: &[u8], text: String) -> Result<(), String> {
    let number = || finite::<1>(rest).map(|[v]| v as f32);
    match word {
        b"Kd" => material.diffuse = colour(rest)?,
        b"Ks" => material.specular = colour(rest)?,
        b"Ke" => material.emissive = colour(rest)?,
        b"Ns" => material.exponent = number()?,
        b"d" => material.dissolve = number()?,
        b"Tr" => material.dissolve = 1.0 - number()?,
        b"Ni" => material.ior = Some(number()?),
        b"illum" => material.model = number()? as u32,
        b"map_Kd" => material.diffuse_map = Some(file_name(text)),
        b"map_Ke" => material.emissive_map = Some(file_name(text)),
        b"map_d" => material.opacity_map = Some(file_name(text)),
        b"map_Ks" | b"map_Ns" | b"map_bump" | b"map_Bump" | b"bump" | b"disp" | b"norm" => {
            material.other_maps.push(String::from_utf8_lossy(word).into_owned());
        }
        _ => {}
    }
    Ok(())
}

/// Returns the file name of a map. Options come before the name; without options the name may contain spaces.
fn file_name(text: String) -> String {
    let last = text.split_whitespace().last().unwrap_or_default().to_owned();
    if text.starts_with('-') { last } else { text }
}

/// Parses the first `N` numbers of a line.
fn finite<const N: usize>(rest: &[u8]) -> Result<[f64; N], String> {
    let numbers = obj::numbers(rest)?;
    match numbers.iter().find(|number| !(**number as f32).is_finite()) {
        Some(number) => Err(format!("the number {number} is not finite")),
        None => Ok(numbers),
    }
}

/// Parses three numbers, or one number as a grey.
fn colour(rest: &[u8]) -> Result<Rgb, String> {
    let three = finite::<3>(rest).map(|c| DVec3::from(c).as_vec3());
    three.or_else(|e| match rest.split(|b| b.is_ascii_whitespace()).filter(|t| !t.is_empty()).count() {
        1 => finite::<1>(rest).map(|[v]| Rgb::splat(v as f32)),
        _ => Err(e),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_are_read_and_errors_name_their_line() {
        let text = b"# made by hand\nnewmtl a b\nKd 0.1 0.2 0.3\r\nKs 0.5\nTr 0.25\nNs 10\nNi 1.4\nillum 7\n\
            map_Kd -s 2 2 1 wood.png\nmap_bump x.png\nnewmtl c\nmap_Kd my wood.png\n";
        let [a, c] = &read(text, Path::new("t.mtl")).unwrap()[..] else { panic!() };
        assert_eq!(
            (a.name.as_str(), a.diffuse, a.specular),
            ("a b", Rgb::new(0.1, 0.2, 0.3), Rgb::splat(0.5))
        );
        assert_eq!((a.dissolve, a.exponent, a.ior, a.model), (0.75, 10.0, Some(1.4), 7));
        assert_eq!((a.diffuse_map.as_deref(), a.other_maps.len()), (Some("wood.png"), 1));
        assert_eq!(c.diffuse_map.as_deref(), Some("my wood.png"));
        for bad in ["Kd 0.1 0.2", "Kd a b c", "Ns", "d x", "Ks nan", "d nan", "Ni inf", "Ke 1 2 1e39"] {
            let message =
                read(format!("newmtl a\n{bad}\n").as_bytes(), Path::new("t.mtl")).unwrap_err().to_string();
            assert!(message.starts_with("t.mtl:2:"), "{message}");
        }
    }
}
