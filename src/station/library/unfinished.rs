//! Sources that Azel sets aside because reading them ended the program, in a small file of the
//! library.
//!
//! The reader locks a second file and writes the source there while it reads. If a later reader
//! finds a source in that file, this source ended its reader and would end the program again. Azel
//! sets it aside until the operator asks for it.

use std::{
    fs::{self, File},
    io::{self, Read as _, Seek as _, Write as _},
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize, de::DeserializeOwned};

use super::lock::Lock;
use crate::{orbit::Source, whole_file};

/// Names of the files in the folder of the library.
const SET_ASIDE: &str = "unfinished.toml";
const READING: &str = "reading.toml";

/// Sources that are set aside.
#[derive(Debug)]
pub(super) struct SetAside {
    path: PathBuf,
    list: UnfinishedList,
}

#[derive(Debug, Default, Serialize, Deserialize)]
struct UnfinishedList {
    #[serde(default)]
    source: Vec<Source>,
}

impl SetAside {
    /// Reads the list in `folder`. An unreadable file sets nothing aside.
    pub(super) fn load(folder: &Path) -> Self {
        let path = folder.join(SET_ASIDE);
        let list = fs::read_to_string(&path).ok().and_then(|text| parsed(&text));
        Self { path, list: list.unwrap_or_default() }
    }

    /// Returns `true` if `source` is set aside with its current settings.
    pub(super) fn contains(&self, source: &Source) -> bool {
        self.list.source.contains(source)
    }

    fn add(&mut self, source: Source) -> io::Result<()> {
        if !self.contains(&source) {
            self.list.source.push(source);
        }
        self.save()
    }

    /// Removes the sources named in `except_sources`, and those that are no longer in `list`.
    pub(super) fn keep(&mut self, list: &[Source], except_sources: &[String]) {
        let before = self.list.source.len();
        self.list
            .source
            .retain(|source| list.contains(source) && !except_sources.contains(&source.name));
        if self.list.source.len() != before {
            warn(&self.path, self.save());
        }
    }

    fn save(&self) -> io::Result<()> {
        if self.list.source.is_empty() {
            return whole_file::remove(&self.path);
        }
        let text = toml::to_string(&self.list).map_err(io::Error::other)?;
        whole_file::replace(&self.path, text.as_bytes())
    }
}

/// Note of the source that this program is reading. It stays unused while another program reads; a
/// source that ends this program then goes unnoticed, which is rare.
#[derive(Debug)]
pub(super) struct ReadingNote {
    path: PathBuf,
    lock: Option<Lock>,
}

impl ReadingNote {
    /// Begins to read in `folder`. Adds a source that an earlier program did not finish to
    /// `set_aside`.
    pub(super) fn begin(folder: &Path, set_aside: &mut SetAside) -> Self {
        let path = folder.join(READING);
        let newest = Lock::try_take(folder, READING).and_then(|mut lock| {
            lock.as_mut().map_or(Ok(()), |lock| take_over(lock.file(), set_aside))?;
            Ok(lock)
        });
        let lock = newest.unwrap_or_else(|error| {
            warn(&path, Err(error));
            None
        });
        Self { path, lock }
    }

    /// Runs `read` with `source` in the note.
    pub(super) fn while_reading<T>(&mut self, source: &Source, read: impl FnOnce() -> T) -> T {
        self.note(&toml::to_string(source).unwrap_or_default());
        let outcome = read();
        self.note("");
        outcome
    }

    fn note(&mut self, text: &str) {
        let Some(lock) = &mut self.lock else { return };
        warn(&self.path, rewrite(lock.file(), text));
    }
}

/// Moves the source in the note `file` to `set_aside`.
fn take_over(file: &mut File, set_aside: &mut SetAside) -> io::Result<()> {
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    if let Some(source) = str::from_utf8(&bytes).ok().and_then(parsed) {
        set_aside.add(source)?;
        rewrite(file, "")?;
    }
    Ok(())
}

fn rewrite(file: &mut File, text: &str) -> io::Result<()> {
    file.set_len(0)?;
    file.rewind()?;
    file.write_all(text.as_bytes())?;
    file.sync_data()
}

fn parsed<T: DeserializeOwned>(text: &str) -> Option<T> {
    toml::from_str(text).ok()
}

/// Logs an error but does not return it: a full disk must not prevent reading the elements.
fn warn(path: &Path, noted: io::Result<()>) {
    if let Err(error) = noted {
        tracing::warn!(%error, path = %path.display(), "what is read is not noted");
    }
}

#[cfg(test)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use super::*;

    fn begin(folder: &Path) -> (SetAside, ReadingNote) {
        let mut set_aside = SetAside::load(folder);
        let reading = ReadingNote::begin(folder, &mut set_aside);
        (set_aside, reading)
    }

    /// Leaves `folder` like a program that ends while it reads `source`.
    fn end_in(folder: &Path, source: &Source) {
        let (_, mut reading) = begin(folder);
        let ends = || panic!("on purpose");
        catch_unwind(AssertUnwindSafe(|| reading.while_reading(source, ends))).unwrap_err();
    }

    #[test]
    fn a_source_that_ended_the_program_is_set_aside_until_it_is_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        let folder = &folder.path().join("deep");
        let list = [Source::celestrak("weather"), Source::celestrak("noaa")];
        assert_eq!(begin(folder).1.while_reading(&list[0], || 7), 7);
        assert!(begin(folder).0.list.source.is_empty());
        end_in(folder, &list[1]);

        let (mut set_aside, mut reading) = begin(folder);
        assert_eq!([&list[0], &list[1]].map(|source| set_aside.contains(source)), [false, true]);
        reading.while_reading(&list[0], || ());
        drop(reading);
        set_aside.keep(&list, &[]);
        assert!(begin(folder).0.contains(&list[1]));
        set_aside.keep(&list, &["noaa".to_owned()]);
        assert!(!begin(folder).0.contains(&list[1]));
        assert!(!folder.join(SET_ASIDE).exists());
    }

    #[test]
    fn a_source_that_another_program_reads_is_not_set_aside() {
        let folder = tempfile::tempdir().unwrap();
        let source = Source::celestrak("weather");
        let (_, mut first) = begin(folder.path());
        first.while_reading(&source, || {
            let (set_aside, mut second) = begin(folder.path());
            assert!(!set_aside.contains(&source));
            second.while_reading(&source, || ());
        });
        drop(first);
        assert!(begin(folder.path()).0.list.source.is_empty());
    }

    #[test]
    fn a_source_that_is_gone_from_the_list_or_has_moved_is_not_set_aside() {
        let folder = tempfile::tempdir().unwrap();
        end_in(folder.path(), &Source::celestrak("noaa"));
        let (mut set_aside, _reading) = begin(folder.path());
        let moved = Source { name: "noaa".to_owned(), ..Source::celestrak("weather") };
        assert!(!set_aside.contains(&moved));
        set_aside.keep(&[moved], &[]);
        assert!(set_aside.list.source.is_empty());
    }
}
