//! Serialization of every command and event of a station.

use azel::{
    astro::{Angle, AzEl, Offset, TrackOffsets},
    contract::{
        Attention, Command, Event,
        alarms::ShelveTime,
        closing::CloseHow,
        control::ClientCommand,
        driver::{self, OffsetChange},
        older_sets::SetChoice,
        passes::{ListChoice, Scope},
        source_tests::{SourceOrder, TestAsk, TestedSource},
        sources::Copied,
        transfer::{FileName, Peer, TleFile},
        uploads::{Ask, Cargo, Order},
    },
    controller::SPECS,
    device::{
        Pointing, TrackTarget,
        panel::Act,
        settings::{Change, Value, Values},
    },
    orbit::{Elements, PassSearch, Propagator, RefreshHours, Source, bundled, passes},
    plan::{OnBoardPass, ProgramTrack, Target},
    secret::Secret,
    station::{
        Antenna, AntennaId, Frequency, Hook, HookAction, HookEvent, LockOut, OffsetsSubject,
        Priority, RuleSubject, Station,
    },
};
use jiff::{Timestamp, ToSpan as _};

use crate::common::comes_back;

const ANTENNA: AntennaId = AntennaId(7);

fn noon() -> Timestamp {
    "2026-08-12T12:00:00.123456789Z".parse().unwrap()
}

/// Returns one of each command and no more. A new command does not compile until this list has it.
#[expect(clippy::too_many_lines, reason = "one line a command")]
fn commands_of_antennas() -> Vec<driver::Command> {
    use azel::contract::driver::Command as C;
    let elements = bundled().unwrap().get(25_544).unwrap().clone();
    let site = Station::default().site;
    let track = || {
        ProgramTrack::new(
            Target::Satellite(Box::new(elements.clone())),
            site,
            vec![(noon(), Timestamp::MAX)],
        )
    };
    let pass = OnBoardPass {
        target: TrackTarget {
            catalog_number: 25_544,
            name: "ISS (ZARYA)".to_owned(),
            element_file: None,
            start: noon(),
            end: Timestamp::MAX,
        },
        elements: elements.clone(),
        site,
        is_agreed: true,
    };
    let values = Values::from([
        ("flag", Value::Flag(true)),
        ("choice", Value::Choice(-3)),
        ("integer", Value::Integer(i64::MIN)),
        ("decimal", Value::Decimal(0.1 + 0.2)),
        ("text", Value::Text("\u{0} \"Ä\"".to_owned())),
        ("password", Value::Secret(Secret::new("hunter2"))),
        ("time", Value::Time(noon())),
    ]);
    let act = Act { action: "to_counts", values: values.clone() };
    let change = Change {
        ticket: u64::MAX,
        group: "general",
        values: values.clone(),
        expected: Some(values),
        is_unlocked: true,
    };
    let lock_out = LockOut { operator: "A".to_owned(), start: noon(), reason: "grease".to_owned() };
    let all = vec![
        C::Standby,
        C::Manual,
        C::Hold,
        C::Jog { rates_deg_s: [1.0 / 3.0, -0.0] },
        C::EndJog,
        C::AllowUnguarded,
        C::AllowWayOut,
        C::ForgetDrives,
        C::MoveAway,
        C::Step { steps_deg: [0.1, f64::MIN_POSITIVE] },
        C::Position { azimuth: Some(Angle::from_degrees(0.1)), elevation: None },
        C::Track(Box::new(pass)),
        C::ProgramTrack(Box::new(track())),
        C::ProgramTrackIntoSun(Box::new(track())),
        C::EndAtTarget,
        C::Resume,
        C::Offset(OffsetChange::Step(Offset::Along(Angle::from_degrees(-0.1)))),
        C::Offset(OffsetChange::Zero),
        C::FirstOffsets(
            TrackOffsets::NONE.plus(Offset::Azimuth(Angle::from_degrees(0.1))).unwrap(),
        ),
        C::SeenStanding,
        C::Park,
        C::Preview(Some(Pointing { azimuth: Some(Angle::from_degrees(0.1)), elevation: None })),
        C::Connect,
        C::Disconnect,
        C::Act(act.clone()),
        C::ActUnseen(act),
        C::AutoTrack(true),
        C::ReadGroup("general"),
        C::WriteSettings(change),
        C::LockOut(lock_out),
        C::Unlock,
        C::TakeOver,
        C::Ask("STATUS?".into()),
    ];
    for command in &all {
        match command {
            C::Standby
            | C::Manual
            | C::Hold
            | C::Jog { .. }
            | C::EndJog
            | C::AllowUnguarded
            | C::AllowWayOut
            | C::ForgetDrives
            | C::MoveAway
            | C::Step { .. }
            | C::Position { .. }
            | C::Track(_)
            | C::TakeOver
            | C::ProgramTrack(_)
            | C::ProgramTrackIntoSun(_)
            | C::EndAtTarget
            | C::Resume
            | C::Offset(_)
            | C::FirstOffsets(_)
            | C::SeenStanding
            | C::Park
            | C::Preview(_)
            | C::Connect
            | C::Disconnect
            | C::Act(_)
            | C::ActUnseen(_)
            | C::AutoTrack(_)
            | C::ReadGroup(_)
            | C::WriteSettings(_)
            | C::LockOut(_)
            | C::Unlock
            | C::Ask(_) => {}
        }
    }
    all
}

