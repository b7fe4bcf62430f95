//! Saves elements, passes, look angles and the plan to files that the operator names in the dialog
//! of the desktop, on a thread.

use std::{
    collections::{BTreeMap, btree_map::Entry},
    io::{self, Write as _},
    sync::Arc,
};

use jiff::Timestamp;

use super::App;
use crate::{
    astro::time::seconds_between,
    desktop::file_dialog,
    engine::{
        CatalogState,
        passes::{PassKey, PassLists, PredictedPass},
        schedule::Planned,
    },
    job::Job,
    model::export::{ElementForm, Export, SavedFile},
    orbit::{PassSearch, write_omm_csv, write_omm_json, write_tle},
    plan::{
        pass_export::{
            ExportedPass, LookFormat, LookList, PassFormat, PassList, PassQuery, Satellite,
        },
        schedule::LeftOut,
        schedule_export::{ScheduleFormat, ScheduleList},
    },
    station::Station,
    ui::{hand_over_sheet::HandOverSheet, words},
    whole_file,
};

/// Seconds between two look angles, the smallest first.
const STEPS_S: [f64; 3] = [1.0, 10.0, 60.0];
/// Most rows of a table of look angles, unless the largest step takes more.
const MOST_ROWS: f64 = 3600.0;

/// The file that was written; `None` after Cancel.
type Saved = Result<Option<SavedFile>, String>;

/// Saves one file at a time.
#[derive(Default)]
pub(super) struct ExportWork {
    job: Option<Job<Saved>>,
}

/// What is written, with all that it takes.
struct Order {
    export: Export,
    catalog: CatalogState,
    lists: PassLists,
    schedule: Arc<Planned>,
    station: Arc<Station>,
    span_h: u32,
    now: Timestamp,
}

impl App {
    /// Shows the dialog and writes the file, unless another one is being written.
    pub(super) fn save_export(&mut self, export: Export) {
        if self.export_work.job.is_some() {
            let why = "another file is being saved; its dialog may be behind this window";
            return self.views.file_saved(Err(why.to_owned()));
        }
        let model = &self.model;
        let order = Order {
            export,
            catalog: model.catalog.clone(),
            lists: model.pass_lists.clone(),
            schedule: Arc::clone(&model.schedule),
            station: Arc::clone(&model.station),
            span_h: model.list.span_h(),
            now: model.now,
        };
        let work = move |_: &(dyn Fn() -> bool + Sync)| order.save();
        match Job::start("azel-export", Arc::clone(&self.wake), work) {
            Ok(job) => self.export_work.job = Some(job),
            Err(error) => self.views.file_saved(Err(format!("no thread for the file: {error}"))),
        }
    }

    /// Takes the result of the thread.
    pub(super) fn take_export(&mut self) {
        let Some(end) = Job::take(&mut self.export_work.job) else { return };
        match end.unwrap_or_else(|broke_off| Err(broke_off.to_string())) {
            Ok(None) => {}
            Ok(Some(file)) => self.views.file_saved(Ok(file)),
            Err(why) => self.views.file_saved(Err(why)),
        }
    }
}

impl Order {
    fn save(&self) -> Saved {
        let title = match self.export {
            Export::Elements { .. } => "Save elements",
            Export::Passes { .. } => "Save passes",
            Export::Looks { .. } => "Save look angles",
            Export::Schedule { .. } => "Save the plan",
            Export::HandOverSheet => "Save the hand-over sheet",
        };
        let asked = file_dialog::file_to_save(title, &self.name());
        let Some(path) = asked.map_err(|error| error.to_string())? else { return Ok(None) };
        let (text, left_out) = self.text().map_err(|why| format!("{why}: {}", path.display()))?;
        match whole_file::replace_for_others(&path, &text) {
            Ok(()) => Ok(Some(SavedFile { path, left_out })),
            Err(error) => Err(format!("{error}: {}", path.display())),
        }
    }

