//! Stores for host keys, old uploads and secrets.

use std::{fmt, sync::Arc};

use crate::transfer::{KeptFiles, Keyring, KnownHosts, Limits, MemoryKeyring, SystemKeyring};

/// Stores for host keys, old uploads and secrets, and timeouts for a unit.
#[derive(Clone)]
pub struct Places {
    /// Pinned host keys.
    pub known_hosts: KnownHosts,
    /// Previous files of all units.
    pub kept_files: KeptFiles,
    /// Secrets that the operator wants to save.
    pub keyring: Arc<dyn Keyring>,
    /// Secrets that last until the program ends.
    pub session: Arc<MemoryKeyring>,
    /// Timeouts of the steps.
    pub limits: Limits,
}

impl Places {
    /// Returns the places of this user; `None` on a machine without a home folder.
    pub fn of_this_user() -> Option<Self> {
        Some(Self {
            known_hosts: KnownHosts::of_this_user()?,
            kept_files: KeptFiles::of_this_user()?,
            keyring: Arc::new(SystemKeyring),
            session: Arc::default(),
            limits: Limits::default(),
        })
    }
}

impl fmt::Debug for Places {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { known_hosts, kept_files, limits, .. } = self;
        f.debug_struct("Places")
            .field("known_hosts", known_hosts)
            .field("kept", kept_files)
            .field("limits", limits)
            .finish_non_exhaustive()
    }
}
