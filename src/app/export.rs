//! Exports to a file that the operator names in the desktop's dialog, on a thread.

#[cfg(test)]
mod tests;

use std::{
    collections::{BTreeMap, BTreeSet, btree_map::Entry},
    io::{self, Write as _},
    path::{Path, PathBuf},
    sync::Arc,
};

use jiff::{Timestamp, civil::Date, tz::TimeZone};

use super::{App, open_file::unusable};
use crate::{
    astro::time::seconds_between,
    contract::{
        self, CatalogState,
        passes::{PassListKey, PassLists, PredictedPass},
        record::OpenedPass,
        recorded::Recorded,
        schedule::Planned,
    },
    desktop::{
        file_dialog::{self, NoDialog},
        folder,
    },
    export::{
        EventFormat, ExportedPass, ListFormat, LookList, PassList, PassQuery, PlanList, RowFormat,
        Satellite, points, reports,
    },
    job::Job,
    model::{
        export::{ElementForm, Export, ReportFormat, SavedFile},
        typed_path::{PathPurpose, PathRequest, TypedPath},
    },
    orbit::{PassSearch, write_omm_csv, write_omm_json, write_tle},
    plan::schedule::LeftOut,
    record::{self},
    station::{AntennaId, Station},
    ui::{hand_over_sheet::HandOverSheet, report_sheet, words},
    whole_file,
};

/// Steps between two look angles, seconds, smallest first.
const STEPS_S: [f64; 3] = [1.0, 10.0, 60.0];
/// Max rows in a table of look angles; only the largest step may exceed it.
const MAX_ROWS: f64 = 3600.0;

/// Result of a request to save a file.
#[derive(Debug, PartialEq, Eq)]
enum Outcome {
    Saved(SavedFile),
    Cancelled,
    /// Request for a typed path.
    AsksForPath(PathRequest),
}

/// Dialog that asks for a file to save, from a title and a name; `None` after Cancel.
type SaveDialog = fn(&str, &str) -> Result<Option<PathBuf>, NoDialog>;

/// Job that saves one file at a time.
pub(super) struct ExportWork {
    job: Option<Job<Result<Outcome, String>>>,
    dialog: SaveDialog,
}

impl Default for ExportWork {
    fn default() -> Self {
        Self { job: None, dialog: file_dialog::file_to_save }
    }
}

/// Export to write, with all the data that it needs.
struct Order {
    export: Export,
    catalog: CatalogState,
    lists: PassLists,
    recorded: Option<Arc<Recorded>>,
    /// Path of the record.
    record: Option<PathBuf>,
    schedule: Arc<Planned>,
    station: Arc<Station>,
    span_h: u32,
    now: Timestamp,
}

impl App {
    /// Makes the app save and open files as on a desktop without dialogs.
    #[must_use]
    pub fn without_file_dialogs(mut self) -> Self {
        self.export_work.dialog = |_, _| Err(NoDialog);
        self.open_work.dialog = |_, _| Err(NoDialog);
        self
    }

    /// Writes the file to the typed path or to the dialog's path, unless another save is running.
    pub(super) fn save_export(&mut self, export: Export, typed: Option<TypedPath>) {
        if self.export_work.job.is_some() {
            let reason = "another file is being saved; its dialog may be behind this window";
            return self.views.file_saved(Err(reason.to_owned()));
        }
        let model = &self.model;
        let order = Order {
            export,
            catalog: model.catalog.clone(),
            lists: model.pass_lists.clone(),
            recorded: model.recorded.clone(),
            record: model.record.as_ref().map(|record| record.path.clone()),
            schedule: Arc::clone(&model.schedule),
            station: Arc::clone(&model.station),
            span_h: model.list.span_h(),
            now: model.now,
        };
        let dialog = self.export_work.dialog;
        let work = move |_: &(dyn Fn() -> bool + Sync)| match typed {
            Some(typed) => order.save_as(typed),
            None => order.save(dialog, folder::documents),
        };
        self.export_work.job = Some(Job::start("azel-export", Arc::clone(&self.wake), work));
    }

    /// Takes the result of the export thread.
    pub(super) fn take_export(&mut self) {
        let Some(end) = Job::take(&mut self.export_work.job) else { return };
        match end.unwrap_or_else(|broke_off| Err(broke_off.to_string())) {
            Ok(Outcome::Cancelled) => {}
            Ok(Outcome::Saved(file)) => self.views.file_saved(Ok(file)),
            Ok(Outcome::AsksForPath(request)) => self.views.ask_for_path(request),
            Err(reason) => self.views.file_saved(Err(reason)),
        }
    }
}

