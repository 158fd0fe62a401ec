//! Statistics as text and as JSON.

use super::{Counter, Stats};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// Returns the number; 0 without sign if it is displayed as 0.
fn unsigned_zero(x: f64) -> f64 {
    if x.abs() < 5e-7 { 0.0 } else { x }
}

impl Stats {
    /// Returns an aligned table: stage times first, then counters by group. The last column of the times is the share
    /// of the time of `threads` threads in which they worked.
    pub fn to_text(&self, threads: usize) -> String {
        let mut text = String::new();
        // Writing to a String cannot fail, hence the `let _`.
        if self.stages().next().is_some() {
            let _ = writeln!(text, "{:<34}{:>12}{:>12}{:>8}", "Time", "wall s", "CPU s", "busy %");
            for (stage, time) in self.stages() {
                let _ = writeln!(
                    text,
                    "  {:<32}{:>12.3}{:>12.3}{:>8.0}",
                    stage.name(),
                    time.wall_seconds,
                    time.cpu_seconds,
                    100.0 * time.busy(threads)
                );
            }
        }
        let mut last_group = None;
        for (key, counter) in self.counters() {
            let (group, name) = split(key);
            if last_group != Some(group) {
                let _ = writeln!(text, "{group}");
                last_group = Some(group);
            }
            let _ = match counter {
                Counter::Count(n) => writeln!(text, "  {name:<32}{:>12}", grouped(n)),
                Counter::Sum(x) => writeln!(text, "  {name:<32}{:>12.6}", unsigned_zero(x)),
                Counter::Distribution(d) if d.count == 0 => writeln!(text, "  {name:<32}{:>12}", "none"),
                Counter::Distribution(d) => writeln!(
                    text,
                    "  {name:<32}{:>12.2}  ({} to {}, of {})",
                    d.mean(),
                    grouped(d.min),
                    grouped(d.max),
                    grouped(d.count)
                ),
            };
        }
        text
    }

    /// Returns `{"times": {stage: {wall_seconds, cpu_seconds}}, "counters": {group: {name: value}}}`.
    pub fn to_json(&self) -> Value {
        let times: Map<String, Value> =
            self.stages().map(|(stage, time)| (stage.key().to_owned(), json!(time))).collect();
        let mut counters = Map::new();
        for (key, counter) in self.counters() {
            let (group, name) = split(key);
            let members = counters.entry(group).or_insert_with(|| json!({}));
            members[name] = match counter {
                Counter::Count(n) => json!(n),
                Counter::Sum(x) => json!(x),
                Counter::Distribution(d) if d.count == 0 => json!({ "count": 0 }),
                Counter::Distribution(d) => {
                    json!({ "count": d.count, "mean": d.mean(), "min": d.min, "max": d.max })
                }
            };
        }
        json!({ "times": times, "counters": counters })
    }
}

fn split(key: &str) -> (&str, &str) {
    key.split_once('/').unwrap_or(("Other", key))
}

/// Formats digits in groups of three: `1 234 567`.
fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::{Stage, StageTime};
    use super::*;

    fn example() -> Stats {
        let mut stats = Stats::new();
        stats.add_time(Stage::LightPass, StageTime { wall_seconds: 1.5, cpu_seconds: 3.0 });
        stats.count("Rays/shadow", 1_234_567);
        stats.count("Rays/eye", 12);
        stats.observe("Lightcut/cut size", 3);
        stats.observe("Lightcut/cut size", 6);
        stats.add("Light/flux [W]", 2.5);
        stats.add("Light/lost [W]", -1e-9);
        stats
    }

    #[test]
    fn text_groups_counters_under_one_heading() {
        let text = example().to_text(4);
        assert_eq!(text.matches("Rays\n").count(), 1, "{text}");
        assert!(text.contains("1 234 567"), "{text}");
        // Half of four threads worked.
        assert!(text.lines().any(|line| line.ends_with("1.500       3.000      50")), "{text}");
        assert!(text.contains("4.50  (3 to 6, of 2)"), "{text}");
        assert!(text.contains("light pass") && !text.contains("-0.0"), "{text}");
    }

    #[test]
    fn json_nests_by_group() {
        let json = example().to_json();
        assert_eq!(json["times"]["light_pass"]["cpu_seconds"], 3.0);
        assert_eq!(json["counters"]["Rays"]["shadow"], 1_234_567u64);
        assert_eq!(json["counters"]["Lightcut"]["cut size"]["mean"], 4.5);
        assert_eq!(json["counters"]["Light"]["flux [W]"], 2.5);
    }

    #[test]
    fn digits_are_grouped_from_the_right() {
        assert_eq!([0, 12, 999, 1000, 1_000_000].map(grouped), ["0", "12", "999", "1 000", "1 000 000"]);
    }
}
