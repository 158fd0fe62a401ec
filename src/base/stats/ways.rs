//! Light of a picture by the way it came there.

use super::Stats;

/// Sums of luminance over the pixels of a picture in the making, by way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ways(Vec<(&'static str, f64)>);

impl Ways {
    /// Photons that came by mirrors and smooth glass alone.
    pub const PHOTONS: &str = "photons through glass or by mirrors";

    /// Adds light that came by `way`.
    pub fn add(&mut self, way: &'static str, luminance: f64) {
        match self.0.iter_mut().find(|(known, _)| *known == way) {
            Some((_, sum)) => *sum += luminance,
            None => self.0.push((way, luminance)),
        }
    }

    /// Light that is not among the ways so far came by `way`; `luminance` is that of the whole picture.
    pub fn rest(&mut self, way: &'static str, luminance: f64) {
        let known: f64 = self.0.iter().map(|(_, sum)| sum).sum();
        self.add(way, luminance - known);
    }

    /// Reports the shares of all ways by which light came, in per cent.
    pub fn report(&self, stats: &mut Stats) {
        let all: f64 = self.0.iter().map(|(_, sum)| sum).sum();
        if !(all > 0.0 && all.is_finite()) {
            return;
        }
        for (way, sum) in self.0.iter().filter(|(_, sum)| *sum != 0.0) {
            stats.add(&format!("Light/by {way} [%]"), 100.0 * sum / all);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Counter;

    #[test]
    fn shares_of_all_ways_come_to_the_whole() {
        let mut ways = Ways::default();
        ways.add("eye samples", 1.0);
        ways.add(Ways::PHOTONS, 0.0);
        ways.add("eye samples", 1.0);
        ways.rest("records", 3.0);
        ways.rest("cuts", 8.0);
        let mut stats = Stats::new();
        ways.report(&mut stats);
        let share = |way: &str| stats.get(&format!("Light/by {way} [%]"));
        assert_eq!(share("eye samples"), Some(Counter::Sum(25.0)));
        assert_eq!(share("records"), Some(Counter::Sum(12.5)));
        assert_eq!(share("cuts"), Some(Counter::Sum(62.5)));
        assert_eq!(share(Ways::PHOTONS), None);
        let mut black = Stats::new();
        Ways::default().report(&mut black);
        assert_eq!(black.get("Light/by eye samples [%]"), None);
    }
}
