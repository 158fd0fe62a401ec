//! Visibility of segments: offsets that keep a surface from shadowing itself, and batched queries.
