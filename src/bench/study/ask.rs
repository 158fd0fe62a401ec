//! How the images of a question are rendered and judged.

use super::{
    Answer, Candidate, Errors, Question, Reference, Run, Shot, Study, StudyError, Subject, Truth, eye_samples,
};
use std::rc::Rc;
use transport::paths::Estimand;

/// References and other images of a scene.
#[derive(Default)]
struct Standards {
    pixels: Option<Rc<Reference>>,
    samples: Option<Reference>,
    others: Vec<Run>,
}

/// First of the seeds over which errors are averaged.
const FIRST_SEED: u32 = 1000;

impl Study<'_> {
    /// Renders and judges the images of a question, scene by scene.
    pub fn ask(
        &self,
        question: Question,
        scenes: impl IntoIterator<Item = Result<Subject, StudyError>>,
    ) -> Result<Answer, StudyError> {
        let mut answer = Answer::to(&question);
        for subject in scenes {
            let subject = subject?;
            let standards = self.standards(&subject, &question)?;
            for candidate in question.images {
                answer.shots.push(self.shot(&subject, candidate, &question, &standards)?);
            }
            (answer.scene, answer.triangles) = (subject.name, subject.triangles);
            (answer.reference, answer.light_reference) = (standards.pixels, standards.samples);
        }
        Ok(answer)
    }

    fn standards(&self, subject: &Subject, question: &Question) -> Result<Standards, StudyError> {
        let mut standards = Standards::default();
        match question.error {
            Truth::None => {}
            Truth::Pixels => standards.pixels = Some(Rc::new(self.reference(subject, Estimand::Pixels)?)),
            Truth::PixelsAndEyeSamples => {
                standards.pixels = Some(Rc::new(self.reference(subject, Estimand::Pixels)?));
                standards.samples = Some(self.reference(subject, eye_samples())?);
            }
            Truth::Given(reference) => standards.pixels = Some(Rc::clone(reference)),
        }
        for other in question.others {
            standards.others.push(self.run(subject, other)?);
        }
        Ok(standards)
    }

    fn shot(
        &self,
        subject: &Subject,
        candidate: &Candidate,
        question: &Question,
        standards: &Standards,
    ) -> Result<Shot, StudyError> {
        let (mut errors, mut nonfinite) = (Vec::new(), 0);
        let mut last = None;
        for seed in 0..candidate.seeds.max(1) {
            let mut run = match candidate.seeds {
                0 => self.run(subject, candidate)?,
                _ => self.run_seed(subject, candidate, FIRST_SEED + seed)?,
            };
            let factor = (question.brightness)(subject.value);
            run.color.pixels.iter_mut().for_each(|p| *p = (p.as_dvec3() / factor).as_vec3());
            let reference = standards.pixels.as_ref();
            errors.push(reference.map_or(Ok(Errors::UNKNOWN), |r| Errors::against(&run.color, r))?);
            nonfinite += run.counted.nonfinite;
            last = Some(run);
        }
        let Run { color, counted } = last.ok_or(StudyError::Interrupted)?;
        let errors = Errors::mean(&errors);
        let samples = standards.samples.as_ref().filter(|_| candidate.method.estimand() == eye_samples());
        let light = match candidate.whole_pixels() {
            true => Some(errors),
            false => samples.map(|reference| Errors::against(&color, reference)).transpose()?,
        };
        let other = (question.compared_with)(candidate).and_then(|index| standards.others.get(index));
        let compared = other.map(|other| Errors::between(&color, &other.color)).transpose()?;
        let candidate = candidate.clone();
        let (value, load) = (subject.value, subject.load);
        Ok(Shot { candidate, value, load, counted, errors, light, compared, nonfinite })
    }
}
