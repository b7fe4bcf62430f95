//! Settings of a unit. The same groups of fields drive the forms, files and read-backs of
//! all controllers.

mod copy;
mod field;
mod group_state;
mod hindrance;
mod key;
mod points;
mod queue;
mod settings_write;
mod value;

pub use crate::secret::Secret;
pub use copy::{CopiedValue, CopyError, CopyHead, Difference, SettingsCopy, Verdict};
pub use field::{Access, Field, Group, Guard, Kind};
pub use group_state::{
    Change, GroupState, GroupStates, HeldGroup, ReadFailure, WriteError, WriteStep, Written,
};
pub use hindrance::Hindrance;
pub use key::Key;
pub(crate) use queue::ChangeQueue;
pub(crate) use settings_write::{SettingsWrite, WriteAction};
pub use value::number;
pub use value::{Unfit, Value, Values};