#[test]
fn what_is_asked_of_an_antenna_comes_back() {
    for command in commands_of_antennas() {
        let back = comes_back(&Command::Antenna(ANTENNA, command.clone()));
        // Serialization leaves secrets out.
        if !format!("{command:?}").contains("Secret") {
            assert_eq!(back, Command::Antenna(ANTENNA, command));
        }
    }
}

fn order() -> Order {
    let catalog = bundled().unwrap();
    let takes = SPECS.iter().find_map(|make| make.element_files).unwrap();
    Order {
        antenna: "Dish".to_owned(),
        takes,
        unit: Peer { host: "10.0.0.5".to_owned(), port: 22 },
        folder: takes.folder.to_owned(),
        file: FileName::new("weather.txt", takes).unwrap(),
        user: takes.factory_user.to_owned(),
        key_file: Some("/home/o/.ssh/id".into()),
        cargo: Cargo::New(TleFile::new([catalog.get(25_544).unwrap()], takes).unwrap()),
        satellite: Some(25_544),
        is_unattended: false,
    }
}

#[test]
fn what_is_asked_of_a_station_comes_back() {
    let pass = (25_544, noon());
    let station = Station {
        antennas: SPECS.iter().map(|make| make.antenna(make.name, "host:1")).collect(),
        keep_outs: vec![crate::common::mast(&[(1.0, 0.0), (9.0, 0.0), (9.0, 40.0), (1.0, 40.0)])],
        ..Station::default()
    };
    let station = Station {
        antennas: (1..)
            .map(AntennaId)
            .zip(station.antennas)
            .map(|(id, antenna)| Antenna { id, ..antenna })
            .collect(),
        ..station
    };
    let source = TestedSource::Web { url: "https://example.org/a.txt".to_owned() };
    let commands = [
        Command::Track { antenna: ANTENNA, pass, is_agreed: true },
        Command::ProgramTrackPass { antenna: ANTENNA, pass },
        Command::SetElevationFloor(12.3),
        Command::CancelSearch(Scope::All),
        Command::ResumeSearch(Scope::Favourites),
        Command::SetFavourites { numbers: vec![999_999_999], is_favourite: true },
        Command::ListOlderSets(25_544),
        Command::UseSet(SetChoice::Older { catalog_number: 25_544, epoch: noon() }),
        Command::UseSet(SetChoice::Newest { catalog_number: 25_544 }),
        Command::CopyElements { name: "own".to_owned(), origin: Copied::Text("x".to_owned()) },
        Command::SetRefresh { name: "active".to_owned(), hours: Some(RefreshHours::from(6)) },
        Command::SetFrequencies {
            satellite: 25_544,
            frequencies: Frequency::read_list("25544 145.8 Voice").unwrap(),
        },
        Command::KeepOffsets {
            subject: OffsetsSubject::Antenna(ANTENNA),
            offsets: TrackOffsets::NONE,
        },
        Command::SetSourceOrder { satellite: 25_544, sources: vec!["own".to_owned()] },
        Command::SetPriority { numbers: vec![25_544], priority: Priority::default() },
        Command::AddSource(Source::celestrak("weather")),
        Command::RemoveSource("weather".to_owned()),
        Command::RefreshSources { names: vec!["weather".to_owned()], forced: true },
        Command::OpenedAlarms,
        Command::AcknowledgeAlarm(u64::MAX),
        Command::AcknowledgeAlarms { newest: u64::MAX },
        Command::ShelveAlarm { id: 7, time: ShelveTime::OneHour },
        Command::UnshelveAlarm(7),
        Command::SaveSettings(ANTENNA),
        Command::CompareSettings(ANTENNA),
        Command::ReadCopy { antenna: ANTENNA, path: "/a b".into() },
        Command::CloseCopy,
        Command::SaveStation(Box::new(station)),
        Command::Upload(Ask::Begin(Box::new(order()))),
        Command::TestSource(TestAsk::Begin(Box::new(SourceOrder {
            antenna: "Dish".to_owned(),
            source,
            satellite: "ISS".to_owned(),
        }))),
        Command::TestLink(Box::new(SPECS[0].antenna("Dish", "host:1"))),
        Command::TryHook(Box::new(Hook {
            antenna: Some(ANTENNA),
            subject: Some(RuleSubject::Satellite(25_544)),
            delay_s: -30.0,
            ..Hook::new(
                "Recorder",
                HookEvent::Aos,
                HookAction::Command(vec!["record".to_owned(), "a b".to_owned()]),
            )
        })),
        Command::CloseAfter(CloseHow::Leave),
        Command::StayOpen,
        Command::Client(ANTENNA, ClientCommand::Point(AzEl::from_degrees(100.0, 20.0))),
        Command::Client(
            ANTENNA,
            ClientCommand::Turn { rates_deg_s: [1.5, -0.5], is_repeated: true },
        ),
        Command::TakeControl(ANTENNA),
        Command::ReleaseControl(ANTENNA),
        Command::HandOver { antenna: ANTENNA, client: "[::1]:4533".parse().unwrap(), always: true },
        Command::Look(Attention { list: ListChoice::default(), selected: Some(pass) }),
    ];
    for command in commands {
        assert_eq!(comes_back(&command), command);
    }
}

