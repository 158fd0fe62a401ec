//! Settings of the light pass.

use base::setting::{JudgedBy, settings};

/// Factors on their numbers that benchmarks try.
const FEWER: [f64; 4] = [1.0 / 16.0, 0.25, 1.0, 4.0];

settings! {
    /// Numbers of VPLs to create.
    pub struct LightPassSettings in "Lightcuts" {
        /// Virtual point lights on area lights and directions of the environment, about.
        ///
        /// Shared out among all area lights by power; each gets at least 256, of more than 1024 fewer.
        direct: u32 = 4096 => [
            .named("direct_vpls").at_least(1.0).scaled(&FEWER).judged_by(JudgedBy::Light).with(&[("direct", "cuts")])
        ];
        /// Virtual point lights where light is reflected, about, and at least those of 1024 paths; 0: direct light
        /// only.
        ///
        /// To a quarter of them where light of sky and sun comes in by openings and is aimed at them.
        indirect: u32 = 300_000 => [.named("vpls").at_least(0.0).scaled(&FEWER).judged_by(JudgedBy::Light)];
        /// Seed of the VPLs.
        seed: u32 = 0;
    }
}

/// Memory of a virtual light of emitted and of reflected light while its tree is built, in bytes, as measured.
const DIRECT_BYTES: u64 = 320;
const INDIRECT_BYTES: u64 = 220;

impl LightPassSettings {
    /// Memory that the virtual lights take, in bytes, about.
    pub fn expected_bytes(&self) -> u64 {
        u64::from(self.direct) * DIRECT_BYTES + u64::from(self.indirect) * INDIRECT_BYTES
    }
}

impl PartialEq for LightPassSettings {
    fn eq(&self, other: &LightPassSettings) -> bool {
        (self.direct, self.indirect, self.seed) == (other.direct, other.indirect, other.seed)
    }
}