impl Order {
    /// Saves to the path from the dialog. Without a dialog, proposes a name in the folder that
    /// `documents` returns.
    fn save(
        &self,
        dialog: impl FnOnce(&str, &str) -> Result<Option<PathBuf>, NoDialog>,
        documents: impl FnOnce() -> Option<PathBuf>,
    ) -> Result<Outcome, String> {
        let title = match self.export {
            Export::Elements { .. } => "Save elements",
            Export::Passes { .. } => "Save passes",
            Export::Looks { .. } => "Save look angles",
            Export::Schedule { .. } => "Save the plan",
            Export::HandOverSheet => "Save the hand-over sheet",
            Export::Report { .. } => "Save the report",
            Export::Days { .. } => "Save the reports",
        };
        let name = self.name();
        match dialog(title, &name) {
            Ok(None) => Ok(Outcome::Cancelled),
            Ok(Some(path)) => {
                let (text, left_out) =
                    self.text().map_err(|reason| format!("{reason}: {}", path.display()))?;
                match whole_file::replace_for_others(&path, &text) {
                    Ok(()) => Ok(Outcome::Saved(SavedFile { path, left_out })),
                    Err(error) => Err(format!("{error}: {}", path.display())),
                }
            }
            Err(no_dialog) => {
                let path = documents().unwrap_or_default().join(name);
                Ok(self.ask_for_path(path, false, no_dialog.to_string()))
            }
        }
    }

    /// Saves to a typed path, or asks for the path again.
    fn save_as(&self, typed: TypedPath) -> Result<Outcome, String> {
        let TypedPath { path, replaces } = typed;
        let reason = if let Some(reason) = unusable(&path) {
            reason
        } else if !path.parent().is_some_and(Path::is_dir) {
            // Refuse a missing folder, or Azel would create a mistyped one.
            "there is no such folder"
        } else if !replaces && path.exists() {
            return Ok(self.ask_for_path(path, true, "this file exists already".to_owned()));
        } else {
            let (text, left_out) = self.text()?;
            return Ok(match whole_file::replace_for_others(&path, &text) {
                Ok(()) => Outcome::Saved(SavedFile { path, left_out }),
                Err(error) => {
                    self.ask_for_path(path, false, format!("the file cannot be written: {error}"))
                }
            });
        };
        Ok(self.ask_for_path(path, false, reason.to_owned()))
    }

    fn ask_for_path(&self, path: PathBuf, replaces: bool, reason: String) -> Outcome {
        let purpose = PathPurpose::Save { export: self.export.clone(), replaces };
        Outcome::AsksForPath(PathRequest { purpose, path, reason })
    }

    /// Returns the file name that the dialog offers.
    fn name(&self) -> String {
        let stamp = |time: Timestamp| time.strftime("%Y%m%dT%H%MZ").to_string();
        match &self.export {
            Export::Elements { form, .. } => {
                format!("elements-{}.{}", stamp(self.now), element_extension(*form))
            }
            Export::Passes { format, .. } => {
                format!("passes-{}.{}", stamp(self.now), pass_extension(*format))
            }
            Export::Looks { pass: (number, aos), format } => {
                format!("look-{number}-{}.{}", stamp(*aos), look_extension(*format))
            }
            Export::Schedule { format } => {
                format!("plan-{}.{}", stamp(self.now), schedule_extension(*format))
            }
            Export::HandOverSheet => format!("hand-over-{}.html", stamp(self.now)),
            Export::Report { format } => {
                let start = self.opened().map(|opened| opened.pass.report.start);
                let extension = match format {
                    ReportFormat::Csv => "csv",
                    ReportFormat::Json => "json",
                    ReportFormat::Html => "html",
                };
                format!("pass-{}.{extension}", stamp(start.unwrap_or(self.now)))
            }
            Export::Days { first, last, format, .. } => {
                let extension = match format {
                    RowFormat::Csv => "csv",
                    RowFormat::Json => "json",
                };
                let [first, last] = [first, last].map(|day| day.strftime("%Y%m%d"));
                format!("passes-{first}-{last}.{extension}")
            }
        }
    }

    /// Returns the text of the file, and the number of objects that the file format cannot hold.
    fn text(&self) -> Result<(Vec<u8>, usize), String> {
        let mut text = Vec::new();
        let mut left_out = 0;
        match &self.export {
            Export::Elements { numbers, form } => {
                left_out = self.write_elements(numbers, *form, &mut text)?;
            }
            Export::Passes { keys, format } => self.write_passes(keys, *format, &mut text)?,
            Export::Looks { pass, format } => self.write_looks(*pass, *format, &mut text)?,
            Export::Schedule { format } => self.write_schedule(*format, &mut text)?,
            Export::HandOverSheet => self.write_sheet(&mut text)?,
            Export::Report { format } => self.write_report(*format, &mut text)?,
            Export::Days { query, first, last, format } => {
                let passes = self.passes_of(query, *first, *last)?;
                write_days(&passes, *format, &mut text)?;
            }
        }
        if left_out > 0 && text.is_empty() {
            return Err("a TLE can hold none of these objects".to_owned());
        }
        Ok((text, left_out))
    }

