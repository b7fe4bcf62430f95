//! Comparison of a read-back with a change.

use crate::{
    device::settings::{Access, Field, Group, Value, Values},
    protocol::satrak::Faults,
};

/// A group, as it was read back after a change.
pub(in crate::controller::satrak) struct Proof<'a> {
    pub(in crate::controller::satrak) group: &'static Group,
    /// Requested values.
    pub new: &'a Values,
    /// Values that the unit holds.
    pub(in crate::controller::satrak) unit_values: &'a Values,
    /// How far the unit's clock is ahead of the computer's, seconds.
    pub(in crate::controller::satrak) ahead_s: Option<f64>,
}

/// Returns the keys of the fields that do not hold the requested value.
pub(in crate::controller::satrak) type Differing = fn(&Proof<'_>) -> Vec<&'static str>;

/// Returns why the unit cannot work with what it holds.
pub(in crate::controller::satrak) type Judge = fn(Faults) -> Option<&'static str>;

impl Proof<'_> {
    /// The keys of the fields for which `is_held` is `false` of the new and the held value.
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

/// The held values must equal the new ones.
pub(super) fn plain(proof: &Proof<'_>) -> Vec<&'static str> {
    proof.differing(|field, new, current| field.kind.same(new, current))
}

/// No fault speaks against it.
pub(super) fn no_objection(_: Faults) -> Option<&'static str> {
    None
}
