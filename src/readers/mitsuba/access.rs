//! Typed access to the properties of an object. Any property that is asked for counts as supported.

use super::statements::fate_of_parameter;
use super::tree::{Object, ObjectProperty};
use super::value::PropertyValue;
use crate::error::{Log, SceneError};
use crate::statements::Fate;
use glam::{DMat4, DVec3};

impl Object {
    /// Returns the property and marks it as used.
    pub fn property(&self, name: &str) -> Option<&ObjectProperty> {
        // The last value counts if a file gives a parameter twice.
        let last = self.properties.iter().rev().find(|p| p.name == name);
        last.inspect(|p| p.used.set(true))
    }

    pub fn has(&self, name: &str) -> bool {
        self.property(name).is_some() || self.children.iter().any(|c| c.name.as_deref() == Some(name))
    }

    fn typed<T>(
        &self,
        name: &str,
        kind: &str,
        get: impl Fn(&PropertyValue) -> Option<T>,
    ) -> Result<Option<T>, SceneError> {
        let Some(property) = self.property(name) else { return Ok(None) };
        let what = || format!("\"{name}\" of {} \"{}\" has the wrong type", self.tag, self.plugin);
        let wrong = || property.place.wrong(what(), format!("give a <{kind}>"));
        get(&property.value).map(Some).ok_or_else(wrong)
    }

    pub fn boolean(&self, name: &str, default: bool) -> Result<bool, SceneError> {
        let get = |v: &PropertyValue| if let PropertyValue::Boolean(b) = v { Some(*b) } else { None };
        Ok(self.typed(name, "boolean", get)?.unwrap_or(default))
    }

    pub fn float(&self, name: &str) -> Result<Option<f64>, SceneError> {
        let get = |v: &PropertyValue| match v {
            PropertyValue::Float(f) | PropertyValue::Spectrum(f) => Some(*f),
            PropertyValue::Integer(i) => Some(*i as f64),
            _ => None,
        };
        self.typed(name, "float", get)
    }

    pub fn integer(&self, name: &str) -> Result<Option<i64>, SceneError> {
        let get = |v: &PropertyValue| if let PropertyValue::Integer(i) = v { Some(*i) } else { None };
        self.typed(name, "integer", get)
    }

    pub fn string(&self, name: &str) -> Result<Option<String>, SceneError> {
        let get = |v: &PropertyValue| if let PropertyValue::String(s) = v { Some(s.clone()) } else { None };
        self.typed(name, "string", get)
    }

    pub fn vector(&self, name: &str) -> Result<Option<DVec3>, SceneError> {
        let get = |v: &PropertyValue| if let PropertyValue::Vector(p) = v { Some(*p) } else { None };
        self.typed(name, "point", get)
    }

    pub fn transform(&self, name: &str) -> Result<Option<DMat4>, SceneError> {
        Ok(self.transforms(name)?.map(|[matrix, _]| matrix))
    }

    /// Returns a transform, and the one with a scale of 1 in place of each scale of 0.
    pub fn transforms(&self, name: &str) -> Result<Option<[DMat4; 2]>, SceneError> {
        let get = |v: &PropertyValue| match v {
            PropertyValue::Transform(transforms) => Some(**transforms),
            _ => None,
        };
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

    /// Warns of every property and child that no converter has asked for, except for those without effect.
    pub fn report_unused(&self, log: &mut Log) -> Result<(), SceneError> {
        let of = || format!("of {} \"{}\" is not supported", self.tag, self.plugin);
        let matters = |name: &str| fate_of_parameter(&self.tag, &self.plugin, name) != Fate::NoEffect;
        let unused = self.properties.iter().filter(|p| !p.used.replace(true));
        for property in unused.filter(|p| matters(&p.name)) {
            log.warn(&property.place, format!("\"{}\" {}", property.name, of()), "it is ignored")?;
        }
        for child in self.children.iter().filter(|c| !c.used.replace(true)) {
            let name = child.name.as_deref().map_or("a child".to_owned(), |name| format!("\"{name}\""));
            log.warn(&child.place, format!("{name} {}", of()), "it is ignored")?;
        }
        Ok(())
    }
}
