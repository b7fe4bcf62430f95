//! Changes from one JSON value to the next.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// Max number of items that may leave the front of a list between two pictures. A list that loses
/// more is written whole.
const MAX_DROPPED: usize = 8;

/// Change of a value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) enum Patch {
    /// New value.
    #[serde(rename = "=")]
    Put(Value),
    /// Changes of fields of an object.
    #[serde(rename = "f")]
    Fields(BTreeMap<String, Patch>),
    /// Removed field.
    #[serde(rename = "-")]
    Gone,
    /// Changes of items of a list.
    #[serde(rename = "i")]
    Items(BTreeMap<usize, Patch>),
    /// Number of items removed at the front of a list, and new items at its end.
    #[serde(rename = "s")]
    Slide(usize, Vec<Value>),
}

/// Error of a patch that does not fit the value.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Misfit;

impl Patch {
    /// Returns the patch that turns `old` into `new`; `None` if they are equal.
    pub(super) fn difference(old: &Value, new: &Value) -> Option<Self> {
        match (old, new) {
            (Value::Object(old), Value::Object(new)) => {
                let mut fields = BTreeMap::new();
                for (name, new) in new {
                    let patch = match old.get(name) {
                        Some(old) => Self::difference(old, new),
                        None => Some(Self::Put(new.clone())),
                    };
                    fields.extend(patch.map(|patch| (name.clone(), patch)));
                }
                let removed = old.keys().filter(|name| !new.contains_key(*name));
                fields.extend(removed.map(|name| (name.clone(), Self::Gone)));
                (!fields.is_empty()).then_some(Self::Fields(fields))
            }
            (Value::Array(old), Value::Array(new)) => Self::between_lists(old, new),
            _ => (old != new).then(|| Self::Put(new.clone())),
        }
    }

    fn between_lists(old: &[Value], new: &[Value]) -> Option<Self> {
        if old == new {
            return None;
        }
        let slides = |dropped: &usize| {
            old.get(*dropped..).is_some_and(|values| !values.is_empty() && new.starts_with(values))
        };
        if let Some(dropped) = (0..=MAX_DROPPED).find(slides) {
            let put = new.iter().skip(old.len() - dropped);
            return Some(Self::Slide(dropped, put.cloned().collect()));
        }
        if old.len() != new.len() {
            return Some(Self::Put(new.into()));
        }
        let pairs = old.iter().zip(new).enumerate();
        let items =
            pairs.filter_map(|(index, (old, new))| Some((index, Self::difference(old, new)?)));
        Some(Self::Items(items.collect()))
    }

    /// Turns the old value into the new one.
    pub(super) fn apply(self, value: &mut Value) -> Result<(), Misfit> {
        match (self, value) {
            (Self::Put(new), value) => *value = new,
            (Self::Fields(fields), Value::Object(object)) => {
                for (name, patch) in fields {
                    match patch {
                        Self::Gone => drop(object.remove(&name)),
                        Self::Put(new) => drop(object.insert(name, new)),
                        patch => patch.apply(object.get_mut(&name).ok_or(Misfit)?)?,
                    }
                }
            }
            (Self::Items(items), Value::Array(list)) => {
                for (index, patch) in items {
                    patch.apply(list.get_mut(index).ok_or(Misfit)?)?;
                }
            }
            (Self::Slide(dropped, put), Value::Array(list)) => {
                if dropped > list.len() {
                    return Err(Misfit);
                }
                list.drain(..dropped);
                list.extend(put);
            }
            _ => return Err(Misfit),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use serde_json::json;

    use super::*;

    fn any_value() -> impl Strategy<Value = Value> {
        let leaf = prop_oneof![
            Just(Value::Null),
            any::<bool>().prop_map(Value::from),
            (0..4_i64).prop_map(Value::from),
            any::<f64>().prop_map(Value::from),
            "[a-b]{0,2}".prop_map(Value::from),
        ];
        leaf.prop_recursive(4, 40, 6, |inner| {
            prop_oneof![
                prop::collection::vec(inner.clone(), 0..6).prop_map(Value::from),
                prop::collection::hash_map("[a-c]", inner, 0..4)
                    .prop_map(|fields| Value::Object(fields.into_iter().collect())),
            ]
        })
    }

    /// Returns the patch after writing and reading it.
    fn written(patch: &Patch) -> Patch {
        serde_json::from_str(&serde_json::to_string(patch).unwrap()).unwrap()
    }

    proptest! {
        #[test]
        fn a_patch_makes_the_new_value_of_the_old(old in any_value(), new in any_value()) {
            let mut value = old.clone();
            if let Some(patch) = Patch::difference(&old, &new) {
                prop_assert_ne!(&old, &new);
                written(&patch).apply(&mut value).unwrap();
            }
            prop_assert_eq!(value, new);
        }

        #[test]
        fn a_patch_of_something_else_is_harmless(
            old in any_value(), new in any_value(), mut other in any_value()
        ) {
            if let Some(patch) = Patch::difference(&old, &new) {
                let _ = patch.apply(&mut other);
            }
        }
    }

    #[test]
    fn of_a_list_that_slides_only_what_is_new_is_written() {
        let (old, new) =
            (json!({"a": [1, 2, 3], "b": {"c": 0}}), json!({"a": [2, 3, 4], "b": {"c": 1}}));
        let patch = Patch::difference(&old, &new).unwrap();
        let text = serde_json::to_string(&patch).unwrap();
        assert_eq!(text, r#"{"f":{"a":{"s":[1,[4]]},"b":{"f":{"c":{"=":1}}}}}"#);
    }
}
