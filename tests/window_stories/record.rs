//! Record view: tracked passes and their results.

use std::sync::Arc;

use azel::{
    astro::{
        Angle, AzEl, HorizonMask, Offset, PointingModel, Site, TrackOffsets, time::add_seconds,
    },
    contract::{
        Command,
        alarms::{Alarm, AlarmKind},
        automatic::{Flown, Interruption, MissCause},
        driver::{self, TimeSync},
        record::{
            AboutTrack, ExplainedPasses, ListedKind, OpenedPass, PassPage, PassQuery, RecordedPass,
            RecordedReport, Row, TrackedBy,
        },
        recorded::{Found, MissedPass, RecordLook, Recorded},
    },
    device::{
        Pointing,
        settings::{Change, Value, Written},
    },
    export::{self, RowFormat},
    model::{
        Model, UiCommand, View,
        export::{Export, ReportFormat},
    },
    orbit::{Pass, PassSearch, Propagator, bundled, passes},
    plan::{
        Sample,
        pass_report::{
            Cause, Evidence, Explanation, FlownOffsets, LossCause, LostStretch, MeasuredPosition,
            PassReport, PassVerdict, PathSource, PointingError, TrackPoint, WorstError,
        },
    },
    station::{self, OffsetsSubject},
    ui::{format, theme},
};
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use jiff::ToSpan as _;

use crate::window_stories::{
    every_view::painted,
    extremes::{nothing_is_cut, nothing_overlaps},
    preferences,
    rig::{self, LARGE, NOAA_20, SIZES, Window, asked, says, settle},
    settings_rig, states,
};

/// Delay of the antenna behind the satellite, seconds.
const LATE_S: f64 = 0.8;
const HALF_BEAM_DEG: f64 = 0.44;

/// Returns passes of the previous day, newest first, each with the flight of an antenna.
fn flown(model: &Model) -> Vec<OpenedPass> {
    let elements = bundled().unwrap().get(NOAA_20).unwrap().clone();
    let propagator = Propagator::new(&elements).unwrap();
    let search = PassSearch::new(model.station.site, model.now - 24.hours(), model.now - 1.hour());
    let mut found = passes(&propagator, &search, &|| false);
    found.sort_by_key(|pass| std::cmp::Reverse(pass.aos.time));
    let kinds = [PassVerdict::Fair, PassVerdict::Good, PassVerdict::Poor];
    let both = found.iter().zip(kinds.into_iter().cycle());
    (1..).zip(both).map(|(id, (pass, verdict))| opened(model, id, pass, verdict)).collect()
}

