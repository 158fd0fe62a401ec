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
    pub fn joined(&self) -> Vec<&Point> {
        match self.line {
            Line::None => Vec::new(),
            Line::All => self.drawable().collect(),
            Line::Front => self.front(),
        }
    }

    /// Returns the points that no other point beats in both coordinates.
    fn front(&self) -> Vec<&Point> {
        let mut points: Vec<&Point> = self.drawable().collect();
        points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let mut front: Vec<&Point> = Vec::new();
        for point in points {
            if front.last().is_none_or(|best| point.y < best.y) {
                front.push(point);
            }
        }
        front
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let point = |x, y| Point { x, y, name: String::new() };
        let points =
            vec![point(3.0, 2.0), point(1.0, 4.0), point(2.0, 5.0), point(0.0, 9.0), point(4.0, 2.0)];
        let series = Series { name: String::new(), colour: Colour::Red, line: Line::Front, points };
        let front: Vec<[f64; 2]> = series.front().iter().map(|p| [p.x, p.y]).collect();
        assert_eq!(front, [[1.0, 4.0], [3.0, 2.0]]);
    }
}
