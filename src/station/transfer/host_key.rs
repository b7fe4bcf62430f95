//! Pinned host keys: Azel accepts only keys that the operator has confirmed for the host.
//!
//! The file has OpenSSH's `known_hosts` form, so operators can read and correct it with familiar
//! tools. Host names are in clear text. Azel ignores hashed names, patterns and certificate
//! authorities, and asks the operator again for such a host.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use russh::keys::{
    Algorithm, HashAlg, PublicKey,
    ssh_key::known_hosts::{Entry, HostPatterns, Marker},
};

use crate::whole_file;

/// Key that a host has proved to own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OfferedKey {
    host: String,
    port: u16,
    key: PublicKey,
}

impl OfferedKey {
    pub(super) fn new(host: &str, port: u16, key: PublicKey) -> Self {
        Self { host: host.to_owned(), port, key }
    }

    /// Returns a key of `host`, for tests.
    #[cfg(test)]
    pub(crate) fn example(host: &str, port: u16) -> Self {
        let text = "ssh-ed25519 \
                    AAAAC3NzaC1lZDI1NTE5AAAAIAABAgMEBQYHCAkKCwwNDg8QERITFBUWFxgZGhscHR4f";
        Self::new(host, port, PublicKey::from_openssh(text).unwrap())
    }

    /// Returns the fingerprint `SHA256:…`, as `ssh-keygen -l` shows it on the host.
    pub fn fingerprint(&self) -> String {
        fingerprint(&self.key)
    }

    /// Returns the algorithm of the key, such as `ssh-ed25519`.
    pub fn algorithm(&self) -> String {
        self.key.algorithm().to_string()
    }

    /// Returns the name of the host in the file: `unit`, or `[unit]:2222` for ports other than 22.
    pub fn address(&self) -> String {
        pattern(&self.host, self.port)
    }
}

/// Verdict of the file about a key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum KeyVerdict {
    Pinned,
    /// Unknown host: the operator must check the key.
    Unknown,
    /// Known host with another key; Azel refuses it.
    Changed {
        /// Fingerprints of the pinned keys.
        pinned: Vec<String>,
    },
    /// Key marked as stolen or withdrawn; Azel refuses it.
    Revoked,
}

/// Reason why the file cannot be used. The file stays unchanged.
#[derive(Debug, thiserror::Error)]
pub enum KnownHostsError {
    #[error("the known host keys cannot be used: {source}; fix the access to {}", path.display())]
    Disk { source: io::Error, path: PathBuf },
    /// Unreadable line, which may contain the key of any host.
    #[error("line {line} of the known host keys cannot be read; fix or remove it in {}", path.display())]
    Line {
        /// Line number, from 1.
        line: usize,
        path: PathBuf,
    },
    /// Key without a text form.
    #[error("the host key of {address} cannot be written down, so it was not accepted")]
    Key {
        /// Host of the key.
        address: String,
    },
}

/// File of pinned host keys.
#[derive(Debug, Clone)]
pub struct KnownHosts {
    path: PathBuf,
}

impl KnownHosts {
    /// Uses the file at `path`, which may not exist yet.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into() }
    }

    /// Returns the file of this user; `None` on a machine without a home folder.
    pub fn of_this_user() -> Option<Self> {
        directories::ProjectDirs::from("", "", "azel")
            .map(|dirs| Self::new(dirs.data_dir().join("known_hosts")))
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Compares `offered` with the file.
    pub fn check(&self, offered: &OfferedKey) -> Result<KeyVerdict, KnownHostsError> {
        let entries = self.entries(&offered.address())?;
        let is_same = |entry: &Entry| entry.public_key().key_data() == offered.key.key_data();
        if entries.iter().any(|entry| entry.marker() == Some(&Marker::Revoked) && is_same(entry)) {
            return Ok(KeyVerdict::Revoked);
        }
        let pinned: Vec<_> = entries.iter().filter(|entry| entry.marker().is_none()).collect();
        Ok(if pinned.is_empty() {
            KeyVerdict::Unknown
        } else if pinned.iter().any(|entry| is_same(entry)) {
            KeyVerdict::Pinned
        } else {
            let pinned = pinned.iter().map(|entry| fingerprint(entry.public_key())).collect();
            KeyVerdict::Changed { pinned }
        })
    }

    /// Accepts `offered` for its host from now on, in addition to the host's other keys.
    pub fn pin(&self, offered: &OfferedKey) -> Result<(), KnownHostsError> {
        let address = offered.address();
        let mut key = offered.key.clone();
        key.set_comment("");
        let key =
            key.to_openssh().map_err(|_| KnownHostsError::Key { address: address.clone() })?;
        let mut text = self.text()?;
        if !text.is_empty() && !text.ends_with('\n') {
            text.push('\n');
        }
        self.write(&format!("{text}{address} {key}\n"))
    }

    /// Removes all keys of the host, for instance after a replacement. Revoked keys stay revoked.
    pub fn forget(&self, host: &str, port: u16) -> Result<(), KnownHostsError> {
        let address = pattern(host, port);
        let text = self.text()?;
        let is_kept = |line: &&str| {
            let entry: Option<Entry> = line.parse().ok();
            entry.is_none_or(|entry| entry.marker().is_some() || !names(&entry, &address))
        };
        let lines: String = text.lines().filter(is_kept).flat_map(|line| [line, "\n"]).collect();
        self.write(&lines)
    }

    /// Returns the algorithms of the host's pinned keys.
    pub(super) fn algorithms(
        &self,
        host: &str,
        port: u16,
    ) -> Result<Vec<Algorithm>, KnownHostsError> {
        let entries = self.entries(&pattern(host, port))?;
        let pinned = entries.iter().filter(|entry| entry.marker().is_none());
        Ok(pinned.map(|entry| entry.public_key().algorithm()).collect())
    }

    /// Returns all entries for `address`.
    fn entries(&self, address: &str) -> Result<Vec<Entry>, KnownHostsError> {
        let text = self.text()?;
        let lines = text.lines().map(str::trim).enumerate();
        let lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let mut entries = Vec::new();
        for (index, line) in lines {
            let entry: Entry = line
                .parse()
                .map_err(|_| KnownHostsError::Line { line: index + 1, path: self.path.clone() })?;
            if names(&entry, address) {
                entries.push(entry);
            }
        }
        Ok(entries)
    }

    fn text(&self) -> Result<String, KnownHostsError> {
        match fs::read_to_string(&self.path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(String::new()),
            other => other.map_err(|source| self.disk(source)),
        }
    }

    fn write(&self, text: &str) -> Result<(), KnownHostsError> {
        whole_file::replace_and_keep_old(&self.path, text.as_bytes())
            .map_err(|source| self.disk(source))
    }

    fn disk(&self, source: io::Error) -> KnownHostsError {
        KnownHostsError::Disk { source, path: self.path.clone() }
    }
}

fn names(entry: &Entry, address: &str) -> bool {
    match entry.host_patterns() {
        HostPatterns::Patterns(names) => {
            names.iter().any(|name| name.eq_ignore_ascii_case(address))
        }
        HostPatterns::HashedName { .. } => false,
    }
}

fn pattern(host: &str, port: u16) -> String {
    let host = host.to_ascii_lowercase();
    if port == 22 { host } else { format!("[{host}]:{port}") }
}

fn fingerprint(key: &PublicKey) -> String {
    key.fingerprint(HashAlg::Sha256).to_string()
}

#[cfg(test)]
mod tests;
