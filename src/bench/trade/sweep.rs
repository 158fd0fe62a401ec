//! Sweeps of single knobs, and the designed sample of all together.

use super::front::effect;
use super::knobs::Knob;
use super::verdict::{ERROR_TOLERANCE, TIME_TOLERANCE, course, verdict};
use super::{Candidate, Judge, KnobEffect, Point, Sort, StudyError, Sweep};
use base::sampling::Sampler;
use base::setting::JudgedBy;
use render::method::Method;

/// Seed of the designed sample.
const DESIGN: u32 = 1;

impl Judge<'_> {
    /// Varies a knob alone.
    pub fn sweep(&mut self, knob: &Knob) -> Result<Sweep, StudyError> {
        let mut levels = Vec::with_capacity(knob.levels.len());
        for level in &knob.levels {
            let mut method = knob.base;
            knob.turn(level, &mut method);
            let label = format!("{} {}", knob.name, level.text);
            let point = self.point(&Candidate::new(&*label, method), &label, Sort::Sweep)?;
            levels.push((level.text.clone(), point));
        }
        Ok(self.judged(&knob.name, levels, knob.judged_by))
    }

    /// Judges points from coarse to fine.
    pub fn judged(&self, knob: &str, levels: Vec<(String, usize)>, judged_by: JudgedBy) -> Sweep {
        let names: Vec<String> = levels.iter().map(|(text, _)| text.clone()).collect();
        let of = |figure: &dyn Fn(&Point) -> f64| -> Vec<f64> {
            levels.iter().map(|&(_, point)| figure(&self.points[point])).collect()
        };
        let error = course(&of(&|p| p.error(judged_by).unwrap_or(0.0)), &names, ERROR_TOLERANCE);
        let time = course(&of(&|p| p.seconds), &names, TIME_TOLERANCE);
        let verdict = verdict(&error, &time);
        Sweep { knob: knob.to_owned(), levels, error, time, verdict, judged_by }
    }

    /// Varies all knobs of the default together that have an effect on it and leave its samples unchanged.
    pub fn sample(&mut self, knobs: &[Knob]) -> Result<Vec<KnobEffect>, StudyError> {
        let default = Method::default();
        let matters =
            |knob: &&Knob| knob.judged_by != JudgedBy::Flip && knob.base.settings() == default.settings();
        let knobs: Vec<&Knob> = knobs.iter().filter(matters).collect();
        let mut places = vec![Vec::new(); knobs.len()];
        let (mut errors, mut times) = (Vec::new(), Vec::new());
        for index in 0..self.study.plan.samples {
            let mut sampler = Sampler::new(DESIGN, index);
            let mut method = default;
            let mut turned = Vec::new();
            for (knob, places) in knobs.iter().zip(&mut places) {
                let count = knob.levels.len();
                let level = ((f64::from(sampler.next_1d()) * count as f64) as usize).min(count - 1);
                knob.turn(&knob.levels[level], &mut method);
                if knob.level_of(&default) != Some(level) {
                    turned.push(format!("{} {}", knob.name, knob.levels[level].text));
                }
                places.push(level as f64 / (count - 1).max(1) as f64);
            }
            let candidate = Candidate::new(format!("sample {index}"), method);
            let point = self.point(&candidate, &turned.join("; "), Sort::Sample)?;
            errors.push(self.points[point].light.unwrap_or(0.0));
            times.push(self.points[point].seconds);
        }
        let of = |(knob, places): (&&Knob, &Vec<f64>)| KnobEffect {
            knob: knob.name.clone(),
            error: effect(places, &errors),
            time: effect(places, &times),
        };
        Ok(knobs.iter().zip(&places).map(of).collect())
    }
}
