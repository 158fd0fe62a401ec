//! Properties of every kind of material.
