//! Serialization round trip.

use std::fmt::Debug;

use serde::{Serialize, de::DeserializeOwned};

/// Serializes `value`, reads it back and fails if the two differ. The function compares their
/// `Debug` texts, which hide secrets, because secrets are not serialized.
pub(crate) fn comes_back<T: Serialize + DeserializeOwned + Debug>(value: &T) -> T {
    let text = serde_json::to_string(value).unwrap_or_else(|error| panic!("{error}: {value:?}"));
    let back: T =
        serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}\n{value:?}"));
    assert_eq!(format!("{back:?}"), format!("{value:?}"), "{text}");
    back
}
