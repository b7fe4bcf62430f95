use super::*;
use crate::{
    contract,
    contract::passes::{ListedSatellite, Observer, PassList as Listed},
    makes::DemoAddresses,
    orbit::{Propagator, bundled, passes, read_elements},
    plan::schedule::{Entry, LeftOutReason, PassKey as Key, Schedule, testing::entry},
    record::testing,
    station::{AntennaId, Frequency},
};

const ISS: u32 = 25_544;

fn order(export: impl Fn(&[PredictedPass]) -> Export) -> Order {
    let catalog = bundled().unwrap();
    let elements = catalog.get(ISS).unwrap().clone();
    let now = elements.epoch();
    let frequencies = vec![Frequency { satellite: ISS, mhz: 145.8, name: String::new() }];
    let demo = Station::demo(&DemoAddresses::default());
    let station = Station { frequencies, antennas: demo.antennas, ..Station::default() };
    let observer = Arc::new(Observer::from_station(&station));
    let propagator = Propagator::new(&elements).unwrap();
    let satellite = Arc::new(ListedSatellite { elements, propagator });
    let end = now + jiff::SignedDuration::from_hours(24);
    let search = PassSearch::new(station.site, now, end);
    let found = passes(&satellite.propagator, &search, &|| false).into_iter();
    let listed =
        found.map(|pass| PredictedPass::new(Arc::clone(&satellite), pass, Arc::clone(&observer)));
    let listed: Vec<_> = listed.collect();
    let export = export(&listed);
    let favourites = Listed {
        satellites: vec![satellite].into(),
        passes: Arc::new(listed),
        ..Listed::default()
    };
    let lists = PassLists { favourites, ..PassLists::default() };
    let planned = schedule(&lists, station.antennas[0].id);
    let schedule = Arc::new(Planned { end: Some(end), ..planned });
    let (catalog, station) = (CatalogState::Ready(Arc::new(catalog)), Arc::new(station));
    let (recorded, record) = (None, None);
    Order { export, catalog, lists, recorded, record, schedule, station, span_h: 24, now }
}

/// Returns a plan that takes the first pass of the lists and leaves out the second.
fn schedule(lists: &PassLists, antenna: AntennaId) -> Planned {
    let [predicted, left_out, ..] = &lists.favourites.passes[..] else { panic!("two passes") };
    let key = |pass: &PredictedPass| Key { satellite: pass.number(), aos: pass.pass.aos.time };
    let taken_by = Entry {
        slew_s: 12.0,
        set_up_s: 10.0,
        ..entry(antenna, key(predicted), predicted.pass.los.time)
    };
    let reason = LeftOutReason::TooFar;
    let left_out = LeftOut { pass: key(left_out), reason, by_antenna: vec![] };
    let schedule =
        Schedule { entries: vec![taken_by], left_out: vec![left_out], ..Schedule::default() };
    Planned { schedule, ..Planned::default() }
}

fn lines(order: &Order) -> Vec<String> {
    let text = String::from_utf8(order.text().unwrap().0).unwrap();
    text.lines().map(str::to_owned).collect()
}

#[test]
fn the_wanted_passes_are_written_in_each_form() {
    let schedule_order = |format| {
        order(|listed| {
            let keys = listed.iter().skip(1).map(PredictedPass::key).collect();
            Export::Passes { keys, format }
        })
    };
    let csv = schedule_order(EventFormat::Csv);
    let requested = csv.lists.favourites.passes.len() - 1;
    assert!(requested > 2 && lines(&csv).len() == requested + 1, "{:?}", lines(&csv));
    let json: serde_json::Value =
        serde_json::from_str(&lines(&schedule_order(EventFormat::Json)).join("\n")).unwrap();
    assert_eq!(json["passes"].as_array().unwrap().len(), requested);
    let calendar = lines(&schedule_order(EventFormat::Ics));
    let events = calendar.iter().filter(|line| *line == "BEGIN:VEVENT");
    assert_eq!(events.count(), requested);
    let place = format!("LOCATION:{}", csv.station.name);
    assert!(calendar.contains(&place), "{calendar:#?}");
    assert!(csv.name().starts_with("passes-20") && csv.name().ends_with("Z.csv"));
}

