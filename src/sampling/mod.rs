//! Owen-scrambled Sobol points and the warps from the unit square.
