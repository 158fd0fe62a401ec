//! Eye samples: what a pixel sees, through mirrors and glass.