#[test]
fn elements_are_written_in_each_form_and_what_a_tle_cannot_carry_is_counted() {
    const LARGE_NUMBER: u32 = 799_501_204;
    let elements_order = |form, numbers: &[u32]| {
        let numbers: Arc<[u32]> = numbers.into();
        let mut order = order(|_| Export::Elements { numbers: Arc::clone(&numbers), form });
        let CatalogState::Ready(catalog) = &mut order.catalog else { unreachable!() };
        let iss = String::from_utf8({
            let mut text = Vec::new();
            write_omm_json([catalog.get(ISS).unwrap()], &mut text).unwrap();
            text
        });
        let large = iss.unwrap().replace("25544", &LARGE_NUMBER.to_string());
        Arc::make_mut(catalog).merge(read_elements(&large), "own");
        order
    };
    for form in [ElementForm::Tle, ElementForm::OmmJson, ElementForm::OmmCsv] {
        let order = elements_order(form, &[ISS, LARGE_NUMBER, 43_013]);
        let (text, left_out) = order.text().unwrap();
        let read = crate::orbit::read_element_bytes(&text).elements;
        let is_tle = form == ElementForm::Tle;
        assert_eq!((read.len(), left_out), if is_tle { (2, 1) } else { (3, 0) }, "{form:?}");
        assert!(read.iter().any(|elements| elements.catalog_number() == ISS));
        assert!(order.name().starts_with("elements-20"), "{}", order.name());
    }
    let none = "a TLE can hold none of these objects".to_owned();
    assert_eq!(elements_order(ElementForm::Tle, &[LARGE_NUMBER]).text(), Err(none));
}

#[test]
fn look_angles_go_from_aos_to_los_second_by_second() {
    let order = order(|listed| Export::Looks { pass: listed[0].key(), format: ListFormat::Csv });
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
    let schedule_order = |format| order(|_| Export::Schedule { format });
    let csv = schedule_order(EventFormat::Csv);
    let rows = lines(&csv);
    assert_eq!(rows.len(), 3, "{rows:#?}");
    let antenna = &csv.station.antennas[0].name;
    assert!(rows[1].starts_with(&format!("taken,{antenna},25544,ISS")), "{}", rows[1]);
    let reason = "The antenna cannot be there in time";
    assert!(rows[2].contains("ISS") && rows[2].contains(reason), "{}", rows[2]);
    let calendar = lines(&schedule_order(EventFormat::Ics));
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
    assert_eq!(lines(&window), sheet.html().lines().collect::<Vec<_>>());
    assert!(lines(&window).iter().any(|line| line.contains(">1 pass<")));
    assert!(window.name().starts_with("hand-over-20") && window.name().ends_with("Z.html"));
}

#[test]
fn without_a_dialog_a_path_among_the_documents_is_proposed() {
    let folder = tempfile::tempdir().unwrap();
    let order = order(|_| Export::HandOverSheet);
    let documents = || Some(folder.path().to_owned());
    let outcome = order.save(|_, _| Err(NoDialog), documents).unwrap();
    let Outcome::AsksForPath(request) = outcome else { panic!("{outcome:?}") };
    assert_eq!(request.path, folder.path().join(order.name()));
    let purpose = PathPurpose::Save { export: order.export.clone(), replaces: false };
    assert_eq!(request.purpose, purpose);
    assert!(request.reason.contains("no file dialogs"), "{request:?}");
    assert_eq!(order.save(|_, _| Ok(None), documents), Ok(Outcome::Cancelled));
}

