//! Points of plots.

use crate::front::front;

/// Colour of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    Red,
    Blue,
    Green,
    Orange,
    Purple,
    Olive,
    Steel,
    Grey,
    Plain,
}

/// All colours, the ones that differ most first: class in style sheets, and CSS colour on light and on dark ground.
pub const COLOURS: [(Colour, &str, [&str; 2]); 9] = [
    (Colour::Red, "red", ["#c8102e", "#ff6b6b"]),
    (Colour::Blue, "blue", ["#0969c3", "#58a6ff"]),
    (Colour::Green, "green", ["#0a7f5a", "#3fc38e"]),
    (Colour::Orange, "orange", ["#b35900", "#f0983e"]),
    (Colour::Purple, "purple", ["#8639a0", "#cf8ee8"]),
    (Colour::Olive, "olive", ["#5d7a1f", "#a9c95c"]),
    (Colour::Steel, "steel", ["#4a7fb5", "#79a9d6"]),
    (Colour::Grey, "grey", ["#a8a8a8", "#6e6e6e"]),
    (Colour::Plain, "plain", ["#222222", "#e6e6e6"]),
];

impl Colour {
    /// Returns the class in style sheets.
    pub fn class(self) -> &'static str {
        COLOURS[self as usize].1
    }
}

/// Points that a line joins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// No points.
    None,
    /// All points, in their order.
    All,
    /// The points that no other point of the series beats.
    Front,
}

/// Points of one colour.
#[derive(Clone)]
pub struct Series {
    /// Name in the legend; empty to name each point instead.
    pub name: String,
    pub colour: Colour,
    pub line: Line,
    pub points: Vec<Point>,
}

/// A point of a scatter plot.
#[derive(Clone)]
pub struct Point {
    /// Coordinates.
    pub x: f64,
    pub y: f64,
    /// Name, which may be empty.
    pub name: String,
}

impl Point {
    /// Returns true if the point lies on logarithmic axes.
    pub fn is_drawable(&self) -> bool {
        [self.x, self.y].iter().all(|v| v.is_finite() && *v > 0.0)
    }
}

impl Series {
    /// Returns the points that can be drawn.
    pub fn drawable(&self) -> impl Iterator<Item = &Point> {
        self.points.iter().filter(|point| point.is_drawable())
    }

    /// Returns the points that the line joins. The front is sorted by its first coordinate.
    pub fn joined(&self) -> Vec<(f64, f64)> {
        let points = self.drawable().map(|point| (point.x, point.y));
        match self.line {
            Line::None => Vec::new(),
            Line::All => points.collect(),
            Line::Front => front(points),
        }
    }
}
