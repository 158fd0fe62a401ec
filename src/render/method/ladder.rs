//! The quality scale: settings that qualities and plans move together, as factors on the defaults, from cheap
//! to exact.
//!
//! In [`CUTS`] every level halves ε, on whose root the cost of cuts depends, and the virtual lights follow: a cut as
//! fine as ε asks is no use in a tree whose leaves are coarser. The levels are near the Pareto front of error against
//! time of the knot, nave and kitchen at 512 x 512. In [`DRAWN`] every level doubles the samples, since the noise of
//! direct light is most of the error; ε falls slowly, since coarse cuts cost more error than they spare time: their
//! errors are the same for many points, and no denoiser takes them off.

/// Number of levels of the scale.
pub const RUNGS: usize = 9;

/// A setting that moves.
#[derive(Debug)]
pub struct Move {
    /// Key of the setting.
    pub key: &'static str,
    /// True if it sets the fineness of cuts, false if the number of samples, virtual lights or patches.
    pub fine: bool,
    /// Factors on its default, from the cheapest level to the most exact.
    pub factors: [f64; RUNGS],
}

const EPSILON: [f64; RUNGS] = [50.0, 32.0, 16.0, 8.0, 4.0, 2.0, 1.0, 0.5, 0.25];

/// Of methods that light by cuts. Those that a method lacks do not count.
#[rustfmt::skip]
pub static CUTS: [Move; 6] = [
    Move { key: "spp", fine: false, factors: [0.25, 0.25, 0.5, 1.0, 1.0, 1.0, 2.0, 2.0, 4.0] },
    Move { key: "epsilon", fine: true, factors: EPSILON },
    Move { key: "max_cut", fine: true, factors: [0.01, 0.06, 0.25, 0.5, 1.0, 1.0, 2.0, 4.0, 8.0] },
    Move { key: "vpls", fine: false, factors: [0.016, 0.033, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0] },
    Move { key: "patches", fine: false, factors: [0.016, 0.0625, 0.125, 0.25, 0.25, 0.25, 0.5, 1.0, 2.0] },
    Move { key: "record_epsilon", fine: true, factors: EPSILON },
];

/// Of the cache where direct light is drawn: the defaults are level 4.
#[rustfmt::skip]
pub static DRAWN: [Move; 6] = [
    Move { key: "spp", fine: false, factors: [0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0] },
    Move { key: "epsilon", fine: true, factors: [12.0, 6.0, 3.0, 1.5, 1.0, 0.6, 0.4, 0.28, 0.2] },
    Move { key: "max_cut", fine: true, factors: [0.06, 0.125, 0.25, 0.5, 1.0, 1.0, 2.0, 4.0, 8.0] },
    Move { key: "vpls", fine: false, factors: [0.07, 0.12, 0.25, 0.5, 1.0, 1.4, 2.0, 3.0, 6.0] },
    Move { key: "patches", fine: false, factors: [0.125, 0.25, 0.5, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0] },
    Move { key: "record_epsilon", fine: true, factors: [16.0, 6.0, 3.0, 1.5, 1.0, 0.6, 0.4, 0.3, 0.2] },
];

/// Of path tracing, which has no other setting.
pub static PATHS: [Move; 1] = [Move {
    key: "spp",
    fine: false,
    factors: [0.00390625, 0.015625, 0.0625, 0.25, 1.0, 4.0, 16.0, 64.0, 256.0],
}];
