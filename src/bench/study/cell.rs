//! Figures of tables, exact for programs and rounded for people.

use super::Bounded;
use serde::Serialize;
use serde_json::{Value, json};

/// A figure.
pub struct Cell {
    /// Exact value for programs.
    pub exact: Value,
    /// Rounded text for people.
    pub text: String,
}

impl Cell {
    /// Figure that was not measured. A table without any other figure in a column leaves the column out.
    pub const MISSING: Cell = Cell { exact: Value::Null, text: String::new() };

    /// Creates a cell of text.
    pub fn text(text: impl Into<String>) -> Cell {
        let text = text.into();
        Cell { exact: json!(text), text }
    }

    /// Creates a cell for programs alone.
    pub fn exact(value: impl Serialize) -> Cell {
        Cell { exact: json!(value), text: String::new() }
    }

    /// Creates a number, shown with three significant digits.
    pub fn figure(value: f64) -> Cell {
        Cell { exact: json!(value), text: figure(value) }
    }

    /// Creates a number that may be missing, then shown as a dash.
    pub fn optional(value: Option<f64>) -> Cell {
        Cell { exact: json!(value), text: optional(value) }
    }

    /// Creates a time.
    pub fn seconds(value: f64) -> Cell {
        Cell { exact: json!(value), text: seconds(value) }
    }
}

/// Formats a value with three significant digits.
pub fn figure(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        v if v >= 100.0 => format!("{value:.0}"),
        v if v >= 10.0 => format!("{value:.1}"),
        v if v >= 1.0 => format!("{value:.2}"),
        v if v >= 0.001 => {
            let text = format!("{:.*}", (2 - v.log10().floor() as i32) as usize, value);
            text.replacen("0.", ".", 1)
        }
        _ => format!("{value:.1e}"),
    }
}

/// Formats a value with three significant digits; a dash for `None`.
pub fn optional(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), figure)
}

/// Formats seconds.
pub fn seconds(value: f64) -> String {
    if value >= 100.0 { format!("{value:.0}") } else { format!("{value:.2}") }
}

/// Formats a time or ratio; a dash for `None`.
pub fn bounded(value: Option<Bounded>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| value.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_three_digits() {
        let texts = [0.0, 1234.4, 45.67, 1.234, 0.0456, -0.5, 0.00012].map(figure);
        assert_eq!(texts, ["0", "1234", "45.7", "1.23", ".0456", "-.500", "1.2e-4"]);
        let others = [optional(None), seconds(123.4), seconds(1.234)];
        assert_eq!(others, ["-", "123", "1.23"]);
    }
}
