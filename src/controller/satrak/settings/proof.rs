//! What a read-back proves.

use crate::{
    device::settings::{Access, Field, Group, Value, Values},
    protocol::satrak::Faults,
};

/// What a group was read back with after a change.
pub(in crate::controller::satrak) struct Proof<'a> {
    /// The group.
    pub(in crate::controller::satrak) group: &'static Group,
    /// What was asked for.
    pub(in crate::controller::satrak) new: &'a Values,
    /// What the unit holds.
    pub(in crate::controller::satrak) held: &'a Values,
    /// How far the unit's clock is ahead of ours, seconds.
    pub(in crate::controller::satrak) ahead_s: Option<f64>,
}

/// The keys of the fields that do not hold what was asked for.
pub(in crate::controller::satrak) type Differing = fn(&Proof<'_>) -> Vec<&'static str>;

/// Why the unit cannot work with what it holds, in words.
pub(in crate::controller::satrak) type Judge = fn(Faults) -> Option<&'static str>;

impl Proof<'_> {
    /// The keys of the fields for which `is_held` says no to the new and the
    /// held value.
    pub(super) fn differing(
        &self,
        is_held: impl Fn(&Field, &Value, &Value) -> bool,
    ) -> Vec<&'static str> {
        let differs = |field: &&Field| {
            let Some(new) = self.new.get(field.key) else { return false };
            !self.held.get(field.key).is_some_and(|held| is_held(field, new, held))
        };
        let fields = self.group.fields.iter().filter(|field| field.access == Access::Edit);
        fields.filter(differs).map(|field| field.key).collect()
    }
}

/// The new values are the held ones.
pub(super) fn plain(proof: &Proof<'_>) -> Vec<&'static str> {
    proof.differing(|field, new, held| field.kind.same(new, held))
}

/// Nothing is known that would speak against it.
pub(super) fn no_objection(_: Faults) -> Option<&'static str> {
    None
}
