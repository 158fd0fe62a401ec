//! Questions about images, declared as data, and the judged images of their answers.

use super::{Candidate, Cell, Counted, Errors, Reference};
use crate::plot::{Colour, Line};
use base::stats::Stage;

/// A question: which images, by which errors, in which table and figures.
#[derive(Clone, Copy)]
pub struct Question<'q> {
    /// Images of each scene, in the order of the table.
    pub images: &'q [Candidate],
    /// References that errors are measured against.
    pub error: Truth,
    /// Other images that images are compared with.
    pub others: &'q [Candidate],
    /// Returns the index of the other image that an image is compared with.
    pub compared_with: fn(&Candidate) -> Option<usize>,
    /// Columns of the table, a row per image. The first `names` columns hold text.
    pub table: &'static [Column<Shot>],
    pub names: usize,
    /// Heads of the columns that matter most. The others are folded away; none if all columns are shown.
    pub brief: &'static [&'static str],
    /// Figures.
    pub figures: &'static [Figure],
}

impl Question<'_> {
    /// Default of all fields: no images, over seconds, with a reference of pixels.
    pub const PLAIN: Question<'static> = Question {
        images: &[],
        error: Truth::Pixels,
        others: &[],
        compared_with: |_| None,
        table: &[],
        names: 1,
        brief: &[],
        figures: &[],
    };
}

/// References that errors are measured against.
#[derive(Clone, Copy, PartialEq)]
pub enum Truth {
    /// No reference: only times are measured.
    None,
    /// Reference of the scene's pixels.
    Pixels,
    /// References of the scene's pixels, and of the eye samples of methods that keep these.
    PixelsAndEyeSamples,
}

/// An image of a question with its time and errors.
pub struct Shot {
    /// Method and settings.
    pub candidate: Candidate,
    /// Value of the scene's quantity.
    pub value: f64,
    /// Processor seconds of loading the scene, if measured.
    pub load: Option<f64>,
    /// Counters and times.
    pub counted: Counted,
    /// Errors against the reference of pixels.
    pub errors: Errors,
    /// Errors of light: against the reference of pixels for methods that estimate whole pixels, and of eye samples for
    /// methods that keep these. `None` without such a reference.
    pub light: Option<Errors>,
    /// Errors against the other image that this one is compared with.
    pub compared: Option<Errors>,
}

/// A column of a table of records: its name for programs, its name for people, and its figure.
pub struct Column<R> {
    /// Key in JSON; empty in a column for people alone.
    pub key: &'static str,
    /// Head of the column; empty in a column for programs alone.
    pub head: &'static str,
    /// Returns the figure of a record.
    pub cell: fn(&Answer, &R) -> Cell,
}

impl<R> Column<R> {
    /// Declares a column.
    pub const fn new(key: &'static str, head: &'static str, cell: fn(&Answer, &R) -> Cell) -> Column<R> {
        Column { key, head, cell }
    }
}

/// A figure: an error of the images over their seconds, in a curve per group of images.
pub struct Figure {
    /// Name of its vertical axis.
    pub name: &'static str,
    /// Returns the error of an image, if it is measured.
    pub error: fn(&Shot) -> Option<f64>,
    /// Curves.
    pub curves: &'static [Curve],
}

/// A curve of a figure.
pub struct Curve {
    /// Name in the legend; empty to name each point instead.
    pub name: &'static str,
    /// Colour.
    pub colour: Colour,
    /// Points that a line joins.
    pub line: Line,
    /// Returns true for the images of the curve.
    pub holds: fn(&Candidate) -> bool,
}

impl Curve {
    /// Declares a curve.
    pub const fn of(name: &'static str, colour: Colour, line: Line, holds: fn(&Candidate) -> bool) -> Curve {
        Curve { name, colour, line, holds }
    }
}

/// Judged images of a question.
pub struct Answer {
    /// The question, without its images.
    pub question: Question<'static>,
    /// Name of the scene, the last of several.
    pub scene: String,
    /// Number of its triangles.
    pub triangles: usize,
    /// Reference that judges pixels.
    pub reference: Option<Reference>,
    /// Reference that judges eye samples.
    pub light_reference: Option<Reference>,
    /// Images, scene by scene.
    pub shots: Vec<Shot>,
}

impl Answer {
    /// Creates the answer to a question before its images are rendered.
    pub fn to(question: &Question) -> Answer {
        let Question { table, names, brief, figures, .. } = *question;
        Answer {
            question: Question { table, names, brief, figures, ..Question::PLAIN },
            scene: String::new(),
            triangles: 0,
            reference: None,
            light_reference: None,
            shots: Vec::new(),
        }
    }

    /// Finds an image by its label.
    pub fn find(&self, label: &str) -> Option<&Shot> {
        self.shots.iter().find(|shot| shot.candidate.label == label)
    }
}

impl Shot {
    /// Returns the processor seconds of all stages.
    pub fn seconds(&self) -> f64 {
        self.counted.seconds(&Stage::ALL)
    }
}
