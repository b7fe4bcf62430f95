//! Reads the element files and picks the satellites that are asked for. What
//! cannot be used is named on standard error, object by object.

use std::{
    borrow::Borrow,
    fs::File,
    io::{self, Write as _},
    path::{Path, PathBuf},
};

use anyhow::{Context as _, bail};

use crate::{
    library::disk::read_limited,
    orbit::{Catalog, Elements, Propagator, read_element_bytes},
};

/// Of one file; the whole catalogue as XML has 30 MB.
const MAX_BYTES: u64 = 1 << 30;

/// Elements, ready to be computed with.
pub(super) struct Satellite {
    pub(super) elements: Elements,
    pub(super) propagator: Propagator,
}

impl Borrow<Propagator> for Satellite {
    fn borrow(&self) -> &Propagator {
        &self.propagator
    }
}

/// What the files hold.
pub(super) struct Input {
    /// In the order of their catalogue numbers.
    pub(super) satellites: Vec<Satellite>,
    /// Some object could not be used.
    pub(super) any_refused: bool,
}

/// Reads all `files`, of which `-` is standard input. Only the satellites with
/// `numbers` are used, or all when there are none.
pub(super) fn read(files: &[PathBuf], numbers: &[u32]) -> anyhow::Result<Input> {
    let mut said = Said { errors: io::stderr().lock(), any_refused: false };
    let mut catalog = Catalog::default();
    for file in files {
        let source = file.display().to_string();
        let bytes = bytes_of(file).with_context(|| format!("{source} cannot be read"))?;
        let summary = catalog.merge(read_element_bytes(&bytes), &source);
        for refusal in &summary.refused {
            let object = refusal.object.as_deref().unwrap_or("unnamed object");
            said.refused(&format!("{source}:{}: {object}: {}", refusal.line, refusal.reason));
        }
        if let Some(why) = summary.nothing {
            said.refused(&format!("{source}: no elements, {why}"));
        }
        if summary.refused_unlisted > 0 {
            said.refused(&format!("{source}: {} more were refused", summary.refused_unlisted));
        }
        for note in &summary.notes {
            let object = note.object.as_deref().unwrap_or("unnamed object");
            said.line(&format!(
                "{source}:{}: {object}: {}; used all the same",
                note.line, note.kind
            ));
        }
    }
    for number in numbers.iter().filter(|number| catalog.get(**number).is_none()) {
        said.refused(&format!("{number}: no elements of this object"));
    }
    let mut satellites = Vec::new();
    for elements in catalog.iter() {
        if !numbers.is_empty() && !numbers.contains(&elements.catalog_number()) {
            continue;
        }
        match Propagator::new(elements) {
            Ok(propagator) => {
                satellites.push(Satellite { elements: elements.clone(), propagator });
            }
            Err(reason) => said.refused(&format!("{}: {reason}", elements.label())),
        }
    }
    if satellites.is_empty() {
        bail!("There are no elements to compute with.");
    }
    Ok(Input { satellites, any_refused: said.any_refused })
}

fn bytes_of(file: &Path) -> io::Result<Vec<u8>> {
    if file == Path::new("-") {
        read_limited(io::stdin().lock(), MAX_BYTES)
    } else {
        read_limited(File::open(file)?, MAX_BYTES)
    }
}

/// What the operator is told on the way.
struct Said {
    errors: io::StderrLock<'static>,
    any_refused: bool,
}

impl Said {
    fn refused(&mut self, sentence: &str) {
        self.any_refused = true;
        self.line(sentence);
    }

    fn line(&mut self, sentence: &str) {
        // Nobody is left to be told that standard error is closed.
        let _ = writeln!(self.errors, "{sentence}");
    }
}