fn opened(model: &Model, id: i64, pass: &Pass, verdict: PassVerdict) -> OpenedPass {
    let elements = bundled().unwrap().get(NOAA_20).unwrap().clone();
    let propagator = Propagator::new(&elements).unwrap();
    let site = model.station.site.airless();
    let at = |time| propagator.look_from(site, time).unwrap().direction;
    let (from, until) = (pass.aos.time, pass.los.time);
    let late_s = if verdict == PassVerdict::Good { 0.02 } else { LATE_S };
    let positions: Vec<MeasuredPosition> = (0..pass.duration_s() as u32)
        .map(|second| {
            let time = add_seconds(from, f64::from(second));
            let AzEl { azimuth, elevation } = at(add_seconds(time, -late_s));
            let pointing = Pointing { azimuth: Some(azimuth), elevation: Some(elevation) };
            MeasuredPosition { time, pointing }
        })
        .collect();
    let point = |flown: &MeasuredPosition| TrackPoint::new(&propagator, site, true, *flown);
    let track: Vec<TrackPoint> = positions.iter().filter_map(point).collect();
    let worst = track.iter().max_by(|a, b| a.error.off_deg.total_cmp(&b.error.off_deg)).unwrap();
    let rms = |part: fn(&PointingError) -> f64| {
        let squares: f64 = track.iter().map(|point| part(&point.error).powi(2)).sum();
        (squares / track.len() as f64).sqrt()
    };
    let counted_s = pass.duration_s();
    let lost_s = if verdict == PassVerdict::Poor { 90.0 } else { 0.0 };
    let report = PassReport {
        verdict,
        counted_s,
        known_s: counted_s - lost_s,
        in_beam_s: counted_s * if verdict == PassVerdict::Good { 1.0 } else { 0.98 } - lost_s,
        rms: Some(PointingError {
            off_deg: rms(|error| error.off_deg),
            azimuth_deg: rms(|error| error.azimuth_deg),
            elevation_deg: rms(|error| error.elevation_deg),
            along_deg: rms(|error| error.along_deg),
            across_deg: rms(|error| error.across_deg),
        }),
        worst: Some(WorstError { time: worst.time, error: worst.error }),
        losses: (lost_s > 0.0)
            .then(|| LostStretch {
                start: from,
                end: add_seconds(from, lost_s),
                cause: LossCause::NotMeasured,
            })
            .into_iter()
            .collect(),
    };
    let measured = track.iter().map(|point| (point.time, point.antenna));
    let source = PathSource::Unit { clock_ahead_s: Some(-LATE_S), place: None };
    let causes =
        Evidence::new(model.station.antennas[0].mount, true, Angle::from_degrees(HALF_BEAM_DEG))
            .with_pass(&propagator, site, source, measured)
            .explanations(&[]);
    let step = |step: u32| {
        let time = add_seconds(from, 2.0 * f64::from(step)).min(until);
        Sample { time, direction: at(time) }
    };
    let report = RecordedReport {
        start: from,
        end: until,
        planned: None,
        max_elevation_deg: pass.max_elevation().degrees(),
        age_days: 0.4,
        elements,
        site: Some(site),
        half_beam_deg: HALF_BEAM_DEG,
        track: AboutTrack {
            begun: add_seconds(from, -30.0),
            tracked_by: TrackedBy::OnBoard,
            sent: None,
            offsets: FlownOffsets::default(),
            pointing_model: PointingModel::default(),
            unit_clock_ahead_s: Some(-LATE_S),
            unit_place: None,
            sync: TimeSync::Synchronised,
        },
        report,
        causes: if verdict == PassVerdict::Good { Vec::new() } else { causes },
    };
    let antenna = &model.antennas[0];
    OpenedPass {
        pass: RecordedPass {
            id,
            antenna: antenna.id(),
            antenna_name: antenna.config.name.clone(),
            report,
        },
        track,
        path: (0..=(counted_s / 2.0) as u32 + 1).map(step).collect(),
        entries: Vec::new(),
    }
}

/// Returns the record of a station with these passes, of which the one at `place` is open.
fn recorded(flown: &[OpenedPass], place: usize) -> Recorded {
    let passes: Vec<RecordedPass> = flown.iter().map(|opened| opened.pass.clone()).collect();
    let count = passes.len() as u32;
    let since = passes.last().map(|pass| pass.report.end);
    let page = PassPage { passes, matching: count, all: count, start: since, unreadable: 0 };
    let opened = flown.get(place).cloned();
    let look = RecordLook {
        query: PassQuery { count: 200, ..PassQuery::default() },
        opened: opened.as_ref().map(|opened| opened.pass.id),
    };
    Recorded { look, found: Ok(Found { page, missed: Vec::new(), opened }), combined: None }
}

fn model() -> (Model, Vec<OpenedPass>) {
    let mut model = rig::model(states::holding());
    let flown = flown(&model);
    model.shown_mut().recorded = Some(Arc::new(recorded(&flown, 0)));
    model.view = View::Record;
    (model, flown)
}

pub(super) fn view(size: [f32; 2]) -> Window {
    rig::window(size, model().0)
}

fn looks(asked: &[UiCommand]) -> Vec<Option<RecordLook>> {
    let look = |command: &UiCommand| match command {
        UiCommand::Station(Command::LookAtRecord(look)) => Some(look.clone()),
        _ => None,
    };
    asked.iter().filter_map(look).collect()
}

#[test]
fn the_record_is_asked_for_while_it_is_shown() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.get_by_role_and_label(Role::Tab, "Record").click();
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Record)]);
        window.key_press_modifiers(Modifiers::COMMAND, Key::Num7);
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Record)]);
        window.state_mut().model.view = View::Record;
        let first = looks(&asked(&mut window));
        let [Some(first)] = &first[..] else { panic!("{first:?}") };
        assert_eq!((first.query.text.as_str(), first.opened), ("", None));
        assert!(says(&window, "The record is being read."));
        settle(&mut window);
        assert_eq!(looks(&asked(&mut window)), [], "asked once");
        window.state_mut().model.view = View::Operate;
        assert_eq!(looks(&asked(&mut window)), [None], "and not any more");
    }
}

