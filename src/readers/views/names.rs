//! Names of the images of views, which stay inside of the output folder and differ from each other.

use crate::draft::DraftView;
use crate::error::{Location, Log};
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Extensions of images that names of data sets end in.
const IMAGES: [&str; 9] = ["png", "jpg", "jpeg", "exr", "webp", "tif", "tiff", "bmp", "hdr"];

/// Maximum number of bytes of a part of a name. File systems allow 255 with all extensions.
const MAX_PART: usize = 200;

/// Returns the name of the image of each view, which has a number in the list.
///
/// A path of a data set keeps its folders below the output folder, and loses the extension of an image. A note names
/// paths that lead elsewhere, and names that are used twice.
pub fn file_names(numbers: &[usize], views: &[DraftView], place: &Location, log: &mut Log) -> Vec<PathBuf> {
    let (mut taken, mut names) = (BTreeSet::new(), Vec::with_capacity(views.len()));
    let (mut outside, mut repeated) = (Vec::new(), Vec::new());
    for (number, view) in numbers.iter().zip(views) {
        let Parts { parts, leads_elsewhere } = parts_of(view);
        let name = if parts.is_empty() { format!("view_{number:04}") } else { parts.join("/") };
        if leads_elsewhere {
            outside.push((view.name.clone(), name.clone()));
        }
        let unique = if taken.insert(name.to_lowercase()) { name } else { numbered(&name, &mut taken) };
        if parts.join("/") != unique && !parts.is_empty() {
            repeated.push((view.name.clone(), unique.clone()));
        }
        names.push(PathBuf::from(unique));
    }
    report(&outside, "leads out of the output folder", place, log);
    report(&repeated, "is the name of another camera, too", place, log);
    names
}

/// Notes the first of some names with the name that is used instead, and how many there are.
fn report(changed: &[(String, String)], why: &str, place: &Location, log: &mut Log) {
    let Some((given, used)) = changed.first() else { return };
    let more =
        if changed.len() > 1 { format!(" ({} more like it)", changed.len() - 1) } else { String::new() };
    log.note(place, format!("\"{given}\" {why}{more}"), format!("the image is {used}"));
}

/// Returns the first name with a number that is not taken, and takes it. Names differ in more than their case.
fn numbered(name: &str, taken: &mut BTreeSet<String>) -> String {
    let mut number = 2;
    loop {
        let candidate = format!("{name}_{number}");
        if taken.insert(candidate.to_lowercase()) {
            return candidate;
        }
        number += 1;
    }
}

/// Folders and name of an image.
struct Parts {
    parts: Vec<String>,
    /// True if the path in the list is absolute or leads upwards.
    leads_elsewhere: bool,
}

fn parts_of(view: &DraftView) -> Parts {
    let name = view.name.trim();
    if !view.is_path {
        let part = part(&name.replace(['/', '\\'], "_"));
        return Parts { parts: part.into_iter().collect(), leads_elsewhere: false };
    }
    let mut leads_elsewhere = name.starts_with(['/', '\\']);
    let mut parts = Vec::new();
    for (index, piece) in name.split(['/', '\\']).enumerate() {
        let is_drive = index == 0 && piece.len() == 2 && piece.ends_with(':');
        leads_elsewhere |= piece == ".." || is_drive;
        if !is_drive && !matches!(piece, "." | "..") {
            parts.extend(part(piece));
        }
    }
    if let Some(last) = parts.last_mut()
        && let Some((stem, extension)) = last.rsplit_once('.')
        && !stem.is_empty()
        && IMAGES.contains(&extension.to_lowercase().as_str())
    {
        *last = stem.to_owned();
    }
    Parts { parts, leads_elsewhere }
}

/// Returns a part of a name without what file systems refuse; `None` if nothing is left.
fn part(text: &str) -> Option<String> {
    let is_refused = |c: char| c.is_control() || "<>:\"|?*".contains(c);
    let safe: String = text.chars().map(|c| if is_refused(c) { '_' } else { c }).collect();
    let mut end = safe.len().min(MAX_PART);
    while !safe.is_char_boundary(end) {
        end -= 1;
    }
    let safe = safe[..end].trim().trim_end_matches('.');
    (!safe.is_empty()).then(|| safe.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::DraftCamera;
    use std::path::{Component, Path};

    fn named(names: &[&str], is_path: bool) -> (Vec<String>, Vec<String>) {
        let camera = DraftCamera::default();
        let view = |name: &&str| DraftView { name: (*name).to_owned(), is_path, camera, resolution: None };
        let views: Vec<DraftView> = names.iter().map(view).collect();
        let mut log = Log::new(false);
        let numbers: Vec<usize> = (1..=names.len()).collect();
        let found = file_names(&numbers, &views, &Location::file(Path::new("t.json")), &mut log);
        let text = |path: PathBuf| path.to_str().unwrap().to_owned();
        let warnings = log.into_warnings().iter().map(ToString::to_string).collect();
        (found.into_iter().map(text).collect(), warnings)
    }

    #[test]
    fn paths_of_data_sets_keep_their_folders_and_lose_the_extension_of_an_image() {
        let (names, warnings) =
            named(&["./train/r_0", "images/0001.JPG", "a.b.png", "v1.2", "train\\x"], true);
        assert_eq!(names, ["train/r_0", "images/0001", "a.b", "v1.2", "train/x"]);
        assert!(warnings.is_empty(), "{warnings:?}");
        let (names, _) = named(&["Camera.001", "left/right", "Key.png"], false);
        assert_eq!(names, ["Camera.001", "left_right", "Key.png"]);
    }

    #[test]
    fn no_name_leads_out_of_the_folder_and_none_is_used_twice() {
        let (long, longer) = ("é".repeat(300), format!("{}/x", "y".repeat(300)));
        let given = [
            "/etc/passwd",
            "../../up.png",
            "a/../b",
            "C:\\a\\b",
            "..",
            "",
            "b",
            "B.png",
            "b_2",
            ".",
            "a\0b",
            &long,
            &longer,
            "x...",
            "a//b",
            "nul:|?",
        ];
        let (names, warnings) = named(&given, true);
        assert_eq!(
            names[..10],
            ["etc/passwd", "up", "a/b", "a/b_2", "view_0005", "view_0006", "b", "B_2", "b_2_2", "view_0010"]
        );
        let lowered: BTreeSet<String> = names.iter().map(|name| name.to_lowercase()).collect();
        assert_eq!(lowered.len(), given.len(), "{names:?}");
        for name in &names {
            let mut parts = Path::new(name).components();
            assert!(
                parts.all(|part| matches!(part, Component::Normal(text) if text.len() <= MAX_PART + 4)),
                "{name}"
            );
            assert!(!name.chars().any(|c| c.is_control() || c == ':'), "{name}");
        }
        assert_eq!(warnings.len(), 2, "{warnings:?}");
        assert!(
            warnings[0].contains("\"/etc/passwd\" leads out") && warnings[0].contains("4 more"),
            "{warnings:?}"
        );
        assert!(
            warnings[1].contains("another camera") && warnings[1].contains("the image is a/b_2"),
            "{warnings:?}"
        );
    }
}
