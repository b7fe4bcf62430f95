//! Whole stations in memory: simulators instead of units and a clock for each station,
//! side by side in one process.

mod automatic;
mod prices;
mod recorded;
mod rehearsal;
mod replay;
mod scene;
mod unattended;

use std::{num::NonZeroU32, thread};

use azel::{
    astro::time::seconds_between,
    cli::serve::{Ended, Wake, until_the_end},
    driver,
    engine::{Client, Command, Snapshot, alarms::AlarmKind, status::LinkStatus},
    orbit::{PassSearch, Propagator, bundled, passes},
    plan::{ProgramTrack, Target},
    sim::{rc2000c, rotator_genius, satrak},
    station::{Notices, Station},
};
use jiff::ToSpan as _;

use scene::{FAST, Scene, Units, antenna, measured, move_by, passed_s, start, until};

#[test]
fn two_stations_live_in_one_process_one_of_them_at_200_times_real_time() {
    let (real, fast) = (Scene::at_speed(NonZeroU32::MIN), Scene::at_speed(FAST));
    let (here, there) = (real.client(), fast.client());
    for name in ["Dish", "Mast", "Horn"] {
        measured(&here, name);
        measured(&there, name);
    }
    let before = here.now().steady;
    let went = there.now().steady;
    let sun = ProgramTrack::new(Target::Sun, there.snapshot().station.site, Vec::new());
    move_by(&there, "Mast", &driver::Command::ProgramTrack(Box::new(sun)));
    until("ten minutes", || ((there.now().steady - went).as_secs() > 600).then_some(()));
    assert!((here.now().steady - before).as_secs() < 60, "{:?}", here.now().steady - before);
    assert!(passed_s(&there) > 600.0);
    assert!(antenna(&here, "Mast").unwrap().1.tracks.is_none(), "they share nothing");
    assert!(real.units.all_stand());
    there.stop_all();
    until("standstill", || fast.units.all_stand().then_some(()));
}

#[test]
fn a_marked_pass_is_reminded_of_and_its_alarm_ends_when_an_antenna_takes_it() {
    const ISS: u32 = 25_544;
    let station = Station::default();
    let propagator = Propagator::new(bundled().unwrap().get(ISS).unwrap()).unwrap();
    let search = PassSearch {
        aos_elevation: station.aos_elevation(),
        floor: station.elevation_floor(),
        ..PassSearch::new(station.site, start(), start() + 24.hours())
    };
    let aos = passes(&propagator, &search, &|| false)[0].aos.time;
    let notices = Notices { reminder_min: 10.0, reminders: [ISS].into(), ..Notices::default() };
    let station = Station { notices, ..scene::station() };
    let scene = Scene::with(aos - 5.minutes(), NonZeroU32::new(30).unwrap(), &station);
    let client = scene.client();
    let is_raised = || {
        let snapshot = client.snapshot();
        let mut standing = snapshot.alarms.list().iter().filter(|alarm| !alarm.is_over());
        standing.any(|alarm| matches!(alarm.kind, AlarmKind::NoAntennaFor { .. }))
    };
    let reminder = until("the reminder", || client.snapshot().reminders.first().cloned());
    assert!(seconds_between(reminder.aos(), aos).abs() < 1.0, "{reminder:?}");
    assert_eq!((reminder.pass.0, &*reminder.name), (ISS, "ISS"));
    until("the alarm", || is_raised().then_some(()));
    assert!(seconds_between(client.snapshot().at.utc, aos) <= 30.0);
    let mast = measured(&client, "Mast");
    until("its end", || {
        let pass = reminder.pass;
        let _ = client.send(Command::ProgramTrackPass { antenna: mast, pass });
        (!is_raised()).then_some(())
    });
    assert!(client.snapshot().at.utc < reminder.los, "not by LOS");
    until("the track", || antenna(&client, "Mast")?.1.tracks);
}

/// Serializes every snapshot that it gets of a station until the station ends; returns
/// their number.
fn write_down(mut client: Client) -> usize {
    let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
    let mut count = 0;
    while runtime.block_on(client.changed()) {
        let snapshot = client.snapshot();
        let text = serde_json::to_string(&*snapshot).unwrap();
        let back: Snapshot = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}"));
        assert_eq!(serde_json::to_string(&back).unwrap(), text);
        // Only the catalog and the pass lists leave anything out.
        let shown = |of: &Snapshot| {
            let of = (
                (&of.at, &of.time_sync, &of.station, &of.sources),
                (&of.antennas, &of.alarms, &of.reminders),
                (&of.schedule, &of.day),
            );
            format!("{of:?}")
        };
        assert_eq!(shown(&back), shown(&snapshot));
        count += 1;
    }
    count
}

/// Switches one of nine kinds of trouble.
fn trouble(kind: u32, units: &Units, is_on: bool) {
    use rc2000c::Fault as Line;
    use rotator_genius::Fault as Socket;
    use satrak::Fault;
    match kind % 9 {
        0 => units.dish.set_fault(Fault::Silence, is_on),
        1 => units.dish.set_fault(Fault::Garbage, is_on),
        2 => units.dish.set_fault(Fault::HangUp, is_on),
        3 => units.mast.set_fault(Socket::DropReply, is_on),
        4 => units.mast.set_fault(Socket::Split, is_on),
        5 => units.mast.drop_clients(),
        6 => units.horn.set_fault(Line::BitError, is_on),
        7 => units.horn.set_fault(Line::Truncate, is_on),
        _ => units.horn.drop_clients(),
    }
}

/// An hour of a station without a window, in the main loop of the program.
#[test]
fn a_served_station_lives_an_hour_with_trouble_on_the_lines() {
    let scene = Scene::at_speed(FAST);
    let (client, units, end) = (scene.client(), scene.units.clone(), scene.end.clone());
    let witness = scene.client();
    let written = thread::Builder::new().name("writes".to_owned()).spawn(|| write_down(witness));
    let driving = thread::Builder::new().name("drives".to_owned()).spawn(move || {
        let site = client.snapshot().station.site;
        let sun = || ProgramTrack::new(Target::Sun, site, Vec::new());
        move_by(&client, "Mast", &driver::Command::ProgramTrack(Box::new(sun())));
        measured(&client, "Horn");
        let mut count = 0;
        while passed_s(&client) < 3600.0 {
            trouble(count, &units, true);
            let from = client.now().steady;
            until("20 s", || ((client.now().steady - from).as_secs() >= 20).then_some(()));
            trouble(count, &units, false);
            let from = client.now().steady;
            until("30 s", || ((client.now().steady - from).as_secs() >= 30).then_some(()));
            count += 1;
        }
        println!("an hour with {count} troubles");
        for name in ["Dish", "Mast", "Horn"] {
            until("the link after all that", || {
                let (id, status) = antenna(&client, name)?;
                if status.link == LinkStatus::Off {
                    let _ = client.send(Command::Antenna(id, driver::Command::Connect));
                }
                (status.link == LinkStatus::Up).then_some(())
            });
        }
        end.send(Wake::End).unwrap();
    });
    let Scene { station, woken, units, .. } = scene;
    let mut lines = 0_u32;
    let Ended { not_proved, broke_down } = until_the_end(station, &woken, &mut |_| lines += 1);
    driving.unwrap().join().unwrap();
    let written = written.unwrap().join().unwrap();
    assert!(written > 100, "{written} snapshots were written down");
    assert!(!broke_down);
    assert_eq!(not_proved, [""; 0]);
    assert!(units.all_stand());
    assert!(lines > 10, "{lines} lines of an hour with trouble");
}