#[test]
fn a_typed_path_is_written_and_a_file_there_is_replaced_only_if_the_operator_agrees() {
    let folder = tempfile::tempdir().unwrap();
    let order = order(|_| Export::HandOverSheet);
    let save = |path: PathBuf, replaces| order.save_as(TypedPath { path, replaces }).unwrap();
    let problem = |outcome: Outcome, replaces| {
        let Outcome::AsksForPath(request) = outcome else { panic!("{outcome:?}") };
        let export = order.export.clone();
        assert_eq!(request.purpose, PathPurpose::Save { export, replaces });
        request.reason
    };
    let path = folder.path().join("sheet.html");
    let sheet = || std::fs::read(&path).unwrap();
    let saved = SavedFile { path: path.clone(), left_out: 0 };
    assert_eq!(save(path.clone(), false), Outcome::Saved(saved.clone()));
    assert_eq!(sheet(), order.text().unwrap().0);
    std::fs::write(&path, "theirs").unwrap();
    assert_eq!(problem(save(path.clone(), false), true), "this file exists already");
    assert_eq!(sheet(), b"theirs");
    assert_eq!(save(path.clone(), true), Outcome::Saved(saved));
    assert_ne!(sheet(), b"theirs");
    assert!(problem(save("sheet.html".into(), false), false).contains("whole path"));
    assert!(problem(save(folder.path().to_owned(), false), false).contains("folder"));
    let nowhere = folder.path().join("missing").join("sheet.html");
    assert_eq!(problem(save(nowhere.clone(), false), false), "there is no such folder");
    assert!(!nowhere.parent().unwrap().exists());
    let too_long = folder.path().join("s".repeat(1000));
    assert!(problem(save(too_long, false), false).contains("cannot be written"));
}

#[test]
fn a_pass_that_has_left_the_list_is_told() {
    let missing =
        order(|_| Export::Looks { pass: (ISS, Timestamp::UNIX_EPOCH), format: ListFormat::Json });
    assert_eq!(missing.text(), Err("the pass is not in the list any more".to_owned()));
}

#[test]
fn the_passes_of_chosen_days_are_written_into_one_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.sqlite");
    let start: Timestamp = "2026-11-14T23:00:00Z".parse().unwrap();
    let time = |hours: i64| start + jiff::SignedDuration::from_hours(hours);
    let notes = [0, 2, 30].map(|hours| testing::note(AntennaId(1), ISS, time(hours)));
    testing::record(&path, notes);
    let day = |text: &str| text.parse::<Date>().unwrap();
    let days_order = |first: &str, last: &str, format| {
        let (first, last) = (day(first), day(last));
        let query = contract::record::PassQuery::default();
        let order = order(|_| Export::Days { query: query.clone(), first, last, format });
        Order { record: Some(path.clone()), ..order }
    };
    let json = days_order("2026-11-15", "2026-11-16", RowFormat::Json);
    assert_eq!(json.name(), "passes-20261115-20261116.json");
    let value: serde_json::Value = serde_json::from_slice(&json.text().unwrap().0).unwrap();
    let values = value["passes"].as_array().unwrap();
    let begun: Vec<_> =
        values.iter().map(|report| report["report"]["from"].as_str().unwrap()).collect();
    assert_eq!(begun, ["2026-11-15T01:00:00Z", "2026-11-16T05:00:00Z"], "in order of time");
    let csv = lines(&days_order("2026-11-14", "2026-11-14", RowFormat::Csv));
    assert!(csv[0].starts_with("antenna,satellite,name,time,azimuth_deg"), "{}", csv[0]);
    assert_eq!(csv.len(), 1 + testing::POINTS);
    let first = "Dish,25544,ISS (ZARYA),2026-11-14T23:00:00.000Z,";
    assert!(csv[1].starts_with(first), "{}", csv[1]);
    let none = days_order("2026-12-01", "2026-12-02", RowFormat::Csv).text();
    assert_eq!(none, Err("no pass was recorded on these days".to_owned()));
}
