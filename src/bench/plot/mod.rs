//! Plots in SVG: a chart of panels, each with points over two logarithmic axes.
//!
//! Colours are classes of a style sheet, which has a light and a dark palette.

mod chart;
mod panel;
mod series;

pub use chart::{Chart, Panel};
pub use series::{Colour, Line, Point, Series, front};