    /// Returns the opened pass of the record.
    fn opened(&self) -> Option<&OpenedPass> {
        self.recorded.as_ref()?.found.as_ref().ok()?.opened.as_ref()
    }

    fn write_report(&self, format: ReportFormat, out: &mut Vec<u8>) -> Result<(), String> {
        let opened = self.opened().ok_or("no pass of the record is shown any more")?;
        let passes = std::slice::from_ref(opened);
        in_words(match format {
            ReportFormat::Csv => points(out, passes),
            ReportFormat::Json => reports(out, passes),
            ReportFormat::Html => out.write_all(report_sheet::html(opened, self.now).as_bytes()),
        })
    }

    /// Returns the recorded passes from `first` to `last` that match `query`, in order of time.
    fn passes_of(
        &self,
        query: &contract::record::PassQuery,
        first: Date,
        last: Date,
    ) -> Result<Vec<OpenedPass>, String> {
        let path = self.record.as_deref().ok_or("nothing is recorded")?;
        let begins = |day: Date| day.to_zoned(TimeZone::UTC).map(|day| day.timestamp());
        let span = begins(first)
            .and_then(|start| Ok(start..begins(last.tomorrow()?)?))
            .map_err(|error| error.to_string())?;
        let passes = record::passes_within(path, query, &span, self.station.site);
        let passes = passes.map_err(|error| error.to_string())?;
        if passes.is_empty() {
            return Err("no pass was recorded on these days".to_owned());
        }
        Ok(passes)
    }

    /// Writes the elements; returns the number of objects that the form cannot hold.
    fn write_elements(
        &self,
        numbers: &[u32],
        form: ElementForm,
        out: &mut Vec<u8>,
    ) -> Result<usize, String> {
        let CatalogState::Ready(catalog) = &self.catalog else { return Ok(0) };
        let elements = numbers.iter().filter_map(|number| catalog.get(*number));
        let written = match form {
            ElementForm::Tle => write_tle(elements, out).map(|refused| refused.len()),
            ElementForm::OmmJson => write_omm_json(elements, out).map(|()| 0),
            ElementForm::OmmCsv => write_omm_csv(elements, out).map(|()| 0),
        };
        in_words(written)
    }

    fn write_passes(
        &self,
        keys: &[PassListKey],
        format: EventFormat,
        out: &mut Vec<u8>,
    ) -> Result<(), String> {
        let found: Vec<&PredictedPass> =
            keys.iter().filter_map(|key| self.lists.find(*key)).collect();
        let satellites = satellites(&found)?;
        let list = PassList {
            query: &self.query(),
            place: Some(&self.station.name),
            carrier_hz: None,
            alarm_before_s: None,
            now: self.now,
        };
        in_words(list.write(out, format, exported(&found, &satellites)))
    }

    /// Returns the search that found the listed passes.
    fn query(&self) -> PassQuery {
        let station = &self.station;
        let hours = jiff::SignedDuration::from_hours(i64::from(self.span_h));
        let end = self.now.saturating_add(hours).unwrap_or(Timestamp::MAX);
        let search = PassSearch {
            aos_elevation: station.aos_elevation(),
            floor: station.elevation_floor(),
            ..PassSearch::new(station.site, self.now, end)
        };
        // The AOS times of a pass list ignore the mask.
        PassQuery { search, mask: None }
    }

    fn write_looks(
        &self,
        pass: PassListKey,
        format: ListFormat,
        out: &mut Vec<u8>,
    ) -> Result<(), String> {
        let missing = || "the pass is not in the list any more".to_owned();
        let predicted = self.lists.find(pass).ok_or_else(missing)?;
        let satellite = satellite(predicted)?;
        let (start, end) = (predicted.pass.aos.time, predicted.pass.los.time);
        let whole_s = seconds_between(start, end);
        let fits = |step_s: &f64| whole_s / step_s <= MAX_ROWS;
        let [.., largest_s] = STEPS_S;
        let step_s = STEPS_S.into_iter().find(fits).unwrap_or(largest_s);
        let mut carriers = self
            .station
            .frequencies
            .iter()
            .filter(|frequency| frequency.satellite == predicted.number());
        // The table has a single Doppler column, so only a single frequency can fill it.
        let carrier_hz = match (carriers.next(), carriers.next()) {
            (Some(only), None) => Some(only.mhz * 1e6),
            _ => None,
        };
        let list = LookList {
            satellite: &satellite,
            site: self.station.site,
            start,
            count: (whole_s / step_s) as u32 + 1,
            step_s,
            carrier_hz,
        };
        in_words(list.write(out, format))
    }

