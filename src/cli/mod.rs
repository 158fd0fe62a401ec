//! The command line: what was typed becomes a validated job.
