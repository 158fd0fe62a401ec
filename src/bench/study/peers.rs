//! Figures of other programs, measured elsewhere.
//!
//! A file has a JSON object per line, for one image each. `docs/benchmarks.md` describes the fields.

use super::StudyError;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// Time and errors of an image of another program.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct PeerFigure {
    /// Program and method, which name a line of the chart.
    pub name: String,
    /// Name of the scene.
    pub scene: String,
    /// Settings of the image.
    #[serde(default)]
    pub label: String,
    /// Processor seconds over all threads, without loading the scene and building its acceleration structure.
    pub seconds: f64,
    /// PSNR of the displayed image, dB.
    pub psnr: Option<f64>,
    /// Relative mean square error.
    pub rel_mse: Option<f64>,
    /// Mean FLIP of the displayed image.
    pub flip: Option<f64>,
    /// Sentence on how the figures were measured, for the caption.
    pub note: Option<String>,
}

impl PeerFigure {
    /// Reads a file of figures.
    ///
    /// # Errors
    /// If the file cannot be read, or a line has no figures.
    pub fn read(path: &Path) -> Result<Vec<PeerFigure>, StudyError> {
        let file = path.display();
        let wrong = |line: usize, what: String| {
            let form = "a line is a JSON object with name, scene, seconds, and rel_mse or flip, see docs/benchmarks.md";
            StudyError::Input(format!("{file}:{}: {what}; {form}", line + 1))
        };
        let text = fs::read_to_string(path)
            .map_err(|error| StudyError::Input(format!("cannot read {file}: {error}")))?;
        let mut figures = Vec::new();
        for (i, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
            let figure: PeerFigure =
                serde_json::from_str(line).map_err(|error| wrong(i, error.to_string()))?;
            figure.check().map_err(|what| wrong(i, what))?;
            figures.push(figure);
        }
        if figures.is_empty() { Err(wrong(0, "the file has no figures".to_owned())) } else { Ok(figures) }
    }

    /// Checks that the figures can be drawn.
    fn check(&self) -> Result<(), String> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        if !positive(self.seconds) {
            return Err(format!("seconds are {}, which is not above 0", self.seconds));
        }
        match [self.rel_mse, self.flip] {
            [None, None] => Err("both rel_mse and flip are missing".to_owned()),
            errors if errors.into_iter().flatten().all(positive) => Ok(()),
            _ => {
                Err("an error is not above 0; leave it out if it is below the noise of the reference"
                    .to_owned())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_read_and_wrong_lines_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("others.jsonl");
        let read = |text: &str| {
            fs::write(&path, text).unwrap();
            PeerFigure::read(&path).map_err(|error| error.to_string())
        };
        let good = r#"{"name": "P", "scene": "knot", "seconds": 2, "flip": 0.04}"#;
        let found = read(&format!("{good}\n\n{good}\n")).unwrap();
        assert_eq!((found.len(), found[1].flip, &*found[1].label), (2, Some(0.04), ""));
        for (bad, said) in [
            (r#"{"name": "P", "scene": "knot", "seconds": 2}"#, "missing"),
            (r#"{"name": "P", "scene": "knot", "seconds": -1, "flip": 0.04}"#, "seconds are -1"),
            (r#"{"name": "P", "scene": "knot", "seconds": 1, "rel_mse": -0.1, "flip": 0.04}"#, "not above 0"),
            (r#"{"name": "P", "scene": "knot", "second": 1, "flip": 0.04}"#, "unknown field `second`"),
            ("[]", "invalid"),
        ] {
            let error = read(&format!("{good}\n{bad}\n")).unwrap_err();
            assert!(error.contains("others.jsonl:2: ") && error.contains(said), "{error}");
        }
        assert!(read("\n").unwrap_err().contains("no figures"));
        assert!(
            PeerFigure::read(&folder.path().join("none")).unwrap_err().to_string().contains("cannot read")
        );
    }
}
