//! Automatic operation of a station with three antennas at 100 times real time: what was tracked is
//! the schedule, and each difference has its cause in the list of the day. An hour and a half here;
//! `AZEL_HOURS=24 cargo test --test processes rehearsed::automatic` takes a day.

use std::{num::NonZeroU32, sync::Arc};

use azel::{
    astro::time::seconds_between,
    driver,
    engine::{
        Client, Command,
        automatic::{Flown, Interruption, MissCause, Operation},
    },
    sim::satrak,
    station::{AntennaId, LockOut, Station},
};
use jiff::Timestamp;

use super::scene::{self, Scene, flown, measured, operation, set_automatic, start, until};

/// Slow enough for a busy computer.
const SPEED: NonZeroU32 = NonZeroU32::new(100).unwrap();

/// The station with its antennas on the way to little rest and no long warning.
fn station() -> Station {
    let mut station = scene::station();
    station.scheduling.warn_after_rest_min = 24.0 * 60.0;
    station
}

/// Waits until the clock of the station shows a time.
fn until_time(client: &Client, at: Timestamp) {
    let patience = std::time::Instant::now() + std::time::Duration::from_mins(10);
    while client.now().utc < at {
        assert!(std::time::Instant::now() < patience);
        std::thread::sleep(scene::LOOK);
    }
}

fn add_hours(at: Timestamp, hours: f64) -> Timestamp {
    azel::astro::time::add_seconds(at, hours * 3600.0)
}

#[test]
fn a_station_takes_its_passes_by_itself_and_each_that_it_misses_has_its_cause() {
    let hours: f64 = std::env::var("AZEL_HOURS").map_or(1.5, |text| text.parse().unwrap());
    let scene = Scene::with(start(), SPEED, &station());
    let client = scene.client();
    let [dish, mast, horn] = ["Dish", "Mast", "Horn"].map(|name| measured(&client, name));
    until("the schedule", || client.snapshot().schedule.made_at);
    for antenna in [dish, mast] {
        set_automatic(&client, antenna, true);
    }
    let lock_out = LockOut { by: "Ada".to_owned(), reason: "belts".to_owned(), since: start() };
    let _ = client.send(Command::Antenna(horn, driver::Command::LockOut(lock_out)));

    // Somebody sends the mast elsewhere in the middle of a pass.
    until("a pass of the mast", || operation(&client, mast).taking()?.proved_at);
    let taken = operation(&client, mast).taking().copied().unwrap();
    until("the pass", || (client.now().utc > taken.from).then_some(()));
    until("the interruption", || {
        let _ = client.send(Command::Antenna(mast, driver::Command::Park));
        let by = Interruption::ByHand;
        matches!(operation(&client, mast), Operation::Suspended { by: found, .. } if found == by)
            .then_some(())
    });
    until_time(&client, taken.until);
    assert!(!operation(&client, mast).is_on(), "the end of a pass ends no suspension");
    let _ = client.send(Command::GoOn(mast));
    until("the mast to go on", || operation(&client, mast).is_on().then_some(()));

    // The unit of the dish does not answer for some minutes.
    let middle = add_hours(start(), hours / 2.0);
    until_time(&client, middle);
    scene.units.dish.set_fault(satrak::Fault::Silence, true);
    until_time(&client, add_hours(middle, 0.1));
    scene.units.dish.set_fault(satrak::Fault::Silence, false);

    until_time(&client, add_hours(start(), hours));
    client.stop_all();
    for antenna in [dish, mast] {
        until("automatic operation to end", || {
            matches!(operation(&client, antenna), Operation::Off(_)).then_some(())
        });
    }

    let flown = flown(&client);
    for (antenna, of) in &flown {
        println!("{antenna:?} {} {:.0} of {:.0} s {:?}", of.name, of.in_beam_s, of.of_s, of.cause);
    }
    // A busy computer answers late at this speed, which costs seconds.
    let is_had = |(_, of): &&(AntennaId, Flown)| of.in_beam_s > 0.75 * of.of_s;
    let had = flown.iter().filter(is_had).count();
    assert!(had >= 2 && had * 2 >= flown.len(), "{had} passes of {}", flown.len());
    let is_interrupted = |(antenna, of): &(AntennaId, Flown)| {
        *antenna == mast && of.cause == Some(MissCause::Suspended(Interruption::ByHand))
    };
    assert!(flown.iter().any(is_interrupted));
    assert!(flown.iter().all(|(antenna, _)| *antenna != horn), "it is locked out");
    let schedule = Arc::clone(&client.snapshot().schedule);
    assert!(schedule.schedule.entries.iter().all(|entry| entry.antenna != horn));
    for (_, of) in &flown {
        assert!(of.cause.is_some() || of.lost_s() < 0.01 * of.of_s, "{of:?}");
        assert!(seconds_between(start(), of.pass.1) > -3600.0);
    }
}
