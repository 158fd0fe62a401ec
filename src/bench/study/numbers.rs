//! Formatting of figures.

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_three_digits() {
        let texts = [0.0, 1234.4, 45.67, 1.234, 0.0456, -0.5, 0.00012].map(figure);
        assert_eq!(texts, ["0", "1234", "45.7", "1.23", ".0456", "-.500", "1.2e-4"]);
        assert_eq!(
            (optional(None), seconds(123.4), seconds(1.234)),
            ("-".into(), "123".into(), "1.23".into())
        );
    }
}
