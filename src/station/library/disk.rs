//! Element files, read whole with a size limit.

use std::{
    ffi::OsStr,
    fs, io,
    io::Read as _,
    path::{Path, PathBuf},
};

use jiff::Timestamp;

/// Content of a file.
pub(super) struct DiskFile {
    pub(super) bytes: Vec<u8>,
    /// Time of the last change, if the file system reports it.
    pub(super) modified: Option<Timestamp>,
}

/// Reads the file at `path`, at most `limit` bytes. Refuses folders, devices and pipes.
pub(super) fn read(path: &Path, limit: u64) -> io::Result<DiskFile> {
    // Check the type before opening: a pipe without a writer would block.
    if !fs::metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a regular file"));
    }
    let file = fs::File::open(path)?;
    let modified = file.metadata()?.modified().ok();
    let modified = modified.and_then(|modified| Timestamp::try_from(modified).ok());
    Ok(DiskFile { bytes: read_limited(file, limit)?, modified })
}

/// Reads to the end. Returns an error of kind `FileTooLarge` beyond `limit` bytes.
pub fn read_limited(reader: impl io::Read, limit: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    reader.take(limit.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        return Err(io::Error::new(
            io::ErrorKind::FileTooLarge,
            format!("more than {limit} bytes"),
        ));
    }
    Ok(bytes)
}

/// Returns the files in `folder` with one of these extensions in any case, sorted by name.
pub(super) fn files(folder: &Path, endings: &[&str]) -> io::Result<Vec<PathBuf>> {
    let is_wanted = |path: &PathBuf| {
        let ending = path.extension().and_then(OsStr::to_str);
        ending.is_some_and(|ending| {
            endings.iter().any(|candidate| candidate.eq_ignore_ascii_case(ending))
        }) && path.is_file()
    };
    let entries: Result<Vec<_>, _> = fs::read_dir(folder)?.collect();
    let mut paths: Vec<PathBuf> =
        entries?.into_iter().map(|entry| entry.path()).filter(is_wanted).collect();
    paths.sort();
    Ok(paths)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_pipe_a_device_and_a_folder_are_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe.tle");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status().unwrap();
        assert!(made.success());
        for path in [pipe.as_path(), Path::new("/dev/zero"), folder.path()] {
            let error = read(path, 1000).err().unwrap();
            assert_eq!(error.kind(), io::ErrorKind::InvalidInput, "{}", path.display());
        }
    }
}
