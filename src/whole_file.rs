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
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let target = target(path);
    persist(beside(&target, bytes)?, &target)
}

/// The same; what stood there before is kept at [`old`].
pub(crate) fn replace_and_keep_old(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let target = target(path);
    let file = beside(&target, bytes)?;
    match fs::copy(path, old(path)) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    persist(file, &target)
}

/// The path with the ending `.old` added.
pub(crate) fn old(path: &Path) -> PathBuf {
    path.with_added_extension("old")
}

/// Where `path` leads, through symbolic links; `path` itself where it is none.
fn target(path: &Path) -> PathBuf {
    let Ok(link) = fs::read_link(path) else { return path.to_owned() };
    // A link to a file that is not there yet leads there all the same.
    let folder = path.parent().unwrap_or(Path::new(""));
    fs::canonicalize(path).unwrap_or_else(|_| folder.join(link))
}

fn beside(path: &Path, bytes: &[u8]) -> io::Result<NamedTempFile> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    let mut file = NamedTempFile::new_in(folder)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    Ok(file)
}

fn persist(file: NamedTempFile, path: &Path) -> io::Result<()> {
    file.persist(path).map_err(|error| error.error)?;
    // The file is whole and in its place; a folder that cannot be synced could only
    // bring back the old one after a loss of power.
    #[cfg(unix)]
    if let Some(Ok(folder)) = path.parent().map(fs::File::open) {
        let _ = folder.sync_all();
    }
    Ok(())
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
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("kept")).unwrap();
        symlink("kept/station.toml", at("near.toml")).unwrap();
        symlink(at("near.toml"), at("far.toml")).unwrap();
        for (link, text) in [("near.toml", "first"), ("far.toml", "second")] {
            replace_and_keep_old(&at(link), text.as_bytes()).unwrap();
            assert!(fs::symlink_metadata(at(link)).unwrap().is_symlink(), "{link}");
            assert_eq!(fs::read_to_string(at("kept/station.toml")).unwrap(), text);
        }
        assert_eq!(fs::read_to_string(old(&at("far.toml"))).unwrap(), "first");
    }

    #[test]
    fn a_failure_leaves_everything_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        // A folder of that name cannot be replaced by a file.
        let taken = folder.path().join("taken");
        fs::create_dir_all(taken.join("inside")).unwrap();
        replace(&taken, b"new").unwrap_err();
        replace_and_keep_old(&taken, b"new").unwrap_err();
        assert_eq!(names(folder.path()), ["taken"]);
        assert_eq!(names(&taken), ["inside"]);
    }
}