    /// The name that the dialog offers.
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
            Export::HandOverSheet => format!("hand-over-{}.svg", stamp(self.now)),
        }
    }

    /// The text of the file, and the number of objects that it cannot carry.
    fn text(&self) -> Result<(Vec<u8>, usize), String> {
        let mut text = Vec::new();
        let mut left_out = 0;
        let written = match &self.export {
            Export::Elements { numbers, form } => {
                self.write_elements(numbers, *form, &mut text).map(|count| left_out = count)
            }
            Export::Passes { keys, format } => self.write_passes(keys, *format, &mut text)?,
            Export::Looks { pass, format } => self.write_looks(*pass, *format, &mut text)?,
            Export::Schedule { format } => self.write_schedule(*format, &mut text),
            Export::HandOverSheet => self.write_sheet(&mut text),
        };
        written.map_err(|error| error.to_string())?;
        if left_out > 0 && text.is_empty() {
            return Err("a TLE can carry none of these objects".to_owned());
        }
        Ok((text, left_out))
    }

    /// Returns the number of objects that the form cannot carry.
    fn write_elements(
        &self,
        numbers: &[u32],
        form: ElementForm,
        out: &mut Vec<u8>,
    ) -> io::Result<usize> {
        let CatalogState::Ready(catalog) = &self.catalog else { return Ok(0) };
        let elements = numbers.iter().filter_map(|number| catalog.get(*number));
        match form {
            ElementForm::Tle => write_tle(elements, out).map(|refused| refused.len()),
            ElementForm::OmmJson => write_omm_json(elements, out).map(|()| 0),
            ElementForm::OmmCsv => write_omm_csv(elements, out).map(|()| 0),
        }
    }

    fn write_passes(
        &self,
        keys: &[PassKey],
        format: PassFormat,
        out: &mut Vec<u8>,
    ) -> Result<io::Result<()>, String> {
        let found: Vec<&PredictedPass> =
            keys.iter().filter_map(|key| self.lists.find(*key)).collect();
        let mut satellites = BTreeMap::new();
        for predicted in &found {
            if let Entry::Vacant(place) = satellites.entry(predicted.number()) {
                place.insert(satellite(predicted)?);
            }
        }
        let with_satellite = found.iter().filter_map(|predicted| {
            let satellite = satellites.get(&predicted.number())?;
            Some(ExportedPass { satellite, pass: &predicted.pass })
        });
        let rows: Vec<_> = with_satellite.collect();
        let station = &self.station;
        let hours = jiff::SignedDuration::from_hours(i64::from(self.span_h));
        let to = self.now.saturating_add(hours).unwrap_or(Timestamp::MAX);
        let search = PassSearch {
            aos_elevation: station.aos_elevation(),
            floor: station.elevation_floor(),
            ..PassSearch::new(station.site, self.now, to)
        };
        let list = PassList {
            rows: &rows,
            // The mask moves no AOS in a list.
            query: &PassQuery { search, mask: None },
            place: Some(&station.name),
            carrier_hz: None,
            alarm_before_s: None,
            now: self.now,
        };
        Ok(list.write(out, format))
    }

    fn write_looks(
        &self,
        pass: PassKey,
        format: LookFormat,
        out: &mut Vec<u8>,
    ) -> Result<io::Result<()>, String> {
        let gone = || "the pass is not in the list any more".to_owned();
        let predicted = self.lists.find(pass).ok_or_else(gone)?;
        let satellite = satellite(predicted)?;
        let (from, to) = (predicted.pass.aos.time, predicted.pass.los.time);
        let whole_s = seconds_between(from, to);
        let fits = |step_s: &f64| whole_s / step_s <= MOST_ROWS;
        let [.., largest_s] = STEPS_S;
        let step_s = STEPS_S.into_iter().find(fits).unwrap_or(largest_s);
        let mut carriers =
            self.station.frequencies.iter().filter(|of| of.satellite == predicted.number());
        // The table has one column of Doppler shifts.
        let carrier_hz = match (carriers.next(), carriers.next()) {
            (Some(only), None) => Some(only.mhz * 1e6),
            _ => None,
        };
        let list = LookList {
            satellite: &satellite,
            site: self.station.site,
            from,
            count: (whole_s / step_s) as u32 + 1,
            step_s,
            carrier_hz,
        };
        Ok(list.write(out, format))
    }

    fn write_schedule(&self, format: ScheduleFormat, out: &mut Vec<u8>) -> io::Result<()> {
        let name = |number: u32| {
            let found = self.lists.satellite(number);
            found.map_or_else(|| number.to_string(), |of| of.elements.name().to_owned())
        };
        let schedule = &self.schedule.schedule;
        let taken = schedule.entries.iter().map(|entry| entry.pass.satellite);
        let left_out = schedule.left_out.iter().map(|left| left.pass.satellite);
        let satellites = taken.chain(left_out).map(|number| (number, name(number))).collect();
        let antennas = self.station.antennas.iter().map(|it| (it.id, it.name.clone())).collect();
        let list = ScheduleList {
            schedule,
            satellites: &satellites,
            antennas: &antennas,
            reason: &|left: &LeftOut| words::schedule::why(&|(number, _)| name(number), &left.why),
            now: self.now,
        };
        list.write(out, format)
    }

    fn write_sheet(&self, out: &mut Vec<u8>) -> io::Result<()> {
        let schedule = &self.schedule.schedule;
        let taken = schedule.entries.iter().map(|entry| entry.pass.satellite);
        let left_out = schedule.left_out.iter().map(|left| left.pass.satellite);
        let known = taken.chain(left_out).filter_map(|number| self.lists.satellite(number));
        let satellites = known
            .map(|it| (it.elements.catalog_number(), (&it.elements, &it.propagator)))
            .collect();
        let until = self.schedule.until.unwrap_or(self.now);
        let span = (self.now, until);
        let sheet = HandOverSheet::new(&self.station, schedule, &satellites, span, self.now);
        out.write_all(sheet.svg().as_bytes())
    }
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

