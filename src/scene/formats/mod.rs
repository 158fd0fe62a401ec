//! Scene readers: native TOML and Mitsuba XML, one model.
