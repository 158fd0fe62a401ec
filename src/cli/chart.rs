//! Columns drawn by characters.

/// Most columns of a chart, and its rows.
const COLUMNS: usize = 70;
const ROWS: usize = 6;

/// Parts of a column's last character, in eighths.
const PARTS: [char; 8] = [' ', '▁', '▂', '▃', '▄', '▅', '▆', '▇'];

/// Draws values of consecutive frames, from 0 to the greatest, each column the greatest of its frames; `frames` are the
/// first and the last. Nothing for none.
pub fn chart(title: &str, frames: [usize; 2], values: &[f64]) -> String {
    let most = values.iter().fold(0.0, |most: f64, value| most.max(*value));
    if most <= 0.0 {
        return String::new();
    }
    let count = values.len().min(COLUMNS);
    let column = |i: usize| {
        let of = &values[i * values.len() / count..(i + 1) * values.len() / count];
        of.iter().fold(0.0, |most: f64, value| most.max(*value)) / most * (8 * ROWS) as f64
    };
    let eighths: Vec<usize> = (0..count).map(|i| column(i).round() as usize).collect();
    let mut text = format!("{title}\n");
    for row in (0..ROWS).rev() {
        let label = match row {
            0 => "0.0".to_owned(),
            _ if row == ROWS - 1 => format!("{most:.1}"),
            _ => String::new(),
        };
        let part = |eighths: &usize| match eighths.saturating_sub(8 * row) {
            8.. => '█',
            rest => PARTS[rest],
        };
        let line: String = eighths.iter().map(part).collect();
        text += format!("{label:>8} │{line}").trim_end();
        text += "\n";
    }
    let [first, last] = frames.map(|frame| frame.to_string());
    text += &format!("{:9} {first}{last:>1$}\n", "", count.saturating_sub(first.len()).max(1 + last.len()));
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_high_as_the_greatest_of_their_values() {
        let drawn = chart("MiB", [3, 6], &[0.0, 1.0, 12.0, 6.5]);
        let expected = "MiB\n    12.0 │  █\n         │  █\n         │  █▂\n         │  ██\n         │  ██\n     0.0 │ ▄██\n";
        assert_eq!(drawn, format!("{expected}          3 6\n").replace("3 6", "3  6"));
        let many: Vec<f64> = (0..700).map(f64::from).collect();
        let drawn = chart("MiB", [1, 700], &many);
        let lines: Vec<&str> = drawn.lines().collect();
        assert_eq!(lines[1].chars().rfind(|c| *c != ' '), Some('█'));
        assert_eq!(lines[ROWS].chars().count(), 10 + COLUMNS);
        assert_eq!(lines[ROWS + 1].chars().count(), 10 + COLUMNS);
        assert_eq!(chart("MiB", [1, 2], &[0.0, 0.0]) + &chart("MiB", [0, 0], &[]), "");
    }
}
