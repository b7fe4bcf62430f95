//! Replacement of whole files. Azel writes a new file beside the old one and then renames it, so a
//! failure at any moment leaves the old file unchanged. Through a symbolic link, Azel replaces the
//! target of the link.

use std::{
    fs, io,
    io::Write as _,
    path::{Path, PathBuf},
};

use tempfile::NamedTempFile;

/// Writes `bytes` to `path`, and creates missing folders.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let target = target(path);
    persist(temporary(&target, bytes, Readers::Owner)?, &target)
}

/// Writes a file like [`replace`] that other users of this computer may read, as far as the user's
/// mask or the old file allows.
pub fn replace_for_others(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let target = target(path);
    persist(temporary(&target, bytes, Readers::AsUsual)?, &target)
}

/// Writes a file like [`replace`], and keeps a copy of the previous file at [`old`].
pub fn replace_and_keep_old(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let target = target(path);
    let file = temporary(&target, bytes, Readers::Owner)?;
    match fs::copy(path, old(path)) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    persist(file, &target)
}

/// Removes the file at `path`. A missing file is no error.
pub fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        removed => removed?,
    }
    sync_folder(path);
    Ok(())
}

/// Returns the path with the added ending `.old`.
pub fn old(path: &Path) -> PathBuf {
    path.with_added_extension("old")
}

/// Returns the path to which `path` leads through symbolic links; `path` itself if it is no link.
fn target(path: &Path) -> PathBuf {
    let Ok(link) = fs::read_link(path) else { return path.to_owned() };
    // A link to a missing file leads to that file nevertheless.
    let folder = path.parent().unwrap_or(Path::new(""));
    fs::canonicalize(path).unwrap_or_else(|_| folder.join(link))
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Readers {
    Owner,
    AsUsual,
}

fn temporary(path: &Path, bytes: &[u8], readers: Readers) -> io::Result<NamedTempFile> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    if readers == Readers::AsUsual {
        use std::os::unix::fs::PermissionsExt as _;
        let of_old = fs::metadata(path).map(|old| old.permissions());
        // The user's mask removes some of these permissions.
        builder.permissions(of_old.unwrap_or_else(|_| fs::Permissions::from_mode(0o666)));
    }
    let mut file = builder.tempfile_in(folder)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    Ok(file)
}

fn persist(file: NamedTempFile, path: &Path) -> io::Result<()> {
    file.persist(path).map_err(|error| error.error)?;
    sync_folder(path);
    Ok(())
}

/// Syncs the folder of `path` to the disk. Ignores an error: the change is in place, and without
/// the sync only a loss of power could restore the old state.
fn sync_folder(path: &Path) {
    #[cfg(unix)]
    if let Some(Ok(folder)) = path.parent().map(fs::File::open) {
        let _ = folder.sync_all();
    }
    #[cfg(not(unix))]
    let _ = path;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let name = |entry: io::Result<fs::DirEntry>| entry.unwrap().file_name();
        let mut names: Vec<String> =
            entries.map(|entry| name(entry).into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn only_what_was_asked_to_be_kept_is_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/a.toml");
        for text in ["first", "second"] {
            replace(&path, text.as_bytes()).unwrap();
        }
        assert_eq!(names(path.parent().unwrap()), ["a.toml"]);
        replace_and_keep_old(&path, b"third").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "third");
        assert_eq!(fs::read_to_string(old(&path)).unwrap(), "second");
        assert_eq!(names(path.parent().unwrap()), ["a.toml", "a.toml.old"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_what_it_leads_to_is_replaced() {
        use std::os::unix::fs::symlink;

        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("kept")).unwrap();
        symlink("kept/station.toml", path("near.toml")).unwrap();
        symlink(path("near.toml"), path("far.toml")).unwrap();
        for (link, text) in [("near.toml", "first"), ("far.toml", "second")] {
            replace_and_keep_old(&path(link), text.as_bytes()).unwrap();
            assert!(fs::symlink_metadata(path(link)).unwrap().is_symlink(), "{link}");
            assert_eq!(fs::read_to_string(path("kept/station.toml")).unwrap(), text);
        }
        assert_eq!(fs::read_to_string(old(&path("far.toml"))).unwrap(), "first");
    }

    #[test]
    fn a_failure_leaves_everything_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        // A file cannot replace a folder of that name.
        let occupied = folder.path().join("taken");
        fs::create_dir_all(occupied.join("inside")).unwrap();
        replace(&occupied, b"new").unwrap_err();
        replace_and_keep_old(&occupied, b"new").unwrap_err();
        assert_eq!(names(folder.path()), ["taken"]);
        assert_eq!(names(&occupied), ["inside"]);
    }

    #[cfg(unix)]
    #[test]
    fn others_read_what_is_for_them_as_any_file_of_the_user() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let mode = |name: &str| {
            fs::metadata(folder.path().join(name)).unwrap().permissions().mode() & 0o777
        };
        fs::write(folder.path().join("usual"), "").unwrap();
        replace_for_others(&folder.path().join("passes.csv"), b"a").unwrap();
        assert_eq!(mode("passes.csv"), mode("usual"));
        replace(&folder.path().join("station.toml"), b"a").unwrap();
        assert_eq!(mode("station.toml"), 0o600);
        replace_for_others(&folder.path().join("station.toml"), b"a").unwrap();
        assert_eq!(mode("station.toml"), 0o600);
    }
}
