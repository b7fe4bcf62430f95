//! What is written down comes back as it was.

use std::fmt::Debug;

use serde::{Serialize, de::DeserializeOwned};

/// Writes `value` down and reads it back. They are compared as `Debug` shows them, which
/// hides secrets: those alone are left out of what is written.
pub(crate) fn comes_back<T: Serialize + DeserializeOwned + Debug>(value: &T) -> T {
    let text = serde_json::to_string(value).unwrap_or_else(|error| panic!("{error}: {value:?}"));
    let back: T =
        serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}\n{value:?}"));
    assert_eq!(format!("{back:?}"), format!("{value:?}"), "{text}");
    back
}
