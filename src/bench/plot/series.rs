//! Points of plots.

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

/// Returns the points that no other point beats in both coordinates, by the first coordinate.
pub fn front(points: impl IntoIterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = points.into_iter().collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut front: Vec<(f64, f64)> = Vec::new();
    for point in points {
        if front.last().is_none_or(|best| point.1 < best.1) {
            front.push(point);
        }
    }
    front
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let points = [(5.0, 1.0), (1.0, 4.0), (2.0, 2.0), (2.0, 3.0), (4.0, 1.0), (2.0, 2.0), (3.0, 5.0)];
        assert_eq!(front(points), [(1.0, 4.0), (2.0, 2.0), (4.0, 1.0)]);
        assert_eq!(front([]), []);
    }
}
