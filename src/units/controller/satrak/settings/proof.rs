//! Comparison of a read-back with a change.

use crate::{
    device::settings::{Access, Field, Group, Value, Values},
    protocol::satrak::Faults,
};

/// The values of a group that Azel has read back after a change.
pub(in crate::controller::satrak) struct Proof<'a> {
    pub(in crate::controller::satrak) group: &'static Group,
    /// Requested values.
    pub new: &'a Values,
    /// Values that the unit holds.
    pub(in crate::controller::satrak) unit_values: &'a Values,
    /// Lead of the unit's clock over the computer's, seconds.
    pub(in crate::controller::satrak) ahead_s: Option<f64>,
}

/// Function that returns the keys of the fields that do not hold the requested value.
pub(in crate::controller::satrak) type Differing = fn(&Proof<'_>) -> Vec<&'static str>;

/// Function that returns the reason why the unit cannot use its values.
pub(in crate::controller::satrak) type Judge = fn(Faults) -> Option<&'static str>;

impl Proof<'_> {
    /// Returns the keys of the fields for whose new and current value `is_held` is `false`.
    pub(super) fn differing(
        &self,
        is_held: impl Fn(&Field, &Value, &Value) -> bool,
    ) -> Vec<&'static str> {
        let differs = |field: &&Field| {
            let Some(new) = self.new.get(field.key) else { return false };
            !self.unit_values.get(field.key).is_some_and(|current| is_held(field, new, current))
        };
        let fields = self.group.fields.iter().filter(|field| field.access == Access::Edit);
        fields.filter(differs).map(|field| field.key).collect()
    }
}

/// Returns the keys of the fields whose current value differs from the new one.
pub(super) fn plain(proof: &Proof<'_>) -> Vec<&'static str> {
    proof.differing(|field, new, current| field.kind.same(new, current))
}

/// Returns `None`: no fault concerns the group.
pub(super) fn no_objection(_: Faults) -> Option<&'static str> {
    None
}
