//! Settings of the light pass.

use base::setting::{JudgedBy, settings};

/// Factors on the numbers of VPLs that benchmarks try.
const FACTORS: [f64; 4] = [1.0 / 16.0, 0.25, 1.0, 4.0];

settings! {
    /// Numbers of VPLs to create.
    pub struct LightPassSettings in "Lightcuts" {
        /// Approximate number of virtual point lights for direct light, on area lights and in the environment.
        ///
        /// Area lights share the number by power. Each has at least 256; fewer if there are more than 1024 lights.
        direct: u32 = 4096 => [
            .named("direct_vpls").at_least(1.0).scaled(&FACTORS).judged_by(JudgedBy::Light).with(&[("direct", "cuts")])
        ];
        /// Approximate number of virtual point lights for indirect light, from at least 1024 light paths. 0 computes
        /// only direct light.
        ///
        /// Photons are aimed at openings through which light of sky and sun enters.
        indirect: u32 = 300_000 => [.named("vpls").at_least(0.0).scaled(&FACTORS).judged_by(JudgedBy::Light)];
        /// Seed of the VPLs.
        seed: u32 = 0;
    }
}

/// Memory per VPL of emitted light while its tree is built, bytes.
const DIRECT_BYTES: u64 = 320;

/// Memory per VPL of reflected light while its tree is built, bytes.
const INDIRECT_BYTES: u64 = 220;

impl LightPassSettings {
    /// Approximate memory of the VPLs and their trees, bytes.
    pub fn expected_bytes(&self) -> u64 {
        u64::from(self.direct) * DIRECT_BYTES + u64::from(self.indirect) * INDIRECT_BYTES
    }
}

impl PartialEq for LightPassSettings {
    fn eq(&self, other: &LightPassSettings) -> bool {
        (self.direct, self.indirect, self.seed) == (other.direct, other.indirect, other.seed)
    }
}
