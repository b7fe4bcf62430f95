//! Automatic operation of a station with three antennas. The tracked passes match the schedule, and
//! the list of the day has the cause of each difference. The test takes an hour and a half;
//! `AZEL_HOURS=24 cargo test --test azel rehearsed::automatic` takes a day.

use std::{sync::Arc, time::Duration};

use azel::{
    astro::time::seconds_between,
    contract::{
        Command,
        automatic::{Flown, Interruption, MissCause, OffBecause, Operation},
        driver,
        passes::PassListKey,
    },
    engine::Client,
    plan::{pass_report::LossCause, schedule::Entry},
    sim::satrak,
    station::{AntennaId, LockOut, Station},
};
use jiff::Timestamp;

use super::{
    flown,
    scene::{Scene, operation, set_automatic},
};
use crate::common::units::{self, measured, start, until};

/// Returns a station that starts in automatic operation and warns of rest only after a day.
fn station() -> Station {
    let mut station = units::station();
    station.scheduling.warn_after_rest_min = 24.0 * 60.0;
    for antenna in &mut station.antennas {
        antenna.automatic.is_on_at_start = true;
    }
    station
}

/// Observations of the running station. The list of the day covers only one day and one run, so the
/// test collects them.
#[derive(Default)]
struct Witness {
    /// Entries of the schedule that were under way: antenna, satellite and AOS.
    begun: Vec<(AntennaId, PassListKey)>,
    flown: Vec<(AntennaId, Flown)>,
}

impl Witness {
    fn look(&mut self, client: &Client) {
        let (schedule, now) = (Arc::clone(&client.snapshot().schedule), client.now().utc);
        let is_under_way = |entry: &&Entry| {
            let is_off = matches!(operation(client, entry.antenna), Operation::Off(_));
            entry.start < now && now < entry.end && !is_off
        };
        for entry in schedule.schedule.entries.iter().filter(is_under_way) {
            let pass = (entry.pass.satellite, entry.pass.aos);
            if !self.begun.iter().any(|of| of.0 == entry.antenna && is_same(of.1, pass)) {
                self.begun.push((entry.antenna, pass));
            }
        }
        for (antenna, of) in flown(client) {
            if !self.is_told(antenna, of.pass) {
                self.flown.push((antenna, of));
            }
        }
    }

    fn is_told(&self, antenna: AntennaId, pass: PassListKey) -> bool {
        self.flown.iter().any(|(id, of)| *id == antenna && is_same(of.pass, pass))
    }

    /// Looks each second until the clock of the station shows `at`; a pass lasts for minutes.
    async fn until_time(&mut self, client: &Client, at: Timestamp) {
        while client.now().utc < at {
            self.look(client);
            tokio::time::sleep(Duration::from_secs(1)).await;
        }
    }
}

fn is_same(one: PassListKey, other: PassListKey) -> bool {
    one.0 == other.0 && seconds_between(one.1, other.1).abs() < 60.0
}

fn add_hours(at: Timestamp, hours: f64) -> Timestamp {
    azel::astro::time::add_seconds(at, hours * 3600.0)
}

