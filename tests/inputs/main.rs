//! Files that are read: valid ones, invalid ones, damaged ones.

mod corpus;
mod fuzz;
mod own_scenes;
mod shared_scenes;
mod sound;
