//! Bindings to Embree 4.
