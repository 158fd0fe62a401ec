//! Plots in SVG: ratios as bars, points over two logarithmic axes, and a chart of several such panels.
//!
//! Colours are classes of a style sheet, which has a light and a dark palette. Pages hold plots as elements; files of
//! their own are made by [`standalone`].

mod axis;
mod bars;
mod chart;
mod panel;
mod series;
mod style;

pub use bars::bars;
pub use chart::{Chart, Panel};
pub use panel::scatter;
pub use series::{Colour, Point, Series};
pub use style::{page_style, standalone};
