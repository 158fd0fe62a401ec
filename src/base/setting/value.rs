//! Types of settings. Each value has a text, which users type and which `--help` and reports show.

use serde_json::{Value as Json, json};
use std::any::Any;
use std::fmt;
use std::sync::Arc;

/// A value of a setting.
pub trait Value: Assign {
    /// Returns the value as users type it; empty if it cannot be typed.
    fn text(&self) -> String;

    /// Parses a value from text.
    ///
    /// # Errors
    /// A description of the values expected. The value is unchanged then.
    fn parse(&mut self, text: &str) -> Result<(), String>;

    /// Returns all values, if they have names.
    fn choices(&self) -> &'static [Choice] {
        &[]
    }

    /// Returns the numbers of the value; none if values have names.
    fn numbers(&self) -> Vec<f64> {
        self.text().split(',').filter_map(|number| number.parse().ok()).collect()
    }

    /// Changes one of the numbers.
    fn put(&mut self, part: usize, number: f64) {
        let mut numbers: Vec<String> = self.numbers().iter().map(f64::to_string).collect();
        if let Some(old) = numbers.get_mut(part) {
            *old = number.to_string();
        }
        // The text has as many numbers as the type expects.
        let _ = self.parse(&numbers.join(","));
    }

    /// Returns the value for reports.
    fn json(&self) -> Json {
        let text = self.text();
        let number = |x: f64| if x.fract() == 0.0 && x.abs() < 1e15 { json!(x as i64) } else { json!(x) };
        match self.numbers()[..] {
            [] if text.is_empty() => Json::Null,
            [] => text.into(),
            [x] => number(x),
            ref several => several.iter().map(|&x| number(x)).collect(),
        }
    }
}

/// A value that was parsed, of the type of one setting.
#[derive(Clone)]
pub struct Parsed {
    text: String,
    value: Arc<dyn Any + Send + Sync>,
}

impl fmt::Debug for Parsed {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str(&self.text)
    }
}

/// Copies of values whose type is not known.
pub trait Assign {
    /// Returns a copy.
    fn parsed(&self) -> Parsed;

    /// Copies `parsed` if it has the same type; returns false if it has not.
    fn assign(&mut self, parsed: &Parsed) -> bool;
}

impl<T: Value + Copy + Send + Sync + 'static> Assign for T {
    fn parsed(&self) -> Parsed {
        Parsed { text: self.text(), value: Arc::new(*self) }
    }

    fn assign(&mut self, parsed: &Parsed) -> bool {
        let value = parsed.value.downcast_ref::<T>();
        if let Some(value) = value {
            *self = *value;
        }
        value.is_some()
    }
}

/// A value that has a name.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// Text that users type.
    pub name: &'static str,
    /// Documentation of the value.
    pub doc: &'static str,
}

impl Choice {
    /// Returns the text for users.
    pub fn help(&self) -> String {
        first_paragraph(self.doc)
    }
}

/// Implements [`Value`] for numbers: `$expected` describes the numbers expected, `$put` converts from `f64`.
macro_rules! number {
    ($($Number:ty, $expected:expr, $put:expr;)+) => {$(
        impl Value for $Number {
            fn text(&self) -> String {
                self.to_string()
            }

            fn parse(&mut self, text: &str) -> Result<(), String> {
                *self = text.parse().map_err(|_| $expected(text))?;
                Ok(())
            }

            fn put(&mut self, _: usize, number: f64) {
                *self = $put(number);
            }
        }
    )+};
}

number! {
    u32, |text| whole_number(text, u64::from(u32::MAX)), |x: f64| x.round() as u32;
    usize, |text| whole_number(text, usize::MAX as u64), |x: f64| x.round() as usize;
    f32, |_| "expected a number".to_owned(), |x: f64| x as f32;
    f64, |_| "expected a number".to_owned(), |x: f64| x;
}

