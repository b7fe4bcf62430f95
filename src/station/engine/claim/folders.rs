//! Folders in which processes keep lock files and sockets.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// Folder of the service on this machine; systemd creates it for the service.
#[cfg(unix)]
const SERVICE_FOLDER: &str = "/run/azel";

/// Folder for lock files and a socket of this process.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LockFolder {
    pub path: PathBuf,
    /// Group that may pass through the folder to the socket.
    pub group: Option<u32>,
}

impl LockFolder {
    /// Creates the folder if it is missing, and restricts access to it.
    pub(in crate::engine) fn make(&self) -> io::Result<()> {
        let mut builder = fs::DirBuilder::new();
        builder.recursive(true);
        #[cfg(unix)]
        std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
        builder.create(&self.path)?;
        // An existing folder may be open to others.
        #[cfg(unix)]
        {
            use std::os::unix::fs::{PermissionsExt as _, chown};
            if self.group.is_some() {
                chown(&self.path, None, self.group)?;
            }
            let mode = if self.group.is_some() { 0o710 } else { 0o700 };
            fs::set_permissions(&self.path, fs::Permissions::from_mode(mode))?;
        }
        Ok(())
    }
}

/// All lock folders of a process.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LockFolders {
    /// Folders for this process's locks. The first folder must work and also has the socket. The
    /// others announce the process to processes in other environments.
    pub own: Vec<LockFolder>,
    /// Folders in which only other processes keep locks.
    pub others: Vec<PathBuf>,
}

impl LockFolders {
    /// Returns the folders of this user, or `None` without a home folder. Processes without
    /// `XDG_RUNTIME_DIR`, such as cron jobs, share the data folder with the others.
    pub fn of_user() -> Option<Self> {
        let dirs = directories::ProjectDirs::from("", "", "azel")?;
        let runtime = dirs.runtime_dir().map(Path::to_path_buf);
        let paths = runtime.into_iter().chain([dirs.data_dir().join("run")]);
        let own: Vec<LockFolder> = paths.map(|path| LockFolder { path, group: None }).collect();
        #[cfg(unix)]
        let others = {
            // Processes of a log-in session keep their locks in this folder.
            let log_in = format!("/run/user/{}/azel", nix::unistd::geteuid());
            vec![PathBuf::from(log_in), service_folder()]
        };
        #[cfg(not(unix))]
        let others = Vec::new();
        let is_other = |path: &PathBuf| !own.iter().any(|folder| folder.path == *path);
        let others = others.into_iter().filter(is_other).collect();
        Some(Self { own, others })
    }

    /// Returns the folders for a service whose socket is open to `group`. The service folder comes
    /// first.
    #[cfg(unix)]
    #[must_use]
    pub fn open_to(mut self, group: u32) -> Self {
        let path = service_folder();
        self.others.retain(|other| *other != path);
        self.own.insert(0, LockFolder { path, group: Some(group) });
        self
    }

    /// Returns all folders in which a process may keep locks.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        let own = self.own.iter().map(|folder| folder.path.as_path());
        own.chain(self.others.iter().map(PathBuf::as_path))
    }
}

/// Uses one folder for everything.
impl From<PathBuf> for LockFolders {
    fn from(path: PathBuf) -> Self {
        Self { own: vec![LockFolder { path, group: None }], others: Vec::new() }
    }
}

/// Returns the folder of the service from systemd's `RuntimeDirectory=`, or [`SERVICE_FOLDER`].
#[cfg(unix)]
fn service_folder() -> PathBuf {
    let paths = std::env::var_os("RUNTIME_DIRECTORY");
    let first = paths.and_then(|paths| std::env::split_paths(&paths).next());
    first.unwrap_or_else(|| SERVICE_FOLDER.into())
}
