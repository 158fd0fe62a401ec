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

impl Colour {
    /// All colours, the ones that differ most first.
    pub const ALL: [Colour; 9] = [
        Colour::Red,
        Colour::Blue,
        Colour::Green,
        Colour::Orange,
        Colour::Purple,
        Colour::Olive,
        Colour::Steel,
        Colour::Grey,
        Colour::Plain,
    ];

    /// Returns the class in style sheets.
    pub fn class(self) -> &'static str {
        match self {
            Colour::Red => "red",
            Colour::Blue => "blue",
            Colour::Green => "green",
            Colour::Orange => "orange",
            Colour::Purple => "purple",
            Colour::Olive => "olive",
            Colour::Steel => "steel",
            Colour::Grey => "grey",
            Colour::Plain => "plain",
        }
    }

    /// Returns the CSS colours on light and on dark ground.
    pub fn shades(self) -> [&'static str; 2] {
        match self {
            Colour::Red => ["#c8102e", "#ff6b6b"],
            Colour::Blue => ["#0969c3", "#58a6ff"],
            Colour::Green => ["#0a7f5a", "#3fc38e"],
            Colour::Orange => ["#b35900", "#f0983e"],
            Colour::Purple => ["#8639a0", "#cf8ee8"],
            Colour::Olive => ["#5d7a1f", "#a9c95c"],
            Colour::Steel => ["#4a7fb5", "#79a9d6"],
            Colour::Grey => ["#a8a8a8", "#6e6e6e"],
            Colour::Plain => ["#222222", "#e6e6e6"],
        }
    }
}

/// Points of one colour.
#[derive(Clone)]
pub struct Series {
    /// Name in the legend; empty to name each point instead.
    pub name: String,
    /// Colour.
    pub colour: Colour,
    /// True if a line joins the points in their order.
    pub joined: bool,
    /// Points.
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

    /// Returns the points that no other point beats in both coordinates, by their first coordinate.
    pub fn front(&self) -> Vec<&Point> {
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
        let series = Series { name: String::new(), colour: Colour::Red, joined: true, points };
        let front: Vec<[f64; 2]> = series.front().iter().map(|p| [p.x, p.y]).collect();
        assert_eq!(front, [[1.0, 4.0], [3.0, 2.0]]);
    }
}