#[test]
fn the_newest_pass_is_told_in_a_sentence_and_what_explains_its_error_first() {
    for size in rig::sizes() {
        let (model, flown) = model();
        let newest = &flown[0].pass.report;
        let mut window = rig::window(size, model);
        settle(&mut window);
        let worst = newest.report.worst.unwrap();
        assert!(says(&window, &format!("worst {:.2}°", worst.error.off_deg)));
        assert!(says(&window, "The antenna was 0.80 s late; that explains"));
        assert!(says(&window, "Time offset +0.80 s: explains"));
        assert!(says(&window, "Unit clock: 0.80 s late"));
        assert!(says(&window, "Set the unit's clock first"), "no offset that hides it");
    }
}

#[test]
fn rows_tell_verdict_and_cause_and_the_arrows_lead_through_them() {
    let (model, flown) = model();
    let mut window = rig::window(LARGE, model);
    settle(&mut window);
    let rows: Vec<String> = window
        .query_all_by_role(Role::ListBoxOption)
        .filter_map(|node| node.accesskit_node().label())
        .filter(|label| label.contains("in beam"))
        .collect();
    assert_eq!(rows.len(), flown.len(), "{rows:?}");
    assert!(rows[0].contains("Fair, 98.0 % in beam"), "{}", rows[0]);
    assert!(rows[0].contains("0.80 s late"), "{}", rows[0]);
    assert!(rows[1].contains("Good, 100 % in beam"), "{}", rows[1]);
    assert!(rows[2].contains("not known, No positions 1:30"), "{}", rows[2]);
    let _ = asked(&mut window);
    window.key_press(Key::ArrowDown);
    let look = looks(&asked(&mut window));
    assert_eq!(look[0].as_ref().unwrap().opened, Some(flown[1].pass.id));
    assert!(says(&window, "The pass is being read."), "not the report of the other");
    window.state_mut().model.shown_mut().recorded = Some(Arc::new(recorded(&flown, 1)));
    settle(&mut window);
    assert!(says(&window, "Nothing was lost."));
    assert!(says(&window, "A good pass: there is nothing to explain"));
}

#[test]
fn a_click_on_an_event_moves_the_cursor_there() {
    let (model, flown) = model();
    let mut window = rig::window(LARGE, model);
    settle(&mut window);
    let from = flown[0].pass.report.start.strftime("%H:%M:%SZ").to_string();
    window.get_by_label(&format!("{from}: AOS {from}")).click();
    settle(&mut window);
    let read = window.get_by_role(Role::Slider).accesskit_node().label().unwrap();
    assert!(read.starts_with(&format!("Time in the pass, {from}")), "{read}");
}

#[test]
fn a_report_is_saved_for_other_programs() {
    for (word, format) in [
        ("Page to print (HTML)", ReportFormat::Html),
        ("Points (CSV)", ReportFormat::Csv),
        ("Report (JSON)", ReportFormat::Json),
    ] {
        let mut window = view(LARGE);
        settle(&mut window);
        window.get_by_role_and_label(Role::Button, "Export report").click();
        settle(&mut window);
        let _ = asked(&mut window);
        window.get_by_label(word).click();
        let asked = asked(&mut window);
        assert!(asked.contains(&UiCommand::Save(Export::Report { format })), "{asked:?}");
    }
    let (_, flown) = model();
    let written = |write: fn(&mut Vec<u8>, &[OpenedPass]) -> std::io::Result<()>| {
        let mut text = Vec::new();
        write(&mut text, &flown[..1]).unwrap();
        String::from_utf8(text).unwrap()
    };
    let csv = written(export::points);
    let mut lines = csv.lines();
    let columns = lines.next().unwrap().split(',').count();
    assert_eq!(lines.clone().count(), flown[0].track.len());
    assert!(lines.all(|line| line.split(',').count() == columns));
    let json: serde_json::Value = serde_json::from_str(&written(export::reports)).unwrap();
    assert_eq!(json["format_version"], 1);
    assert_eq!(json["passes"][0]["satellite"], NOAA_20);
    assert_eq!(json["passes"][0]["report"]["verdict"], "fair");
}

