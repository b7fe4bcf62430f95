//! Saves of a station while an antenna moves.

use azel::{
    astro::{Angle, Site},
    contract::{Command, alarms::AlarmKind, antenna::AntennaModel, driver},
    station::Station,
};

use super::unattended::scene_of;
use crate::common::units::{measured, until};

#[tokio::test(start_paused = true)]
async fn the_site_is_not_changed_under_an_antenna_that_moves() {
    let (_scene, client, id) = scene_of("Mast", |_| {}).await;
    measured(&client, "Mast").await;
    let before = client.snapshot().station.site;
    let mut station = Station::clone(&client.snapshot().station);
    station.site = Site::new(40.0, 29.0, 0.0).unwrap();
    station.name = "Hill".to_owned();
    let save = || Command::SaveStation(Box::new(station.clone()));
    let is_refused = |of: &AlarmKind| matches!(of, AlarmKind::Settings(why) if why.starts_with("Mast moves or tracks: stop it"));
    let (azimuth, elevation) = (Some(Angle::from_degrees(200.0)), Some(Angle::from_degrees(40.0)));
    let go = driver::Command::Position { azimuth, elevation };
    client.send(Command::Antenna(id, go)).unwrap();
    until("a motion", || {
        client.snapshot().antennas.first().is_some_and(AntennaModel::is_busy).then_some(())
    })
    .await;
    client.send(save()).unwrap();
    until("the refusal", || {
        let snapshot = client.snapshot();
        snapshot.alarms.in_order().iter().any(|of| is_refused(&of.alarm.kind)).then_some(())
    })
    .await;
    assert_eq!(client.snapshot().station.site, before);
    client.stop_all();
    until("standstill", || {
        let snapshot = client.snapshot();
        let antenna = snapshot.antennas.first()?;
        (!antenna.is_busy() && !antenna.snapshot.unproved).then_some(())
    })
    .await;
    client.send(save()).unwrap();
    until("the new site", || (client.snapshot().station.name == "Hill").then_some(())).await;
    assert_eq!(client.snapshot().station.site, station.site);
}
