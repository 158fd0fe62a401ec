//! Settings of the light pass.

/// Numbers of VPLs to create.
#[derive(Clone, Copy, Debug)]
pub struct LightPassSettings {
    /// Number of points divided among all area lights by power (each gets at least 256), and of directions of
    /// the environment.
    pub direct: u32,
    /// Number of indirect VPLs.
    pub indirect: u32,
    /// Seed of the VPLs.
    pub seed: u32,
}

impl Default for LightPassSettings {
    fn default() -> LightPassSettings {
        LightPassSettings { direct: 4096, indirect: 300_000, seed: 0 }
    }
}