/// Returns the record of a station whose unit was read. `set` changes the track of the newest pass,
/// which `cause` alone explains.
fn explained_by(cause: Cause, set: impl FnOnce(&mut AboutTrack)) -> Model {
    let mut model = rig::model(settings_rig::read());
    let mut flown = flown(&model);
    let report = &mut flown[0].pass.report;
    report.causes = vec![Explanation { cause, left_deg: 0.01, share: 0.9, partner: None }];
    set(&mut report.track);
    model.shown_mut().recorded = Some(Arc::new(recorded(&flown, 0)));
    model.view = View::Record;
    model
}

/// Returns a report whose best explanation has a correction.
pub(super) fn to_correct(size: [f32; 2]) -> Window {
    let mut window =
        rig::window(size, explained_by(Cause::AzimuthOffset { offset_deg: 0.25 }, |_| ()));
    settle(&mut window);
    window
}

#[test]
fn a_pass_that_was_not_tracked_stands_in_the_list_and_says_why() {
    for size in SIZES {
        let (mut model, flown) = model();
        let of = &flown[1].pass;
        let aos = of.report.start - 10.minutes();
        let missed = MissedPass {
            id: 77,
            time: of.report.end + 1.minutes(),
            antenna: of.antenna,
            antenna_name: of.antenna_name.clone(),
            flown: Flown {
                pass: (43_689, aos),
                name: "METOP-C".to_owned(),
                of_s: 600.0,
                in_beam_s: 0.0,
                proved_at: None,
                cause: Some(MissCause::Lost(LossCause::LinkLost)),
            },
        };
        let mut recorded = recorded(&flown, 0);
        recorded.found.as_mut().unwrap().missed.push(missed);
        model.shown_mut().recorded = Some(Arc::new(recorded));
        let now = model.now;
        let mut window = rig::window(size, model);
        if size != LARGE {
            window.get_by_role_and_label(Role::Button, "Passes").click();
            settle(&mut window);
        }
        let row = format!(
            "METOP-C, {}, {}: not tracked. The unit did not answer.",
            format::moment(aos, now),
            of.antenna_name,
        );
        let node = window.get_by_label(&row);
        let from = format!("NOAA 20, {}, ", format::moment(of.report.start, now));
        let below = window.get_by_label_contains(&from);
        assert!(node.rect().bottom() <= below.rect().top() + 1.0, "in the order of time");
        window.get_by_label_contains("1 not tracked");
        let texts = painted::texts(&window);
        assert!(texts.iter().any(|of| of == "Not tracked"), "{texts:?}");
        window.get_by_label("Verdict, All verdicts").click();
        settle(&mut window);
        let _ = asked(&mut window);
        window.get_by_label("Not tracked").click();
        let looks = looks(&asked(&mut window));
        let kinds: Vec<_> = looks.iter().flatten().map(|look| look.query.kind).collect();
        assert_eq!(kinds, [Some(ListedKind::NotTracked)]);
    }
}

#[test]
fn a_report_says_why_it_is_not_replayed_where_nothing_is_recorded() {
    for size in rig::sizes() {
        let mut window = rig::window(size, model().0);
        let button = window.get_by_role_and_label(Role::Button, "Replay");
        assert!(button.accesskit_node().is_disabled());
        button.hover();
        settle(&mut window);
        window.get_by_label("Nothing is recorded.");
    }
}

