//! Counters and stage times of a run.
