//! Typed access to an object's properties; a property that is asked for counts as supported.

use super::tree::{Object, Property};
use super::value::Value;
use crate::error::{Log, SceneError};
use glam::{DMat4, DVec3};

impl Object {
    /// Returns the property and marks it as used.
    pub fn property(&self, name: &str) -> Option<&Property> {
        // If a file gives a parameter twice, the last one counts.
        let found = self.properties.iter().rev().find(|p| p.name == name);
        found.inspect(|p| p.used.set(true))
    }

    pub fn has(&self, name: &str) -> bool {
        self.property(name).is_some() || self.children.iter().any(|c| c.name.as_deref() == Some(name))
    }

    fn typed<T>(
        &self,
        name: &str,
        kind: &str,
        get: impl Fn(&Value) -> Option<T>,
    ) -> Result<Option<T>, SceneError> {
        let Some(property) = self.property(name) else { return Ok(None) };
        let what = || format!("\"{name}\" of {} \"{}\" has the wrong type", self.tag, self.plugin);
        let wrong = || property.place.wrong(what(), format!("give a <{kind}>"));
        get(&property.value).map(Some).ok_or_else(wrong)
    }

    pub fn boolean(&self, name: &str, default: bool) -> Result<bool, SceneError> {
        let get = |v: &Value| if let Value::Boolean(b) = v { Some(*b) } else { None };
        Ok(self.typed(name, "boolean", get)?.unwrap_or(default))
    }

    pub fn float(&self, name: &str) -> Result<Option<f64>, SceneError> {
        let get = |v: &Value| match v {
            Value::Float(f) | Value::Spectrum(f) => Some(*f),
            Value::Integer(i) => Some(*i as f64),
            _ => None,
        };
        self.typed(name, "float", get)
    }

    pub fn integer(&self, name: &str) -> Result<Option<i64>, SceneError> {
        let get = |v: &Value| if let Value::Integer(i) = v { Some(*i) } else { None };
        self.typed(name, "integer", get)
    }

    pub fn string(&self, name: &str) -> Result<Option<String>, SceneError> {
        let get = |v: &Value| if let Value::String(s) = v { Some(s.clone()) } else { None };
        self.typed(name, "string", get)
    }

    pub fn vector(&self, name: &str) -> Result<Option<DVec3>, SceneError> {
        let get = |v: &Value| if let Value::Vector(p) = v { Some(*p) } else { None };
        self.typed(name, "point", get)
    }

    pub fn transform(&self, name: &str) -> Result<Option<DMat4>, SceneError> {
        let get = |v: &Value| if let Value::Transform(m) = v { Some(*m) } else { None };
        self.typed(name, "transform", get)
    }

    /// Returns a positive float.
    pub fn positive(&self, name: &str, default: f64) -> Result<f64, SceneError> {
        let value = self.float(name)?.unwrap_or(default);
        match self.property(name) {
            Some(p) if value <= 0.0 => {
                Err(p.place.wrong(format!("{name} is {value}"), "give a number above 0"))
            }
            _ => Ok(value),
        }
    }

    /// Marks parameters as supported, though nothing here depends on them.
    pub fn ignore(&self, names: &[&str]) {
        names.iter().for_each(|name| _ = self.property(name));
    }

    /// Warns of every property and child that was never asked for.
    pub fn report_unused(&self, log: &mut Log) -> Result<(), SceneError> {
        let of = || format!("of {} \"{}\" is not modelled", self.tag, self.plugin);
        for property in self.properties.iter().filter(|p| !p.used.replace(true)) {
            log.warn(&property.place, format!("\"{}\" {}", property.name, of()), "it is ignored")?;
        }
        for child in self.children.iter().filter(|c| !c.used.replace(true)) {
            let name = child.name.as_deref().unwrap_or("a child");
            log.warn(&child.place, format!("\"{name}\" {}", of()), "it is ignored")?;
        }
        Ok(())
    }
}
