//! Folder on a unit, by SFTP version 3.

use std::{future::Future, time::Duration};

use russh_sftp::{
    client::{Config, RawSftpSession, error::Error},
    protocol::{FileAttributes, OpenFlags, Packet, StatusCode},
};

use super::{
    FolderError, Limits,
    folder::{Folder, FolderFile, Tell},
    ssh::Ssh,
};
use crate::contract::transfer::OldAlgorithm;

/// Max packet content that every server accepts and sends, bytes.
const CHUNK_BYTES: usize = 32 << 10;
/// Bits of a mode for access rights.
const RIGHTS: u32 = 0o7777;
/// Extension for a rename that replaces (OpenSSH, `PROTOCOL`, section 4.3).
const POSIX_RENAME: &str = "posix-rename@openssh.com";
/// Extension for syncing a file (OpenSSH, `PROTOCOL`, section 4.6).
const FSYNC: &str = "fsync@openssh.com";
/// Extension for free disk space (OpenSSH, `PROTOCOL`, section 4.4).
const STATVFS: &str = "statvfs@openssh.com";

/// Open folder on a unit.
pub struct SftpFolder {
    sftp: RawSftpSession,
    /// SSH connection, held open for the session.
    ssh: Ssh,
    path: String,
    limits: Limits,
    can_replace: bool,
    can_sync: bool,
    can_tell_space: bool,
}

impl SftpFolder {
    pub(super) async fn open(ssh: Ssh, path: &str, limits: Limits) -> Result<Self, String> {
        let problem = |error: russh::Error| format!("no file transfer there ({error})");
        let channel = ssh.handle.channel_open_session().await.map_err(problem)?;
        channel.request_subsystem(true, "sftp").await.map_err(problem)?;
        // The library takes whole seconds; Azel's own timeout ends earlier.
        let request_timeout_secs = limits.request.as_secs() + 2;
        let config = Config { request_timeout_secs, ..Config::default() };
        let sftp = RawSftpSession::new_with_config(channel.into_stream(), config);
        let version =
            sftp.init().await.map_err(|error| format!("no file transfer there ({error})"))?;
        let has = |name| version.extensions.contains_key(name);
        Ok(Self {
            can_replace: has(POSIX_RENAME),
            can_sync: has(FSYNC),
            can_tell_space: has(STATVFS),
            path: path.trim_end_matches('/').to_owned(),
            sftp,
            ssh,
            limits,
        })
    }

    /// Returns the old algorithms of the connection.
    pub fn old_algorithms(&self) -> &[OldAlgorithm] {
        &self.ssh.old_algorithms
    }

    /// Returns the path of a file in this folder.
    fn path(&self, name: &str) -> String {
        format!("{}/{name}", self.path)
    }

    /// Makes one request, which ends with its answer, its timeout or the end of the connection.
    async fn answer<T>(
        &self,
        request: impl Future<Output = Result<T, Error>>,
    ) -> Result<Result<T, Error>, FolderError> {
        let limit = self.limits.request;
        tokio::time::timeout(limit, request).await.map_err(|_| FolderError::TimedOut(limit))
    }

    /// Makes one request that must succeed.
    async fn ask<T>(
        &self,
        request: impl Future<Output = Result<T, Error>>,
    ) -> Result<T, FolderError> {
        self.answer(request).await?.map_err(|error| folder_error(error, self.limits.request))
    }

    /// Transfers a whole file in one direction, within its timeout.
    async fn whole<T>(
        &self,
        work: impl Future<Output = Result<T, FolderError>>,
    ) -> Result<T, FolderError> {
        let late = FolderError::TimedOut(self.limits.file);
        tokio::time::timeout(self.limits.file, work).await.unwrap_or(Err(late))
    }

    async fn read_all(&self, handle: &str, tell: Tell<'_>) -> Result<Vec<u8>, FolderError> {
        let mut bytes = Vec::new();
        loop {
            let start = bytes.len() as u64;
            if start > self.limits.file_bytes {
                return Err(FolderError::TooLarge(self.limits.file_bytes));
            }
            match self.answer(self.sftp.read(handle, start, CHUNK_BYTES as u32)).await? {
                Ok(data) if data.data.is_empty() => return Ok(bytes),
                Ok(data) => bytes.extend_from_slice(&data.data),
                Err(Error::Status(status)) if status.status_code == StatusCode::Eof => {
                    return Ok(bytes);
                }
                Err(error) => return Err(folder_error(error, self.limits.request)),
            }
            tell(bytes.len() as u64);
        }
    }

    async fn write_all(
        &self,
        handle: &str,
        bytes: &[u8],
        tell: Tell<'_>,
    ) -> Result<(), FolderError> {
        let mut done = 0;
        for chunk in bytes.chunks(CHUNK_BYTES) {
            self.ask(self.sftp.write(handle, done, chunk.to_vec())).await?;
            done += chunk.len() as u64;
            tell(done);
        }
        if self.can_sync {
            self.ask(self.sftp.fsync(handle)).await?;
        }
        Ok(())
    }

