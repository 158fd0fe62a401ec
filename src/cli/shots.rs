//! Images of a walk job: the frames of the scene's camera path, or the views of a list. Both are numbered from 1.

use readers::ViewList;
use render::walk::{FileNames, FrameList};
use std::path::{Path, PathBuf};

/// Images of a walk job.
#[derive(Debug)]
pub enum Shots {
    /// Frames of the camera path, with the names of their files.
    Path(FileNames),
    /// Views of a list.
    Views(Box<ViewFiles>),
}

/// Views of a list, and the folder of their files.
#[derive(Debug)]
pub struct ViewFiles {
    /// The list.
    pub list: ViewList,
    /// Folder of the images.
    pub folder: PathBuf,
    /// True if each PNG file is exposed by itself.
    pub exposes_each: bool,
}

impl Shots {
    /// Returns the main file of an image: OpenEXR, or a PNG file alone.
    pub fn file(&self, number: usize) -> PathBuf {
        match self {
            Shots::Path(names) => names.file(number),
            Shots::Views(views) => views.exr(number),
        }
    }

    /// Returns the file of the table of ids.
    pub fn ids(&self) -> PathBuf {
        match self {
            Shots::Path(names) => names.pattern().with_extension("ids.json"),
            Shots::Views(views) => views.folder.join("ids.json"),
        }
    }

    /// Returns the names of all files for users.
    pub fn name(&self) -> String {
        match self {
            Shots::Path(names) => names.pattern().display().to_string(),
            Shots::Views(views) => views.folder.display().to_string(),
        }
    }

    /// Returns the word for an image.
    pub fn noun(&self) -> &'static str {
        match self {
            Shots::Path(_) => "frame",
            Shots::Views(_) => "view",
        }
    }

    /// Returns the name of an image in messages.
    pub fn label(&self, number: usize) -> String {
        match self {
            Shots::Path(_) => format!("frame {number}"),
            Shots::Views(views) => format!("view {number} ({})", views.title(number)),
        }
    }

    /// Returns the views, if the images are views of a list.
    pub fn views(&self) -> Option<&ViewFiles> {
        match self {
            Shots::Path(_) => None,
            Shots::Views(views) => Some(views),
        }
    }
}

impl ViewFiles {
    /// Returns the number of the last view in the list.
    pub fn last(&self) -> usize {
        self.list.numbers().last().copied().unwrap_or(0)
    }

    /// Returns the numbers of the views that can be rendered, in the order of `only`.
    pub fn numbers(&self, only: Option<&FrameList>) -> Vec<usize> {
        let all = self.list.numbers();
        let known =
            |list: &FrameList| list.iter().filter(|number| all.binary_search(number).is_ok()).collect();
        only.map_or_else(|| all.to_owned(), known)
    }

    /// Returns the name of a view: the path of its image in the folder, without extension.
    pub fn title(&self, number: usize) -> String {
        self.file_name(number).display().to_string()
    }

    fn file_name(&self, number: usize) -> &Path {
        let place = self.list.numbers().binary_search(&number).ok();
        let name = place.and_then(|index| self.list.file_names().get(index));
        name.map_or(Path::new(""), PathBuf::as_path)
    }

    /// Returns the OpenEXR file of a view. A name may contain full stops, which are no extension.
    pub fn exr(&self, number: usize) -> PathBuf {
        let mut name = self.folder.join(self.file_name(number)).into_os_string();
        name.push(".exr");
        name.into()
    }
}
