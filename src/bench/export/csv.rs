//! CSV (RFC 4180): one line per case, the same columns for all tables.

use crate::Report;

const HEAD: &str =
    "benchmark,scene,table,case,ratio,ratio low,ratio high,rate,rate low,rate high,unit,figures";

/// Returns a head, then a line per case.
pub fn csv(report: &Report) -> String {
    let mut text = format!("{HEAD}\r\n");
    for table in &report.tables {
        for row in &table.rows {
            let figures = table.figures.iter().zip(&row.figures);
            let figures: Vec<String> =
                figures.filter_map(|(name, value)| value.map(|v| format!("{name}={v}"))).collect();
            let (ratio, rate) = (&row.ratio, &row.rate);
            let numbers = [ratio.median, ratio.low, ratio.high, rate.median, rate.low, rate.high];
            let mut fields = vec![
                report.benchmark.clone(),
                report.scene.clone().unwrap_or_default(),
                table.title.clone(),
                row.labels.join("; "),
            ];
            fields.extend(numbers.map(|n| n.to_string()));
            fields.extend([table.unit.clone(), figures.join("; ")]);
            text += &fields.iter().map(|f| quoted(f)).collect::<Vec<_>>().join(",");
            text += "\r\n";
        }
    }
    text
}

fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
