//! Stage 2: VPLs clustered in trees, each cluster with bounds, cone, intensity and representative.
