//! Reading of elements, and selection of the requested satellites. Unusable input is named
//! on standard error, object by object.

use std::{
    collections::BTreeMap,
    fs::File,
    io::{self, Write as _},
    path::{Path, PathBuf},
};

use anyhow::{Context as _, bail};
use jiff::Timestamp;
use rayon::prelude::*;

use super::InputOptions;
use crate::{
    controller::SPECS,
    export::Satellite,
    library::{
        Exceptions, Library, Limits, disk::read_limited, element_files, library_folder,
        load_sources,
    },
    orbit::{
        Catalog, Elements, MAX_ELEMENT_BYTES, MergeSummary, Note, Refusal, Source, SourceOrders,
        read_element_bytes,
    },
    station,
};

/// Requested satellites.
pub(in crate::cli) struct Satellites {
    /// Sorted by catalogue number.
    pub(in crate::cli) list: Vec<Satellite>,
    /// Everything requested could be used.
    pub(in crate::cli) is_complete: bool,
}

struct Merged {
    file: String,
    summary: MergeSummary,
    holds_elements: bool,
}

impl InputOptions {
    /// Reads the requested satellites for use from `start` on; an error if there are none.
    pub(in crate::cli) fn satellites(
        &self,
        station: Option<&Path>,
        start: Timestamp,
    ) -> anyhow::Result<Satellites> {
        let mut notes = Notes { errors: io::stderr().lock(), is_complete: true };
        let mut files = self.own_files(&mut notes);
        let mut older_sets = None;
        let mut orders = SourceOrders::default();
        let mut sources: BTreeMap<PathBuf, String> = BTreeMap::new();
        if let Some(station) = station
            && (self.elements.is_empty() || !self.group.is_empty())
        {
            sources = self.library_files(station, &mut notes)?;
            files.extend(sources.keys().cloned());
            orders = source_orders(station);
            older_sets = library_folder().map(|folder| Exceptions::load(&folder));
        }
        // Of two sets with the same epoch the first stays: make the order on the command line
        // irrelevant.
        files.sort();
        files.dedup();
        let mut catalog = Catalog::default();
        // For a time in the past, sets that are newer than that time are less exact.
        catalog.set_time(start.min(Timestamp::now()));
        catalog.set_orders(orders);
        let mut merged = Vec::new();
        for path in &files {
            let file = path.display().to_string();
            match bytes_of(path) {
                Ok(bytes) => {
                    let report = read_element_bytes(&bytes);
                    let holds_elements = !report.elements.is_empty();
                    let summary = catalog.merge(report, sources.get(path).unwrap_or(&file));
                    merged.push(Merged { file, summary, holds_elements });
                }
                Err(error) => notes.unusable(&format!("{file} cannot be read: {error}")),
            }
        }
        if let Some(older_sets) = &older_sets {
            older_sets.apply(&mut catalog);
        }
        let has_choice = |number| older_sets.as_ref().is_some_and(|sets| sets.has(number));
        catalog.apply_orders(has_choice);
        let request = SearchRequest::new(self, &catalog);
        for file in &merged {
            notes.file(file, &request);
        }
        for missing in &request.missing {
            notes.unusable(missing);
        }
        let requested: Vec<&Elements> =
            catalog.iter().filter(|elements| request.holds(elements)).collect();
        let prepared = |elements: &&Elements| {
            let satellite = Satellite::new((*elements).clone());
            satellite.map_err(|reason| format!("{}: {reason}", elements.label()))
        };
        // Collected in place: there are fifteen megabytes of them in the whole catalogue.
        let mut list = Vec::new();
        requested.par_iter().map(prepared).collect_into_vec(&mut list);
        let list: Vec<Satellite> = list
            .into_iter()
            .filter_map(|satellite| satellite.map_err(|sentence| notes.unusable(&sentence)).ok())
            .collect();
        if list.is_empty() {
            bail!("There are no elements to compute with.");
        }
        Ok(Satellites { list, is_complete: notes.is_complete })
    }

    /// Files of `--elements`, and those in its folders.
    fn own_files(&self, notes: &mut Notes) -> Vec<PathBuf> {
        let mut files = Vec::new();
        for path in &self.elements {
            if !path.is_dir() {
                files.push(path.clone());
                continue;
            }
            match element_files(path) {
                Ok(found) if found.is_empty() => {
                    notes.unusable(&format!("{}: no element files in it", path.display()));
                }
                Ok(found) => files.extend(found),
                Err(error) => {
                    notes.unusable(&format!("{} cannot be read: {error}", path.display()));
                }
            }
        }
        files
    }