#[test]
fn the_passes_of_chosen_days_are_exported_as_the_list_is_filtered() {
    for size in rig::sizes() {
        let (mut model, _) = model();
        model.shown_mut().record = Some(Arc::default());
        let mut window = rig::window(size, model);
        let press = |window: &mut Window, name: &str| {
            window.get_by_role_and_label(Role::Button, name).click();
            settle(window);
        };
        press(&mut window, "Export days");
        assert!(says(&window, "All recorded passes of these days, in one file."));
        let last = window.get_by_role_and_label(Role::TextInput, "Last day");
        assert_eq!(last.value().as_deref(), Some("2026-08-12"));
        preferences::write(&mut window, "First day", "2026-08-13");
        assert!(says(&window, "The last day is before the first one."));
        let json = window.get_by_role_and_label(Role::Button, "Reports (JSON)");
        assert!(json.accesskit_node().is_disabled());
        preferences::write(&mut window, "First day", "2026-08-01");
        let _ = asked(&mut window);
        press(&mut window, "Points (CSV)");
        let day = |day| jiff::civil::date(2026, 8, day);
        let days = |query, format| {
            UiCommand::Save(Export::Days { query, first: day(1), last: day(12), format })
        };
        let all = PassQuery { count: 200, ..PassQuery::default() };
        assert_eq!(asked(&mut window), [days(all.clone(), RowFormat::Csv)]);
        assert!(window.query_by_label("Points (CSV)").is_none(), "closed");

        preferences::write(&mut window, "Satellite or date", "noaa");
        press(&mut window, "Export days");
        assert!(says(&window, "The passes that the list is filtered to, in one file."));
        preferences::write(&mut window, "First day", "2026-08-01");
        let _ = asked(&mut window);
        window.key_press(Key::Enter);
        let noaa = PassQuery { text: "noaa".to_owned(), ..all };
        assert_eq!(asked(&mut window), [days(noaa, RowFormat::Json)]);
        // The key that opens the dialog is no answer to it.
        window.get_by_role_and_label(Role::Button, "Export days").focus();
        settle(&mut window);
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), []);
        assert!(says(&window, "The passes that the list is filtered to, in one file."));
        window.key_press(Key::E);
        assert_eq!(asked(&mut window), [], "the keys of the view wait");
        press(&mut window, "Cancel");
        window.get_by_label("Verdict, All verdicts").click();
        settle(&mut window);
        window.get_by_label("Not tracked").click();
        settle(&mut window);
        let button = window.get_by_role_and_label(Role::Button, "Export days");
        assert!(button.accesskit_node().is_disabled());
        button.hover();
        settle(&mut window);
        window.get_by_label("A pass that was not tracked has no report.");
    }
}

#[test]
fn without_a_report_there_is_nothing_to_export() {
    let (mut model, _) = model();
    model.shown_mut().recorded = Some(Arc::new(recorded(&[], 0)));
    let mut window = rig::window(LARGE, model);
    let _ = asked(&mut window);
    window.key_press(Key::E);
    assert_eq!(asked(&mut window), []);
}

#[test]
fn a_correction_of_a_unit_is_typed_into_its_form_and_nothing_is_sent() {
    for size in rig::sizes() {
        let model = explained_by(Cause::AzimuthOffset { offset_deg: 0.25 }, |_| ());
        let held = &model.antennas[0].snapshot.state.groups["general"].last_read;
        let Value::Decimal(held_deg) = held.as_ref().unwrap().values["azimuth_offset_deg"] else {
            panic!("{held:?}")
        };
        let mut window = rig::window(size, model);
        settle(&mut window);
        window.get_by_label("Apply…").scroll_to_me();
        settle(&mut window);
        let _ = asked(&mut window);
        window.get_by_label("Apply…").click();
        let led = [UiCommand::SelectAntenna(0), UiCommand::Show(View::Antennas)];
        let all = asked(&mut window);
        assert!(all.ends_with(&led), "{all:?}");
        window.state_mut().model.view = View::Antennas;
        settle(&mut window);
        let named = "Azimuth offset, new value";
        let field = window.get_by_role_and_label(Role::TextInput, named);
        let typed: f64 = field.accesskit_node().value().unwrap().parse().unwrap();
        assert!((typed - (held_deg - 0.25)).abs() < 1e-9, "{typed}");
        assert_eq!(settings_rig::state_of(&window, "Azimuth offset"), "Edited");
        let sent = asked(&mut window);
        let writes = |command: &UiCommand| {
            matches!(
                command,
                UiCommand::Station(Command::Antenna(_, driver::Command::WriteSettings(_)))
            )
        };
        assert!(!sent.iter().any(writes), "{sent:?}");
    }
}

