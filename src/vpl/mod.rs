//! Stage 1: lights and photon paths become virtual point lights (VPLs).