    /// Library files of the requested sources of a station, each with the name of its source.
    fn library_files(
        &self,
        station: &Path,
        notes: &mut Notes,
    ) -> anyhow::Result<BTreeMap<PathBuf, String>> {
        let sources = load_sources(&station.with_file_name("sources.toml"))?;
        let names = || sources.iter().map(|source| source.name.as_str()).collect::<Vec<_>>();
        if sources.is_empty() {
            bail!("The station has no sources of elements; --elements names files of them.");
        }
        for group in &self.group {
            if !names().contains(&group.as_str()) {
                bail!("The station has no source {group}; it has: {}.", names().join(", "));
            }
        }
        let folder = library_folder().context("this user has no folder for data")?;
        let library = Library::open(&folder, Limits::default())?;
        let is_asked =
            |source: &&Source| self.group.is_empty() || self.group.contains(&source.name);
        let mut files = BTreeMap::new();
        for source in sources.iter().filter(is_asked) {
            match library.files_of(source) {
                Ok(found) if found.is_empty() => {
                    notes.unusable(&format!("{}: nothing of this source is held", source.name));
                }
                Ok(found) => {
                    files.extend(found.into_iter().map(|file| (file, source.name.clone())));
                }
                Err((folder, error)) => {
                    notes.unusable(&format!("{} cannot be read: {error}", folder.display()));
                }
            }
        }
        Ok(files)
    }
}

/// The orders of sources in a station file. [`InputOptions::place`] reports a file that cannot be read.
fn source_orders(station: &Path) -> SourceOrders {
    let loaded = station::load(station, SPECS);
    loaded.map(|loaded| loaded.station.favourites.source_orders()).unwrap_or_default()
}

fn bytes_of(file: &Path) -> io::Result<Vec<u8>> {
    if file == Path::new("-") {
        read_limited(io::stdin().lock(), MAX_ELEMENT_BYTES)
    } else {
        read_limited(File::open(file)?, MAX_ELEMENT_BYTES)
    }
}

/// Requested objects.
struct SearchRequest<'a> {
    numbers: &'a [u32],
    /// In lower case.
    names: Vec<String>,
    /// Names of the objects found, in lower case.
    found: Vec<String>,
    /// A sentence for each number and name that was not found.
    missing: Vec<String>,
}

impl<'a> SearchRequest<'a> {
    fn new(options: &'a InputOptions, catalog: &Catalog) -> Self {
        let numbers = &options.catalog_number[..];
        let names = options.name.iter().map(|name| name.to_lowercase()).collect();
        let mut request = Self { numbers, names, found: Vec::new(), missing: Vec::new() };
        if request.is_everything() {
            return request;
        }
        let found = catalog.iter().filter(|elements| request.holds(elements));
        let found: Vec<String> = found.map(|elements| elements.name().to_lowercase()).collect();
        for number in numbers.iter().filter(|number| catalog.get(**number).is_none()) {
            request.missing.push(format!("{number}: no elements of this object"));
        }
        for (name, lower) in options.name.iter().zip(&request.names) {
            if !found.iter().any(|found| found.contains(lower)) {
                request.missing.push(format!("{name}: no elements of an object of this name"));
            }
        }
        request.found = found;
        request
    }

    fn is_everything(&self) -> bool {
        self.numbers.is_empty() && self.names.is_empty()
    }

    fn holds(&self, elements: &Elements) -> bool {
        self.is_everything()
            || self.numbers.contains(&elements.catalog_number())
            || self.holds_name(&elements.name().to_lowercase())
    }

    fn holds_name(&self, lower: &str) -> bool {
        self.names.iter().any(|name| lower.contains(name))
    }

    /// Whether a refused set may belong to a requested object. A reader identifies the set by
    /// its name, by its number, or not at all.
    fn concerns(&self, object: Option<&str>) -> bool {
        let is_some_missing = !self.missing.is_empty();
        let Some(object) = object.filter(|_| !self.is_everything()) else {
            return self.is_everything() || is_some_missing;
        };
        let lower = object.to_lowercase();
        self.holds_name(&lower)
            || self.found.contains(&lower)
            || match object.parse::<u32>() {
                Ok(number) => self.numbers.contains(&number),
                Err(_) => is_some_missing,
            }
    }
}

/// Standard error, and whether anything unusable was reported there.
struct Notes {
    errors: io::StderrLock<'static>,
    is_complete: bool,
}

impl Notes {
    /// Reports the unusable sets of a file, and the oddities of usable ones.
    fn file(&mut self, merged: &Merged, request: &SearchRequest<'_>) {
        let Merged { file, summary, holds_elements } = merged;
        let object =
            |object: &Option<String>| object.clone().unwrap_or_else(|| "unnamed object".to_owned());
        // Any object may have been in a file without elements.
        let concerns =
            |object: &Option<String>| !holds_elements || request.concerns(object.as_deref());
        for Refusal { line, object: name, reason } in &summary.refused {
            if concerns(name) {
                self.unusable(&format!("{file}:{line}: {}: {reason}", object(name)));
            }
        }
        if summary.refused_unlisted > 0 && (request.is_everything() || !holds_elements) {
            self.unusable(&format!("{file}: {} more were refused", summary.refused_unlisted));
        }
        if let Some(nothing) = summary.nothing {
            self.unusable(&format!("{file}: no elements, {nothing}"));
        }
        for Note { line, object: name, kind } in &summary.notes {
            if concerns(name) {
                self.line(&format!("{file}:{line}: {}: {kind}; used all the same", object(name)));
            }
        }
    }

    fn unusable(&mut self, sentence: &str) {
        self.is_complete = false;
        self.line(sentence);
    }

    fn line(&mut self, sentence: &str) {
        // An error is ignored: standard error is closed.
        let _ = writeln!(self.errors, "{sentence}");
    }
}
