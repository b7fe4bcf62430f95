//! Automatic operation in Operate and in the lanes of the plan.

use azel::engine::automatic::{Doing, Operation};

/// Automatic operation that is on.
pub(crate) fn on(doing: &Doing) -> Operation {
    let on = serde_json::json!({
        "on": { "doing": doing, "failures": 0, "moved_at": null, "moves_since": null }
    });
    serde_json::from_value(on).unwrap()
}