fn pass_extension(format: PassFormat) -> &'static str {
    match format {
        PassFormat::Table => "txt",
        PassFormat::Csv => "csv",
        PassFormat::Json => "json",
        PassFormat::Ics => "ics",
    }
}

fn look_extension(format: LookFormat) -> &'static str {
    match format {
        LookFormat::Table => "txt",
        LookFormat::Csv => "csv",
        LookFormat::Json => "json",
    }
}

fn schedule_extension(format: ScheduleFormat) -> &'static str {
    match format {
        ScheduleFormat::Table => "txt",
        ScheduleFormat::Csv => "csv",
        ScheduleFormat::Json => "json",
        ScheduleFormat::Ics => "ics",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        engine::passes::{ListedSatellite, Observer, PassList as Listed},
        makes::DemoAddresses,
        orbit::{Propagator, bundled, passes, read_elements},
        plan::schedule::{Class, Entry, PassKey as Key, Schedule, Why},
        station::{AntennaId, Frequency, Priority},
    };

    const ISS: u32 = 25_544;

    fn order(export: impl Fn(&[PredictedPass]) -> Export) -> Order {
        let catalog = bundled().unwrap();
        let elements = catalog.get(ISS).unwrap().clone();
        let now = elements.epoch();
        let frequencies = vec![Frequency { satellite: ISS, mhz: 145.8, name: String::new() }];
        let demo = Station::demo(&DemoAddresses::default());
        let station = Station { frequencies, antennas: demo.antennas, ..Station::default() };
        let observer = Arc::new(Observer::of(&station));
        let propagator = Propagator::new(&elements).unwrap();
        let satellite = Arc::new(ListedSatellite { elements, propagator });
        let to = now + jiff::SignedDuration::from_hours(24);
        let search = PassSearch::new(station.site, now, to);
        let found = passes(&satellite.propagator, &search, &|| false).into_iter();
        let listed = found
            .map(|pass| PredictedPass::new(Arc::clone(&satellite), pass, Arc::clone(&observer)));
        let listed: Vec<_> = listed.collect();
        let export = export(&listed);
        let favourites = Listed {
            satellites: vec![satellite].into(),
            passes: Arc::new(listed),
            ..Listed::default()
        };
        let lists = PassLists { favourites, ..PassLists::default() };
        let planned = schedule(&lists, station.antennas[0].id);
        let schedule = Arc::new(Planned { until: Some(to), ..planned });
        let (catalog, station) = (CatalogState::Ready(Arc::new(catalog)), Arc::new(station));
        Order { export, catalog, lists, schedule, station, span_h: 24, now }
    }

    /// The first pass of the lists is taken, the second is not.
    fn schedule(lists: &PassLists, antenna: AntennaId) -> Planned {
        let [taken, left_out, ..] = &lists.favourites.passes[..] else { panic!("two passes") };
        let key = |of: &PredictedPass| Key { satellite: of.number(), aos: of.pass.aos.time };
        let entry = Entry {
            pass: key(taken),
            antenna,
            class: Class::Priority(Priority::default()),
            from: taken.pass.aos.time,
            to: taken.pass.los.time,
            late_s: 0.0,
            early_s: 0.0,
            counted_s: taken.pass.duration_s(),
            worth: 1,
            lost: None,
            axes_deg: [[0.0; 2]; 2],
            after: None,
            slew_s: 12.0,
            set_up_s: 10.0,
            spare_s: None,
            shared_with: None,
            is_fixed: false,
        };
        let why = Why::TooFar;
        let left_out = LeftOut { pass: key(left_out), why, by_antenna: vec![] };
        let schedule =
            Schedule { entries: vec![entry], left_out: vec![left_out], ..Schedule::default() };
        Planned { schedule, ..Planned::default() }
    }

    fn lines(order: &Order) -> Vec<String> {
        let text = String::from_utf8(order.text().unwrap().0).unwrap();
        text.lines().map(str::to_owned).collect()
    }

    #[test]
    fn the_wanted_passes_are_written_in_each_form() {
        let of = |format| {
            order(|listed| {
                let keys = listed.iter().skip(1).map(PredictedPass::key).collect();
                Export::Passes { keys, format }
            })
        };
        let csv = of(PassFormat::Csv);
        let wanted = csv.lists.favourites.passes.len() - 1;
        assert!(wanted > 2 && lines(&csv).len() == wanted + 1, "{:?}", lines(&csv));
        let json: Vec<serde_json::Value> =
            serde_json::from_str(&lines(&of(PassFormat::Json)).join("\n")).unwrap();
        assert_eq!(json.len(), wanted);
        let calendar = lines(&of(PassFormat::Ics));
        let events = calendar.iter().filter(|line| *line == "BEGIN:VEVENT");
        assert_eq!(events.count(), wanted);
        let place = format!("LOCATION:{}", csv.station.name);
        assert!(calendar.contains(&place), "{calendar:#?}");
        assert!(csv.name().starts_with("passes-20") && csv.name().ends_with("Z.csv"));
    }

    #[test]
    fn elements_are_written_in_each_form_and_what_a_tle_cannot_carry_is_counted() {
        const BEYOND: u32 = 799_501_204;
        let of = |form, numbers: &[u32]| {
            let numbers: Arc<[u32]> = numbers.into();
            let mut order = order(|_| Export::Elements { numbers: Arc::clone(&numbers), form });
            let CatalogState::Ready(catalog) = &mut order.catalog else { unreachable!() };
            let iss = String::from_utf8({
                let mut text = Vec::new();
                write_omm_json([catalog.get(ISS).unwrap()], &mut text).unwrap();
                text
            });
            let beyond = iss.unwrap().replace("25544", &BEYOND.to_string());
            Arc::make_mut(catalog).merge(read_elements(&beyond), "own");
            order
        };
        for form in [ElementForm::Tle, ElementForm::OmmJson, ElementForm::OmmCsv] {
            let order = of(form, &[ISS, BEYOND, 43_013]);
            let (text, left_out) = order.text().unwrap();
            let read = crate::orbit::read_element_bytes(&text).elements;
            let is_tle = form == ElementForm::Tle;
            assert_eq!((read.len(), left_out), if is_tle { (2, 1) } else { (3, 0) }, "{form:?}");
            assert!(read.iter().any(|elements| elements.catalog_number() == ISS));
            assert!(order.name().starts_with("elements-20"), "{}", order.name());
        }
        let none = "a TLE can carry none of these objects".to_owned();
        assert_eq!(of(ElementForm::Tle, &[BEYOND]).text(), Err(none));
    }

    #[test]
    fn look_angles_go_from_aos_to_los_second_by_second() {
        let order =
            order(|listed| Export::Looks { pass: listed[0].key(), format: LookFormat::Csv });
        let pass = &order.lists.favourites.passes[0].pass;
        let rows = lines(&order);
        assert_eq!(rows.len(), pass.duration_s() as usize + 2);
        assert!(rows[0].ends_with("doppler_hz"), "{}", rows[0]);
        let azimuth_deg: f64 = rows[1].split(',').nth(1).unwrap().parse().unwrap();
        assert!((azimuth_deg - pass.aos.direction.azimuth_deg()).abs() < 1e-3);
        assert!(order.name().starts_with("look-25544-20"), "{}", order.name());
    }

    #[test]
    fn the_plan_is_written_with_names_and_reasons() {
        let of = |format| order(|_| Export::Schedule { format });
        let csv = of(ScheduleFormat::Csv);
        let rows = lines(&csv);
        assert_eq!(rows.len(), 3, "{rows:#?}");
        let antenna = &csv.station.antennas[0].name;
        assert!(rows[1].starts_with(&format!("taken,{antenna},25544,ISS")), "{}", rows[1]);
        let reason = "The antenna cannot be there in time from where it stands";
        assert!(rows[2].contains("ISS") && rows[2].ends_with(reason), "{}", rows[2]);
        let calendar = lines(&of(ScheduleFormat::Ics));
        assert_eq!(calendar.iter().filter(|line| *line == "BEGIN:VEVENT").count(), 1);
        assert!(csv.name().starts_with("plan-20") && csv.name().ends_with("Z.csv"));
    }

    #[test]
    fn the_window_and_the_command_line_write_one_hand_over_sheet() {
        let window = order(|_| Export::HandOverSheet);
        let catalog = bundled().unwrap();
        let satellite = Satellite::new(catalog.get(ISS).unwrap().clone()).unwrap();
        let satellites = BTreeMap::from([(ISS, (&satellite.elements, &satellite.propagator))]);
        let span = (window.now, window.now + jiff::SignedDuration::from_hours(24));
        let schedule = &window.schedule.schedule;
        let sheet = HandOverSheet::new(&window.station, schedule, &satellites, span, window.now);
        assert_eq!(lines(&window), sheet.svg().lines().collect::<Vec<_>>());
        assert!(lines(&window).iter().any(|line| line.contains(">1 pass<")));
        assert!(window.name().starts_with("hand-over-20") && window.name().ends_with("Z.svg"));
    }

    #[test]
    fn a_pass_that_has_left_the_list_is_told() {
        let gone = order(|_| Export::Looks {
            pass: (ISS, Timestamp::UNIX_EPOCH),
            format: LookFormat::Json,
        });
        assert_eq!(gone.text(), Err("the pass is not in the list any more".to_owned()));
    }
}
