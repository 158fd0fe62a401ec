//! Light of an image by the technique that computed it.

use super::Stats;

/// Sums of luminance over the pixels of an unfinished image, by technique.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contributions(Vec<(&'static str, f64)>);

impl Contributions {
    /// Technique: photons by mirrors and smooth glass alone.
    pub const PHOTONS: &str = "photons through glass or by mirrors";

    /// Adds light computed by `technique`.
    pub fn add(&mut self, technique: &'static str, luminance: f64) {
        match self.0.iter_mut().find(|(known, _)| *known == technique) {
            Some((_, sum)) => *sum += luminance,
            None => self.0.push((technique, luminance)),
        }
    }

    /// Adds light computed by `technique`: the image's luminance, less all contributions so far.
    pub fn rest(&mut self, technique: &'static str, luminance: f64) {
        let known: f64 = self.0.iter().map(|(_, sum)| sum).sum();
        self.add(technique, luminance - known);
    }

    /// Reports the shares of all techniques, in per cent.
    pub fn report(&self, stats: &mut Stats) {
        let all: f64 = self.0.iter().map(|(_, sum)| sum).sum();
        if !(all > 0.0 && all.is_finite()) {
            return;
        }
        for (technique, sum) in self.0.iter().filter(|(_, sum)| *sum != 0.0) {
            stats.add(&format!("Light/by {technique} [%]"), 100.0 * sum / all);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Counter;

    #[test]
    fn shares_of_all_techniques_add_up_to_the_whole() {
        let mut contributions = Contributions::default();
        contributions.add("eye samples", 1.0);
        contributions.add(Contributions::PHOTONS, 0.0);
        contributions.add("eye samples", 1.0);
        contributions.rest("records", 3.0);
        contributions.rest("cuts", 8.0);
        let mut stats = Stats::new();
        contributions.report(&mut stats);
        let share = |technique: &str| stats.get(&format!("Light/by {technique} [%]"));
        assert_eq!(share("eye samples"), Some(Counter::Sum(25.0)));
        assert_eq!(share("records"), Some(Counter::Sum(12.5)));
        assert_eq!(share("cuts"), Some(Counter::Sum(62.5)));
        assert_eq!(share(Contributions::PHOTONS), None);
        let mut black = Stats::new();
        Contributions::default().report(&mut black);
        assert_eq!(black.get("Light/by eye samples [%]"), None);
    }
}