#[tokio::test(start_paused = true)]
async fn a_station_takes_its_passes_by_itself_and_each_that_it_misses_has_its_cause() {
    let hours: f64 = std::env::var("AZEL_HOURS").map_or(1.5, |text| text.parse().unwrap());
    let mut scene = Scene::new(start(), &station());
    let mut client = scene.client();
    let mut witness = Witness::default();
    let dish = measured(&client, "Dish").await;
    let mast = measured(&client, "Mast").await;
    let horn = measured(&client, "Horn").await;
    until("the schedule", || client.snapshot().schedule.made_at).await;
    for antenna in [dish, mast] {
        set_automatic(&client, antenna, true).await;
    }
    let lock_out =
        LockOut { operator: "Ada".to_owned(), reason: "belts".to_owned(), start: start() };
    let _ = client.send(Command::Antenna(horn, driver::Command::LockOut(lock_out)));

    // Somebody sends the mast elsewhere in the middle of a pass.
    until("a pass of the mast", || operation(&client, mast).taking()?.proved_at).await;
    let taken = operation(&client, mast).taking().copied().unwrap();
    until("the pass", || (client.now().utc > taken.start).then_some(())).await;
    until("the interruption", || {
        let _ = client.send(Command::Antenna(mast, driver::Command::Park));
        let by = Interruption::ByHand;
        matches!(operation(&client, mast), Operation::Suspended { interruption: found, .. } if found == by)
            .then_some(())
    })
    .await;
    witness.until_time(&client, taken.end).await;
    assert!(!operation(&client, mast).is_on(), "the end of a pass ends no suspension");
    let _ = client.send(Command::GoOn(mast));
    until("the mast to go on", || operation(&client, mast).is_on().then_some(())).await;

    // The unit of the dish does not answer for some minutes.
    let middle = add_hours(start(), hours / 2.0);
    witness.until_time(&client, middle).await;
    scene.units.dish.set_fault(satrak::Fault::Silence, true);
    witness.until_time(&client, add_hours(middle, 0.1)).await;
    scene.units.dish.set_fault(satrak::Fault::Silence, false);

    // The program ends and starts again.
    witness.until_time(&client, add_hours(start(), hours * 0.7)).await;
    witness.look(&client);
    // A pass under way has no entry in the list of either run.
    let told = std::mem::take(&mut witness.begun).into_iter();
    witness.begun = told.filter(|(antenna, pass)| witness.is_told(*antenna, *pass)).collect();
    assert!([dish, mast].iter().all(|antenna| operation(&client, *antenna).is_on()));
    for antenna in &client.snapshot().antennas {
        let passes = &antenna.tally.passes;
        let flown = witness.flown.iter().filter(|(id, _)| *id == antenna.id()).count() as u64;
        let counted = passes.whole + passes.partial + passes.missed;
        assert_eq!(counted, flown, "the metrics count each pass once: {passes:?}");
    }
    scene = scene.started_again(false).await;
    client = scene.client();
    for (name, antenna) in [("Dish", dish), ("Mast", mast)] {
        measured(&client, name).await;
        assert!(operation(&client, antenna).is_on(), "{name} goes on");
    }

    // The unit of the dish refuses settings until that has cost it two passes.
    witness.until_time(&client, add_hours(start(), hours)).await;
    scene.units.dish.set_fault(satrak::Fault::RefuseSettings, true);
    let refused = Operation::Off(OffBecause::Failures);
    while operation(&client, dish) != refused {
        let now = client.now().utc;
        assert!(now < add_hours(start(), hours + 6.0), "{:?}", client.snapshot().day);
        if !operation(&client, dish).is_on() {
            let _ = client.send(Command::SetAutomatic { antenna: dish, is_on: true });
        }
        witness.until_time(&client, add_hours(now, 0.02)).await;
    }
    scene.units.dish.set_fault(satrak::Fault::RefuseSettings, false);

    client.stop_all();
    until("automatic operation to end", || {
        matches!(operation(&client, mast), Operation::Off(OffBecause::Stop)).then_some(())
    })
    .await;
    let end = client.now().utc;
    witness.until_time(&client, add_hours(end, 0.5)).await;

    let flown = &witness.flown;
    for (antenna, of) in flown {
        println!("{antenna:?} {} {:.0} of {:.0} s {:?}", of.name, of.in_beam_s, of.of_s, of.cause);
    }
    let had = |of: &Flown| of.in_beam_s > 0.97 * of.of_s;
    // Antennas of the passes that the test disturbed on purpose, by cause.
    let causes = |wanted: MissCause| {
        flown.iter().filter(move |(_, of)| of.cause == Some(wanted)).map(|(antenna, _)| *antenna)
    };
    let by_hand = MissCause::Suspended(Interruption::ByHand);
    assert!(causes(by_hand).any(|antenna| antenna == mast));
    assert!(causes(MissCause::Refused).any(|antenna| antenna == dish));
    assert!(flown.iter().all(|(antenna, _)| *antenna != horn), "it is locked out");
    let schedule = Arc::clone(&client.snapshot().schedule);
    assert!(schedule.schedule.entries.iter().all(|entry| entry.antenna != horn));
    for (antenna, of) in flown {
        let is_disturbed =
            of.cause.is_some_and(|cause| cause != MissCause::Lost(LossCause::OutsideBeam));
        assert!(is_disturbed || had(of), "{antenna:?} {of:?}");
    }
    assert!(flown.iter().filter(|(_, of)| had(of)).count() >= 2);
    let is_told = |(antenna, pass): &&(AntennaId, PassListKey)| witness.is_told(*antenna, *pass);
    let begun = &witness.begun;
    assert!(begun.iter().all(|it| is_told(&it)), "each entry is told of: {begun:?} {flown:?}");
}
