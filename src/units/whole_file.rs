//! Files that are replaced whole: a new one beside the old one first, then one
//! rename, so that a failure at any moment leaves the old file as it was. Where
//! the path is a symbolic link, the file that it leads to is replaced.

use std::{
    fs, io,
    io::Write as _,
    path::{Path, PathBuf},
};

use tempfile::NamedTempFile;

/// Puts `bytes` at `path`, in folders that are made where they are missing.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let target = target(path);
    persist(temporary(&target, bytes, Readers::Owner)?, &target)
}

/// The same for a file that others of this computer may read, as far as the user lets them read
/// new files or could read the old one.
pub fn replace_for_others(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let target = target(path);
    persist(temporary(&target, bytes, Readers::AsUsual)?, &target)
}

/// The same as [`replace`]; what stood there before is kept at [`old`].
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

/// The path with the ending `.old` added.
pub fn old(path: &Path) -> PathBuf {
    path.with_added_extension("old")
}

/// Where `path` leads, through symbolic links; `path` itself where it is none.
fn target(path: &Path) -> PathBuf {
    let Ok(link) = fs::read_link(path) else { return path.to_owned() };
    // A link to a file that is not there yet leads there all the same.
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
        // The mask of the user takes its share of them.
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

/// Ignores an error: the change is in place, and a folder that cannot be synced could only bring
/// back the old state after a loss of power.
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
        // A folder of that name cannot be replaced by a file.
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