#[test]
fn a_correction_of_what_azel_sends_is_asked_about() {
    let by_program = |about: &mut AboutTrack| {
        about.tracked_by = TrackedBy::ProgramTrack;
        let with = Offset::Elevation(Angle::from_degrees(0.5));
        about.offsets.note(rig::now(), TrackOffsets::NONE.plus(with).unwrap());
    };
    let model = explained_by(Cause::ElevationOffset { offset_deg: 0.2 }, by_program);
    let of = OffsetsSubject::Antenna(model.antennas[0].id());
    let mut window = rig::window(LARGE, model);
    settle(&mut window);
    let _ = asked(&mut window);
    window.key_press(Key::C);
    settle(&mut window);
    assert!(says(&window, "el +0.30°, in place of none?"));
    assert_eq!(asked(&mut window), []);
    window.get_by_role_and_label(Role::Button, "Cancel").click();
    settle(&mut window);
    window.get_by_role_and_label(Role::Button, "Apply…").focus();
    settle(&mut window);
    window.key_press(Key::Enter);
    assert_eq!(asked(&mut window), [], "the press that asks is no answer");
    assert!(says(&window, "el +0.30°, in place of none?"));
    window.key_press(Key::Enter);
    let with = Offset::Elevation(Angle::from_degrees(0.3));
    let offsets = TrackOffsets::NONE.plus(with).unwrap();
    let keep = UiCommand::Station(Command::KeepOffsets { subject: of, offsets });
    assert_eq!(asked(&mut window), [keep]);
    let station = &mut window.state_mut().model.shown_mut().station;
    Arc::make_mut(station).keep_offsets(of, offsets);
    settle(&mut window);
    assert!(window.query_by_label("Apply…").is_none(), "it is remembered");
}

#[test]
fn what_nothing_here_corrects_has_no_correction_and_neither_has_a_setting_written_since() {
    let tilt = Cause::Tilt { north_deg: 0.1, east_deg: 0.2 };
    let mut window = rig::window(LARGE, explained_by(tilt, |_| ()));
    settle(&mut window);
    assert!(window.query_by_label("Apply…").is_none());
    window.key_press(Key::C);
    settle(&mut window);
    assert!(says(&window, "Nothing to apply: no setting or offset corrects"), "C tells why");
    let offset = Cause::AzimuthOffset { offset_deg: 0.25 };
    let mut model = explained_by(offset, |_| ());
    let antenna = &mut model.shown_mut().antennas[0];
    let group = Arc::make_mut(&mut Arc::make_mut(&mut antenna.snapshot).state.groups)
        .get_mut("general")
        .unwrap();
    let values = group.last_read.as_ref().unwrap().values.clone();
    let change = Change { ticket: 1, group: "general", values, expected: None, is_unlocked: false };
    group.written = Some(Arc::new(Written { change, time: rig::now(), result: Ok(()) }));
    let mut window = rig::window(LARGE, model);
    settle(&mut window);
    assert!(window.query_by_label("Apply…").is_none(), "it may be corrected already");
}

/// Collects the lines that were painted with this width.
fn lines(shape: &egui::Shape, width: f32, found: &mut Vec<Vec<egui::Pos2>>) {
    match shape {
        egui::Shape::Vec(shapes) => shapes.iter().for_each(|of| lines(of, width, found)),
        egui::Shape::Path(path) if (path.stroke.width - width).abs() < 0.01 && !path.closed => {
            found.push(path.points.clone());
        }
        _ => {}
    }
}

#[test]
fn the_times_of_aos_and_los_do_not_lie_on_the_path() {
    for size in [LARGE, [1920.0, 1080.0], [2560.0, 1440.0]] {
        let mut window = view(size);
        settle(&mut window);
        let sky = window.get_by_label_contains("Sky plot of the pass.").rect();
        let mut found = Vec::new();
        for clipped in &window.output().shapes {
            lines(&clipped.shape, 2.0, &mut found);
        }
        found.retain(|line| line.iter().all(|at| sky.contains(*at)));
        assert!(!found.is_empty(), "a path");
        let texts = painted::placed(&window);
        let ends = texts.iter().filter(|(words, at)| {
            sky.expand(30.0).contains_rect(*at)
                && ["AOS", "LOS"].iter().any(|of| words.starts_with(of))
        });
        assert_eq!(ends.clone().count(), 2, "{size:?}");
        for (words, at) in ends {
            let letters = at.shrink(1.0);
            let is_crossed = found.iter().flat_map(|line| line.windows(2)).any(|pair| {
                (0..=20).any(|step| letters.contains(pair[0].lerp(pair[1], step as f32 / 20.0)))
            });
            assert!(!is_crossed, "{size:?}: {words} at {at:?}");
        }
    }
}