    /// Turns a refusal into [`FolderError::DiskFull`] if that is its cause.
    async fn explain(&self, error: FolderError, requested: usize) -> FolderError {
        if !self.can_tell_space || !matches!(error, FolderError::Refused(_)) {
            return error;
        }
        match self.ask(self.sftp.statvfs(self.path.as_str())).await {
            Ok(space) => {
                let free_bytes = space.blocks_avail.saturating_mul(space.fragment_size);
                if free_bytes < requested as u64 {
                    FolderError::DiskFull { free_bytes }
                } else {
                    error
                }
            }
            Err(_) => error,
        }
    }
}

impl Folder for SftpFolder {
    async fn read(
        &mut self,
        name: &str,
        tell: Tell<'_>,
    ) -> Result<Option<FolderFile>, FolderError> {
        let path = self.path(name);
        let none = FileAttributes::empty();
        let handle = match self.ask(self.sftp.open(path.as_str(), OpenFlags::READ, none)).await {
            Ok(handle) => handle.handle,
            // Check the folder: a missing folder must not count as a missing file.
            Err(FolderError::Missing) => {
                let folder = self.ask(self.sftp.opendir(self.path.as_str())).await?;
                self.ask(self.sftp.close(folder.handle)).await?;
                return Ok(None);
            }
            Err(error) => return Err(error),
        };
        let bytes = self.whole(self.read_all(&handle, tell)).await?;
        let attributes = self.ask(self.sftp.fstat(handle.as_str())).await?.attrs;
        self.ask(self.sftp.close(handle)).await?;
        Ok(Some(FolderFile { bytes, mode: attributes.permissions.map(|mode| mode & RIGHTS) }))
    }

    async fn write_new(
        &mut self,
        name: &str,
        bytes: &[u8],
        mode: Option<u32>,
        tell: Tell<'_>,
    ) -> Result<(), FolderError> {
        let path = self.path(name);
        let flags = OpenFlags::CREATE | OpenFlags::EXCLUDE | OpenFlags::WRITE;
        let opening = self.sftp.open(path.as_str(), flags, FileAttributes::empty());
        let handle = match self.ask(opening).await {
            Ok(handle) => handle.handle,
            Err(error) => return Err(self.explain(error, bytes.len()).await),
        };
        let written = self.whole(self.write_all(&handle, bytes, tell)).await;
        let closed = match &written {
            Err(error) if error.ends_connection() => Ok(()),
            _ => self.ask(self.sftp.close(handle)).await.map(|_| ()),
        };
        if let Err(error) = written.and(closed) {
            return Err(self.explain(error, bytes.len()).await);
        }
        if let Some(mode) = mode {
            let rights = FileAttributes { permissions: Some(mode), ..FileAttributes::empty() };
            self.ask(self.sftp.setstat(path, rights)).await?;
        }
        Ok(())
    }

    async fn remove(&mut self, name: &str) -> Result<(), FolderError> {
        match self.ask(self.sftp.remove(self.path(name))).await {
            Ok(_) | Err(FolderError::Missing) => Ok(()),
            Err(error) => Err(error),
        }
    }

    async fn rename(&mut self, source: &str, destination: &str) -> Result<(), FolderError> {
        self.ask(self.sftp.rename(self.path(source), self.path(destination))).await.map(|_| ())
    }

    fn can_replace(&self) -> bool {
        self.can_replace
    }

    async fn replace(&mut self, source: &str, destination: &str) -> Result<(), FolderError> {
        let names: Vec<u8> = [self.path(source), self.path(destination)]
            .iter()
            .flat_map(|path| string(path))
            .collect();
        match self.ask(self.sftp.extended(POSIX_RENAME, names)).await? {
            Packet::Status(status) if status.status_code == StatusCode::Ok => Ok(()),
            Packet::Status(status) => Err(folder_error(Error::Status(status), self.limits.request)),
            _ => Err(FolderError::Lost),
        }
    }
}

/// Returns a string as its length and its bytes (RFC 4251, section 5).
fn string(text: &str) -> impl Iterator<Item = u8> {
    (text.len() as u32).to_be_bytes().into_iter().chain(text.bytes())
}

fn folder_error(error: Error, limit: Duration) -> FolderError {
    match error {
        Error::Status(status) => match status.status_code {
            StatusCode::NoSuchFile => FolderError::Missing,
            StatusCode::PermissionDenied => FolderError::Denied,
            StatusCode::NoConnection | StatusCode::ConnectionLost => FolderError::Lost,
            _ => FolderError::Refused(status.error_message),
        },
        Error::Timeout => FolderError::TimedOut(limit),
        Error::Limited(reason) => FolderError::Refused(reason),
        Error::IO(_) | Error::UnexpectedBehavior(_) | Error::UnexpectedPacket => {
            tracing::debug!(%error, "SFTP ended");
            FolderError::Lost
        }
    }
}