/// Describes the whole numbers expected, with their range if `text` is a whole number out of it.
fn whole_number(text: &str, most: u64) -> String {
    match text.parse::<f64>() {
        Ok(number) if number.fract() == 0.0 => format!("expected a whole number from 0 to {most}"),
        _ => "expected a whole number".to_owned(),
    }
}

const SWITCH: [Choice; 2] = [Choice { name: "on", doc: "Enabled" }, Choice { name: "off", doc: "Disabled" }];
const AUTOMATIC: [Choice; 3] =
    [SWITCH[0], SWITCH[1], Choice { name: "auto", doc: "Enabled if it is faster" }];

impl Value for bool {
    fn text(&self) -> String {
        if *self { "on" } else { "off" }.to_owned()
    }

    fn parse(&mut self, text: &str) -> Result<(), String> {
        *self = match text {
            "on" => true,
            "off" => false,
            _ => return Err("expected on or off".to_owned()),
        };
        Ok(())
    }

    fn choices(&self) -> &'static [Choice] {
        &SWITCH
    }
}

/// On, off, or the faster of them.
impl Value for Option<bool> {
    fn text(&self) -> String {
        self.map_or("auto".to_owned(), |on| on.text())
    }

    fn parse(&mut self, text: &str) -> Result<(), String> {
        *self = match text {
            "on" => Some(true),
            "off" => Some(false),
            "auto" => None,
            _ => return Err("expected on, off or auto".to_owned()),
        };
        Ok(())
    }

    fn choices(&self) -> &'static [Choice] {
        &AUTOMATIC
    }
}

/// A number, or a default that the setting's text describes.
impl Value for Option<u32> {
    fn text(&self) -> String {
        self.map_or(String::new(), |number| number.to_string())
    }

    fn parse(&mut self, text: &str) -> Result<(), String> {
        let mut number = 0u32;
        *self = if text.is_empty() { None } else { Some(number.parse(text).map(|()| number)?) };
        Ok(())
    }
}

/// Minimum of optional shares, besides 0.
const MIN_SHARE: f32 = 1e-3;

/// A share of at least [`MIN_SHARE`], or 0 for none.
impl Value for Option<f32> {
    fn text(&self) -> String {
        self.unwrap_or(0.0).to_string()
    }

    fn parse(&mut self, text: &str) -> Result<(), String> {
        let mut number = 0f32;
        number.parse(text)?;
        if !(number == 0.0 || number >= MIN_SHARE) {
            return Err(format!("expected 0 for none, or at least {MIN_SHARE}"));
        }
        *self = (number > 0.0).then_some(number);
        Ok(())
    }
}

/// Two numbers.
impl Value for [f32; 2] {
    fn text(&self) -> String {
        self.map(|number| number.to_string()).join(",")
    }

    fn parse(&mut self, text: &str) -> Result<(), String> {
        let numbers: Option<Vec<f32>> = text.split(',').map(|s| s.trim().parse().ok()).collect();
        *self = numbers
            .and_then(|numbers| numbers.try_into().ok())
            .ok_or("expected two numbers like 0.3,0.5".to_owned())?;
        Ok(())
    }
}

/// Ranges of direct and of indirect light. A single range holds for both.
impl Value for [[f32; 2]; 2] {
    fn text(&self) -> String {
        self.map(|range| range.text()).join(",")
    }

    fn parse(&mut self, text: &str) -> Result<(), String> {
        let numbers: Option<Vec<f32>> = text.split(',').map(|s| s.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[a, b]) if a <= b => *self = [[a, b]; 2],
            Some(&[a, b, c, d]) if a <= b && c <= d => *self = [[a, b], [c, d]],
            _ => return Err("expected a range like 1.5,20, or two like 1.5,20,1.5,40".to_owned()),
        }
        Ok(())
    }
}

/// Returns the first paragraph of a documentation comment, as one line without the stop at its end.
pub fn first_paragraph(doc: &str) -> String {
    let lines: Vec<&str> = doc.lines().map(str::trim).take_while(|line| !line.is_empty()).collect();
    lines.join(" ").trim_end_matches('.').replace('`', "")
}