#[test]
fn a_typed_password_is_left_out() {
    let with = |secret: &str| Command::SetSourcePassword {
        name: "Space-Track".to_owned(),
        secret: Secret::new(secret),
        keep: true,
    };
    let command = with("hunter2");
    assert!(!serde_json::to_string(&command).unwrap().contains("hunter2"));
    assert_eq!(comes_back(&command), with(""));
}

#[test]
fn a_file_outside_of_its_folder_does_not_come_back() {
    let text = serde_json::to_string(&order()).unwrap();
    let outside = text.replace("weather.txt", "../weather.txt");
    let error = serde_json::from_str::<Order>(&outside).unwrap_err();
    assert!(error.to_string().contains("slash"), "{error}");
}

#[test]
fn elements_that_are_no_orbit_do_not_come_back() {
    let elements = bundled().unwrap().get(25_544).unwrap().clone();
    assert_eq!(comes_back(&elements), elements);
    let mut fields = serde_json::to_value(&elements).unwrap();
    fields["eccentricity"] = 1.5.into();
    assert!(serde_json::from_value::<Elements>(fields).is_err());
}

#[test]
fn elements_and_passes_come_back_by_range() {
    let catalog = bundled().unwrap();
    let elements: Vec<Elements> = catalog.range(3..5).cloned().collect();
    assert_eq!(comes_back(&elements), elements);
    assert!(elements.iter().eq(catalog.iter().skip(3).take(2)));
    let propagator = Propagator::new(&elements[0]).unwrap();
    let search = PassSearch::new(Station::default().site, noon(), noon() + 48.hours());
    let passes = passes(&propagator, &search, &|| false);
    assert!(!passes.is_empty());
    assert_eq!(comes_back(&passes), passes);
}

#[test]
fn what_a_station_tells_comes_back() {
    for event in [Event::Saved(Ok(noon())), Event::Saved(Err("full".to_owned()))] {
        assert_eq!(comes_back(&event), event);
    }
    assert_eq!(comes_back(&Event::Changed), Event::Changed);
    assert_eq!(comes_back(&Event::MayEnd), Event::MayEnd);
}