#[test]
fn the_bar_of_the_link_runs_below_its_words_and_a_loss_of_no_length_is_not_told() {
    let (mut model, mut flown) = model();
    let report = &mut flown[0].pass.report;
    let (time, data) = (report.start, serde_json::Value::from("Connected"));
    let until = add_seconds(time, 0.4);
    report.report.losses.push(LostStretch { start: time, end: until, cause: LossCause::EarlyEnd });
    let row = Row { time, run: 1, steady_s: None, antenna: None, kind: "link".to_owned(), data };
    flown[0].entries.push(row);
    model.shown_mut().recorded = Some(Arc::new(recorded(&flown, 0)));
    let mut window = rig::window(LARGE, model);
    settle(&mut window);
    let ground = theme::tokens(&window.ctx).bg0;
    assert_eq!(painted::ground_of(&window, "Connected"), Some(ground));
    assert!(!painted::texts(&window).iter().any(|words| words.contains("half the beamwidth 0:00")));
}

#[test]
fn a_gap_is_told_from_its_beginning_and_a_stop_with_who_pressed_it() {
    let (mut model, mut flown) = model();
    let from = flown[0].pass.report.start;
    let row = |kind: &str, time, data| Row {
        time,
        run: 1,
        steady_s: None,
        antenna: None,
        kind: kind.to_owned(),
        data,
    };
    let pressed = serde_json::json!({"by": "window", "antennas": [1], "is_for_all": true});
    let gap = serde_json::json!({"since": from + 2.minutes(), "positions": 3});
    flown[0].entries = vec![
        row("stop", from + 1.minutes(), pressed),
        row("stop", from + 61.seconds(), "Stopped".into()),
        row("gap", flown[0].pass.report.end + 1.hour(), gap),
    ];
    let lasted_s = flown[0].pass.report.end.duration_since(from + 2.minutes()).as_secs_f64();
    model.shown_mut().recorded = Some(Arc::new(recorded(&flown, 0)));
    let mut window = rig::window(LARGE, model);
    settle(&mut window);
    let at = |minutes: i64| (from + minutes.minutes()).strftime("%H:%M:%SZ").to_string();
    window.get_by_label(&format!("{}: STOP (from the window)", at(1)));
    window.get_by_label_contains(": Stopped");
    let lasted = format::duration(lasted_s + 3600.0);
    window.get_by_label(&format!("{}: Not recorded for {lasted}", at(2)));
}

#[test]
fn an_acknowledged_alarm_is_no_new_one() {
    let (mut model, mut flown) = model();
    let came = flown[0].pass.report.start + 1.minutes();
    let alarm = Alarm {
        id: 7,
        row: 7,
        antenna: Some(flown[0].pass.antenna),
        kind: AlarmKind::AutomaticSuspended(Interruption::Elsewhere),
        raised: came,
        last: came,
        count: 1,
        acknowledged: false,
        over_since: None,
        shelved_until: None,
    };
    let seen = Alarm { acknowledged: true, ..alarm.clone() };
    let over = Alarm { over_since: Some(came + 3.minutes()), ..seen.clone() };
    // This alarm came before the shown stretch.
    let older = Alarm { id: 3, last: came - 1.hour(), ..seen.clone() };
    let row = |time, alarm: &Alarm| Row {
        time,
        run: 1,
        steady_s: None,
        antenna: None,
        kind: "alarm".to_owned(),
        data: serde_json::to_value(alarm).unwrap(),
    };
    flown[0].entries = vec![
        row(came, &alarm),
        row(came + 1.minutes(), &seen),
        row(came + 2.minutes(), &older),
        row(came + 3.minutes(), &over),
    ];
    model.shown_mut().recorded = Some(Arc::new(recorded(&flown, 0)));
    let mut window = rig::window(LARGE, model);
    settle(&mut window);
    let told = |minutes: i64, what: &str| {
        let at = (came + minutes.minutes()).strftime("%H:%M:%SZ").to_string();
        window.query_by_label_contains(&format!("{at}: {what}")).is_some()
    };
    assert!(told(1, "Acknowledged: ") && told(2, "Acknowledged: ") && told(3, "Over: "));
    assert!(told(0, "") && !told(0, "Acknowledged") && !told(0, "Over"));
}

