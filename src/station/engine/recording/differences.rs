//! Differences between two JSON values.

use serde::Serialize;
use serde_json::Value;

/// Value that has changed.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct Difference<'a> {
    /// Place of the value, such as `antenna[0].beam_width_deg`.
    place: String,
    was: Option<&'a Value>,
    is: Option<&'a Value>,
}

/// Returns all values in which `is` differs from `was`.
pub(super) fn differences<'a>(was: &'a Value, is: &'a Value) -> Vec<Difference<'a>> {
    let mut found = Vec::new();
    compare(String::new(), Some(was), Some(is), &mut found);
    found
}

fn compare<'a>(
    place: String,
    was: Option<&'a Value>,
    is: Option<&'a Value>,
    found: &mut Vec<Difference<'a>>,
) {
    match (was, is) {
        (Some(Value::Object(before)), Some(Value::Object(now))) => {
            let added = now.keys().filter(|key| !before.contains_key(*key));
            for key in before.keys().chain(added) {
                let place = if place.is_empty() { key.clone() } else { format!("{place}.{key}") };
                compare(place, before.get(key), now.get(key), found);
            }
        }
        (Some(Value::Array(before)), Some(Value::Array(now))) => {
            for index in 0..before.len().max(now.len()) {
                let place = format!("{place}[{index}]");
                compare(place, before.get(index), now.get(index), found);
            }
        }
        (was, is) if was != is => found.push(Difference { place, was, is }),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn each_changed_value_is_named_by_its_place() {
        let was = json!({ "name": "A", "site": { "lat": 1.0, "lon": 2.0 }, "list": [1, 2] });
        let is = json!({ "name": "A", "site": { "lat": 1.5, "lon": 2.0 }, "list": [1], "new": 3 });
        let found = differences(&was, &is);
        let places: Vec<&str> = found.iter().map(|difference| &*difference.place).collect();
        assert_eq!(places, ["list[1]", "site.lat", "new"]);
        assert_eq!((found[1].was, found[1].is), (Some(&json!(1.0)), Some(&json!(1.5))));
        assert_eq!((found[0].is, found[2].was), (None, None));
        assert_eq!(differences(&was, &was), []);
    }
}
