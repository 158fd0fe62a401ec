//! What shines: emitting triangles, point, spot and directional lights, and the environment, sampled.