#[test]
fn what_stood_in_the_way_is_on_the_path_where_it_is_known() {
    let named = |has_mask: bool, site: Site| {
        let (mut model, flown) = model();
        model.shown_mut().antennas[0].config =
            Arc::new(station::Antenna::satrak("Dish", "10.0.0.5:4001"));
        Arc::make_mut(&mut model.shown_mut().antennas[0].config).id = flown[0].pass.antenna;
        let mask = HorizonMask::from_degrees([(0.0, 5.0), (90.0, 30.0), (180.0, 5.0)]).unwrap();
        let station = Arc::make_mut(&mut model.shown_mut().station);
        (station.horizon_mask, station.site) = (has_mask.then_some(mask), site);
        let window = rig::window(LARGE, model);
        ["mask", "keyhole"].map(|word| window.query_by_label(word).is_some())
    };
    let here = rig::station().site;
    assert_eq!(named(false, here), [false, true], "of an X/Y mount");
    assert_eq!(named(true, here), [true, true]);
    let elsewhere = Site::new(-30.0, 20.0, 0.0).unwrap();
    assert_eq!(named(true, elsewhere), [false, true], "the mask of another site");
}

#[test]
fn half_of_a_wide_beam_is_named_within_the_margin() {
    for size in SIZES {
        let (mut model, mut flown) = model();
        flown[0].pass.report.half_beam_deg = 10.0;
        model.shown_mut().recorded = Some(Arc::new(recorded(&flown, 0)));
        let window = rig::window(size, model);
        let runs = painted::runs(&window);
        // The painter leaves blanks out.
        let name = runs.iter().find(|run| run.text == "10.00halfbeam").expect("it is whole");
        assert!(name.rect.right() <= size[0] - 16.0, "{:?}", name.rect);
    }
}

#[test]
fn nothing_lies_on_another_and_in_a_usual_window_nothing_is_cut() {
    for size in SIZES {
        let mut window = view(size);
        settle(&mut window);
        nothing_overlaps(&window);
    }
    let mut window = view(LARGE);
    settle(&mut window);
    nothing_is_cut(&window, LARGE);
}

#[test]
fn two_causes_that_act_together_stand_together_and_the_passes_before_are_told() {
    for size in SIZES {
        let mut model = rig::model(settings_rig::read());
        let mut flown = flown(&model);
        let mixed = Explanation {
            cause: Cause::ElevationOffset { offset_deg: 0.25 },
            partner: Some(Cause::AzimuthOffset { offset_deg: -0.5 }),
            left_deg: 0.01,
            share: 0.97,
        };
        flown[0].pass.report.causes = vec![mixed];
        let mut found = recorded(&flown, 0);
        let explanations = vec![Explanation { partner: None, share: 0.92, ..mixed }];
        found.combined = Some(ExplainedPasses { passes: 12, start: None, explanations });
        model.shown_mut().recorded = Some(Arc::new(found));
        model.view = View::Record;
        let name = model.antennas[0].config.name.clone();
        let mut window = rig::window(size, model);
        settle(&mut window);
        window.get_by_label_contains(
            "Elevation offset +0.25° with azimuth offset −0.50°: explains 97 %, 0.010° left",
        );
        assert!(
            says(&window, "together they explain 97 % of the error"),
            "the verdict tells the best"
        );
        let said = format!(
            "The 12 passes of {name} up to this one, together: Elevation offset +0.25°; that explains 92 % of \
             their error."
        );
        window.get_by_label(&said);
        // One correction enters both values.
        window.query_all_by_label("Apply…").next().unwrap().scroll_to_me();
        settle(&mut window);
        let _ = asked(&mut window);
        window.query_all_by_label("Apply…").next().unwrap().click();
        let _ = asked(&mut window);
        window.state_mut().model.view = View::Antennas;
        settle(&mut window);
        for field in ["Azimuth offset", "Elevation offset"] {
            assert_eq!(settings_rig::state_of(&window, field), "Edited", "{field}");
        }
    }
}
