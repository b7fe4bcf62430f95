//! A user of this machine for the duration of a test.

use std::{
    io::Write as _,
    os::unix::fs::PermissionsExt as _,
    path::Path,
    process::{Command, Stdio},
    sync::atomic::{AtomicU32, Ordering},
};

pub(crate) const PASSWORD: &str = "correct-horse-battery";

static COUNT: AtomicU32 = AtomicU32::new(0);

pub(crate) struct User {
    pub(crate) name: String,
}

impl User {
    /// Creates a user with [`PASSWORD`] whose home is `home`.
    pub(crate) fn new(home: &Path) -> Self {
        let name = format!("azel{}x{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        run(Command::new("useradd").args(["-M", "-s", "/bin/sh", "-d"]).arg(home).arg(&name));
        let user = Self { name };
        let mut chpasswd = Command::new("chpasswd").stdin(Stdio::piped()).spawn().unwrap();
        writeln!(chpasswd.stdin.take().unwrap(), "{}:{PASSWORD}", user.name).unwrap();
        assert!(chpasswd.wait().unwrap().success());
        user
    }

    /// Makes the user the owner of `path`.
    pub(crate) fn own(&self, path: &Path) {
        run(Command::new("chown").arg(&self.name).arg(path));
    }
}

impl Drop for User {
    fn drop(&mut self) {
        // Some servers outlive their connection, so force the removal of the user.
        let _ = Command::new("userdel").args(["-f", &self.name]).output();
    }
}

/// Runs a command that must succeed; returns its output.
pub(crate) fn run(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// Creates a folder that every user may read.
pub(crate) fn open_folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::set_permissions(folder.path(), std::fs::Permissions::from_mode(0o755)).unwrap();
    folder
}
