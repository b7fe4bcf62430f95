//! Sources that the program has not finished reading, in a small file of the library.
//!
//! A source is entered before it is read and removed afterwards. An entry at the start of
//! the program means that this source ended the last run and would end this one: it is set
//! aside until the operator asks for it.

use std::{
    fs,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use crate::{orbit::Source, whole_file};

/// Name of the file in the folder of the library.
const NAME: &str = "unfinished.toml";

/// Sources that are set aside or being read.
#[derive(Debug)]
pub(super) struct Unfinished {
    path: PathBuf,
    held: Held,
}

#[derive(Debug, Default, Serialize, Deserialize)]
struct Held {
    #[serde(default)]
    source: Vec<Source>,
}

impl Unfinished {
    /// Reads the entries that the last run left in `folder`. An unreadable file sets nothing
    /// aside.
    pub(super) fn load(folder: &Path) -> Self {
        let path = folder.join(NAME);
        let text = fs::read_to_string(&path).ok();
        let held = text.and_then(|text| toml::from_str(&text).ok()).unwrap_or_default();
        Self { path, held }
    }

    /// Returns `true` if `source` is set aside with its present settings.
    pub(super) fn holds(&self, source: &Source) -> bool {
        self.held.source.contains(source)
    }

    /// Removes the sources named in `but`, and those that are no longer in `list`.
    pub(super) fn keep(&mut self, list: &[Source], but: &[String]) {
        let before = self.held.source.len();
        self.held.source.retain(|held| list.contains(held) && !but.contains(&held.name));
        if self.held.source.len() != before {
            self.save();
        }
    }

    /// Runs `read` with `source` entered in the file.
    pub(super) fn during<T>(&mut self, source: &Source, read: impl FnOnce() -> T) -> T {
        self.held.source.push(source.clone());
        self.save();
        let outcome = read();
        self.held.source.pop();
        self.save();
        outcome
    }

    /// Errors are ignored: a full disk must not keep the elements from being read.
    fn save(&self) {
        let saved = if self.held.source.is_empty() {
            fs::remove_file(&self.path)
        } else {
            let text = toml::to_string(&self.held).map_err(std::io::Error::other);
            text.and_then(|text| whole_file::replace(&self.path, text.as_bytes()))
        };
        if let Err(error) = saved {
            tracing::warn!(%error, path = %self.path.display(), "what is read is not noted");
        }
    }
}

#[cfg(test)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use super::*;

    #[test]
    fn what_ended_the_program_is_held_until_it_is_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        let folder = &folder.path().join("deep");
        let list = [Source::celestrak("weather"), Source::celestrak("noaa")];
        let ends = || panic!("on purpose");
        let mut first = Unfinished::load(folder);
        assert_eq!(first.during(&list[0], || 7), 7);
        assert!(!folder.join(NAME).exists());
        catch_unwind(AssertUnwindSafe(|| first.during(&list[1], ends))).unwrap_err();

        let mut second = Unfinished::load(folder);
        assert_eq!([&list[0], &list[1]].map(|source| second.holds(source)), [false, true]);
        second.during(&list[0], || ());
        second.keep(&list, &[]);
        assert!(Unfinished::load(folder).holds(&list[1]));
        second.keep(&list, &["noaa".to_owned()]);
        assert!(!Unfinished::load(folder).holds(&list[1]));
        assert!(!folder.join(NAME).exists());
    }

    #[test]
    fn what_is_gone_from_the_list_or_has_moved_is_not_held() {
        let folder = tempfile::tempdir().unwrap();
        let mut unfinished = Unfinished::load(folder.path());
        unfinished.held.source.push(Source::celestrak("noaa"));
        let moved = Source { name: "noaa".to_owned(), ..Source::celestrak("weather") };
        assert!(!unfinished.holds(&moved));
        unfinished.keep(&[moved], &[]);
        assert!(unfinished.held.source.is_empty());
    }
}