    fn write_schedule(&self, format: EventFormat, out: &mut Vec<u8>) -> Result<(), String> {
        let name = |number: u32| {
            let found = self.lists.satellite(number);
            found.map_or_else(|| number.to_string(), |listed| listed.elements.name().to_owned())
        };
        let schedule = &self.schedule.schedule;
        let taken_numbers = schedule.entries.iter().map(|entry| entry.pass.satellite);
        let left_out = schedule.left_out.iter().map(|left| left.pass.satellite);
        let names =
            taken_numbers.clone().chain(left_out).map(|number| (number, name(number))).collect();
        let taken_set: BTreeSet<u32> = taken_numbers.collect();
        let favourites = self.lists.favourites.passes.iter();
        let planned: Vec<&PredictedPass> =
            favourites.filter(|pass| taken_set.contains(&pass.number())).collect();
        let satellites = satellites(&planned)?;
        let passes: Vec<ExportedPass<'_>> = exported(&planned, &satellites).collect();
        let antennas: BTreeMap<AntennaId, String> = self
            .station
            .antennas
            .iter()
            .map(|configured| (configured.id, configured.name.clone()))
            .collect();
        let names_in_reasons = words::schedule::Names {
            pass: &|(number, _)| name(number),
            antenna: &|id| antennas.get(&id).cloned().unwrap_or_default(),
        };
        let list = PlanList {
            schedule,
            satellites: &names,
            antennas: &antennas,
            reason: &|left: &LeftOut| {
                words::schedule::left_out_reason(names_in_reasons, &left.reason)
            },
            passes: &passes,
            query: &self.query(),
            now: self.now,
        };
        in_words(list.write(out, format))
    }

    fn write_sheet(&self, out: &mut Vec<u8>) -> Result<(), String> {
        let schedule = &self.schedule.schedule;
        let taken_numbers = schedule.entries.iter().map(|entry| entry.pass.satellite);
        let left_out = schedule.left_out.iter().map(|left| left.pass.satellite);
        let known_satellites =
            taken_numbers.chain(left_out).filter_map(|number| self.lists.satellite(number));
        let satellites = known_satellites
            .map(|listed| {
                (listed.elements.catalog_number(), (&listed.elements, &listed.propagator))
            })
            .collect();
        let end = self.schedule.end.unwrap_or(self.now);
        let span = (self.now, end);
        let sheet = HandOverSheet::new(&self.station, schedule, &satellites, span, self.now);
        in_words(out.write_all(sheet.html().as_bytes()))
    }
}

/// Returns the satellites of `passes` by catalog number.
fn satellites(passes: &[&PredictedPass]) -> Result<BTreeMap<u32, Satellite>, String> {
    let mut satellites = BTreeMap::new();
    for predicted in passes {
        if let Entry::Vacant(place) = satellites.entry(predicted.number()) {
            place.insert(satellite(predicted)?);
        }
    }
    Ok(satellites)
}

fn exported<'a>(
    passes: &[&PredictedPass],
    satellites: &'a BTreeMap<u32, Satellite>,
) -> impl Iterator<Item = ExportedPass<'a>> {
    passes.iter().filter_map(|predicted| {
        let satellite = satellites.get(&predicted.number())?;
        Some(ExportedPass { satellite, pass: predicted.pass })
    })
}

fn write_days(passes: &[OpenedPass], format: RowFormat, out: &mut Vec<u8>) -> Result<(), String> {
    in_words(match format {
        RowFormat::Csv => points(out, passes),
        RowFormat::Json => reports(out, passes),
    })
}

/// Converts an I/O error to the text of the system.
fn in_words<T>(written: io::Result<T>) -> Result<T, String> {
    written.map_err(|error| error.to_string())
}

fn satellite(predicted: &PredictedPass) -> Result<Satellite, String> {
    Satellite::new(predicted.satellite.elements.clone()).map_err(|error| error.to_string())
}

fn element_extension(form: ElementForm) -> &'static str {
    match form {
        ElementForm::Tle => "tle",
        ElementForm::OmmJson => "json",
        ElementForm::OmmCsv => "csv",
    }
}

fn pass_extension(format: EventFormat) -> &'static str {
    match format {
        EventFormat::Table => "txt",
        EventFormat::Csv => "csv",
        EventFormat::Json => "json",
        EventFormat::Ics => "ics",
    }
}

fn look_extension(format: ListFormat) -> &'static str {
    match format {
        ListFormat::Table => "txt",
        ListFormat::Csv => "csv",
        ListFormat::Json => "json",
    }
}

fn schedule_extension(format: EventFormat) -> &'static str {
    match format {
        EventFormat::Table => "txt",
        EventFormat::Csv => "csv",
        EventFormat::Json => "json",
        EventFormat::Ics => "ics",
    }
}
