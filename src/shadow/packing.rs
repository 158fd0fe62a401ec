//! What the rays of a packet have in common, and how they are best traced.

/// Why rays are asked for together.
///
/// Which rays share a packet decides what the packet is worth: `lightsplat bench shadow SCENE` shows by how much on
/// any scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packing {
    /// A ray by itself.
    Single,
    /// From neighbouring points to one light.
    Neighbours,
    /// From one point to lights close together.
    Cluster,
    /// Nothing in common: packets of such rays gain nothing.
    Unrelated,
}

impl Packing {
    /// All, in the order of their declaration.
    pub const ALL: [Packing; 4] =
        [Packing::Single, Packing::Neighbours, Packing::Cluster, Packing::Unrelated];

    /// Whether the packet is traversed as a bundle. Such packets start at the receivers: one that starts at a light and
    /// fans out loses some hits.
    #[inline]
    pub fn coherent(self) -> bool {
        matches!(self, Packing::Neighbours | Packing::Cluster)
    }

    /// Whether the rays are traced as packets at all.
    #[inline]
    pub fn packed(self) -> bool {
        self.coherent()
    }

    /// Name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Packing::Single => "single",
            Packing::Neighbours => "neighbours",
            Packing::Cluster => "cluster",
            Packing::Unrelated => "unrelated",
        }
    }
}
