//! Text of JSON as values. Two values of one key in an object are an error, as a reader may take either.

use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};
use std::fmt::{self, Formatter};

/// Parses a text. Objects named `extras`, the data of applications, may repeat keys.
///
/// # Errors
/// An error about a repeated key is of the category `Data`; no other error is.
pub(crate) fn parse(text: &[u8]) -> Result<Value, serde_json::Error> {
    let mut parser = serde_json::Deserializer::from_slice(text);
    let value = UniqueKeys.deserialize(&mut parser)?;
    parser.end()?;
    Ok(value)
}

/// Builder of values whose objects have each key once.
struct UniqueKeys;

impl<'de> DeserializeSeed<'de> for UniqueKeys {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, parser: D) -> Result<Value, D::Error> {
        parser.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for UniqueKeys {
    type Value = Value;

    fn expecting(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_bool<E>(self, is_true: bool) -> Result<Value, E> {
        Ok(is_true.into())
    }

    fn visit_i64<E>(self, number: i64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_u64<E>(self, number: u64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_f64<E>(self, number: f64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_str<E>(self, text: &str) -> Result<Value, E> {
        Ok(text.into())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Value, A::Error> {
        let mut list = Vec::new();
        while let Some(element) = elements.next_element_seed(UniqueKeys)? {
            list.push(element);
        }
        Ok(list.into())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut members: A) -> Result<Value, A::Error> {
        let mut map = Map::new();
        while let Some(key) = members.next_key::<String>()? {
            if map.contains_key(&key) {
                return Err(A::Error::custom(format!(
                    "the key \"{key}\" is twice in one object; remove one"
                )));
            }
            let value =
                if key == "extras" { members.next_value()? } else { members.next_value_seed(UniqueKeys)? };
            map.insert(key, value);
        }
        Ok(map.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_as_written() {
        let text = r#"{"a": [null, true, -1, 18446744073709551615, 0.1, "ß\n", {"b": {}}], "extras": [1]}"#;
        assert_eq!(parse(text.as_bytes()).unwrap(), serde_json::from_str::<Value>(text).unwrap());
        assert!(parse(b"{} 1").unwrap_err().is_syntax());
    }

    #[test]
    fn repeated_keys_are_named_with_their_line() {
        let error = parse(b"{\"a\": [\n{\"b\": 1, \"c\": 2,\n\"b\": 1}]}").unwrap_err();
        assert!(error.is_data() && error.line() == 3, "{error}");
        assert!(error.to_string().contains("\"b\" is twice"), "{error}");
        assert!(parse(b"{\"a\": {\"extras\": {\"b\": 1, \"b\": 2}}}").is_ok());
        let deep = "[".repeat(200);
        assert!(!parse(deep.as_bytes()).unwrap_err().is_data());
    }
}
