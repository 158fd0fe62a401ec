//! How the images of a question are rendered and judged.

use super::{
    Answer, Candidate, Errors, Question, Reference, Run, Shot, Study, StudyError, Subject, Truth, eye_samples,
};
use transport::paths::Estimand;

/// References and other images of a scene.
struct Standards {
    pixels: Option<Reference>,
    samples: Option<Reference>,
    others: Vec<Run>,
}

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
        let reference =
            |is_wanted: bool, estimand| is_wanted.then(|| self.reference(subject, estimand)).transpose();
        Ok(Standards {
            pixels: reference(question.error != Truth::None, Estimand::Pixels)?,
            samples: reference(question.error == Truth::PixelsAndEyeSamples, eye_samples())?,
            others: question.others.iter().map(|other| self.run(subject, other)).collect::<Result<_, _>>()?,
        })
    }

    fn shot(
        &self,
        subject: &Subject,
        candidate: &Candidate,
        question: &Question,
        standards: &Standards,
    ) -> Result<Shot, StudyError> {
        let Run { color, counted } = self.run(subject, candidate)?;
        let against = |reference: &Option<Reference>| {
            reference.as_ref().map(|reference| Errors::against(&color, reference)).transpose()
        };
        let errors = against(&standards.pixels)?.unwrap_or(Errors::UNKNOWN);
        let light = match candidate.whole_pixels() {
            true => Some(errors),
            false if candidate.method.estimand() == eye_samples() => against(&standards.samples)?,
            false => None,
        };
        let other = (question.compared_with)(candidate).and_then(|index| standards.others.get(index));
        let compared = other.map(|other| Errors::between(&color, &other.color)).transpose()?;
        let candidate = candidate.clone();
        let (value, load) = (subject.value, subject.load);
        Ok(Shot { candidate, value, load, counted, errors, light, compared })
    }
}
