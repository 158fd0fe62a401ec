//! Settings of the light pass.

/// Numbers of VPLs to make.
#[derive(Clone, Copy, Debug)]
pub struct LightPassSettings {
    /// Points shared out among all area lights by power (each gets at least 256), and directions of the environment.
    pub direct: u32,
    /// Indirect VPLs.
    pub indirect: u32,
    /// Another seed, other VPLs.
    pub seed: u32,
}

impl Default for LightPassSettings {
    fn default() -> LightPassSettings {
        LightPassSettings { direct: 4096, indirect: 300_000, seed: 0 }
    }
}
